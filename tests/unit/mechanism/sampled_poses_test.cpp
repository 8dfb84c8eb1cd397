// Poses sampled in the search box of a workspace, and the nearest solution of the forward kinematics.
#include "engine/mechanism/sampled_poses.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/mechanism/abilities/nearest_assembly.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::sampled_poses {
namespace {

std::vector<double> nominal(const Mechanism& mechanism) {
  std::vector<double> design;
  for (const Parameter& p : mechanism.info().parameters) design.push_back(p.nominal);
  return design;
}

TEST(SampledPoses, FillTheRangesAroundTheDefaultValues) {
  const Mechanism& gough = *test::described("gough");
  const std::vector<double> design = nominal(gough);
  constexpr double kReach = 0.1;
  const SampledPoses at_default(gough, design), near_default(gough, design, kReach);
  const auto ranges = gough.ranges(design).value();
  const std::vector<int>& fixed = gough.info().sweeps.front().fixed;
  ASSERT_FALSE(fixed.empty());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double width = ranges[i][1] - ranges[i][0];
    const bool is_fixed = std::ranges::find(fixed, static_cast<int>(i)) != fixed.end();
    double least = ranges[i][1], greatest = ranges[i][0];
    for (std::size_t k = 1; k <= 200; ++k) {
      const double value = near_default[k][i];
      least = std::min(least, value);
      greatest = std::max(greatest, value);
      if (is_fixed) {
        const double middle = gough.default_value(design, static_cast<int>(i)).value();
        EXPECT_EQ(at_default[k][i], middle);
        EXPECT_LE(std::abs(value - middle), kReach * width * (1 + 1e-12));
      }
    }
    EXPECT_GE(least, ranges[i][0]);
    EXPECT_LE(greatest, ranges[i][1]);
    EXPECT_GT(greatest - least, (is_fixed ? 1.5 * kReach : 0.9) * width);
  }
}

TEST(SampledPoses, ACentralPoseIsFeasible) {
  std::vector<std::string> names = test::mechanism_files();
  for (const MechanismEntry& entry : all_mechanisms()) names.push_back(entry.name());
  for (const std::string& name : names) {
    const Mechanism& mechanism = *test::described(name);
    const std::string& mode = mechanism.info().modes.front();
    const LimitSpec limits = no_limits(mechanism.info());
    const auto pose = central_pose(mechanism, nominal(mechanism), limits, mode);
    ASSERT_TRUE(pose) << name;
    EXPECT_TRUE(mechanism.inspect(nominal(mechanism), *pose, mode, limits).feasible) << name;
  }
}

TEST(NearestAssembly, AnglesAreComparedModuloATurn) {
  const std::shared_ptr<const Mechanism> four_ppa = all_mechanisms().front().get();  // every pose by closed forms
  const Mechanism& mechanism = *four_ppa;
  const std::vector<double> design = nominal(mechanism);
  const std::string& mode = mechanism.info().modes.front();
  const Pose<double> pose = central_pose(mechanism, design, no_limits(mechanism.info()), mode).value();
  const PoseReport report = mechanism.inspect(design, pose, mode, no_limits(mechanism.info()));
  Pose<double> from = pose;
  from[3] += 2 * M_PI - 0.01;
  const auto found = nearest_assembly(mechanism, design, *report.joints, from);
  ASSERT_TRUE(found);
  for (std::size_t i = 0; i < pose.size(); ++i) EXPECT_NEAR(found->pose[i], pose[i], 1e-9);
}

}  // namespace
}  // namespace pkm::sampled_poses
