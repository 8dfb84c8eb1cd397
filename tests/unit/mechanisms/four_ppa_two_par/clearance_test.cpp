// Clearance of 4PPa-2PaR: where the links are, distances known by hand, and surveys under a clearance limit against the
// plain pose test, each other and equivalent limits.
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/math/statistics.hpp"
#include "engine/mechanisms/four_ppa_two_par/clear_volume.hpp"
#include "engine/mechanisms/four_ppa_two_par/voxels.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/plain_pose.hpp"
#include "tests/unit/mechanisms/plain_loop.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;
using Changes = std::vector<std::pair<ParameterIndex, double>>;

constexpr double kRoundoff = 1e-12;

using Vector3 = Eigen::Vector3d;
Vector3 at(const Point3<double>& p) { return {p[0], p[1], p[2]}; }

/// Distance of two parallel lines.
double line_distance(const Segment<double>& a, const Segment<double>& b) {
  const Vector3 direction = (at(a.to) - at(a.from)).normalized(), between = at(b.from) - at(a.from);
  return (between - between.dot(direction) * direction).norm();
}

std::vector<double> with(const Changes& changes) {
  auto p = nominal();
  for (const auto& [index, value] : changes) p[index] = value;
  return p;
}

LimitSpec no_limits_of_four_ppa() { return no_limits(four_ppa().info()); }

LimitSpec clearance(double least) {
  LimitSpec spec = no_limits_of_four_ppa();
  spec.given[kClearanceMin] = least;
  return spec;
}

PoseReport report(const std::vector<double>& p, const SchoenfliesPose<double>& pose, const LimitSpec& limits,
                  const std::string& mode = "lower,lower") {
  return four_ppa().inspect(p, pose, mode, limits);
}

double clearance_at(const std::vector<double>& p, const SchoenfliesPose<double>& pose,
                    const std::string& mode = "lower,lower") {
  const PoseReport r = report(p, pose, no_limits_of_four_ppa(), mode);
  for (const auto& [name, value] : r.angles)
    if (name == "clearance") return value;
  throw std::logic_error("the pose does not assemble: " + r.reason);
}

/// The pose in the middle at theta = 0 at which both limbs have this half spacing of sliders.
SchoenfliesPose<double> middle_pose(const std::vector<double>& p, double h) {
  const double x = (p[kB] - p[kA]) / 2;
  return {p[kB] / 2, p[kL0] / 2, -std::sqrt(p[kLu] * p[kLu] - h * h) - std::sqrt(p[kLd] * p[kLd] - x * x) - p[kD], 0};
}

/// Designs in which more than the sliders matters: thick links, a large clearance, rails near to each other.
struct Exotic {
  Changes changes;
  double least;
};
std::vector<Exotic> exotics() {
  return {
      {{{kA, 0.3}, {kB, 0.35}, {kRs, 0.1}, {kRu, 0.05}, {kD, 0.4}}, 0.22},   // sliders and bars of different rails
      {{{kA, 0.3}, {kB, 0.3}, {kRs, 0.01}, {kD, 0.5}, {kDd, 0.01}}, 0.275},  // all links of different limbs
      {{{kA, 0.25}, {kB, 0.55}, {kLd, 0.3}, {kD, 0.6}, {kDd, 0.01}, {kRp, 0.35}, {kRu, 0.15}},
       0.2},  // a thick platform
      {{{kA, 0.4}, {kB, 0.45}, {kLd, 0.3}, {kLu, 0.5}, {kD, 0.6}, {kDd, 0.02}, {kRd, 0.02}, {kRs, 0.01}}, 0.28},
  };
}

// --- where the links are

TEST(FourPpaLinks, BarsHaveTheirLengthsInEveryMode) {
  Uniform uniform(1);
  const auto p = nominal();
  const auto g = geometry(std::span<const double>(p));
  const auto length = [](const Capsule<double>& link) {
    return segment_distance<double>({link.axis.from, link.axis.from}, {link.axis.to, link.axis.to});
  };
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const SchoenfliesPose<double> pose{uniform(0, 0.8), 1.25, uniform(-1.3, 0.4), uniform(-1.5, 1.5)};
    const WorkingMode mode = {i & 1 ? Branch::lower : Branch::upper, i & 2 ? Branch::lower : Branch::upper};
    const auto limb = inverse(g, pose, mode);
    if (!limb.assembles) continue;
    const auto all = links(g, placement(limb, sincos(pose.angle).sin, mode));
    for (int j = 0; j < 2; ++j) {
      const auto of = [&](LinkGroup group, std::size_t k) { return all[links_of(group_of(j, group)).first + k]; };
      const auto& slider_1 = of(kSliders, 0).axis;
      const auto& slider_2 = of(kSliders, 1).axis;
      EXPECT_NEAR(length(of(kSliders, 0)) + 2 * g.R_s, 2 * (g.d_0 + g.d_u / 2), kRoundoff);
      EXPECT_NEAR(slider_2.from[1] - slider_1.from[1], 2 * limb.h[static_cast<std::size_t>(j)], kRoundoff);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(length(of(kUpperBars, k)), g.l_u, kRoundoff);
      EXPECT_NEAR(length(of(kConnectorSide, 0)), g.d_u, kRoundoff);
      EXPECT_NEAR(length(of(kLowerBars, 0)), g.d_d, kRoundoff);
      for (std::size_t k = 1; k < 3; ++k) EXPECT_NEAR(length(of(kLowerBars, k)), g.l_d, kRoundoff);
      EXPECT_NEAR(length(of(kLowerConnector, 0)), g.d, kRoundoff);
      // the connector's lower end is the platform's joint, at the pose asked for
      const Vector3 end = at(of(kLowerConnector, 0).axis.to),
                    joint = at(j == 0 ? all.back().axis.from : all.back().axis.to);
      EXPECT_LT((end - joint).norm(), kRoundoff);
      const auto [s, c] = sincos(pose.angle);
      const double side = j == 0 ? -g.a / 2 : g.a / 2;
      EXPECT_LT((joint - Vector3(pose.x + side * c, side * s, pose.z)).norm(), kRoundoff);
      // eq 17: distance of the two bars of a parallelogram
      const double sin_alpha = std::fabs(limb.z_c[static_cast<std::size_t>(j)]) / g.l_u;
      EXPECT_NEAR(line_distance(of(kUpperBars, 0).axis, of(kUpperBars, 1).axis), g.d_u * sin_alpha, kRoundoff);
      EXPECT_NEAR(line_distance(of(kLowerBars, 1).axis, of(kLowerBars, 2).axis),
                  g.d_d * limb.x[static_cast<std::size_t>(j)] / g.l_d, kRoundoff);
    }
    EXPECT_NEAR(length(all.back()), g.a, kRoundoff);
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(FourPpaLinks, EveryPairIsTestedOnce) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const GroupPair& pair : kPairs)
    visit_links(pair, [&](std::size_t i, std::size_t k) {
      EXPECT_TRUE(seen.insert(std::minmax(i, k)).second) << link_name(i) << ", " << link_name(k);
    });
  // 11 links of either limb, the platform and the 10 of each limb that do not carry it, two sliders per rail
  EXPECT_EQ(seen.size(), 11u * 11 + 2 * 10 + 2);
  const auto limb_of = [](std::size_t link) { return link < 11 ? 1 : link < 22 ? 2 : 0; };
  for (const auto& [i, k] : seen)
    EXPECT_TRUE(limb_of(i) != limb_of(k) || (link_name(i).starts_with("slider") && link_name(k).starts_with("slider")));
  EXPECT_EQ(link_name(0), "slider 1");
  EXPECT_EQ(link_name(12), "slider 4");
  EXPECT_EQ(link_name(2), "upper bar of slider 1");
  EXPECT_EQ(link_name(5), "upper bar of slider 2");
  EXPECT_EQ(link_name(6), "upper connector of limb 1");
  EXPECT_EQ(link_name(7), "upper connector of limb 1");
  EXPECT_EQ(link_name(20), "lower bar of limb 2");
  EXPECT_EQ(link_name(21), "lower connector of limb 2");
  EXPECT_EQ(link_name(22), "platform");
}

// --- distances by hand

TEST(FourPpaClearance, SlidersOfOneRail) {
  const auto p = nominal();
  for (const double gap : {0.005, 0.01, 0.03}) {  // 2 h - 2 d_0 - d_u
    const auto pose = middle_pose(p, p[kD0] + p[kDu] / 2 + gap / 2);
    EXPECT_NEAR(clearance_at(p, pose), gap, kRoundoff);
    const PoseReport r = report(p, pose, clearance(gap + 1e-9));
    EXPECT_FALSE(r.feasible);
    EXPECT_EQ(r.reason, "limit clearance_min is broken: slider 1 and slider 2 are too near");
    EXPECT_EQ(r.margins.back().first, "clearance_min");
    EXPECT_NEAR(r.margins.back().second, -1e-9, kRoundoff);
    EXPECT_TRUE(report(p, pose, clearance(gap - 1e-9)).feasible);
  }
  EXPECT_NEAR(clearance_at(p, middle_pose(p, p[kD0] + p[kDu] / 2 - 0.005)), -0.01, kRoundoff);
  EXPECT_EQ(report(p, middle_pose(p, p[kD0] + p[kDu] / 2 - 0.005), clearance(0)).reason,
            "limit clearance_min is broken: slider 1 and slider 2 overlap");
  // Sliders thicker than long are balls.
  EXPECT_NEAR(clearance_at(with({{kRs, 0.1}}), middle_pose(p, 0.105)), 0.01, kRoundoff);
}

TEST(FourPpaClearance, WithoutALimitThereIsNoMargin) {
  const PoseReport r = report(nominal(), middle_pose(nominal(), 0.01), no_limits_of_four_ppa());
  EXPECT_TRUE(r.feasible);
  for (const auto& margin : r.margins) EXPECT_NE(margin.first, "clearance_min");
}

TEST(FourPpaClearance, PairsWhoseDistanceIsTheSameAtEveryPose) {
  const SchoenfliesPose<double> pose{0.37, 1.25, -0.9, 0.4};
  // lower bars over the platform: d - d_d - R_d - R_p
  EXPECT_NEAR(clearance_at(nominal(), pose), 0.15 - 0.08 - 0.01 - 0.02, kRoundoff);
  EXPECT_THAT(report(nominal(), pose, clearance(0.05)).reason, ::testing::HasSubstr("platform and lower bar of limb"));
  // lower connectors: a - 2 R_d
  EXPECT_NEAR(clearance_at(with({{kRd, 0.07}, {kD, 0.3}}), {0.37, 1.25, -1, 0.4}), 0.2 - 2 * 0.07, kRoundoff);
  EXPECT_THAT(report(with({{kRd, 0.12}, {kD, 0.5}}), {0.37, 1.25, -1.3, 0.4}, clearance(0)).reason,
              ::testing::HasSubstr("limb 1 and lower"));
}

TEST(FourPpaClearance, BetweenTheRails) {
  // Upper connectors lie side by side at theta = 0, as far apart as the rails.
  EXPECT_NEAR(clearance_at(with({{kRu, 0.39}, {kD, 0.5}}), middle_pose(with({{kD, 0.5}}), 0.3)), 0.8 - 2 * 0.39,
              kRoundoff);
  // Sliders facing each other.
  const auto near = with({{kRs, 0.07}, {kB, 0.2}, {kD, 0.5}});
  EXPECT_NEAR(clearance_at(near, middle_pose(near, 0.3)), 0.2 - 2 * 0.07, kRoundoff);
  // Turned by 60 deg the limbs are a sin(60 deg) apart along the rails; the sliders are balls of 0.1 m.
  const auto p = with({{kA, 0.3}, {kB, 0.2}, {kD, 0.5}, {kRs, 0.1}, {kD0, 0.09}, {kDu, 0.02}});
  const double x_j = (p[kB] - p[kA] * 0.5) / 2, h = 0.3, apart = 0.3 * std::sqrt(0.75);
  const SchoenfliesPose<double> pose{0.1, 1.25, -std::sqrt(0.36 - h * h) - std::sqrt(0.55 * 0.55 - x_j * x_j) - 0.5,
                                     kPi / 3};
  EXPECT_NEAR(clearance_at(p, pose), std::hypot(0.2, apart) - 0.2, kRoundoff);
  EXPECT_EQ(report(p, pose, clearance(0.15)).reason,
            "limit clearance_min is broken: slider 1 and slider 3 are too near");
}

// A lower joint below the platform: the lower bar passes P_j at (d_d - d) sin(beta_j).
TEST(FourPpaClearance, LowerBarsBesideThePlatform) {
  const auto p = with({{kD, 0.05}, {kDd, 0.2}, {kRd, 0.001}, {kRp, 0.002}});
  const SchoenfliesPose<double> pose{0.3, 1.25, -0.8, 0.3};
  const auto limb = inverse(geometry(std::span<const double>(p)), pose, {Branch::lower, Branch::lower});
  const double sine = std::fmin(limb.x[0], limb.x[1]) / p[kLd];
  EXPECT_NEAR(clearance_at(p, pose), std::fmin(0.15 * sine, 0.05) - 0.003, kRoundoff);
}

TEST(FourPpaClearance, MirroredPosesHaveEqualClearance) {
  Uniform uniform(2);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    auto p = nominal();
    p[kA] = uniform(0.05, 0.5);
    p[kB] = uniform(0.1, 1);
    p[kRs] = uniform(0, 0.2);
    p[kRu] = uniform(0, 0.3);
    p[kD] = uniform(0, 0.3);
    const SchoenfliesPose<double> pose{uniform(0, p[kB]), uniform(0, 2.5), uniform(-1.2, 0.2), uniform(-1.5, 1.5)};
    const bool first_lower = i & 1, second_lower = i & 2;
    const auto mode = [](bool one, bool two) {
      return std::string(one ? "lower" : "upper") + "," + (two ? "lower" : "upper");
    };
    if (!report(p, pose, no_limits_of_four_ppa(), mode(first_lower, second_lower)).assembles) continue;
    const double here = clearance_at(p, pose, mode(first_lower, second_lower));
    const SchoenfliesPose<double> in_y{pose.x, 2.5 - pose.y, pose.z, -pose.angle};
    const SchoenfliesPose<double> in_x{p[kB] - pose.x, pose.y, pose.z, -pose.angle};
    EXPECT_NEAR(clearance_at(p, in_y, mode(first_lower, second_lower)), here, kRoundoff);
    EXPECT_NEAR(clearance_at(p, in_x, mode(second_lower, first_lower)), here, kRoundoff);
    auto big = p;
    for (double& length : big) length *= 3;
    EXPECT_NEAR(clearance_at(big, {3 * pose.x, 3 * pose.y, 3 * pose.z, pose.angle}, mode(first_lower, second_lower)),
                3 * here, 3 * kRoundoff);
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(FourPpaClearance, DerivativesEqualDifferences) {
  const auto p = exotics()[1].changes;
  const auto at = [&](auto step) {
    using S = decltype(step);
    std::vector<S> all;
    for (const double v : with(p)) all.emplace_back(v);
    const auto g = geometry(std::span<const S>(all));
    const SchoenfliesPose<S> pose{S(0.13) + step, S(1.25), S(-1.2) + step * 0.5, S(0.7) - step * 2.0};
    const WorkingMode mode = {Branch::lower, Branch::lower};
    return nearest_links(links(g, placement(inverse(g, pose, mode), sincos(pose.angle).sin, mode))).clearance;
  };
  const Dual4 exact = at(Dual4::variable(0, 0));
  EXPECT_EQ(exact.a, at(0.0));
  EXPECT_NEAR(exact.v[0], (at(1e-6) - at(-1e-6)) / 2e-6, 1e-7);
}

// --- the limit taken apart

/// Random designs of every proportion, thick and thin.
struct ClearanceCase {
  std::vector<double> p;
  double least;
};
ClearanceCase random_clearance_case(Uniform& uniform) {
  auto p = nominal();
  p[kA] = uniform(0.05, 0.6);
  p[kB] = uniform(0.05, 1.2);
  p[kLu] = uniform(0.3, 1.2);
  p[kLd] = uniform(0.3, 1.0);
  p[kD] = uniform(0, 0.4);
  p[kDd] = uniform(0.01, 0.3);
  p[kDu] = uniform(0.01, 0.2);
  p[kRu] = uniform(0, 0.1);
  p[kRs] = uniform(0, 0.1);
  p[kRd] = uniform(0, 0.01);
  p[kRp] = uniform(0, 0.01);
  return {p, uniform(-0.05, 0.15)};
}

struct Sampled {
  double x, z, s, c;
};
Sampled random_sample(const Geometry<double>& g, Uniform& uniform) {
  const auto [s, c] = sincos(uniform(-kPi / 2, kPi / 2));
  return {uniform(0, g.b), uniform(-(g.l_u + g.l_d + g.d), -g.d), s, c};
}

TEST(FourPpaClearance, NoPoseIsNearerThanTheBoundsSay) {
  Uniform uniform(3);
  std::vector<double> tightest(kGroups * kGroups, 10.0);
  for (int i = 0; i < 400; ++i) {
    ClearanceCase c = random_clearance_case(uniform);
    for (const ParameterIndex radius : {kRu, kRs, kRd, kRp}) c.p[radius] = 0;
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, no_limits_of_four_ppa());
    for (int k = 0; k < 500; ++k) {
      const Sampled at = random_sample(g, uniform);
      if (!feasible(g, l, at.x, g.L0 / 2, at.z, at.s, at.c)) continue;
      const auto all = links(g, lower_placement(g, at.x, at.z, at.s, at.c));
      for (const GroupPair& pair : kPairs) {
        if (pair.first == pair.second) continue;
        double least = 10;
        visit_links(pair, [&](std::size_t m, std::size_t n) {
          least = std::fmin(least, segment_distance(all[m].axis, all[n].axis));
        });
        const double bound = least_clearance(g, pair);
        ASSERT_GE(least, bound - kRoundoff)
            << link_name(links_of(pair.first).first) << ", " << link_name(links_of(pair.second).first);
        double& best = tightest[static_cast<std::size_t>(pair.first * kGroups + pair.second)];
        best = std::fmin(best, least - bound);
      }
    }
  }
  for (const GroupPair& pair : kPairs) {  // and none is far from what some pose comes to
    if (pair.first == pair.second) continue;
    EXPECT_LT(tightest[static_cast<std::size_t>(pair.first * kGroups + pair.second)], 0.3)
        << link_name(links_of(pair.first).first) << ", " << link_name(links_of(pair.second).first);
  }
}

TEST(FourPpaClearance, TakenApartItSaysTheSameOfEveryPose) {
  Uniform uniform(4);
  int clear = 0, blocked = 0, tested = 0;
  for (int i = 0; i < 600; ++i) {
    const ClearanceCase c = i % 3 > 0 ? random_clearance_case(uniform)
                                      : ClearanceCase{with(exotics()[i / 3 % 4].changes), exotics()[i / 3 % 4].least};
    const auto g = geometry(std::span<const double>(c.p));
    const auto free = limits(g, no_limits_of_four_ppa()), given = limits(g, clearance(c.least));
    auto folded = given;
    const auto test = take_clearance(g, folded);
    EXPECT_FALSE(folded.clearance_min);
    tested += test.has_value();
    for (int k = 0; k < 200; ++k) {
      const Sampled at = random_sample(g, uniform);
      if (!feasible(g, free, at.x, g.L0 / 2, at.z, at.s, at.c)) continue;
      const auto p = lower_placement(g, at.x, at.z, at.s, at.c);
      const double margin = nearest_links(links(g, p)).clearance - c.least;
      if (std::fabs(margin) < kRoundoff) continue;
      const bool plain = feasible(g, given, at.x, g.L0 / 2, at.z, at.s, at.c);
      EXPECT_EQ(plain, margin >= 0);
      const bool base = feasible(g, folded, at.x, g.L0 / 2, at.z, at.s, at.c);
      ASSERT_EQ(base && (!test || test->excess(p) >= 0), plain) << "design " << i << ", pose " << k;
      if (test && base && !plain) {
        EXPECT_NEAR(test->excess(p), margin, kRoundoff);
      }
      ++(plain ? clear : blocked);
    }
  }
  EXPECT_GT(clear, 2000);
  EXPECT_GT(blocked, 2000);
  EXPECT_GT(tested, 150);
}

TEST(FourPpaClearance, UsualProportionsLeaveNothingToTest) {
  for (const double least : {0.0, 0.01, 0.03}) {
    const auto p = nominal();
    const auto g = geometry(std::span<const double>(p));
    auto l = limits(g, clearance(least));
    EXPECT_FALSE(take_clearance(g, l));
    EXPECT_EQ(l.h_min, 0.07 + least / 2);
  }
}

// --- surveys

TEST(FourPpaClearance, VoxelsEqualThePlainLoop) {
  Uniform uniform(5);
  std::int64_t total = 0, cut = 0;
  for (int i = 0; i < 40; ++i) {
    const ClearanceCase c = i % 2 ? random_clearance_case(uniform)
                                  : ClearanceCase{with(exotics()[i / 2 % 4].changes), exotics()[i / 2 % 4].least};
    const double y = i % 3 == 2 ? c.p[kL0] * uniform(0.2, 0.8) : c.p[kL0] / 2;
    const SurveyPlan plan = voxels(clearance(c.least), {13, 16, 18}, at_y(y));
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, plan.limits);
    const VoxelGrid grid(plan.voxels()->cells, default_box(g));
    const VoxelMap plain = test_every_cell(grid, [&](double x, double z, double theta) {
      const auto [s, co] = sincos(theta);
      return feasible(g, l, x, y, z, s, co);
    });
    Survey<double> expected;
    summarise(grid, plain, expected);
    const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
    Demand demand;
    demand.add(kConditioning);
    const auto found = survey(c.p, plan, demand);
    EXPECT_EQ(map.feasible, plain.feasible) << i;
    EXPECT_EQ(found.feasible_cells, expected.feasible_cells) << i;
    EXPECT_EQ(found.touches_box, expected.touches_box) << i;
    double counted = 0;  // a sample may stand for its mirror images too
    for (const double w : found.weight) counted += w / found.cell_volume;
    EXPECT_NEAR(counted, static_cast<double>(expected.feasible_cells), 1e-6) << i;
    EXPECT_EQ(found.weight.size(), found.of(kConditioning).size()) << i;
    auto without = plan;
    without.limits = no_limits_of_four_ppa();
    total += found.feasible_cells;
    cut += survey(c.p, without).feasible_cells - found.feasible_cells;
  }
  EXPECT_GT(total, 5000);
  EXPECT_GT(cut, 5000);
}

TEST(FourPpaClearance, SlidersAloneAreABoundOfTheirSpacing) {
  Demand demand;
  demand.add(kConditioning);
  for (const double least : {0.0, 0.02}) {
    LimitSpec equal = no_limits_of_four_ppa();
    equal.given[kHMin] = 0.03 + 0.08 / 2 + least / 2;
    for (const HeldCoordinate& held : {in_the_middle(), at_y(0.4), over_y()}) {
      const auto found = survey(nominal(), columns(clearance(least), held), demand);
      const auto expected = survey(nominal(), columns(equal, held), demand);
      EXPECT_EQ(found.volume, expected.volume);
      EXPECT_EQ(found.error, expected.error);
      EXPECT_EQ(found.weight, expected.weight);
      EXPECT_EQ(found.of(kConditioning), expected.of(kConditioning));
      EXPECT_LT(found.volume, survey(nominal(), columns(no_limits_of_four_ppa(), held)).volume);
    }
    EXPECT_EQ(survey(nominal(), voxels(clearance(least), {32, 34, 60})).feasible_cells,
              survey(nominal(), voxels(equal, {32, 34, 60})).feasible_cells);
  }
}

TEST(FourPpaClearance, LowerBarsBesideThePlatformAreABoundOfBeta) {
  const auto p = with({{kD, 0.05}, {kDd, 0.2}, {kRd, 0.005}, {kRp, 0.005}});
  LimitSpec equal = no_limits_of_four_ppa();
  equal.given[kHMin] = 0.07 + 0.01;
  equal.given[kBetaMin] = asin((0.02 + 0.005 + 0.005) / (0.2 - 0.05));
  const double expected = survey(p, columns(equal)).volume;
  EXPECT_NEAR(survey(p, columns(clearance(0.02))).volume, expected, 1e-10 * expected);
  EXPECT_NEAR(survey(p, voxels(clearance(0.02), {60, 60, 60})).volume, expected, 0.02 * expected);
}

TEST(FourPpaClearance, ALargerClearanceNeverLeavesMore) {
  for (const Exotic& e : exotics()) {
    double before = survey(with(e.changes), columns(no_limits_of_four_ppa())).volume;
    for (const double share : {0.0, 0.8, 1.0, 1.1, 10.0}) {
      const auto found = survey(with(e.changes), columns(clearance(share * e.least), in_the_middle(), 1e-2));
      EXPECT_LE(found.volume, before * (1 + 1e-3)) << share;
      before = found.volume;
    }
    EXPECT_EQ(before, 0);
  }
}

/// Volumes by columns under a limit that cuts columns.
TEST(FourPpaClearance, ColumnsAgreeWithFineVoxels) {
  for (const Exotic& e : exotics()) {
    const auto p = with(e.changes);
    const auto g = geometry(std::span<const double>(p));
    auto l = limits(g, clearance(e.least));
    ASSERT_TRUE(take_clearance(g, l)) << e.least;
    for (const double y : {p[kL0] / 2, 0.45}) {
      const HeldCoordinate held = at_y(y);
      LimitSpec folded = no_limits_of_four_ppa();
      folded.given[kHMin] = l.h_min;
      const double uncut = survey(p, columns(folded, held)).volume;
      const auto found = survey(p, columns(clearance(e.least), held, 1e-2));
      EXPECT_LT(found.volume, uncut * (y == p[kL0] / 2 ? 1 - found.error : 1 + 1e-9)) << e.least;
      EXPECT_LT(found.error, 0.02);
      const double cells = survey(p, voxels(clearance(e.least), {120, 120, 120}, held)).volume;
      EXPECT_NEAR(found.volume, cells, 0.006 * uncut) << e.least << " at " << y;
    }
  }
}

TEST(FourPpaClearance, TheErrorIsEstimatedHonestly) {
  for (const Exotic& e : {exotics()[1], exotics()[2]}) {
    const auto p = with(e.changes);
    const auto best = survey(p, columns(clearance(e.least), in_the_middle(), kFinestClearTolerance));
    EXPECT_LE(best.error, 2 * kFinestClearTolerance);
    for (const double tolerance : {1e-2, 1e-3}) {
      const auto rough = survey(p, columns(clearance(e.least), in_the_middle(), tolerance));
      EXPECT_LE(std::fabs(rough.volume / best.volume - 1), rough.error + best.error);
      EXPECT_LT(rough.columns, best.columns);
    }
    const auto finer = survey(p, columns(clearance(e.least), in_the_middle(), 1e-9));
    EXPECT_EQ(finer.volume, best.volume) << "a finer tolerance is not aimed at";
    SurveyPlan nodes = columns(clearance(e.least));
    column_options(nodes).nodes = {40, 40};
    const auto fixed = survey(p, nodes);
    EXPECT_NEAR(fixed.volume / best.volume, 1, 2e-3);
    EXPECT_EQ(fixed.error, 0);
  }
}

TEST(FourPpaClearance, IntegratedOverYEqualsTheSumOverPlanes) {
  const Exotic e = exotics()[2];
  const auto p = with(e.changes);
  const auto found = survey(p, columns(clearance(e.least), over_y(), 1e-2));
  constexpr int kPlanes = 100;
  double sum = 0;
  for (int i = 0; i < kPlanes; ++i) {
    SurveyPlan plane = columns(clearance(e.least), at_y(p[kL0] * (i + 0.5) / kPlanes));
    column_options(plane).nodes = {5, 5};
    sum += survey(p, plane).volume;
  }
  EXPECT_NEAR(found.volume, sum * p[kL0] / kPlanes, 0.01 * found.volume);
  const SurveyPlan cells = voxels(clearance(e.least), {40, 40, 60}, over_y(40));
  EXPECT_NEAR(survey(p, cells).volume, found.volume, 0.02 * found.volume);
  // where the test never cuts, it is the quadrature of closed-form areas
  const auto wide = with({{kA, 0.3}, {kB, 0.305}, {kD, 0.3}});
  const auto g = geometry(std::span<const double>(wide));
  auto l = limits(g, clearance(0.005));
  ASSERT_TRUE(take_clearance(g, l));
  LimitSpec equal = no_limits_of_four_ppa();
  equal.given[kHMin] = l.h_min;
  EXPECT_NEAR(survey(wide, columns(clearance(0.005), over_y())).volume / survey(wide, columns(equal, over_y())).volume,
              1, 1e-4);
}

TEST(FourPpaClearance, ConditioningIsThatOfTheClearPoses) {
  Demand demand;
  demand.add(kConditioning);
  for (const Exotic& e : {exotics()[0], exotics()[1]}) {
    const auto p = with(e.changes);
    const auto exact = survey(p, columns(clearance(e.least), in_the_middle(), 1e-2), demand);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 0.04 * exact.volume);  // kinks that no node knows of
    const auto cells = survey(p, voxels(clearance(e.least), {80, 80, 80}), demand);
    EXPECT_NEAR(weighted_mean(cells.weight, cells.of(kConditioning)),
                weighted_mean(exact.weight, exact.of(kConditioning)), 5e-3);
  }
}

TEST(FourPpaClearance, NothingIsLeftWhereAPairIsTooNearAtEveryPose) {
  Demand demand;
  demand.add(kConditioning);
  for (const double least : {0.05, 0.19, 100.0})
    for (const HeldCoordinate& held : {in_the_middle(), over_y(10)}) {
      const SurveyPlan cells = voxels(clearance(least), {10, 10, 10}, held);
      for (const SurveyPlan& plan : {columns(clearance(least), held), cells}) {
        const auto empty = survey(nominal(), plan, demand);
        EXPECT_EQ(empty.volume, 0);
        EXPECT_EQ(empty.feasible_cells, 0);
        EXPECT_EQ(empty.error, 0);
        EXPECT_TRUE(empty.weight.empty());
      }
    }
}

TEST(FourPpaClearance, HasNoDerivativesAndSaysWhy) {
  const auto limited = prepare_survey(four_ppa(), columns(clearance(0.01)), {});
  EXPECT_EQ(limited->slopes(), nullptr);
  EXPECT_EQ(limited->why_no_slopes(),
            "the study limits the clearance of links (clearance_min), which may end columns where no formula says, and "
            "such surveys have no derivatives; take an optimiser without gradients, or keep the sliders apart by "
            "h_min");
  EXPECT_NE(prepare_survey(four_ppa(), columns(no_limits_of_four_ppa()), {})->slopes(), nullptr);
}

}  // namespace
}  // namespace pkm::testing
