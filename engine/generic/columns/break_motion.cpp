#include "engine/generic/columns/break_motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/generic/columns/corners.hpp"

namespace pkm::generic {
namespace {

constexpr double kOnePlace = 1e-3;  // of a section: corners that near meet at the break
constexpr std::size_t kMostThatMeet = 3;

bool are_near(const ArcEnd& x, const ArcEnd& y, const SectionRoom& room) {
  return std::fabs(x.v - y.v) < kOnePlace * room.v[1] && std::fabs(x.z - y.z) < kOnePlace * room.z[1];
}

/// Takes out what both have.
void drop_common(std::vector<ArcEnd>& x, std::vector<ArcEnd>& y, const SectionRoom& room) {
  std::erase_if(x, [&](const ArcEnd& end) {
    const auto same = std::ranges::find_if(y, [&](const ArcEnd& other) {
      return other.label == end.label && other.surface == end.surface && are_near(other, end, room);
    });
    if (same == y.end()) return false;
    y.erase(same);
    return true;
  });
}

/// Factors with which the gradients add up to nothing, where there are some.
std::array<double, kMostThatMeet> factors_of(std::span<const SectionMotion::Boundary> meet) {
  const auto cross = [&](std::size_t i, std::size_t j) { return meet[i].t * meet[j].s - meet[i].s * meet[j].t; };
  if (meet.size() == 1) return {1, 0, 0};
  if (meet.size() == 3) return {cross(1, 2), cross(2, 0), cross(0, 1)};
  const bool along_t = std::fabs(meet[0].t) > std::fabs(meet[0].s);
  return along_t ? std::array{meet[1].t, -meet[0].t, 0.0} : std::array{meet[1].s, -meet[0].s, 0.0};
}

/// Whether they do. @param size  of a single gradient's terms
bool depend(std::span<const SectionMotion::Boundary> meet, const std::array<double, kMostThatMeet>& factors,
            double size) {
  double t = 0, s = 0;
  for (std::size_t i = 0; i < meet.size(); ++i) {
    t += factors[i] * meet[i].t;
    s += factors[i] * meet[i].s;
    if (meet.size() > 1) size += std::fabs(factors[i]) * std::hypot(meet[i].t, meet[i].s);
  }
  return std::hypot(t, s) <= kOnePlace * size;
}

}  // namespace

std::vector<ArcEnd> arc_ends(const Section& section, const SectionRoom& room) {
  std::vector<ArcEnd> ends;
  section.for_each_arc_end(room, [&](EndLabel end, std::size_t first, double t) {
    const std::uint32_t surface = end >> 1U, label = corner_of(surface, first, t, room);
    const Conic& P = room.conics[surface];
    const bool turns = (label & kKind) == kExtreme && !P.is_straight();  // both roots, but for rounding
    const double s = turns ? -0.5 * (P.c[2] + t * P.c[4]) / P.c[5] : end_at(end, t, room);
    ends.push_back({label, surface, room.v[0] + room.v[1] * t, room.z[0] + room.z[1] * s});
  });
  return ends;
}

std::optional<Dual4> moving_break(double at, std::vector<ArcEnd> inside, std::vector<ArcEnd> outside,
                                  const SectionRoom& room, const SectionMotion& by_design, const SectionMotion& by_x) {
  drop_common(inside, outside, room);
  inside.insert(inside.end(), outside.begin(), outside.end());
  // An arc that turns back has no corner there, unless nothing else changes: then its conic comes or goes.
  const auto turns = [](const ArcEnd& end) { return (end.label & kKind) == kExtreme; };
  if (!std::ranges::all_of(inside, turns)) std::erase_if(inside, turns);
  if (inside.empty()) return {};
  const ArcEnd first = inside.front();
  std::erase_if(inside, [&](const ArcEnd& end) { return !are_near(end, first, room); });

  double v = 0, z = 0;
  std::vector<std::uint32_t> bounds;
  const auto add = [&](std::uint32_t bound) {
    if (std::ranges::find(bounds, bound) == bounds.end()) bounds.push_back(bound);
  };
  for (const ArcEnd& end : inside) {
    v += end.v / static_cast<double>(inside.size());
    z += end.z / static_cast<double>(inside.size());
    add(end.surface);
    const std::uint32_t kind = end.label & kKind, number = end.label & ~kKind;
    if (kind == kCrossing) {
      add(number & 255U);
      add(number >> 8U);
    } else if (end.label != 0) {
      add(kind == kSide || kind == kPlain ? end.label : number);
    }
  }
  if (bounds.size() > kMostThatMeet) return {};
  const double t = (v - room.v[0]) / room.v[1], s = (z - room.z[0]) / room.z[1];
  std::vector<SectionMotion::Boundary> meet;
  for (const std::uint32_t bound : bounds) meet.push_back(by_design.boundary(bound, t, s));
  const auto factors = factors_of(meet);
  if (!depend(meet, factors, meet.size() == 1 ? room.conics[bounds[0] & ~kKind].scale : 0)) return {};
  Components<4> change;
  double slope = 0, size = 0;  // of the sum, and of its terms
  for (std::size_t i = 0; i < meet.size(); ++i) {
    const double each = factors[i] * by_x.boundary(bounds[i], t, s).change[0];
    change = change + meet[i].change * factors[i];
    slope += each;
    size += std::fabs(each);
  }
  constexpr double kNothing = 1e-8;
  if (!(std::fabs(slope) > kNothing * size)) return {};
  return moved(at, change, slope);
}

}  // namespace pkm::generic
