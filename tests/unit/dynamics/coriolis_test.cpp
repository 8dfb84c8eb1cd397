// Coriolis matrix of a system with known Christoffel symbols.
#include "tests/unit/dynamics/coriolis.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Coriolis, PointMassInPolarCoordinates) {
  // Polar coordinates (r, theta): M = diag(m, m r^2), C = m r [0 -thetad; thetad rd/r]
  const double m = 2, r = 0.7, r_rate = 0.3, theta_rate = 1.9;
  const MotionState<double> state{{r, 0.4}, {r_rate, theta_rate}};
  const MotionState<Dual4> at = pose_variables(state);
  AxisMatrix<Dual4> M = AxisMatrix<Dual4>::identity(2) * Dual4(m);
  M(1, 1) = at.pose[0] * at.pose[0] * m;
  const AxisMatrix<double> C = coriolis_matrix(M, state.velocity);
  EXPECT_DOUBLE_EQ(C(0, 1), -m * r * theta_rate);
  EXPECT_DOUBLE_EQ(C(1, 0), m * r * theta_rate);
  EXPECT_DOUBLE_EQ(C(1, 1), m * r * r_rate);
  EXPECT_DOUBLE_EQ(C(0, 0), 0);
  EXPECT_DOUBLE_EQ(rate(M, state.velocity)(1, 1), 2 * m * r * r_rate);
}

}  // namespace
}  // namespace pkm
