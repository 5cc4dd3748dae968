#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "taut/core/context.hpp"

namespace taut::paper {

struct Model;
struct ModelRun;

/// What the parts of the report share: what was asked for, and what one part has made that another needs, too.
struct Study {
  Context context;
  std::filesystem::path data;  ///< where real models are looked for; empty = nowhere
  std::map<std::string, std::shared_ptr<const Model>> models = {};   ///< by name, as far as they were needed
  std::map<std::string, std::shared_ptr<const ModelRun>> runs = {};  ///< the paths of Figure 7 by the model's name
};

/// Processor time of this program, all its threads together: what other programs do at the same time hardly changes it.
class ProcessorClock {
 public:
  [[nodiscard]] double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

class WallClock {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace taut::paper
