#include "engine/core/parameter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pkm {
namespace {

const DesignSpace space({{"a", "m", 0.15, 0.95, 0}, {"b", "m", 0.1, 0.3, 0.1}, {"c", "m", 0, 1, 0.3}});

TEST(DesignSpace, MapsTheUnitCubeToTheBounds) {
  EXPECT_EQ(space.dimension(), 3U);
  EXPECT_EQ(space.from_unit(0, 0), 0.15);
  EXPECT_EQ(space.from_unit(0, 1), 0.95);
  EXPECT_DOUBLE_EQ(space.from_unit(0, 0.5), 0.55);
  EXPECT_DOUBLE_EQ(space.to_unit(0, 0.35), 0.25);
  EXPECT_EQ(space.from_unit(0, 1.5), 0.95) << "values outside [0, 1] give the nearest bound";
}

TEST(DesignSpace, RoundsDiscreteVariablesToTheLattice) {
  EXPECT_EQ(space.from_unit(1, 1), 0.3) << "the maximum is on the lattice despite the rounding of 0.1 + 2 * 0.1";
  EXPECT_EQ(space.nearest(1, 0.24), 0.2);
  EXPECT_EQ(space.nearest(1, 9), 0.3);
  EXPECT_EQ(space.nearest(1, -9), 0.1);
  EXPECT_DOUBLE_EQ(space.nearest(2, 1), 0.9) << "the maximum is not on the lattice";
  for (double u = 0; u <= 1; u += 0.01) {
    const double k = space.from_unit(2, u) / 0.3;
    EXPECT_NEAR(k, std::nearbyint(k), 1e-12);
  }
}

}  // namespace
}  // namespace pkm
