// Links of 4PPa-2PaR as the accelerator places them: against the generic engine, and their lengths; the pairs that it
// tests for clearance.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/links.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/clear_designs.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

/// Where a link of the accelerator is in the file's list, which has the two rails before the platform.
std::size_t in_file(std::size_t link) { return link < kLinks - 1 ? link : link + 2; }

/// Distance of two parallel lines.
double line_distance(const Segment<double>& a, const Segment<double>& b) {
  const Vector3 direction = (at(a.to) - at(a.from)).normalized(), between = at(b.from) - at(a.from);
  return (between - between.dot(direction) * direction).norm();
}

double distance(const Point3<double>& a, const Point3<double>& b) { return (at(a) - at(b)).norm(); }

TEST(FourPpaLinks, AreThoseOfTheGenericEngine) {
  Uniform uniform(6);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const ClearanceCase c = random_clearance_case(uniform);
    const auto g = geometry(std::span<const double>(c.p));
    const SchoenfliesPose<double> pose{uniform(0, g.b), uniform(0.2, 2.3), uniform(-(g.l_u + g.l_d + g.d), 0.4),
                                       uniform(-1.5, 1.5)};
    const int mode = i % 4;
    const auto limbs = limbs_at(g, pose, working_mode(mode));
    if (!limbs) continue;
    const auto mine = links(g, placement(*limbs, sincos(pose.angle).sin, working_mode(mode)));
    const auto placed = generic_four_ppa().links()->place(c.p, pose, kModes[mode]);
    ASSERT_EQ(placed.size(), kLinks + 2);
    for (std::size_t k = 0; k < kLinks; ++k) {
      const Capsule<double>& expected = placed[in_file(k)].body;
      const auto moved = [&](const Point3<double>& point) {  // distances do not depend on the platform's y
        return Point3<double>{point[0], point[1] + pose.y, point[2]};
      };
      EXPECT_LT(distance(moved(mine[k].axis.from), expected.axis.from), kRoundoff) << placed[in_file(k)].name;
      EXPECT_LT(distance(moved(mine[k].axis.to), expected.axis.to), kRoundoff) << placed[in_file(k)].name;
      EXPECT_EQ(mine[k].radius, expected.radius) << placed[in_file(k)].name;
    }
    const PoseReport report = generic_four_ppa().inspect(c.p, pose, kModes[mode], no_limits_of_four_ppa());
    EXPECT_NEAR(nearest_links(mine).clearance, named(report.angles, "clearance"), kRoundoff);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(FourPpaLinks, BarsHaveTheirLengthsInEveryMode) {
  Uniform uniform(1);
  const auto p = nominal();
  const auto g = geometry(std::span<const double>(p));
  const auto length = [](const Capsule<double>& link) { return distance(link.axis.from, link.axis.to); };
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const SchoenfliesPose<double> pose{uniform(0, 0.8), 1.25, uniform(-1.3, 0.4), uniform(-1.5, 1.5)};
    const WorkingMode mode = working_mode(i % 4);
    const auto limb = limbs_at(g, pose, mode);
    if (!limb) continue;
    const auto all = links(g, placement(*limb, sincos(pose.angle).sin, mode));
    for (int j = 0; j < 2; ++j) {
      const auto of = [&](LinkGroup group, std::size_t k) { return all[links_of(group_of(j, group)).first + k]; };
      const auto& slider_1 = of(kSliders, 0).axis;
      const auto& slider_2 = of(kSliders, 1).axis;
      EXPECT_NEAR(length(of(kSliders, 0)) + 2 * g.R_s, 2 * (g.d_0 + g.d_u / 2), kRoundoff);
      EXPECT_NEAR(slider_2.from[1] - slider_1.from[1], 2 * limb->h[static_cast<std::size_t>(j)], kRoundoff);
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
      const double sin_alpha = std::fabs(limb->z_c[static_cast<std::size_t>(j)]) / g.l_u;
      EXPECT_NEAR(line_distance(of(kUpperBars, 0).axis, of(kUpperBars, 1).axis), g.d_u * sin_alpha, kRoundoff);
      EXPECT_NEAR(line_distance(of(kLowerBars, 1).axis, of(kLowerBars, 2).axis),
                  g.d_d * limb->x[static_cast<std::size_t>(j)] / g.l_d, kRoundoff);
    }
    EXPECT_NEAR(length(all.back()), g.a, kRoundoff);
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

Pairs tested_pairs() {
  Pairs seen;
  for (const GroupPair& pair : kPairs)
    visit_links(pair, [&](std::size_t i, std::size_t k) {
      EXPECT_TRUE(seen.insert(std::minmax(i, k)).second) << i << ", " << k << " twice";
    });
  return seen;
}

TEST(FourPpaLinks, EveryPairIsTestedOnce) {
  const Pairs seen = tested_pairs();
  // 11 links of either limb, the platform and the 10 of each limb that do not carry it, two sliders per rail
  EXPECT_EQ(seen.size(), 11u * 11 + 2 * 10 + 2);
  const auto limb_of = [](std::size_t link) { return link < 11 ? 1 : link < 22 ? 2 : 0; };
  const auto is_slider = [](std::size_t link) { return link % 11 < 2 && link < 22; };
  for (const auto& [i, k] : seen) EXPECT_TRUE(limb_of(i) != limb_of(k) || (is_slider(i) && is_slider(k)));
}

// In the file, the lower connectors of both limbs are one group with the platform that they carry. They are as far
// apart as the ends of the lower bars, which are tested in both.
TEST(FourPpaLinks, PairsAreThoseOfTheFile) {
  const auto joined = generic_four_ppa().links()->joined();
  Pairs expected;
  for (std::size_t i = 0; i < kLinks; ++i)
    for (std::size_t k = i + 1; k < kLinks; ++k)
      if (std::ranges::count(joined[in_file(i)].others, joined[in_file(k)].link) == 0) expected.insert({i, k});
  const std::size_t first = links_of(group_of(0, kLowerConnector)).first,
                    second = links_of(group_of(1, kLowerConnector)).first;
  EXPECT_TRUE(expected.insert({first, second}).second);
  EXPECT_EQ(tested_pairs(), expected);
}

}  // namespace
}  // namespace pkm::testing
