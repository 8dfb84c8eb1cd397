// The singularity test of Jacobians.
#include "engine/geometry/singular.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/math/dual.hpp"

namespace pkm::testing {
namespace {

using Matrix2 = Matrix<double, 2, 2>;

TEST(SingularJacobian, IsSingularToWorkingPrecision) {
  EXPECT_FALSE(is_singular(Matrix2{{1, 0, 0, 1}}));
  EXPECT_FALSE(is_singular(Matrix2{{1, 1, 1, 1 + 1e-9}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 1, 1, 1}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 1, 1, 1 + 1e-15}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 0, 0, 1e-17}})) << "a column of rounding errors only";
  EXPECT_TRUE(is_singular(Matrix2{}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 0, 0, std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(is_singular(Matrix2{{std::numeric_limits<double>::quiet_NaN(), 0, 0, 1}}));
}

TEST(SingularJacobian, DoesNotDependOnUnitOrScalarType) {
  const Matrix2 regular{{1, 0.3, -0.2, 0.7}};
  for (const double unit : {1e-9, 1e-3, 1e3, 1e9}) EXPECT_FALSE(is_singular(regular * unit)) << unit;
  Matrix2 mixed = regular;  // a rotational column, and lengths of a mechanism of 0.1 mm
  mixed(0, 1) *= 1e-4;
  mixed(1, 1) *= 1e-4;
  EXPECT_FALSE(is_singular(mixed));
  AxisMatrix<Dual4> dual(2, 2);
  for (std::size_t k = 0; k < 4; ++k) dual[k] = Dual4(regular[k]);
  EXPECT_FALSE(is_singular(dual));
  dual(1, 0) = dual(0, 0);
  dual(1, 1) = dual(0, 1);
  EXPECT_TRUE(is_singular(dual));
}

TEST(SingularJacobian, FastTestHoldsOnlyFarFromSingular) {
  using Matrix4 = Matrix<double, 4, 4>;
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int fast = 0, slow = 0;
  for (int k = 0; k < 1000; ++k) {
    Matrix4 J;
    for (double& element : J) element = uniform(engine);
    for (std::size_t j = 0; j < 4; ++j) J(3, j) = J(0, j) + J(3, j) * std::pow(10.0, -k % 18);
    for (const Matrix4& factored : {J, transpose(J)}) {
      Matrix4 u = factored;
      eliminate(u);
      const Matrix4 inverse = solve(J, Matrix4::identity());
      double max = 0, max_of_inverse = 0;  // at most the maximum row sums
      for (std::size_t e = 0; e < J.size(); ++e) {
        max = std::max(max, std::fabs(J[e]));
        max_of_inverse = std::max(max_of_inverse, std::fabs(inverse[e]));
      }
      if (is_clearly_regular(J, u)) {
        ++fast;
        EXPECT_LT(16 * max * max_of_inverse, 1 / kSingularRcond);
        EXPECT_FALSE(is_singular(J));
      } else {
        ++slow;
      }
    }
  }
  EXPECT_GT(fast, 100);
  EXPECT_GT(slow, 100);
}

TEST(RankDeficientJacobian, HasALinearlyDependentColumn) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 200; ++k) {
    AxisMatrix<double> J(5, 3);
    for (double& element : J) element = uniform(engine);
    EXPECT_FALSE(is_rank_deficient(J));
    const double share = std::pow(10.0, -k % 18), a = uniform(engine), b = uniform(engine);
    const std::size_t dependent = static_cast<std::size_t>(k) % 3;
    for (std::size_t i = 0; i < 5; ++i)
      J(i, dependent) = a * J(i, (dependent + 1) % 3) + b * J(i, (dependent + 2) % 3) + share * J(i, dependent);
    if (share > 1e-10) {
      EXPECT_FALSE(is_rank_deficient(J)) << share;
    }
    if (share < 1e-14) {
      EXPECT_TRUE(is_rank_deficient(J)) << share;
    }
    for (std::size_t i = 0; i < 5; ++i) J(i, dependent) = 0;
    EXPECT_TRUE(is_rank_deficient(J));
  }
  EXPECT_TRUE(is_rank_deficient(AxisMatrix<double>(2, 3)));
}

}  // namespace
}  // namespace pkm::testing
