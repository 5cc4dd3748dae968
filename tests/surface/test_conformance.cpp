#include "taut/surface/conformance.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

Box cube(Index d, double half) { return {Vector::Constant(d, -half), Vector::Constant(d, half)}; }

TEST(Conformance, PassesTheSurfacesWrittenByHand) {
  for (const Surface& surface :
       {test::unit_sphere(), test::unit_sphere(6), test::ellipsoid(1, 2, 0.02), test::torus(), test::tangle_cube()}) {
    const ConformanceReport report = check_conformance(surface.function(), cube(surface.dim(), 2));
    EXPECT_TRUE(report.ok()) << report.text();
    EXPECT_GT(report.num_checks, 1000);
    EXPECT_EQ(report.num_skipped, 0);
  }
}

/// The sphere with one thing wrong at a time.
enum class Flaw { none, gradient, hessian, asymmetric, product, neighbours, history, bounds, hides_nan, throws };

class FlawedSphere : public ImplicitFunction {
 public:
  explicit FlawedSphere(Flaw flaw) : flaw_(flaw) {}
  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override { return std::make_unique<Own>(flaw_); }

 private:
  class Own : public Evaluator {
   public:
    explicit Own(Flaw flaw) : Evaluator(3, 1), flaw_(flaw) {}

    void evaluate(const PointBatch& batch) override {
      for (Index j = 0; j < batch.n; ++j) {
        const Eigen::Map<const Eigen::Vector3d> x(batch.x + 3 * j);
        if (flaw_ == Flaw::throws && !x.allFinite()) throw std::runtime_error("not finite");
        if (batch.value != nullptr) {
          double value = x.squaredNorm() - 1;
          if (flaw_ == Flaw::neighbours) value += 1e-15 * static_cast<double>(batch.n - 1);
          if (flaw_ == Flaw::history) value += 1e-12 * static_cast<double>(num_calls_++);
          if (flaw_ == Flaw::hides_nan && std::isnan(value)) value = 1;
          batch.value[j] = value;
        }
        if (batch.jacobian != nullptr) {
          Eigen::Map<Eigen::Vector3d> gradient(batch.jacobian + 3 * j);
          gradient = 2 * x;
          if (flaw_ == Flaw::gradient) gradient(1) += 1e-4 * x(0);
        }
        if (batch.hessian != nullptr) {
          Eigen::Map<Eigen::Matrix3d> hessian(batch.hessian + 9 * j);
          hessian = 2 * batch.weight[j] * Eigen::Matrix3d::Identity();
          if (flaw_ == Flaw::hessian) hessian(2, 2) *= 1.001;
          if (flaw_ == Flaw::asymmetric) hessian(0, 1) = 1e-18;
        }
      }
    }

    void hessian_times(const PointBatch& batch, const double* v, double* out) override {
      Evaluator::hessian_times(batch, v, out);
      if (flaw_ == Flaw::product) out[0] += 1e-6;
    }

    bool bounds(const BoxBatch& batch) override {
      if (flaw_ != Flaw::bounds) return false;
      for (Index j = 0; j < batch.n; ++j) {  // the value at the corners: no bound across 0
        const double a = Eigen::Map<const Eigen::Vector3d>(batch.lower + 3 * j).squaredNorm() - 1;
        const double b = Eigen::Map<const Eigen::Vector3d>(batch.upper + 3 * j).squaredNorm() - 1;
        batch.value_lower[j] = std::min(a, b);
        batch.value_upper[j] = std::max(a, b);
      }
      return true;
    }

   private:
    Flaw flaw_;
    int num_calls_ = 0;
  };

  Flaw flaw_;
};

TEST(Conformance, NamesTheRuleThatIsBroken) {
  const std::pair<Flaw, std::string> cases[] = {
      {Flaw::gradient, "jacobian"},     {Flaw::hessian, "hessian"},  {Flaw::asymmetric, "symmetry"},
      {Flaw::product, "hessian_times"}, {Flaw::neighbours, "batch"}, {Flaw::history, "batch"},
      {Flaw::bounds, "bounds"},         {Flaw::hides_nan, "nan"},    {Flaw::throws, "exception"},
  };
  EXPECT_TRUE(check_conformance(FlawedSphere(Flaw::none), cube(3, 1)).ok());
  for (const auto& [flaw, rule] : cases) {
    const ConformanceReport report = check_conformance(FlawedSphere(flaw), cube(3, 1));
    ASSERT_FALSE(report.ok()) << rule;
    EXPECT_EQ(report.violations.front().rule, rule) << report.text();
    EXPECT_LE(report.violations.size(), 20u);
    EXPECT_NE(report.text().find(rule + " at ("), std::string::npos);
  }
}

TEST(Conformance, RefusesABoxThatIsNone) {
  const FlawedSphere sphere(Flaw::none);
  EXPECT_THROW((void)check_conformance(sphere, cube(2, 1)), InvalidArgument);
  EXPECT_THROW((void)check_conformance(sphere, cube(3, -1)), InvalidArgument);
  EXPECT_THROW((void)check_conformance(sphere, cube(3, std::numeric_limits<double>::infinity())), InvalidArgument);
}

}  // namespace
}  // namespace taut
