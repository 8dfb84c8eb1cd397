// Hybrid robot: laws of its kinematics on random designs and poses.
#include "tests/unit/accelerators/hybrid/golden.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/geometry/influence.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/taylor.hpp"

namespace pkm::testing::hybrid {
namespace {

/// Sine of the angle of links A and B.
double sine_of_links(const Geometry<double>& g, double z, const Joints<double>& j) {
  return std::fabs(z * (j.n1 - j.n2)) / (g.L1 * g.L2);
}

/// The minimum of what the accuracy of the forward kinematics depends on: the sine of the angle of links A and B,
/// |N2|/(e L3), |n_i|/L_i; and their product.
struct Distance {
  double least = 1, product = 1;
};
Distance from_singularities(const Geometry<double>& g, const SchoenfliesPose<double>& pose, const Joints<double>& j) {
  Distance d;
  for (const double measure : {sine_of_links(g, pose.z, j), std::fabs(j.N2) / (g.e * g.L3), std::fabs(j.n1) / g.L1,
                               std::fabs(j.n2) / g.L2, std::fabs(j.n3) / g.L3}) {
    d.least = std::fmin(d.least, measure);
    d.product *= measure;
  }
  return d;
}

AxisVector<double> drives_of(const Joints<double>& j) { return {j.s[0], j.s[1], j.s[2], j.s[3]}; }

/// Difference of two poses, of lengths relative to L1.
double difference(const Geometry<double>& g, const SchoenfliesPose<double>& p, const SchoenfliesPose<double>& q) {
  const double turn = std::fabs(std::remainder(p.angle - q.angle, 2 * kPi));
  return std::fmax(std::fmax(std::fabs(p.x - q.x), std::fabs(p.y - q.y)) / g.L1,
                   std::fmax(std::fabs(p.z - q.z) / g.L1, turn));
}

TEST(HybridKinematics, ForwardInvertsInverseInEveryMode) {
  Uniform uniform(1);
  int regular = 0, near = 0, poses = 0;
  double worst = 0, worst_near = 0;
  while (poses < 100000) {
    const auto g = geometry_of(random_design(uniform));
    const SchoenfliesPose<double> pose = random_pose(uniform);
    if (!inverse(g, pose, {1, 1, 1}).assembles()) continue;
    ++poses;
    for (const WorkingMode& mode : all_signs()) {
      const Joints<double> j = inverse(g, pose, mode);
      const Forward found = forward(g, drives_of(j));
      const Distance distance = from_singularities(g, pose, j);
      ASSERT_EQ(found.status.word, "OK");
      const std::string signs = std::string(pose.z > 0 ? "+," : "-,") + (j.N2 > 0 ? "+" : "-");
      double error = INFINITY;
      for (const AssemblyMode& a : found.modes) {
        for (const double value : a.pose) ASSERT_TRUE(std::isfinite(value));
        const bool same = a.mode == signs;
        if (!same && a.double_roots.empty()) continue;  // of a double root, half of the digits are known
        error = std::fmin(error, difference(g, schoenflies(a.pose), pose));
        if (same && distance.least > 0.05) {
          EXPECT_EQ(a.working_mode, mode_name(mode));
        }
      }
      if (distance.least > 0.05) {
        ++regular;
        worst = std::fmax(worst, error);
      } else {
        ++near;
        worst_near = std::fmax(worst_near, error * distance.product);
      }
    }
  }
  EXPECT_LT(worst, kNear);
  EXPECT_LT(worst_near, kNear);
  EXPECT_GT(regular, 100000);
  EXPECT_GT(near, 10000);
  std::cout << "worst relative error of " << regular << " regular solutions: " << worst << ", of " << near
            << " near singularities, times their distances: " << worst_near << '\n';
}

TEST(HybridKinematics, EveryAssemblyHasTheDrives) {
  Uniform uniform(2);
  int solved = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto g = geometry_of(random_design(uniform));
    const AxisVector<double> s = {uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2)};
    const Forward found = forward(g, s);
    EXPECT_EQ(found.modes.empty(), found.status.word != "OK");
    for (const AssemblyMode& a : found.modes) {
      const std::vector<int> n = signs_of(a.working_mode);
      if (n[0] * n[1] * n[2] == 0) continue;
      const SchoenfliesPose<double> pose = schoenflies(a.pose);
      const Joints<double> j = inverse(g, pose, {n[0], n[1], n[2]});
      const Distance distance = from_singularities(g, pose, j);
      if (!j.assembles() || distance.least < 0.01) continue;
      ++solved;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(j.s[i], s[i], 1e-12);
    }
  }
  EXPECT_GT(solved, 5000);
}

TEST(HybridKinematics, DegenerateDrivesHaveAStatusAndNoPose) {
  auto p = nominal();
  const auto status = [&](const AxisVector<double>& s) {
    const Forward found = forward(geometry_of(p), s);
    EXPECT_TRUE(found.modes.empty());
    return found.status.word;
  };
  // Links A and B parallel: the carriages are as far apart as A' and B'.
  const AxisVector<double> parallel = {0.1, 0, 0.1 + 2 * p[kA] - p[kB1] - p[kB2], 0};
  EXPECT_EQ(status(parallel), "DEGENERATE_XZ");
  p[kL2] = 0.25;
  EXPECT_EQ(status(parallel), "NO_XZ");
  EXPECT_EQ(status({-1, 0, 1, 0}), "NO_XZ");
  EXPECT_EQ(status({0, 0, 0, 1}), "NO_BETA");
}

TEST(HybridKinematics, LinksOfOneLengthInParallelModesAreDegenerateEverywhere) {
  Uniform uniform(7);
  int tested = 0;
  for (int k = 0; k < 1000; ++k) {
    auto p = random_design(uniform);
    p[kL2] = p[kL1];
    const auto g = geometry_of(p);
    const SchoenfliesPose<double> pose = random_pose(uniform);
    for (const WorkingMode& mode : all_signs()) {
      const Joints<double> j = inverse(g, pose, mode);
      if (!j.assembles() || mode[0] != mode[1]) continue;
      ++tested;
      EXPECT_EQ(forward(g, drives_of(j)).status.word, "DEGENERATE_XZ");
      EXPECT_EQ(sine_of_links(g, pose.z, j), 0);
    }
  }
  EXPECT_GT(tested, 500);
}

TEST(HybridKinematics, ReportsAgreeWithTheClosedFormAcrossSingularities) {
  // Any pose, also those out of reach, on the base, or where the shaft has no length.
  Uniform uniform(3);
  auto p = nominal();
  const auto test = [&](const SchoenfliesPose<double>& pose) {
    for (const WorkingMode& mode : all_signs()) {
      const Joints<double> j = inverse(geometry_of(p), pose, mode);
      const PoseReport report = mechanism().inspect(p, pose, mode_name(mode), no_thresholds());
      EXPECT_EQ(report.assembles, j.assembles());
      EXPECT_EQ(report.feasible, report.reason.empty());
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(std::isfinite(j.s[i]));
        if (report.assembles) {
          EXPECT_NEAR((*report.joints)[i], j.s[i], kNear);
        }
      }
      if (report.assembles && !j.serial) {
        EXPECT_TRUE(report.J && report.conditioning);
      }
    }
  };
  for (int k = 0; k < 1000; ++k) test(random_pose(uniform));
  for (const double z : {0.0, p[kL1], -p[kL1], 0.3, 0.05})
    for (const double beta : {0.0, kPi / 2, -kPi / 2, kPi}) test({0, 0, z, beta});
  p[kD] = p[kE];  // e cos b = d at beta = 0
  test({0, 0, 0.2, 0});
  test({0, 0, 0, 0});
  p[kF] = p[kFp];  // F1 = F3
  test({0, 0, 0, 0});
}

TEST(HybridKinematics, MarginsWithDerivativesHaveTheSameBitsAndTheDerivativesOfDifferences) {
  Uniform uniform(4);
  int poses = 0, derivatives = 0;
  while (poses < 200) {
    const auto p = random_design(uniform);
    const pkm::Pose<double> at = {uniform(-0.1, 0.1), 0, uniform(0.15, 0.24), uniform(-0.4, 0.4)};
    const std::size_t varied = static_cast<std::size_t>(uniform(0, kParameters));
    if (!inverse(geometry_of(p), schoenflies(at), {1, -1, -1}).assembles()) continue;
    ++poses;
    Scratch scratch;
    const auto margins_at = [&](const std::vector<double>& design) {
      std::vector<double> found;
      mechanism().pose_margins()->append(design, "", no_thresholds(), {&at, 1}, scratch, found);
      return found;
    };
    std::vector<Dual4> q(p.begin(), p.end()), found;
    q[varied] = Dual4::variable(p[varied], 0);
    mechanism().pose_margins()->append(q, "", no_thresholds(), {&at, 1}, scratch, found);
    const auto plain = margins_at(p);
    ASSERT_EQ(found.size(), plain.size());
    auto lower = p, upper = p;
    constexpr double kStep = 1e-6;
    lower[varied] -= kStep;
    upper[varied] += kStep;
    const auto below = margins_at(lower), above = margins_at(upper);
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_EQ(found[i].a, plain[i]) << i;
      EXPECT_TRUE(std::isfinite(found[i].v[0])) << i;
      if (below.size() != plain.size() || above.size() != plain.size()) continue;  // the edge of a limb's reach
      const double ahead = (above[i] - plain[i]) / kStep, behind = (plain[i] - below[i]) / kStep;
      if (std::fabs(ahead - behind) > 1e-3) continue;  // a kink, or near the edge of a limb's reach
      ++derivatives;
      EXPECT_NEAR(found[i].v[0], (ahead + behind) / 2, 1e-5 * (1 + std::fabs(ahead))) << i;
    }
  }
  EXPECT_GT(derivatives, 4000);
}

template <class S>
Geometry<S> constant(const std::vector<double>& p) {
  const std::vector<S> q(p.begin(), p.end());
  return geometry(std::span<const S>(q));
}

TEST(HybridKinematics, InfluenceCoefficientsAreTheDerivativesOfTheDrives) {
  Uniform uniform(5);
  int compared = 0;
  while (compared < 1000) {
    const auto p = random_design(uniform);
    const SchoenfliesPose<double> pose = random_pose(uniform);
    const WorkingMode mode = all_signs()[static_cast<std::size_t>(uniform(0, 8))];
    const auto g = geometry_of(p);
    const Joints<double> j = inverse(g, pose, mode);
    if (!j.assembles() || from_singularities(g, pose, j).least < 0.05) continue;
    ++compared;
    AxisVector<double> V(4), A(4);
    for (std::size_t i = 0; i < 4; ++i) {
      V[i] = uniform(-1, 1);
      A[i] = uniform(-1, 1);
    }
    const SchoenfliesPose<Taylor> moving{
        {pose.x, V[0], A[0]}, {pose.y, V[1], A[1]}, {pose.z, V[2], A[2]}, {pose.angle, V[3], A[3]}};
    const Joints<Taylor> motion = inverse(constant<Taylor>(p), moving, mode);
    const auto q = mechanism().velocities()->influence(p, pose, mode_name(mode));
    ASSERT_TRUE(q);
    const AxisVector<double> speeds = q->G * V, drives = accelerations(*q, V, A), back = reversed(*q).G * speeds;
    const auto scale = [](double value) { return 1 + std::fabs(value); };
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(speeds[i], motion.s[i].d, kNear * scale(speeds[i]));
      EXPECT_NEAR(drives[i], motion.s[i].dd, kNear * scale(motion.s[i].dd) * scale(speeds[i] * speeds[i]));
      EXPECT_NEAR(back[i], V[i], 1e-11);
    }
  }
}

TEST(HybridKinematics, ChainIsInvertibleAndTheOutputGainsATurnPerTurn) {
  Uniform uniform(6);
  int turned = 0;
  while (turned < 2000) {
    const auto p = random_design(uniform);
    const double zeta = turned % 2 == 0 ? 0 : uniform(-3, 3), theta = uniform(-10, 10);
    MotionSample at{.pose = {uniform(-0.15, 0.15), 0, uniform(0.1, 0.3), uniform(-0.6, 0.6)},
                    .velocity = AxisVector<double>(4),
                    .acceleration = AxisVector<double>(4)};
    const auto at_input = [&](double angle, double gamma_wanted = 0) {
      at.inputs = inputs_of({angle, 1, 0}, zeta, gamma_wanted);
      return quantities(p, at);
    };
    const auto values = at_input(theta);
    const double gamma = values.at("gamma");
    if (std::isnan(gamma)) continue;
    ++turned;
    const double back = at_input(theta, gamma).at("theta_for_gamma");
    EXPECT_NEAR(std::remainder(back - theta, 2 * kPi), 0, 1e-11);
    if (zeta != 0) continue;
    EXPECT_NEAR(back, theta, 1e-11);
    EXPECT_LT(std::fabs(gamma - theta), kPi);
    EXPECT_NEAR(at_input(theta + 2 * kPi).at("gamma"), gamma + 2 * kPi, 1e-11);
    EXPECT_LE(values.at("gamma_speed"), values.at("aux_ratio_max") * (1 + 1e-12));
    EXPECT_GE(values.at("gamma_speed"), values.at("aux_ratio_min") * (1 - 1e-12));
  }
}

}  // namespace
}  // namespace pkm::testing::hybrid
