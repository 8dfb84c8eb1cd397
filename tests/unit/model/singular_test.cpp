// The one criterion of singular Jacobians.
#include "engine/model/singular.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "engine/math/dual.hpp"

namespace pkm::testing {
namespace {

using Matrix2 = Matrix<double, 2, 2>;

TEST(SingularJacobian, IsOneThatRoundingsCannotTellFromRank) {
  EXPECT_FALSE(is_singular(Matrix2{{1, 0, 0, 1}}));
  EXPECT_FALSE(is_singular(Matrix2{{1, 1, 1, 1 + 1e-9}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 1, 1, 1}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 1, 1, 1 + 1e-15}}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 0, 0, 1e-17}})) << "a column of roundings alone";
  EXPECT_TRUE(is_singular(Matrix2{}));
  EXPECT_TRUE(is_singular(Matrix2{{1, 0, 0, std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(is_singular(Matrix2{{std::numeric_limits<double>::quiet_NaN(), 0, 0, 1}}));
}

TEST(SingularJacobian, DoesNotDependOnTheUnitOrTheScalar) {
  const Matrix2 regular{{1, 0.3, -0.2, 0.7}};
  for (const double unit : {1e-9, 1e-3, 1e3, 1e9}) EXPECT_FALSE(is_singular(regular * unit)) << unit;
  Matrix2 mixed = regular;  // rotations beside lengths of a mechanism of a tenth of a millimetre
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

}  // namespace
}  // namespace pkm::testing
