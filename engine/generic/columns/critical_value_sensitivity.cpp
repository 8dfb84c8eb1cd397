#include "engine/generic/columns/critical_value_sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "engine/generic/columns/vertices.hpp"

namespace pkm::generic {
namespace {

// Vertices at a smaller distance, relative to the half widths of the slice, count as the same point.
constexpr double kCoincidence = 1e-3;
constexpr std::size_t kMaxDegenerateCurves = 3;

bool are_near(const ArcEnd& x, const ArcEnd& y, const PlanarSliceScratch& scratch) {
  return std::fabs(x.v - y.v) < kCoincidence * scratch.v[1] && std::fabs(x.z - y.z) < kCoincidence * scratch.z[1];
}

/// Removes from two lists of endpoints of arcs those endpoints that both lists contain.
void remove_common(std::vector<ArcEnd>& x, std::vector<ArcEnd>& y, const PlanarSliceScratch& scratch) {
  std::erase_if(x, [&](const ArcEnd& end) {
    const auto same = std::ranges::find_if(y, [&](const ArcEnd& other) {
      return other.label == end.label && other.surface == end.surface && are_near(other, end, scratch);
    });
    if (same == y.end()) return false;
    y.erase(same);
    return true;
  });
}

/// Returns one factor for each curve. If the gradients of the curves are linearly dependent, the sum of factor times
/// gradient is zero.
std::array<double, kMaxDegenerateCurves> dependency_factors(std::span<const PlanarSliceSensitivity::Boundary> curves) {
  const auto cross = [&](std::size_t i, std::size_t j) {
    return curves[i].t * curves[j].s - curves[i].s * curves[j].t;
  };
  if (curves.size() == 1) return {1, 0, 0};
  if (curves.size() == 3) return {cross(1, 2), cross(2, 0), cross(0, 1)};
  const bool along_t = std::fabs(curves[0].t) > std::fabs(curves[0].s);
  return along_t ? std::array{curves[1].t, -curves[0].t, 0.0} : std::array{curves[1].s, -curves[0].s, 0.0};
}

/// Whether the gradients of the curves are linearly dependent with the given factors: the sum of factor times gradient
/// is zero.
/// @param size  magnitude of a gradient's terms, for comparison, if there is a single curve; otherwise 0
bool are_dependent(std::span<const PlanarSliceSensitivity::Boundary> curves,
                   const std::array<double, kMaxDegenerateCurves>& factors, double size) {
  double t = 0, s = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    t += factors[i] * curves[i].t;
    s += factors[i] * curves[i].s;
    if (curves.size() > 1) size += std::fabs(factors[i]) * std::hypot(curves[i].t, curves[i].s);
  }
  return std::hypot(t, s) <= kCoincidence * size;
}

}  // namespace

std::vector<ArcEnd> arc_ends(const PlanarSlice& planar_slice, const PlanarSliceScratch& scratch) {
  std::vector<ArcEnd> ends;
  planar_slice.for_each_arc_end(scratch, [&](EndLabel end, std::size_t first, double t) {
    const std::uint32_t surface = end >> 1U, label = vertex_of(surface, first, t, scratch);
    const Conic& P = scratch.conics[surface];
    // At a turning point of a conic, both roots s of its equation are equal up to rounding errors.
    const bool turns = (label & kKind) == kTurningPoint && !P.is_straight();
    const double s = turns ? -0.5 * (P.c[2] + t * P.c[4]) / P.c[5] : end_at(end, t, scratch);
    ends.push_back({label, surface, scratch.v[0] + scratch.v[1] * t, scratch.z[0] + scratch.z[1] * s});
  });
  return ends;
}

std::optional<Dual4> differentiable_critical_value(double at, std::vector<ArcEnd> inside, std::vector<ArcEnd> outside,
                                                   const PlanarSliceScratch& scratch,
                                                   const PlanarSliceSensitivity& by_design,
                                                   const PlanarSliceSensitivity& by_x) {
  remove_common(inside, outside, scratch);
  inside.insert(inside.end(), outside.begin(), outside.end());
  // Turning points do not count as vertices, unless nothing else changes: then a complete conic appears or vanishes.
  const auto turns = [](const ArcEnd& end) { return (end.label & kKind) == kTurningPoint; };
  if (!std::ranges::all_of(inside, turns)) std::erase_if(inside, turns);
  if (inside.empty()) return {};
  const ArcEnd first = inside.front();
  std::erase_if(inside, [&](const ArcEnd& end) { return !are_near(end, first, scratch); });

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
      add(kind == kSide || kind == kIndependent ? end.label : number);
    }
  }
  if (bounds.size() > kMaxDegenerateCurves) return {};
  const double t = (v - scratch.v[0]) / scratch.v[1], s = (z - scratch.z[0]) / scratch.z[1];
  std::vector<PlanarSliceSensitivity::Boundary> curves;
  for (const std::uint32_t bound : bounds) curves.push_back(by_design.boundary(bound, t, s));
  const auto factors = dependency_factors(curves);
  if (!are_dependent(curves, factors, curves.size() == 1 ? scratch.conics[bounds[0] & ~kKind].scale : 0)) return {};
  Components<4> change;
  // slope: derivative, with respect to the outer coordinate, of the sum of factor times curve equation; size: sum of
  // the magnitudes of the terms of this sum.
  double slope = 0, size = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double each = factors[i] * by_x.boundary(bounds[i], t, s).change[0];
    change = change + curves[i].change * factors[i];
    slope += each;
    size += std::fabs(each);
  }
  constexpr double kZero = 1e-8;
  if (!(std::fabs(slope) > kZero * size)) return {};
  return differentiable_root(at, change, slope);
}

}  // namespace pkm::generic
