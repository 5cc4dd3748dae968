#include "surface/formula/formula_function.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "surface/formula/kernels.hpp"

namespace taut::detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Bytes of slots a block may fill: a second-level cache. Fewer decoded instructions a point count for more than hits
/// in the first level (a tape of 6000 instructions and 680 slots: 2.7 us a point at 40 KB, 0.8 us at 350 KB).
constexpr std::size_t kBlockBytes = 512 * 1024;
constexpr std::size_t kMinBlock = 32;   // even if that does not fit
constexpr std::size_t kMaxBlock = 128;  // beyond, decoding costs nothing any more

/// Doubles on whole cache lines, as wide as any vector.
constexpr std::align_val_t kAlignment{64};
struct FreeAligned {
  void operator()(double* slots) const { ::operator delete(slots, kAlignment); }
};

class FormulaEvaluator : public Evaluator {
 public:
  explicit FormulaEvaluator(std::shared_ptr<const FormulaProgram> program)
      : Evaluator(program->dim(), program->codim()), program_(std::move(program)), step_(num_lanes()) {}

  void evaluate(const PointBatch& batch) override;
  void hessian_times(const PointBatch& batch, const double* v, double* out) override;
  bool bounds(const BoxBatch& batch) override;
  bool jacobian_bounds(const BoxBatch& batch) override;

 private:
  void run_on_boxes(const Tape& tape, const BoxBatch& batch);
  void run(const Tape& tape, const PointArrays& arrays, std::size_t n);
  /// Points of a block: a multiple of the vector length, whose slots fit the cache where possible; no more than needed.
  [[nodiscard]] std::size_t block_size(std::size_t slots, std::size_t n) const;
  double* slots(std::size_t count);
  void hessian_by_columns(const PointBatch& batch);
  /// Where x is NaN everything is, and where F_i is NaN so are its derivatives (else the branch of a min that was
  /// taken could hide it).
  void spread_nan(const PointBatch& batch, const double* value, double* product) const;
  [[nodiscard]] PointArrays arrays(const PointBatch& batch) const;

  std::shared_ptr<const FormulaProgram> program_;
  std::size_t step_;
  const Tape* value_tape_ = nullptr;  // found once: asking the program takes a lock
  const Tape* bounds_tape_ = nullptr;
  const Tape* jacobian_bounds_tape_ = nullptr;
  const Tape* jacobian_tape_ = nullptr;
  const Tape* hessian_tape_ = nullptr;
  const Tape* hessian_times_tape_ = nullptr;
  bool hessian_too_large_ = false;
  std::unique_ptr<double[], FreeAligned> slots_;
  std::size_t num_slots_ = 0;
  std::vector<double> value_;  // when F is needed to see its NaNs but was not asked for
};

double* FormulaEvaluator::slots(std::size_t count) {
  if (count > num_slots_) {
    slots_.reset(static_cast<double*>(::operator new(count * sizeof(double), kAlignment)));
    num_slots_ = count;
  }
  return slots_.get();
}

std::size_t FormulaEvaluator::block_size(std::size_t slots, std::size_t n) const {
  const std::size_t fitting = kBlockBytes / sizeof(double) / std::max<std::size_t>(slots, 1);
  const auto whole = [&](std::size_t lanes) { return lanes & ~(step_ - 1); };  // vectors: step_ is a power of two
  return std::max(step_, whole(std::min(std::clamp(fitting, kMinBlock, kMaxBlock), n + step_ - 1)));
}

void FormulaEvaluator::run(const Tape& tape, const PointArrays& arrays, std::size_t n) {
  const std::size_t block = block_size(tape.num_slots, n);
  run_points(tape, arrays, n, block, slots(tape.num_slots * block));
}

PointArrays FormulaEvaluator::arrays(const PointBatch& batch) const {
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  return {.input = {batch.x, batch.weight, nullptr},
          .input_stride = {d, k, d},
          .output = {batch.value, batch.jacobian, batch.hessian},
          .output_stride = {k, k * d, d * d}};
}

void FormulaEvaluator::evaluate(const PointBatch& batch) {
  if (batch.n <= 0) return;
  const auto n = static_cast<std::size_t>(batch.n);
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  PointArrays where = arrays(batch);
  const bool derivatives = batch.jacobian != nullptr || batch.hessian != nullptr;
  if (derivatives && batch.value == nullptr) {
    value_.resize(std::max(value_.size(), n * k));
    where.output[0] = value_.data();
  }

  if (batch.hessian != nullptr && hessian_tape_ == nullptr && !hessian_too_large_) {
    hessian_tape_ = program_->hessian();
    hessian_too_large_ = hessian_tape_ == nullptr;
  }
  if (batch.hessian != nullptr && d * d > kMaxOutputRow) std::fill_n(batch.hessian, n * d * d, 0.0);
  if (derivatives && jacobian_tape_ == nullptr) jacobian_tape_ = &program_->jacobian();
  if (batch.jacobian != nullptr && d * k > kMaxOutputRow) std::fill_n(batch.jacobian, n * d * k, 0.0);

  if (batch.hessian != nullptr && !hessian_too_large_) {
    run(*hessian_tape_, where, n);
  } else if (derivatives) {
    where.output[2] = nullptr;
    run(*jacobian_tape_, where, n);
  } else {
    if (value_tape_ == nullptr) value_tape_ = &program_->value();
    run(*value_tape_, where, n);
  }
  if (batch.hessian != nullptr && hessian_too_large_) hessian_by_columns(batch);
  spread_nan(batch, where.output[0], nullptr);
}

/// The Hessian of one point from its products with the unit vectors, which share the lanes.
void FormulaEvaluator::hessian_by_columns(const PointBatch& batch) {
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  if (hessian_times_tape_ == nullptr) hessian_times_tape_ = &program_->hessian_times();
  const std::size_t group = std::max<std::size_t>(step_, 64);
  std::vector<double> unit(group * d, 0.0);
  for (std::size_t j = 0; j < static_cast<std::size_t>(batch.n); ++j) {
    for (std::size_t first = 0; first < d; first += group) {
      const std::size_t count = std::min(group, d - first);
      for (std::size_t i = 0; i < count; ++i) unit[i * d + first + i] = 1;
      run(*hessian_times_tape_,
          {.input = {batch.x + j * d, batch.weight + j * k, unit.data()},
           .input_stride = {0, 0, d},
           .output = {nullptr, nullptr, batch.hessian + (j * d + first) * d},
           .output_stride = {0, 0, d}},
          count);
      for (std::size_t i = 0; i < count; ++i) unit[i * d + first + i] = 0;
    }
    // Exactly symmetric, as the entries of a compiled Hessian are.
    double* h = batch.hessian + j * d * d;
    for (std::size_t column = 0; column < d; ++column) {
      for (std::size_t row = 0; row < column; ++row) h[column * d + row] = h[row * d + column];
    }
  }
}

void FormulaEvaluator::hessian_times(const PointBatch& batch, const double* v, double* out) {
  if (batch.n <= 0) return;
  const auto n = static_cast<std::size_t>(batch.n);
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  if (hessian_times_tape_ == nullptr) hessian_times_tape_ = &program_->hessian_times();
  PointArrays where = arrays(batch);
  where.input[2] = v;
  where.output[1] = nullptr;
  where.output[2] = out;
  where.output_stride[2] = d;
  value_.resize(std::max(value_.size(), n * k));
  where.output[0] = value_.data();
  if (d > kMaxOutputRow) std::fill_n(out, n * d, 0.0);
  run(*hessian_times_tape_, where, n);
  spread_nan({.n = batch.n, .x = batch.x}, where.output[0], out);
}

void FormulaEvaluator::spread_nan(const PointBatch& batch, const double* value, double* product) const {
  const auto n = static_cast<std::size_t>(batch.n);
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  const bool in_value = any_nan(value, n * k);
  const bool in_x = (in_value || !program_->value_shows_nan()) && any_nan(batch.x, n * d);
  if (!in_x && !in_value) return;
  for (std::size_t j = 0; j < n; ++j) {
    const bool lost = in_x && any_nan(batch.x + j * d, d);
    if (lost && batch.value != nullptr) std::fill_n(batch.value + j * k, k, kNaN);
    bool any = lost;
    for (std::size_t i = 0; i < k; ++i) {
      const bool undefined = lost || (in_value && std::isnan(value[j * k + i]));
      if (undefined && batch.jacobian != nullptr) std::fill_n(batch.jacobian + (j * k + i) * d, d, kNaN);
      any = any || undefined;
    }
    if (any && batch.hessian != nullptr) std::fill_n(batch.hessian + j * d * d, d * d, kNaN);
    if (any && product != nullptr) std::fill_n(product + j * d, d, kNaN);
  }
}

bool FormulaEvaluator::bounds(const BoxBatch& batch) {
  if (batch.n <= 0) return true;
  if (bounds_tape_ == nullptr) bounds_tape_ = &program_->bounds();
  run_on_boxes(*bounds_tape_, batch);
  return true;
}

bool FormulaEvaluator::jacobian_bounds(const BoxBatch& batch) {
  if (jacobian_bounds_tape_ == nullptr) jacobian_bounds_tape_ = program_->jacobian_bounds();
  if (jacobian_bounds_tape_ == nullptr) return false;
  if (batch.n <= 0) return true;
  const std::size_t entries = static_cast<std::size_t>(dim_) * static_cast<std::size_t>(codim_);
  if (entries > kMaxOutputRow) {
    std::fill_n(batch.jacobian_lower, static_cast<std::size_t>(batch.n) * entries, 0.0);
    std::fill_n(batch.jacobian_upper, static_cast<std::size_t>(batch.n) * entries, 0.0);
  }
  run_on_boxes(*jacobian_bounds_tape_, batch);
  return true;
}

void FormulaEvaluator::run_on_boxes(const Tape& tape, const BoxBatch& batch) {
  const auto n = static_cast<std::size_t>(batch.n);
  const auto d = static_cast<std::size_t>(dim_);
  const auto k = static_cast<std::size_t>(codim_);
  const std::size_t slots_per_box = 3 * std::size_t{tape.num_slots};
  const std::size_t block = block_size(slots_per_box, n);
  run_boxes(tape,
            {.lower = batch.lower,
             .upper = batch.upper,
             .dim = d,
             .output_lower = {batch.value_lower, batch.jacobian_lower},
             .output_upper = {batch.value_upper, batch.jacobian_upper},
             .output_stride = {k, k * d}},
            n, block, slots(slots_per_box * block));
}

}  // namespace

std::unique_ptr<Evaluator> FormulaFunction::make_evaluator() const {
  return std::make_unique<FormulaEvaluator>(program_);
}

}  // namespace taut::detail
