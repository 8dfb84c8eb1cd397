// Hybrid robot: the whole of it for pictures. Where the joints are is the source's; what it leaves open is drawn so:
//
//   rail E     as long as the stroke s2, in the plane X = 0, just below the carriage
//   carriage   a bar along Y' from the rails of A and B to that of C; the rails as long as strokes s1, s3 and s4, and
//              to the bar
//   platform   the edge A'B' and the arm O''C'
//   chain      input shaft F F1, telescopic shaft F1 F3, output shaft F3 F' and on it the tool, kToolRadii long
//
// Rails and the bar are half as thick as link A.
#include "engine/mechanisms/hybrid/links.hpp"

#include <algorithm>

namespace pkm::hybrid {
namespace {

constexpr double kToolRadii = 6;  ///< of the telescopic shaft

}  // namespace

std::vector<PlacedLink> placed_links(std::span<const double> p, const Pose<double>& pose, const WorkingMode& mode) {
  using Point = Point3<double>;
  std::vector<PlacedLink> placed;
  const Geometry<double> g = geometry(p);
  const Joints<double> j = inverse(g, pose, mode);
  if (!j.assembles()) return placed;
  const Shaft<double> w = shaft(g, pose);
  const Links<double> link = links(g, pose, j, w);
  const auto [sin_b, cos_b] = sincos(pose.angle);
  const auto add = [&](const char* name, const char* part, Point from, Point to, double radius) {
    if (part != kFramePart) {
      from[1] += pose.y;
      to[1] += pose.y;
    }
    placed.push_back({name, part, {{from, to}, radius}});
  };
  const auto add_link = [&](const char* name, const char* part, Link which) {
    add(name, part, link[which].axis.from, link[which].axis.to, link[which].radius);
  };
  const double thin = g.radius[kLinkA] / 2;
  add("rail E", kFramePart, {0, p[kSMin + 1], -2 * thin}, {0, p[kSMax + 1], -2 * thin}, thin);

  const char* const carriage = "carriage";
  const double A = -g.b1, B = g.b2, C = g.c;
  add("rail of A and B", carriage, {std::min({0.0, A + p[kSMin], B + p[kSMin + 2]}), 0, 0},
      {std::max({0.0, A + p[kSMax], B + p[kSMax + 2]}), 0, 0}, thin);
  add("rail of C", carriage, {std::min(0.0, C + p[kSMin + 3]), g.d, 0}, {std::max(0.0, C + p[kSMax + 3]), g.d, 0},
      thin);
  add("carriage E", carriage, {0, 0, 0}, {0, std::max(g.d, g.f), 0}, thin);

  const struct {
    const char *slide, *name, *limb;
    Link which;
  } limbs[] = {{"carriage A", "link A", "limb A", kLinkA},
               {"carriage B", "link B", "limb B", kLinkB},
               {"carriage C", "link C", "limb C", kLinkC}};
  for (const auto& limb : limbs) {
    const Point& foot = link[limb.which].axis.from;
    add(limb.slide, limb.limb, foot, foot, 1.5 * link[limb.which].radius);
    add_link(limb.name, limb.limb, limb.which);
  }
  add_link("platform", kPlatformPart, kLinkP);
  add("platform", kPlatformPart, {pose.x, 0, pose.z}, link[kLinkC].axis.to, g.radius[kLinkP]);

  const char* const chain = "auxiliary chain";
  const Point output = {pose.x, g.fp * cos_b, pose.z + g.fp * sin_b};  // F'
  const double tool = kToolRadii * g.radius[kLinkF];
  add("input shaft", chain, {0, g.f, 0}, w.F1, g.radius[kLinkF]);
  add_link("telescopic shaft", chain, kLinkF);
  add("output shaft", chain, w.F3, output, g.radius[kLinkF]);
  add("tool", chain, output, {output[0], output[1] - tool * sin_b, output[2] + tool * cos_b}, g.radius[kLinkF] / 2);
  return placed;
}

}  // namespace pkm::hybrid
