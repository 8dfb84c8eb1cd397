// Where a section's arcs may end: corners, and what they are called.
#include "engine/generic/columns/corners.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

std::uint32_t crossing(std::size_t k, std::size_t l) { return kCrossing | static_cast<std::uint32_t>(k << 8U | l); }

/// Whether two conics that meet at a place touch there, but for rounding.
bool touch(const Conic& P, const Conic& Q, double t, double s) {
  const auto [pt, ps] = gradient(P, t, s);
  const auto [qt, qs] = gradient(Q, t, s);
  return std::fabs(pt * qs - ps * qt) <= 1e-5 * std::hypot(pt, ps) * std::hypot(qt, qs);
}

/// Conics that touch cross beside that place, twice or not at all, as rounding has it. An upright surface that passes
/// through it, as those do that tell which of the two counts, says where one takes over from the other.
void drop_touching(std::vector<SectionRoom::Corner>& corners) {
  std::erase_if(corners, [&](const SectionRoom::Corner& corner) {
    return corner.touches && std::ranges::any_of(corners, [&](const SectionRoom::Corner& other) {
             return (other.label & kKind) == kUpright && std::fabs(other.t - corner.t) < 1e-6;
           });
  });
}

}  // namespace

/// Unless the place is known to be infeasible whatever the surfaces `of` say there.
void Section::add_corner(double t, double s, Signs of, std::uint32_t label, SectionRoom& room) const {
  if (!(std::fabs(s) <= 1 + 1e-9)) return;
  Signs maybe = room.always;
  for (const std::size_t m : room.active) {
    const auto [same, opposite] = room.meaning[m];
    const Conic& P = room.conics[m];
    const double there = (of & bit(m)) != 0 ? 0 : P.at(t, s), near = 1e-7 * P.scale;
    const Signs no = (there < -near ? same : 0) | (there > near ? opposite : 0);
    if ((plan_.formula.all & no) != 0) return;
    maybe |= (same | opposite) & ~no;
  }
  for (const Signs one_of : plan_.formula.any)
    if ((maybe & one_of) == 0) return;
  const bool crosses = (label & kKind) == kCrossing;
  room.corners.push_back(
      {t, label, crosses && touch(room.conics[label & 255U], room.conics[(label & ~kKind) >> 8U], t, s), s});
}

void Section::find_corners(SectionRoom& room) const {
  room.corners.clear();
  std::array<double, 8> at{};
  std::array<Point, 16> points{};
  for (std::size_t i = 0; i < room.active.size(); ++i) {
    const std::size_t k = room.active[i];
    const Conic& P = room.conics[k];
    const auto number = static_cast<std::uint32_t>(k);
    if (!plan_.surfaces[k].has_z || (P.c[2] == 0 && P.c[4] == 0 && P.c[5] == 0)) {
      const std::size_t found = roots_between(std::array{P.c[0], P.c[1], P.c[3]}, at);
      for (std::size_t n = 0; n < found; ++n) room.corners.push_back({at[n], kUpright | number});
      continue;
    }
    if (P.is_straight()) {
      if (P.c[4] != 0) room.corners.push_back({-P.c[2] / P.c[4], kExtreme | number});
    } else {
      const std::size_t found = roots_between(P.discriminant(), at);
      for (std::size_t n = 0; n < found; ++n)
        add_corner(at[n], -0.5 * (P.c[2] + at[n] * P.c[4]) / P.c[5], bit(k), kExtreme | number, room);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t l = room.active[j];
      if (!plan_.surfaces[l].has_z) continue;
      const std::size_t found = crossings(P, room.conics[l], points);
      for (std::size_t n = 0; n < found; ++n)
        add_corner(points[n].t, points[n].s, bit(k) | bit(l), crossing(l, k), room);
    }
  }
  drop_touching(room.corners);
}

/// Corners where a plain condition along v changes its sign, among the pieces found so far.
void Section::find_plain_corners(std::span<double> registers, SectionRoom& room) const {
  constexpr int kSteps = 24;
  const double low = room.pieces.front().from, high = room.pieces.back().to;
  const double inset = 1e-9 * (high - low);
  double t = low + inset;
  run_plain(t, registers, room, room.before);
  for (int step = 1; step <= kSteps; ++step) {
    const double next = step == kSteps ? high - inset : low + (high - low) * step / kSteps;
    run_plain(next, registers, room, room.now);
    for (std::size_t i = 0; i < room.now.size(); ++i) {
      if (is_satisfied(room.before[i]) == is_satisfied(room.now[i])) continue;
      double a = t, b = next, at_a = room.before[i], at_b = room.now[i];
      for (int n = 0; n < 100 && b - a > 4e-16; ++n) {  // Illinois, which halves where a side stays
        double x = a - at_a * (b - a) / (at_b - at_a);
        if (!(x > a && x < b) || n % 3 == 2) x = 0.5 * (a + b);
        if (x <= a || x >= b) break;
        run_plain(x, registers, room, room.other_adjoints);
        const double f = room.other_adjoints[i];
        const bool is_like_a = is_satisfied(f) == is_satisfied(at_a);
        (is_like_a ? a : b) = x;
        (is_like_a ? at_a : at_b) = f;
      }
      room.corners.push_back({b, kPlain | static_cast<std::uint32_t>(i)});
    }
    t = next;
    std::swap(room.before, room.now);
  }
}

std::uint32_t corner_of(std::size_t surface, std::size_t first, double t, const SectionRoom& room) {
  if (first == room.corners.size()) return kSide | (t > 0 ? 1U : 0U);
  std::uint32_t found = 0;
  for (std::size_t i = first; i < room.corners.size() && room.corners[i].t <= room.corners[first].t + kTie; ++i) {
    const std::uint32_t label = room.corners[i].label, kind = label & kKind, place = label & ~kKind;
    const bool its_own =
        kind == kCrossing ? (place & 255U) == surface || place >> 8U == surface : kind != kExtreme || place == surface;
    if (its_own && (found == 0 || label < found)) found = label;
  }
  return found;
}

}  // namespace pkm::generic
