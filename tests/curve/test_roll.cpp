#include <gtest/gtest.h>

#include <memory>

#include "support/rolled_sheet.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/curve/flow.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/projection.hpp"

// The paper's own way over the roll of its Figure 3, known only by samples: lazy cells, march, descent, curvature flow.
// tests/search/test_rolled_sheet.cpp asks the same of the whole.

namespace taut {
namespace {

TEST(Roll, GeodesicsGoRoundAndDoNotJumpBetweenTheTurns) {
  const Surface roll = make_surface(std::make_shared<const RbfModel>(fit_rbf(test::RolledSheet{}.cloud(700))));
  for (const test::RollPair& pair : test::kRollPairs) {
    const double truth = pair.distance();
    const Vector p = project_to_surface(roll, test::RolledSheet::point(pair.from_angle, pair.from_height)).point;
    const Vector q = project_to_surface(roll, test::RolledSheet::point(pair.to_angle, pair.to_height)).point;
    double lengths[2];
    for (int i = 0; i < 2; ++i) {
      const double cell = 0.5 / (1 << i);
      SurfaceCells cells = SurfaceCells::lazy(roll, p, cell);
      MarchOptions march_options;
      march_options.target = q;
      const DistanceField field = march(roll, cells, p, march_options);
      FlowOptions options;
      options.lattice = {cells.grid().size(), cells.grid().origin()};
      const FlowResult path = correct_flow(roll, descend(roll, cells, field, q), options);
      ASSERT_EQ(path.status, Status::ok) << path.reason << ", cell " << cell;
      EXPECT_NEAR(path.length, truth, 0.01 * truth) << "cell " << cell;
      EXPECT_NEAR(path.length, truth, 2e-4 * truth) << "what fit and polyline are good for";
      EXPECT_TRUE(path.locally_shortest);
      lengths[i] = path.length;
    }
    EXPECT_NEAR(lengths[0], lengths[1], 1e-6 * truth) << "cells of 0.5 and 0.25";
  }
}

}  // namespace
}  // namespace taut
