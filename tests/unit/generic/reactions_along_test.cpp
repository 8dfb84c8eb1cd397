// What joints carry along a motion: the largest of single states, drives by virtual work, what is not determined.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/mechanism/reactions_along.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

constexpr Wrench<double> kWrench = {3, -2, -20, 0.1, 0.2, -0.3};

Trajectory swing(const Mechanism& mechanism, std::size_t samples, const Motion* motion = nullptr) {
  const std::vector<double> design = test::nominal(mechanism.info());
  const std::string& mode = mechanism.info().modes.front();
  const auto own = test::motions(mechanism).front().motion;
  Trajectory along = compute_trajectory(mechanism, design, mode, no_limits(mechanism.info()), motion ? *motion : *own,
                                        samples, kWrench);
  add_reactions(mechanism, design, mode, kWrench, along);
  return along;
}

/// The magnitudes of a joint's force, or couple, of states that are computed one by one.
std::vector<double> magnitudes(const Mechanism& mechanism, std::size_t samples, std::size_t joint,
                               std::array<std::optional<double>, 3> JointReaction::*kind) {
  const std::vector<double> design = test::nominal(mechanism.info());
  const auto states = sample(*test::motions(mechanism).front().motion, samples);
  std::vector<double> all;
  for (const auto& state : states) {
    const Reactions found = mechanism.reactions()->find(design, mechanism.info().modes.front(),
                                                        {state.pose, state.velocity}, state.acceleration, kWrench);
    double square = 0;
    for (const auto& component : found.joints[joint].*kind) square += component.value() * component.value();
    all.push_back(std::sqrt(square));
  }
  return all;
}

TEST(ReactionsAlong, TheLargestIsThatOfSingleStates) {
  constexpr std::size_t kSamples = 17;
  for (const std::string name : {"rotary-delta", "gough"}) {
    SCOPED_TRACE(name);
    const Mechanism& mechanism = *test::described(name);
    const std::vector<ReactionLoads> carried = reaction_loads(swing(mechanism, kSamples));
    ASSERT_FALSE(carried.empty());
    for (std::size_t joint = 0; joint < carried.size(); ++joint) {
      const std::vector<double> forces = magnitudes(mechanism, kSamples, joint, &JointReaction::force);
      const double force = std::ranges::max(forces);
      EXPECT_NEAR(carried[joint].force.peak, force, 1e-13 * force) << carried[joint].name;
      // The motion begins and ends with the same state.
      EXPECT_NEAR(forces[carried[joint].force.at], force, 1e-13 * force);
      EXPECT_GT(carried[joint].force.peak, carried[joint].force.rms);
      EXPECT_GT(carried[joint].force.rms, 0);
      const double couple = std::ranges::max(magnitudes(mechanism, kSamples, joint, &JointReaction::couple));
      EXPECT_NEAR(carried[joint].couple.peak, couple, 1e-13 * couple + 1e-12 * force) << carried[joint].name;
    }
  }
}

TEST(ReactionsAlong, DrivesDoTheWorkThatTheMotionTakes) {
  std::vector<const Mechanism*> with_reactions;
  for (const auto& mechanism : all_mechanisms())
    if (mechanism->reactions()) with_reactions.push_back(mechanism.get().get());
  ASSERT_EQ(with_reactions.size(), 3u) << "4PPa-2PaR, (3CRR/R)&CRU and Quadrupteron";
  with_reactions.push_back(test::described("rotary-delta").get());
  for (const Mechanism* const mechanism : with_reactions) {
    SCOPED_TRACE(mechanism->info().name);
    const Trajectory along = swing(*mechanism, 41);
    double work = 0, largest = 0;
    for (std::size_t k = 0; k + 1 < along.points.size(); ++k)  // a whole cycle
      for (std::size_t i = 0; i < along.points[k].speeds->size(); ++i) {
        const double power = along.points[k].reactions->drive_forces[i] * (*along.points[k].speeds)[i];
        work += power * along.duration / 40;
        largest = std::fmax(largest, std::fabs(power));
        EXPECT_NEAR(power, (*along.points[k].power)[i], 1e-9 * largest);
      }
    EXPECT_GT(largest, 1e-3);
    EXPECT_NEAR(work, 0, 1e-9 * largest) << "of a cycle under weight and a wrench that stays";
  }
}

TEST(ReactionsAlong, WhatIsNotDeterminedIsLeftOut) {
  const Trajectory along = swing(*test::described("3-rrr"), 9);
  for (const ReactionLoads& joint : reaction_loads(along)) {
    EXPECT_EQ(joint.force.determined, (std::array{true, true, false})) << joint.name;
    EXPECT_EQ(joint.couple.determined, (std::array{false, false, true})) << joint.name;
    EXPECT_GT(joint.force.peak, 0);
  }
}

TEST(ReactionsAlong, SamplesThatDoNotAssembleSayWhy) {
  const Mechanism& mechanism = *test::described("rotary-delta");
  const auto away =
      point_to_point(test::reference_pose(mechanism), {{.to = {0, 0, -2}, .duration = 1}}, 0, TimeLaw::quintic);
  const Trajectory along = swing(mechanism, 5, away.get());
  EXPECT_EQ(along.points.front().reactions->reason, "");
  EXPECT_FALSE(along.points.front().reactions->joints.empty());
  EXPECT_EQ(along.points.back().reactions->reason, along.points.back().reason);
  EXPECT_NE(along.points.back().reason, "");
}

}  // namespace
}  // namespace pkm
