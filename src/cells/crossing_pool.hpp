#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "cells/crossing.hpp"

namespace taut::detail {

/// Crossing tests for the threads of a job: each block borrows one and gives it back.
class CrossingPool {
 public:
  CrossingPool(Surface surface, Vector origin, double size)
      : surface_(std::move(surface)), origin_(std::move(origin)), size_(size) {}

  class Loan {
   public:
    explicit Loan(CrossingPool& pool) : pool_(pool), test_(pool.take()) {}
    ~Loan() { pool_.give_back(std::move(test_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    CrossingTest& operator*() const { return *test_; }
    CrossingTest* operator->() const { return test_.get(); }

   private:
    CrossingPool& pool_;
    std::unique_ptr<CrossingTest> test_;
  };

  [[nodiscard]] const Surface& surface() const { return surface_; }
  /// Cells tested so far, once all loans are over.
  [[nodiscard]] Index num_tested() const {
    Index sum = 0;
    for (const auto& test : idle_) sum += test->num_tested();
    return sum;
  }

 private:
  std::unique_ptr<CrossingTest> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto test = std::move(idle_.back());
        idle_.pop_back();
        return test;
      }
    }
    // Outside the lock: evaluators take time to make.
    return std::make_unique<CrossingTest>(surface_, origin_, size_);
  }

  void give_back(std::unique_ptr<CrossingTest> test) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(test));
  }

  Surface surface_;
  Vector origin_;
  double size_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<CrossingTest>> idle_;
};

}  // namespace taut::detail
