// Coriolis matrices of a mechanism whose Christoffel symbols are known.
#include "tests/unit/dynamics/coriolis.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Coriolis, APointOnAnArmOfVariableLength) {
  // Polar coordinates: M = diag(m, m r^2), C = m r [0 -thetad; thetad rd/r], with r = x and theta the fourth one.
  const double m = 2, r = 0.7, r_rate = 0.3, turning = 1.9;
  const MotionState<double, 4> state{{r, 0, 0, 0.4}, {{r_rate, 0, 0, turning}}};
  const MotionState<Dual4, 4> at = pose_variables(state);
  Matrix<Dual4, 4, 4> M = Matrix<Dual4, 4, 4>::identity() * Dual4(m);
  M(3, 3) = at.pose.x * at.pose.x * m;
  const Matrix<double, 4, 4> C = coriolis_matrix(M, state.velocity);
  EXPECT_DOUBLE_EQ(C(0, 3), -m * r * turning);
  EXPECT_DOUBLE_EQ(C(3, 0), m * r * turning);
  EXPECT_DOUBLE_EQ(C(3, 3), m * r * r_rate);
  EXPECT_DOUBLE_EQ(C(0, 0), 0);
  EXPECT_DOUBLE_EQ(rate(M, state.velocity)(3, 3), 2 * m * r * r_rate);
}

}  // namespace
}  // namespace pkm
