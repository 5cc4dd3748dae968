#pragma once

#include <memory>
#include <optional>

#include "surface/height/plane_spline.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// Where samples stand: u = (x - x0) / pixel_x, v = (y - y0) / pixel_y.
struct PixelFrame {
  double x0 = 0;
  double y0 = 0;
  double pixel_x = 1;
  double pixel_y = 1;
};

/// z - s(x, y).
class HeightFunction : public ImplicitFunction {
 public:
  HeightFunction(std::shared_ptr<const PlaneSpline> spline, const PixelFrame& frame);
  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return "heights"; }
  /// s(x, y), within the samples.
  [[nodiscard]] std::optional<double> height(double x, double y) const;

 private:
  std::shared_ptr<const PlaneSpline> spline_;
  PixelFrame frame_;
};

/// Where the graph ends: four components, how far inside of the outermost samples a point lies, in pixels; and where
/// `measured` is given a fifth, its spline less 2/3.
class HeightDomain : public ImplicitFunction {
 public:
  HeightDomain(Index columns, Index rows, const PixelFrame& frame, std::shared_ptr<const PlaneSpline> measured);
  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return measured_ ? 5 : 4; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;

 private:
  double last_u_;
  double last_v_;
  PixelFrame frame_;
  std::shared_ptr<const PlaneSpline> measured_;
};

}  // namespace taut::detail
