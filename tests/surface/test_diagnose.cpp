#include "taut/surface/conformance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using Fault = RankDiagnosis::Fault;

RankDiagnosis diagnose(const std::string& formula, const Vector& x) {
  const Surface surface = parse_surface(formula);
  const auto found = diagnose_rank(surface.function(), x);
  EXPECT_TRUE(found.has_value()) << formula;
  return found.value_or(RankDiagnosis{});
}

Box cube(Index dim) { return {Vector::Constant(dim, -1.5), Vector::Constant(dim, 1.5)}; }

TEST(DiagnoseRank, RegularSurfacesHaveNothingWrong) {
  EXPECT_FALSE(diagnose_rank(parse_surface("x^2+y^2+4z^2=1").function(), Vector(Eigen::Vector3d(1, 0, 0))));
  EXPECT_FALSE(diagnose_rank(parse_surface("x^2+y^2=1; z^2+w^2=1").function(), Vector(Eigen::Vector4d(1, 0, 0, 1))));
  EXPECT_FALSE(diagnose_rank(parse_surface("x^2+y^2=1; z^2+w^2=1").function(), cube(4)));
  EXPECT_FALSE(diagnose_rank(parse_surface("x^2+y^2+z^2+1").function(), cube(3)));  // empty, but not for this reason
  // Nearly parallel is not dependent.
  EXPECT_FALSE(diagnose_rank(parse_surface("x=z^2; x+y/1000=0").function(), Vector(Eigen::Vector3d(0, 0, 0))));
}

TEST(DiagnoseRank, NamesDependentEquations) {
  const RankDiagnosis found = diagnose("x^2+y^2+z^2=1; 2x^2+2y^2+2z^2=2", Eigen::Vector3d(1, 0, 0));
  ASSERT_EQ(found.findings.size(), 1U);
  EXPECT_EQ(found.findings[0].fault, Fault::dependent);
  EXPECT_EQ(found.findings[0].equation, 1);
  EXPECT_EQ(found.findings[0].others, std::vector<Index>{0});
  EXPECT_TRUE(found.everywhere);
  EXPECT_NE(found.text().find("equation 2 depends on equation 1 at (1, 0, 0) and all over the surface; leave it out"),
            std::string::npos)
      << found.text();

  const RankDiagnosis sum = diagnose("x1^2+x2^2=1; x3^2+x4^2=1; x5=0; x1^2+x2^2+x3^2+x4^2=2", Vector{{1, 0, 0, 1, 0}});
  ASSERT_EQ(sum.findings.size(), 1U);
  EXPECT_EQ(sum.findings[0].others, (std::vector<Index>{0, 1}));
  EXPECT_NE(sum.text().find("equation 4 depends on equations 1 and 2"), std::string::npos) << sum.text();
}

TEST(DiagnoseRank, ToldFromSurfacesThatTouchSomewhere) {
  const RankDiagnosis found = diagnose("x^2+y^2+z^2=1; x^2+y^2=z+1", Eigen::Vector3d(0, 0, -1));
  ASSERT_FALSE(found.findings.empty());
  EXPECT_FALSE(found.everywhere);
  EXPECT_NE(found.text().find("touch there"), std::string::npos) << found.text();
}

TEST(DiagnoseRank, AllNineEquationsOfTheRotations) {
  std::string all;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int r = 0; r < 3; ++r) {
        all += "+x" + std::to_string(3 * r + i + 1) + "*x" + std::to_string(3 * r + j + 1);
      }
      all += i == j ? "=1;" : "=0;";
    }
  }
  all.pop_back();
  const auto found = diagnose_rank(*parse_function(all), cube(9));
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->findings.size(), 3U);
  const Index repeated[] = {3, 6, 7};
  const Index original[] = {1, 2, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found->findings[i].equation, repeated[i]);
    EXPECT_EQ(found->findings[i].others, std::vector<Index>{original[i]});
  }
  try {
    (void)parse_surface(all);
    FAIL() << "nine equations in nine dimensions";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("equation 4 depends on equation 2"), std::string::npos) << error.what();
  }
}

TEST(DiagnoseRank, SquaresAndRootsOfSums) {
  EXPECT_EQ(diagnose("(x^2+y^2+z^2-1)^2=0", Eigen::Vector3d(0.6, 0, 0.8)).findings[0].fault, Fault::squared);
  EXPECT_EQ(diagnose("(x^2+y^2-1)^2+z^2=0", Eigen::Vector3d(0.6, 0.8, 0)).findings[0].fault, Fault::squared);
  EXPECT_EQ(diagnose("sqrt((x^2+y^2-1)^2+z^2)=0", Eigen::Vector3d(0.6, 0.8, 0)).findings[0].fault, Fault::root);
  EXPECT_EQ(diagnose("abs(x^2+y^2+z^2-1)=0", Eigen::Vector3d(0.6, 0.8, 0)).findings[0].fault, Fault::root);
  const RankDiagnosis second = diagnose("z=0.6; (x^2+y^2+z^2-1)^2=0", Eigen::Vector3d(0.8, 0, 0.6));
  EXPECT_EQ(second.findings[0].equation, 1);
  EXPECT_NE(second.text().find("equation 2"), std::string::npos) << second.text();
  const auto anywhere = diagnose_rank(parse_surface("(x^2+y^2+z^2-1)^2=0").function(), cube(3));
  ASSERT_TRUE(anywhere.has_value());
  EXPECT_TRUE(anywhere->everywhere);
}

TEST(DiagnoseRank, AnApexIsJustAPoint) {
  const RankDiagnosis found = diagnose("x^2+y^2=z^2", Eigen::Vector3d::Zero());
  EXPECT_EQ(found.findings[0].fault, Fault::singular);
  EXPECT_FALSE(found.everywhere);
}

// Inside a cusp F is negative only in a thin needle; it is no square for that.
TEST(DiagnoseRank, ACuspIsNoSquare) {
  for (const char* formula : {"x^2+y^2=z^3*(1-z)", "x^2+y^2=z^3"}) {
    EXPECT_EQ(diagnose(formula, Eigen::Vector3d::Zero()).findings[0].fault, Fault::singular) << formula;
  }
  const RankDiagnosis lemon = diagnose("1.2*x^2+1.2*z^2=5*(y+0.5)^3*(0.5-y)^3", Eigen::Vector3d(0, 0.5, 0));
  EXPECT_EQ(lemon.findings[0].fault, Fault::singular);
}

TEST(DiagnoseRank, SaysWhereAFormulaEnds) {
  // z = x^(3/2) has the gradient (0, 0, 1) at 0, and no value beyond.
  const RankDiagnosis found = diagnose("z=x^(3/2)", Eigen::Vector3d::Zero());
  EXPECT_EQ(found.findings[0].fault, Fault::undefined);
  EXPECT_THAT(found.text(), testing::HasSubstr("not defined on every side of (0, 0, 0)"));
}

TEST(DiagnoseRank, RefusesBadPoints) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  EXPECT_THROW((void)diagnose_rank(sphere.function(), Vector::Zero(2)), InvalidArgument);
  EXPECT_THROW((void)diagnose_rank(sphere.function(), Vector::Constant(3, NAN)), InvalidArgument);
  EXPECT_THROW((void)diagnose_rank(sphere.function(), Box{Vector::Zero(2), Vector::Ones(2)}), InvalidArgument);
}

}  // namespace
}  // namespace taut
