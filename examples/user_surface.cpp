// Your own surface: implement F with its derivatives, let Taut check them, use it like any other surface.
//
// Here: a superellipsoid |x|^p + |y|^p + |z|^p = 1 with p = 4 on which waves run along z.

#include <cmath>
#include <cstdio>
#include <memory>

#include "taut/surface/conformance.hpp"
#include "taut/surface/projection.hpp"
#include "taut/surface/surface.hpp"

namespace {

using taut::Index;

/// F(x, y, z) = x^4 + y^4 + z^4 + a sin(b z) - 1
class WavySuperellipsoid : public taut::ImplicitFunction {
 public:
  WavySuperellipsoid(double amplitude, double frequency) : amplitude_(amplitude), frequency_(frequency) {}

  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return 1; }

  [[nodiscard]] std::unique_ptr<taut::Evaluator> make_evaluator() const override {
    return std::make_unique<OwnEvaluator>(amplitude_, frequency_);
  }

 private:
  class OwnEvaluator : public taut::Evaluator {
   public:
    OwnEvaluator(double amplitude, double frequency) : Evaluator(3, 1), amplitude_(amplitude), frequency_(frequency) {}

    // One call for a whole batch. Point j starts at batch.x + 3 j; outputs that are null are not wanted.
    void evaluate(const taut::PointBatch& batch) override {
      for (Index j = 0; j < batch.n; ++j) {
        const double* x = batch.x + 3 * j;
        const double wave = amplitude_ * std::sin(frequency_ * x[2]);
        const double slope = amplitude_ * frequency_ * std::cos(frequency_ * x[2]);
        if (batch.value != nullptr) batch.value[j] = fourth(x[0]) + fourth(x[1]) + fourth(x[2]) + wave - 1;
        if (batch.jacobian != nullptr) {
          double* gradient = batch.jacobian + 3 * j;
          for (int i = 0; i < 3; ++i) gradient[i] = 4 * x[i] * x[i] * x[i];
          gradient[2] += slope;
        }
        if (batch.hessian != nullptr) {
          double* hessian = batch.hessian + 9 * j;  // both triangles, times the weight
          for (int i = 0; i < 9; ++i) hessian[i] = 0;
          for (int i = 0; i < 3; ++i) hessian[4 * i] = batch.weight[j] * 12 * x[i] * x[i];
          hessian[8] -= batch.weight[j] * frequency_ * frequency_ * wave;
        }
      }
    }

   private:
    static double fourth(double t) { return t * t * t * t; }

    double amplitude_;
    double frequency_;
  };

  double amplitude_;
  double frequency_;
};

}  // namespace

int main() {
  const auto function = std::make_shared<WavySuperellipsoid>(0.1, 6);

  // Derivatives against differences, batches against single points, NaN, and so on: put this into your tests.
  const taut::Box box{Eigen::Vector3d::Constant(-1.5), Eigen::Vector3d::Constant(1.5)};
  const taut::ConformanceReport report = taut::check_conformance(*function, box);
  std::printf("%td checks, %zu violations\n%s", report.num_checks, report.violations.size(), report.text().c_str());

  const taut::Surface surface(function);
  const taut::ProjectionResult foot = taut::project_to_surface(surface, Eigen::Vector3d(0.9, 0.8, 0.7));
  std::printf("projected to (%.6f, %.6f, %.6f), %.6f away\n", foot.point(0), foot.point(1), foot.point(2),
              foot.distance);
  return report.ok() && foot.converged ? 0 : 1;
}
