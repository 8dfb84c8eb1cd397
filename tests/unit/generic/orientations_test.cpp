// Haar measure of sets of orientations, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/mechanism/orientations.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/voxel_grid.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"
#include "tests/unit/generic/tilting.hpp"

namespace pkm::test {
namespace {

constexpr double kAll = 8 * kPi * kPi;

std::shared_ptr<const Mechanism> tilted(const std::string& axes) {
  return read_mechanism_toml(test::text_of_tilting(axes), "tilting.toml");
}

VoxelMap map_of(const Mechanism& mechanism, double tilt, const Box& box, const std::array<std::int64_t, 3>& cells) {
  const WorkspacePlan plan{.method = VoxelOptions{.cells = cells, .box = box},
                           .swept = {0, 1, 2},
                           .fixed = {},
                           .limits = no_limits(mechanism.info())};
  return voxel_map(mechanism, std::vector{tilt}, plan);
}

const Box kFull = {{{-kPi, kPi}, {-kPi, kPi}, {-kPi, kPi}}};

TEST(Orientations, AllOrientationsAreCountedOnce) {
  for (const char* const axes : {"xyz", "zyx", "zyz", "xzx"}) {
    const auto mechanism = tilted(axes);
    const auto orientations = orientations_of(*mechanism);
    const Box principal = orientations->principal_ranges();
    EXPECT_NEAR(orientations->measure(map_of(*mechanism, kPi, principal, {24, 12, 24})), kAll, 1e-5 * kAll) << axes;
    // Every orientation has two triples of angles in this box, whose cells differ in size.
    EXPECT_NEAR(orientations->measure(map_of(*mechanism, kPi, kFull, {12, 24, 12})), kAll, 1e-5 * kAll) << axes;
  }
}

/// Directions within an angle t of the vertical have the solid angle 2 pi (1 - cos t); a rotation about them adds the
/// factor 2 pi.
TEST(Orientations, MeasureOfACone) {
  for (const char* const axes : {"xyz", "zyz"})
    for (const double degrees : {24, 60, 120}) {
      const double tilt = degrees * kPi / 180;
      const auto mechanism = tilted(axes);
      const auto orientations = orientations_of(*mechanism);
      const double expected = 2 * kPi * 2 * kPi * (1 - std::cos(tilt));
      EXPECT_NEAR(orientations->measure(map_of(*mechanism, tilt, orientations->principal_ranges(), {80, 90, 8})),
                  expected, 0.03 * expected)
          << axes << degrees;
      EXPECT_NEAR(orientations->measure(map_of(*mechanism, tilt, kFull, {80, 180, 8})), expected, 0.03 * expected)
          << axes << degrees;
    }
}

/// Of a box beyond the principal range, only the cells whose orientations the box contains twice are omitted.
TEST(Orientations, OmitsOnlyOrientationsThatTheBoxContains) {
  const auto mechanism = tilted("xyz");
  const auto orientations = orientations_of(*mechanism);
  const Box narrow = {{{-1, 1}, {-2.4, 2.4}, {-1, 1}}};
  // |cos b| over [-2.4, 2.4] is 4 - 2 sin(2.4)
  EXPECT_NEAR(orientations->measure(map_of(*mechanism, kPi, narrow, {8, 96, 8})), 4 * (4 - 2 * std::sin(2.4)), 1e-2);
}

TEST(Orientations, NeedThreeAngles) {
  EXPECT_EQ(why_no_orientations(*described("gough")), Unsupported());
  EXPECT_TRUE(why_no_orientations(*described("rotary-delta")));
  EXPECT_TRUE(why_no_orientations(*tilted("xxy")));
}

}  // namespace
}  // namespace pkm::test
