// Axial forces, stresses and buckling of the rods of the linear Delta, against hand calculations: at x = y = 0 its six
// rods have the same load, by symmetry.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/generic/rod_loads.hpp"
#include "engine/mechanism/reactions_along.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/motion/motion_factories.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

const std::string kRodMass = "rod_mass_per_length = \"0.3 kg/m\"";
constexpr double kOuter = 0.010, kInner = 0.008, kYoung = 70e9, kLength = 0.5, kPlatformMass = 0.5;
const double kArea = kPi / 4 * (kOuter * kOuter - kInner * kInner);
const double kSine = std::sqrt(kLength * kLength - 0.24 * 0.24) / kLength;  // of a rod's slope; R - r = 0.24 m

/// The linear Delta with rods of aluminium tubes, massless unless `more` gives a density.
std::shared_ptr<const Mechanism> delta_with_tubes(const std::string& more = "") {
  std::string text = test::text_of_mechanism("linear-delta");
  text.replace(text.find(kRodMass), kRodMass.size(),
               "rod_section = { outer = \"10 mm\", inner = \"8 mm\", young = \"70 GPa\"" + more + " }");
  return read_mechanism_toml(text, "test.toml");
}

std::vector<generic::RodLoad> loads_of(const Mechanism& mechanism, double acceleration, double force) {
  const std::vector<double> design = test::nominal(mechanism.info());
  const std::string& mode = mechanism.info().modes.front();
  const MotionState<double> state{{0, 0, -0.2}, {0, 0, 0}};
  const Reactions found =
      mechanism.reactions()->find(design, mode, state, {0, 0, acceleration}, {0, 0, force, 0, 0, 0});
  return generic::rod_loads(mechanism, design, mode, state.pose, found);
}

TEST(RodLoads, OfTheLinearDeltaUnderAVerticalForce) {
  const auto mechanism = delta_with_tubes();
  const double buckling =
      kPi * kPi * kYoung * kPi / 64 * (std::pow(kOuter, 4) - std::pow(kInner, 4)) / (kLength * kLength);
  for (const auto& [acceleration, force] : {std::array{0.0, 0.0}, {3.0, 0.0}, {0.0, 100.0}}) {
    const std::vector<generic::RodLoad> rods = loads_of(*mechanism, acceleration, force);
    ASSERT_EQ(rods.size(), 6u);
    EXPECT_EQ(rods[0].name, "rod 1 of rail1");
    const double axial = (kPlatformMass * (kGravity + acceleration) - force) / (6 * kSine);
    for (const generic::RodLoad& rod : rods) {
      for (const double end : rod.ends.value()) EXPECT_NEAR(end, axial, 1e-10);
      EXPECT_NEAR(rod.area, kArea, 1e-18);
      EXPECT_NEAR(rod.buckling_force, buckling, 1e-9 * buckling);
      EXPECT_EQ(rod.reserve().has_value(), axial < 0);
      if (axial < 0) {
        EXPECT_NEAR(*rod.reserve(), buckling / -axial, 1e-9 * *rod.reserve());
      }
    }
  }
}

/// The upper end of a rod at rest carries the component of its weight along the rod in addition.
TEST(RodLoads, WeightMakesTheEndsDiffer) {
  const auto mechanism = delta_with_tubes(", density = \"2700 kg/m^3\"");
  const double weight = 2700 * kArea * kLength * kGravity;
  for (const generic::RodLoad& rod : loads_of(*mechanism, 0, 0)) {
    EXPECT_NEAR((*rod.ends)[0] - (*rod.ends)[1], weight * kSine, 1e-12);
    EXPECT_EQ(rod.axial(), (*rod.ends)[0]);
  }
}

TEST(RodLoads, PeaksAlongAMotionAreThoseOfSingleStates) {
  const auto bare = delta_with_tubes();
  const std::vector<double> design = test::nominal(bare->info());
  const std::string& mode = bare->info().modes.front();
  const auto motion = test::motions(*bare).front().motion;
  const Wrench<double> wrench = {0, 0, 5, 0, 0, 0};
  const DriveTrain screw{.ratio = 300, .rotor = 1e-6};
  for (const auto& mechanism : {bare, with_drive_trains(bare, DriveTrains(3, screw))}) {
    Trajectory along = compute_trajectory(*mechanism, design, mode, no_limits(mechanism->info()), *motion, 21, wrench);
    add_reactions(*mechanism, design, mode, wrench, along);
    const auto peaks = generic::peak_rod_loads(*mechanism, design, mode, along);
    ASSERT_EQ(peaks.size(), 6u);
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      double largest = 0, smallest = 0;
      for (const TrajectoryPoint& point : along.points) {
        const double axial =
            generic::rod_loads(*mechanism, design, mode, point.motion.pose, *point.reactions)[i].axial();
        largest = std::max(largest, axial);
        smallest = std::min(smallest, axial);
      }
      EXPECT_NEAR(peaks[i].tension, largest, 1e-10);
      EXPECT_NEAR(peaks[i].compression, -smallest, 1e-10);
      EXPECT_NEAR(peaks[i].stress, std::max(largest, -smallest) / kArea, 1e-10 / kArea);
      ASSERT_EQ(peaks[i].reserve.has_value(), smallest < 0);
      if (smallest < 0) {
        EXPECT_NEAR(*peaks[i].reserve, peaks[i].buckling_force / -smallest, 1e-6 * *peaks[i].reserve);
      }
    }
  }
}

TEST(RodLoads, NeedYoungsModulus) { EXPECT_TRUE(loads_of(*test::described("linear-delta"), 0, 0).empty()); }

}  // namespace
}  // namespace pkm
