#include "engine/mechanisms/four_ppa_two_par/links.hpp"

#include <numeric>

namespace pkm::four_ppa_two_par {

Placement<double> lower_placement(const Geometry<double>& g, double x, double z, double sin_theta, double cos_theta) {
  Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) place_limb(g, x, 0.0, z, {sin_theta, cos_theta}, kLowerMode[j], j, limbs);
  return placement(limbs, sin_theta, kLowerMode);
}

Nearest<double> nearest_obstacle(Links<double> all, double y, const Obstacles& obstacles) {
  for (Capsule<double>& link : all) {
    link.axis.from[1] += y;
    link.axis.to[1] += y;
  }
  std::array<std::size_t, kLinks> moving;
  std::iota(moving.begin(), moving.end(), std::size_t{0});
  return pkm::nearest_obstacle<double>(all, moving, obstacles);
}

std::string link_name(std::size_t link) {
  for (int limb = 0; limb < 2; ++limb) {
    const std::string of_limb = " of limb " + std::to_string(limb + 1);
    const auto within = [&](LinkGroup group) {  // place of the link in the group, or -1
      const GroupRange range = links_of(group_of(limb, group));
      return link >= range.first && link < range.end ? static_cast<int>(link - range.first) : -1;
    };
    const auto slider = [&](int first_or_second) { return std::to_string(2 * limb + first_or_second + 1); };
    if (const int i = within(kSliders); i >= 0) return "slider " + slider(i);
    if (const int i = within(kUpperBars); i >= 0) return "upper bar of slider " + slider(i / 2);
    if (within(kConnectorSide) >= 0 || within(kLowerBars) == 0) return "upper connector" + of_limb;
    if (within(kLowerBars) > 0) return "lower bar" + of_limb;
    if (within(kLowerConnector) >= 0) return "lower connector" + of_limb;
  }
  return "platform";
}

std::vector<PlacedLink> placed_links(const Geometry<double>& g, const Pose<double>& pose, WorkingMode mode) {
  std::vector<PlacedLink> placed;
  const Limbs<double> limb = inverse(g, pose, mode);
  if (!limb.assembles) return placed;
  for (int rail = 0; rail < 2; ++rail) {
    const double x = rail == 0 ? 0 : g.b;
    placed.push_back({"rail " + std::to_string(rail + 1), kFramePart, {{{x, 0, 0}, {x, g.L0, 0}}, g.R_s / 2}});
  }
  const Links<double> all = links(g, placement(limb, sincos(pose.angle).sin, mode));
  const std::size_t second = links_of(kGroupsPerLimb).first, platform = links_of(kPlatform).first;
  for (std::size_t i = 0; i < kLinks; ++i) {
    const char* const part = i >= platform ? kPlatformPart : i >= second ? "limb 2" : "limb 1";
    PlacedLink link{link_name(i), part, all[i]};
    link.body.axis.from[1] += pose.y;
    link.body.axis.to[1] += pose.y;
    placed.push_back(std::move(link));
  }
  return placed;
}

}  // namespace pkm::four_ppa_two_par
