#include "march/support.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// The unit sphere in the first d - 1 coordinates of R^d, x_d = 0: codimension 2.
class FlatSphere : public ImplicitFunction {
 public:
  explicit FlatSphere(Index d) : d_(d) {}
  [[nodiscard]] Index dim() const override { return d_; }
  [[nodiscard]] Index codim() const override { return 2; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<FlatSphereEvaluator>(d_);
  }

 private:
  class FlatSphereEvaluator : public Evaluator {
   public:
    explicit FlatSphereEvaluator(Index d) : Evaluator(d, 2) {}
    // F = (|x|^2 - 1, x_d + x_1^2 / 2 - x_1 * x_1 / 2): the second equation is x_d = 0.
    void evaluate(const PointBatch& batch) override {
      for (Index j = 0; j < batch.n; ++j) {
        const Eigen::Map<const Vector> x(batch.x + j * dim_, dim_);
        if (batch.value != nullptr) {
          batch.value[2 * j] = x.squaredNorm() - 1;
          batch.value[2 * j + 1] = x(dim_ - 1);
        }
        if (batch.jacobian != nullptr) {
          Eigen::Map<Vector>(batch.jacobian + 2 * j * dim_, dim_) = 2 * x;
          Eigen::Map<Vector>(batch.jacobian + (2 * j + 1) * dim_, dim_) = Vector::Unit(dim_, dim_ - 1);
        }
        if (batch.hessian != nullptr) {
          Eigen::Map<Eigen::MatrixXd>(batch.hessian + j * dim_ * dim_, dim_, dim_) =
              2 * batch.weight[2 * j] * Eigen::MatrixXd::Identity(dim_, dim_);
        }
      }
    }
  };
  Index d_;
};

Vector tilted(Index d) { return Vector::LinSpaced(d, 1, 1.7).normalized(); }

struct Case {
  Index d;
  double h;
  double mean;  // largest mean relative error
};

class HyperSphere : public testing::TestWithParam<Case> {};

TEST_P(HyperSphere, DistancesAndLinesMatchTheClosedForm) {
  const auto [d, h, mean] = GetParam();
  const Surface sphere = test::unit_sphere(d);
  const Vector source = tilted(d);
  SurfaceCells cells = test::all_cells(sphere, source, h);
  const DistanceField field = march(sphere, cells, source);
  EXPECT_EQ(field.num_reached, cells.num_valid());
  EXPECT_LT(test::sphere_errors(cells, field, source).mean, mean);
  std::mt19937 random(3);
  for (int i = 0; i < 5; ++i) {
    const Vector target = test::random_unit(d, random);
    const double distance = test::sphere_distance(source, target);
    EXPECT_NEAR(distance_at(sphere, cells, field, target)(0), distance, 0.1 * h);
    const Points line = descend(sphere, cells, field, target);
    ASSERT_GE(line.cols(), 2);
    EXPECT_EQ(line.col(0), source);
    EXPECT_EQ(line.col(line.cols() - 1), target);
    EXPECT_LT(test::polyline_length(line), distance * 1.05);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, HyperSphere,
                         testing::Values(Case{2, 0.05, 1e-4}, Case{3, 0.1, 2e-4}, Case{4, 0.2, 3e-3},
                                         Case{5, 0.4, 1.5e-2}, Case{6, 0.8, 6e-2}));

TEST(HigherDimensions, IsSecondOrderOnTheThreeSphere) {
  const Surface sphere = test::unit_sphere(4);
  const Vector source = tilted(4);
  std::vector<std::pair<double, double>> errors;
  for (const double h : {0.4, 0.2, 0.1}) {
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source);
    errors.emplace_back(h, test::sphere_errors(cells, field, source).mean);
  }
  EXPECT_GT(test::order(errors), 1.5);
}

TEST(Codimension, TwoEquationsInFourDimensionsGiveTheSphere) {
  const Surface sphere(std::make_shared<FlatSphere>(4));
  Vector source(4);
  source << 0.36, -0.48, 0.8, 0;
  std::vector<std::pair<double, double>> errors;
  for (const double h : {0.2, 0.1, 0.05}) {
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source);
    errors.emplace_back(h, test::sphere_errors(cells, field, source).mean);
  }
  EXPECT_LT(errors.back().second, 1e-4);
  EXPECT_GT(test::order(errors), 1.7);
}

TEST(Codimension, CurveInThreeDimensions) {
  const Surface circle(std::make_shared<FlatSphere>(3));
  const Vector source = Eigen::Vector3d(0.6, 0.8, 0);
  SurfaceCells cells = test::all_cells(circle, source, 0.1);
  const DistanceField field = march(circle, cells, source);
  EXPECT_LT(test::sphere_errors(cells, field, source).mean, 1e-5);
}

// A circle in the plane of the last two axes of R^8, walked both ways round.
TEST(Codimension, CurveInEightDimensions) {
  const Surface circle = parse_surface("x1=0; x2=0; x3=0; x4=0; x5=0; x6=0; x7^2+x8^2=1");
  Vector source = Vector::Zero(8);
  source.tail(2) << 0.6, 0.8;
  SurfaceCells cells = test::all_cells(circle, source, 0.1);
  const DistanceField field = march(circle, cells, source);
  EXPECT_EQ(field.num_reached, cells.num_valid());
  EXPECT_LT(test::sphere_errors(cells, field, source).mean, 1e-5);
}

}  // namespace
}  // namespace taut
