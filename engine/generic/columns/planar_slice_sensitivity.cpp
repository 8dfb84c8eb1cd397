#include "engine/generic/columns/planar_slice_sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "engine/generic/columns/vertices.hpp"

namespace pkm::generic {

Dual4 differentiable_root(double at, const Components<4>& sum, double by) {
  const Components<4> motion = sum * (-1 / by);
  return std::ranges::all_of(motion.d, [](double x) { return std::isfinite(x); }) ? Dual4(at, motion) : Dual4(at);
}

Components<4> tangent(std::span<const double> by, std::span<const Dual4> registers) {
  Components<4> sum;
  for (std::size_t i = 0; i < by.size(); ++i)
    if (by[i] != 0) sum = sum + registers[i].v * by[i];
  return sum;
}

PlanarSliceSensitivity::Boundary PlanarSliceSensitivity::boundary(std::uint32_t of, double t, double s) const {
  const SlicePlan& plan = slice_.plan();
  const std::uint32_t number = of & ~kKind;
  if ((of & kKind) == kSide)
    return {1, 0, dual_registers_[plan.range[plan.range.size() - 2][number]].v * (-1 / scratch_.v[1])};
  if ((of & kKind) == kIndependent) {
    std::vector<double> by;
    const double slope = slice_.slope_of_independent(number, t, registers_, scratch_, by);
    return {slope * scratch_.v[1], 0, tangent(by, dual_registers_)};
  }
  const auto [along_t, along_s] = gradient(scratch_.conics[number], t, s);
  const double v = scratch_.v[0] + scratch_.v[1] * t, z = scratch_.z[0] + scratch_.z[1] * s;
  const double powers[6] = {1, v, z, v * v, v * z, z * z};
  Components<4> change;
  for (std::size_t i = 0; i < 6; ++i)
    change = change + dual_registers_[plan.surfaces[number].coefficients[i]].v * powers[i];
  return {along_t, along_s, change};
}

Dual4 PlanarSliceSensitivity::vertex(std::size_t first, double t) const {
  if (const std::uint32_t label = vertex_of(kMaxSurfaces, first, t, scratch_)) {
    const bool is_surface = (label & kKind) == kVertical;
    const Boundary side = boundary(is_surface ? label & ~kKind : label, t, -scratch_.z[0] / scratch_.z[1]);
    return differentiable_root(t, side.change, side.t);
  }
  const PlanarSliceScratch::Vertex& at = scratch_.vertices[first];
  return {t, ((at.label & kKind) == kCrossing ? crossing(at) : turning_point(at.label & ~kKind, at)).v};
}

Dual4 PlanarSliceSensitivity::crossing(const PlanarSliceScratch::Vertex& at) const {
  if (at.touches) return at.t;  // both arcs coincide to first order, so that the motion of the vertex does not matter
  const Boundary p = boundary(at.label & 255U, at.t, at.s), q = boundary((at.label & ~kKind) >> 8U, at.t, at.s);
  return differentiable_root(at.t, p.change * q.s - q.change * p.s, p.t * q.s - p.s * q.t);
}

Dual4 PlanarSliceSensitivity::turning_point(std::uint32_t surface, const PlanarSliceScratch::Vertex& at) const {
  const Conic& P = scratch_.conics[surface];
  const auto change = [&](double s) { return boundary(surface, at.t, s).change; };
  if (!P.is_straight()) return differentiable_root(at.t, change(at.s), gradient(P, at.t, at.s)[0]);
  // The root s is infinite at this vertex, so that the derivative of P with respect to s is 0 for every s.
  return differentiable_root(at.t, (change(1) - change(-1)) * 0.5, P.c[4]);
}

Dual4 PlanarSliceSensitivity::end(EndLabel end, const Dual4& t) const {
  const double s = end_at(end, t.a, scratch_);
  const Boundary at = boundary(end >> 1U, t.a, s);
  return differentiable_root(s, at.change + t.v * at.t, at.s);
}

}  // namespace pkm::generic
