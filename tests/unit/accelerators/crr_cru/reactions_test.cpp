// Joint forces of (3CRR/R)&CRU and the Quadrupteron: golden values, ranks, and which couples rigid bodies determine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/accelerators/crr_cru/states.hpp"

namespace pkm::testing::crr {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr double kAccuracy = 1e-12;  // of the largest force

Reactions reactions_of(const Json& entry, const State& s) {
  return mechanism(entry["mechanism"])
      .reactions()
      ->find(s.parameters, mode_name(s.mode), s.motion, s.acceleration, s.wrench);
}
Reactions reactions_of(const Json& entry) { return reactions_of(entry, state_of(entry)); }

/// Standing still, without a wrench.
Reactions reactions_at(const std::string& name, const std::vector<double>& p, const pkm::Pose<double>& pose) {
  return mechanism(name).reactions()->find(p, "-,-,+,-", {pose, {0, 0, 0, 0}}, {0, 0, 0, 0}, {});
}

TEST(CrrCruReactions, EveryGoldenCase) {
  for (const Json& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const Reactions found = reactions_of(entry);
    ASSERT_EQ(found.reason, "");
    double largest = 0;
    for (const Json& force : entry["joint_forces"])
      for (const double component : force) largest = std::max(largest, std::fabs(component));
    ASSERT_EQ(found.joints.size(), entry["joint_forces"].size());
    for (const JointReaction& joint : found.joints) {
      const Json& expected = entry["joint_forces"][paper_name(joint.name)];
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(joint.force[k].value(), expected[k].get<double>(), kAccuracy * largest) << joint.name;
      if (joint.name != "t1") continue;
      EXPECT_EQ(joint.on, "middle platform");
      EXPECT_NEAR(joint.couple[1].value(), entry["M_t1y"].get<double>(), kAccuracy * largest);
    }
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(found.drive_forces[i], entry["tau"][i].get<double>(), kAccuracy * largest);
  }
}

TEST(CrrCruReactions, CouplesAreDeterminedWhereNoOtherLimbHoldsThem) {
  // "M_a2x": of joint a2 along x. What a joint transmits: couples normal to its axis, one for a universal joint.
  const std::set<std::string> jointed_undetermined = {"a2x", "b2x", "c2x", "a3x", "b3x", "c3x",
                                                      "a4x", "b4x", "c4x", "t1x",                 // two may be chosen
                                                      "a1y", "b1y", "c1y", "a3y", "b3y", "c3y",   // one
                                                      "a1z", "b1z", "c1z", "a2z", "b2z", "c2z"};  // one
  const std::set<std::string> rigid_undetermined = {"a2x", "b2x", "c2x", "a3x", "b3x", "c3x", "a4x", "b4x",
                                                    "c4x", "a1y", "b1y", "c1y", "a3y", "b3y", "c3y"};
  for (const Json& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const bool jointed = entry["mechanism"] == "3crr-r-cru";
    const Reactions found = reactions_of(entry);
    EXPECT_EQ(found.equations, jointed ? 60 : 54);
    EXPECT_EQ(found.unknowns, jointed ? 64 : 57);
    EXPECT_EQ(found.rank, found.equations);
    std::set<std::string> undetermined, zero;
    for (const JointReaction& joint : found.joints)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name = paper_name(joint.name) + "xyz"[axis];
        if (!joint.couple[axis])
          undetermined.insert(name);
        else if (*joint.couple[axis] == 0)
          zero.insert(name);
      }
    EXPECT_EQ(undetermined, jointed ? jointed_undetermined : rigid_undetermined);
    // no couple about the axes along which the joints turn
    std::set<std::string> free = {"a1x", "b1x", "c1x", "a2y", "b2y", "c2y", "a3z",
                                  "b3z", "c3z", "a4y", "b4y", "c4y", "c4z"};
    for (const char* universal : {"c1z", "c2z"})
      if (!jointed) free.insert(universal);
    if (jointed) free.insert("t1z");
    for (const std::string& name : free) EXPECT_TRUE(zero.contains(name)) << name;
    if (jointed && entry["Xd"][0] != 0) {
      for (const char* name : {"a4z", "b4z", "t1y"})
        EXPECT_FALSE(zero.contains(name) || undetermined.contains(name)) << name;
    }
  }
}

TEST(CrrCruReactions, BothClosuresGiveTheSameForcesAndFulfilTheEquations) {
  for (const Json& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const NewtonEuler system = newton_euler_of(entry["mechanism"], state_of(entry));
    const Eigen::VectorXd closed = solve_square_system(system);
    const MinNormSolution least = min_norm_solution(system);
    const LinearEquations e = equations(system);
    const double scale = closed.lpNorm<Eigen::Infinity>();
    EXPECT_LE((e.A * closed - e.b).lpNorm<Eigen::Infinity>(), 1e-12 * scale);
    EXPECT_LE((e.A * least.x - e.b).lpNorm<Eigen::Infinity>(), 1e-12 * scale);
    // The least norm is the least: not longer than the other solution, and normal to the null space.
    Eigen::VectorXd in_newtons = least.x, closed_in_newtons = closed;
    const double length = couple_length(system);
    Eigen::Index column = 0;
    for (const Joint& joint : system.joints) {
      for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(closed[column + k], least.x[column + k], 1e-11 * scale);
      const auto couples = static_cast<Eigen::Index>(joint.couples.size());
      in_newtons.segment(column + 3, couples) /= length;
      closed_in_newtons.segment(column + 3, couples) /= length;
      column += 3 + couples;
    }
    EXPECT_LE(in_newtons.norm(), closed_in_newtons.norm() * (1 + 1e-12));
    EXPECT_LE((least.null_space.transpose() * in_newtons).lpNorm<Eigen::Infinity>(), 1e-12 * scale);
  }
}

TEST(CrrCruReactions, SayWhyForcesAreNotDetermined) {
  const std::vector<double> p = nominal();
  for (const std::string& name : both()) {
    const Reactions far = reactions_at(name, p, {0.9, 0.17, 0.22, 0.3});
    EXPECT_THAT(far.reason, HasSubstr("cannot reach the pose"));
    EXPECT_TRUE(far.joints.empty());
    // the yaw at which limbs 2 and 4 no longer control it
    const Reactions singular = reactions_at(name, p, {0.2, 0.17, 0.22, kPi / 2});
    EXPECT_THAT(singular.reason, HasSubstr("at a singularity"));
    EXPECT_THAT(singular.reason, HasSubstr("of rank " + std::to_string(singular.equations - 1)));
    EXPECT_TRUE(singular.joints.empty());
  }
}

TEST(CrrCruReactions, ASlidesMassIsTheActuatorsAffair) {
  // The joint between slide and rod transmits the same force, and the actuator exerts m_s (rhoddot - g . e) more.
  for (const Json& entry : golden()["cases"]) {
    State s = state_of(entry);
    const auto at = [&](double mass) {
      s.parameters[kSlideMass] = mass;
      return reactions_of(entry, s);
    };
    const Reactions without = at(0), with = at(0.8);
    for (std::size_t i = 0; i < 4; ++i) {
      const double acceleration = entry["qdd"][i], weight = i == 2 ? kGravity : 0;
      EXPECT_NEAR(with.drive_forces[i], without.drive_forces[i] + 0.8 * (acceleration + weight),
                  1e-10 * (10 + std::fabs(acceleration)));
    }
    for (std::size_t j = 0; j < with.joints.size(); ++j) EXPECT_EQ(with.joints[j].force, without.joints[j].force);
  }
}

TEST(CrrCruReactions, HoldTheWholeWeight) {
  // Standing still, the rails carry all of it, wherever it hangs.
  std::vector<double> p = nominal();
  p[kPayload] = 1.5;
  p[kPayloadOffset] = 0.03;
  for (const std::string& name : both()) {
    const auto b = masses(MassModel::table, std::span<const double>(p));
    double mass = b.m + b.m_middle + b.payload;
    for (std::size_t i = 0; i < 4; ++i) mass += b.m_1[i] + b.m_2[i];
    const Reactions found = reactions_at(name, p, {0.2, 0.17, 0.22, 0.3});
    std::array<double, 3> sum{};
    for (const JointReaction& joint : found.joints)
      if (paper_name(joint.name)[0] == 'a')
        for (std::size_t k = 0; k < 3; ++k) sum[k] += joint.force[k].value();
    EXPECT_NEAR(sum[0], 0, 1e-11);
    EXPECT_NEAR(sum[1], 0, 1e-11);
    EXPECT_NEAR(sum[2], mass * kGravity, 1e-11);
  }
}

}  // namespace
}  // namespace pkm::testing::crr
