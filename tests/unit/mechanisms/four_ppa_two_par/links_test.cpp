// Where the links of 4PPa-2PaR are, and which pairs of them are tested.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "engine/math/statistics.hpp"
#include "engine/mechanisms/four_ppa_two_par/clear_volume.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/clear_designs.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

/// Distance of two parallel lines.
double line_distance(const Segment<double>& a, const Segment<double>& b) {
  const Vector3 direction = (at(a.to) - at(a.from)).normalized(), between = at(b.from) - at(a.from);
  return (between - between.dot(direction) * direction).norm();
}

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

}  // namespace
}  // namespace pkm::testing
