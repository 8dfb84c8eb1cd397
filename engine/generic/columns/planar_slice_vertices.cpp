// Vertices of a planar slice, at which its arcs can end, and their labels.
#include "engine/generic/columns/vertices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/roots.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

std::uint32_t crossing(std::size_t k, std::size_t l) { return kCrossing | static_cast<std::uint32_t>(k << 8U | l); }

/// Whether two conics are tangent to each other at an intersection (t, s), up to rounding errors.
bool touch(const Conic& P, const Conic& Q, double t, double s) {
  const auto [pt, ps] = gradient(P, t, s);
  const auto [qt, qs] = gradient(Q, t, s);
  return std::fabs(pt * qs - ps * qt) <= 1e-5 * std::hypot(pt, ps) * std::hypot(qt, qs);
}

/// Removes the intersections of tangent conics that lie on another conic which is a vertical line: rounding errors
/// decide whether tangent conics intersect, whereas the vertex of the vertical line represents the point reliably.
void drop_touching(std::vector<PlanarSliceScratch::Vertex>& vertices) {
  std::erase_if(vertices, [&](const PlanarSliceScratch::Vertex& vertex) {
    return vertex.touches && std::ranges::any_of(vertices, [&](const PlanarSliceScratch::Vertex& other) {
             return (other.label & kKind) == kVertical && std::fabs(other.t - vertex.t) < 1e-6;
           });
  });
}

}  // namespace

/// Adds a vertex at (t, s), unless the point is infeasible for all combinations of signs of the surfaces in the set
/// `of`.
void PlanarSlice::add_vertex(double t, double s, Signs of, std::uint32_t label, PlanarSliceScratch& scratch) const {
  if (!(std::fabs(s) <= 1 + 1e-9)) return;
  Signs maybe = scratch.always;
  for (const std::size_t m : scratch.active) {
    const auto [same, opposite] = scratch.meaning[m];
    const Conic& P = scratch.conics[m];
    const double there = (of & bit(m)) != 0 ? 0 : P.at(t, s), near = 1e-7 * P.scale;
    const Signs no = (there < -near ? same : 0) | (there > near ? opposite : 0);
    if ((plan_.formula.all & no) != 0) return;
    maybe |= (same | opposite) & ~no;
  }
  for (const Signs one_of : plan_.formula.any)
    if ((maybe & one_of) == 0) return;
  const bool crosses = (label & kKind) == kCrossing;
  scratch.vertices.push_back(
      {t, label, crosses && touch(scratch.conics[label & 255U], scratch.conics[(label & ~kKind) >> 8U], t, s), s});
}

void PlanarSlice::find_vertices(PlanarSliceScratch& scratch) const {
  scratch.vertices.clear();
  std::array<double, 8> at{};
  std::array<Point, 16> points{};
  for (std::size_t i = 0; i < scratch.active.size(); ++i) {
    const std::size_t k = scratch.active[i];
    const Conic& P = scratch.conics[k];
    const auto number = static_cast<std::uint32_t>(k);
    if (!plan_.surfaces[k].has_z || (P.c[2] == 0 && P.c[4] == 0 && P.c[5] == 0)) {
      const std::size_t found = roots_between(std::array{P.c[0], P.c[1], P.c[3]}, at);
      for (std::size_t n = 0; n < found; ++n) scratch.vertices.push_back({at[n], kVertical | number});
      continue;
    }
    if (P.is_straight()) {
      if (P.c[4] != 0) scratch.vertices.push_back({-P.c[2] / P.c[4], kTurningPoint | number});
    } else {
      const std::size_t found = roots_between(P.discriminant(), at);
      for (std::size_t n = 0; n < found; ++n)
        add_vertex(at[n], -0.5 * (P.c[2] + at[n] * P.c[4]) / P.c[5], bit(k), kTurningPoint | number, scratch);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t l = scratch.active[j];
      if (!plan_.surfaces[l].has_z) continue;
      const std::size_t found = crossings(P, scratch.conics[l], points);
      for (std::size_t n = 0; n < found; ++n)
        add_vertex(points[n].t, points[n].s, bit(k) | bit(l), crossing(l, k), scratch);
    }
  }
  drop_touching(scratch.vertices);
}

/// Adds a vertex wherever a constraint that is independent of z changes its sign in the pieces that have been found so
/// far.
void PlanarSlice::find_independent_vertices(std::span<double> registers, PlanarSliceScratch& scratch) const {
  constexpr int kSteps = 24;
  const double low = scratch.pieces.front().from, high = scratch.pieces.back().to;
  const double inset = 1e-9 * (high - low);
  double t = low + inset;
  evaluate_independent(t, registers, scratch, scratch.before);
  for (int step = 1; step <= kSteps; ++step) {
    const double next = step == kSteps ? high - inset : low + (high - low) * step / kSteps;
    evaluate_independent(next, registers, scratch, scratch.now);
    for (std::size_t i = 0; i < scratch.now.size(); ++i) {
      if (is_satisfied(scratch.before[i]) == is_satisfied(scratch.now[i])) continue;
      // refine_root() counts NaN as negative; an infinite value violates the constraint, too.
      const auto finite = [](double f) { return std::isfinite(f) ? f : std::numeric_limits<double>::quiet_NaN(); };
      const auto constraint = [&](double x) {
        evaluate_independent(x, registers, scratch, scratch.other_adjoints);
        return finite(scratch.other_adjoints[i]);
      };
      const double at = refine_root(constraint, t, finite(scratch.before[i]), next, finite(scratch.now[i]), 4e-16);
      scratch.vertices.push_back({at, kIndependent | static_cast<std::uint32_t>(i)});
    }
    t = next;
    std::swap(scratch.before, scratch.now);
  }
}

std::uint32_t vertex_of(std::size_t surface, std::size_t first, double t, const PlanarSliceScratch& scratch) {
  if (first == scratch.vertices.size()) return kSide | (t > 0 ? 1U : 0U);
  std::uint32_t found = 0;
  for (std::size_t i = first;
       i < scratch.vertices.size() && scratch.vertices[i].t <= scratch.vertices[first].t + kMergeDistance; ++i) {
    const std::uint32_t label = scratch.vertices[i].label, kind = label & kKind, place = label & ~kKind;
    const bool its_own = kind == kCrossing ? (place & 255U) == surface || place >> 8U == surface
                                           : kind != kTurningPoint || place == surface;
    if (its_own && (found == 0 || label < found)) found = label;
  }
  return found;
}

}  // namespace pkm::generic
