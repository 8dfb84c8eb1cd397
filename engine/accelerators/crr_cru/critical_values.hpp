// (3CRR/R)&CRU and Quadrupteron: slices as a function of the outer coordinate, and the critical values of that
// coordinate that have a closed form.
#pragma once

#include <span>

#include "engine/accelerators/crr_cru/slice.hpp"
#include "engine/math/critical_values.hpp"

namespace pkm::crr_cru {

/// A design with one fixed coordinate, for an analysis by slices at values of the outer coordinate.
template <class S>
struct SlicedDesign {
  Design<S> design;
  SliceAxes axes;
  S fixed;                   ///< value of the fixed coordinate
  PositionSet<S> positions;  ///< feasible positions at the fixed phi; not set if a position is fixed
};

template <class S>
SlicedDesign<S> sliced_design(const Design<S>& d, const FixedCoordinate& fixed) {
  SlicedDesign<S> s{.design = d, .axes = slice_axes(fixed), .fixed = fixed_value(d.g, fixed), .positions = {}};
  if (!s.axes.outer_is_phi) s.positions = position_set(d, s.fixed);
  return s;
}

/// The slice at a given value of the outer coordinate.
template <class S>
Slice<S> slice_at(const SlicedDesign<S>& s, const S& outer) {
  return s.axes.outer_is_phi ? slice(s.design, position_set(s.design, outer), s.axes, s.fixed)
                             : slice(s.design, s.positions, s.axes, outer);
}

/// Adds the critical values of phi: its bounds, given by the box and by the limit kappa_p >= c_min, which excludes
/// parallel singularities, and the values at which the fixed position is at an end of a slide's stroke.
template <class S>
void add_critical_values_of_phi(const SlicedDesign<S>& s, std::vector<CriticalValue<S>>& values) {
  const Geometry<S>& g = s.design.g;
  const S delta = offset(s.design.yaw), half(acos(s.design.c_min));
  const S first = max(S(-delta - half), S(s.design.box[3][0])), last = min(S(half - delta), S(s.design.box[3][1]));
  if (!(value_of(first) < value_of(last))) return;
  values.push_back({first});
  values.push_back({last});
  // adds the solutions phi of fixed + radius cos(phi + angle) = rho_min or rho_max, for a slide along the fixed
  // coordinate
  const auto add = [&](const S& radius, const S& angle) {
    for (const S& bound : {g.rho_min, g.rho_max}) {
      const S cosine = (bound - s.fixed) / radius;
      if (!(value_of(cosine) > -1 && value_of(cosine) < 1)) continue;
      for (const double sign : {-1.0, 1.0})
        for (const double revolution : {-2 * kPi, 0.0, 2 * kPi}) {
          const S at = acos(cosine) * sign - angle + revolution;
          if (value_of(at) > value_of(first) && value_of(at) < value_of(last)) values.push_back({at});
        }
    }
  };
  const bool rigid = g.platform == Platform::rigid;
  const double quarter = kPi / 2;
  if (rigid && s.axes.normal == 0 && value_of(g.r) > 0) add(g.r, atan2(g.sin_beta[0], g.cos_beta[0]));
  if (rigid && s.axes.normal == 1 && value_of(g.r) > 0) add(g.r, S(atan2(g.sin_beta[1], g.cos_beta[1]) - quarter));
  if (s.axes.normal == 1) add(g.l, S(-quarter));
}

/// Adds the bounds of x and its critical values at given phi. In the slice at x, endpoints of u = y are on circles of
/// limb 3, and endpoints of v = z are on circles of limbs 2 and 4. The critical values of x are the turning points of
/// these circles, their intersections with each other, and their intersections with certain lines y or z = constant:
/// the bounds of y and z, and the lines through the centre of limb 1's annulus, through the turning points of its
/// circles, and through the intersections of its circles with the bounds.
template <class S>
void add_critical_values_of_x(const SlicedDesign<S>& s, std::vector<CriticalValue<S>>& values) {
  const Design<S>& d = s.design;
  const auto& range = s.positions.range;
  const double first = value_of(range[0].lower), last = value_of(range[0].upper);
  values.push_back({range[0].lower});
  values.push_back({range[0].upper});
  const auto add = [&](const S& at, bool is_sqrt) {
    if (value_of(at) > first && value_of(at) < last) values.push_back({at, is_sqrt, is_sqrt});
  };
  struct Line {
    S at;
    bool tangent;  ///< true: the line is tangent to a circle of limb 1
  };
  // For the turning points of the circles of a limb, and for their intersections with lines across the other axis,
  // calls visit(value along the first axis, whether the area has a square-root singularity there).
  const auto visit_circles = [&](std::size_t limb, std::size_t along, std::size_t across, std::span<const Line> lines,
                                 const auto& visit) {
    const Vector3<S>& center = s.positions.center[limb];
    for (const S& radius2 : {d.in2[limb], d.out2[limb]}) {
      const S radius = sqrt_or_zero(radius2);
      visit(center[along] - radius, true);
      visit(center[along] + radius, true);
      for (const Line& line : lines) {
        const S away = line.at - center[across], half2 = radius2 - away * away;
        if (!(value_of(half2) > 0)) continue;
        const S half = sqrt(half2);
        visit(center[along] - half, line.tangent);
        visit(center[along] + half, line.tangent);
      }
    }
  };
  std::array<Line, 15> buffer;
  const auto find_lines = [&](std::size_t axis) {  // finds the lines y = constant or z = constant
    std::size_t n = 0;
    const auto keep = [&](const S& at, bool tangent) {
      const bool inside = value_of(at) >= value_of(range[axis].lower) && value_of(at) <= value_of(range[axis].upper);
      if (inside) buffer[n++] = {at, tangent};
    };
    const std::size_t other = 3 - axis;
    keep(range[axis].lower, false);
    keep(range[axis].upper, false);
    keep(s.positions.center[0][axis], false);
    visit_circles(0, axis, other, std::array<Line, 2>{{{range[other].lower, false}, {range[other].upper, false}}},
                  keep);
    return std::span<const Line>(buffer).first(n);
  };
  visit_circles(2, 0, 1, find_lines(1), add);
  const std::span<const Line> lines = find_lines(2);
  visit_circles(1, 0, 2, lines, add);
  visit_circles(3, 0, 2, lines, add);

  const Vector3<S>&p = s.positions.center[1], &q = s.positions.center[3];
  const S dx = q[0] - p[0], dz = q[2] - p[2], distance2 = dx * dx + dz * dz;
  for (const S& p_radius2 : {d.in2[1], d.out2[1]})
    for (const S& q_radius2 : {d.in2[3], d.out2[3]}) {
      const S share = (p_radius2 - q_radius2 + distance2) / (distance2 * 2.0);
      const S radicand = p_radius2 / distance2 - share * share;
      if (!(value_of(radicand) > 0)) continue;
      const S foot = p[0] + share * dx, half_chord = dz * sqrt(radicand);
      add(foot - half_chord, false);
      add(foot + half_chord, false);
    }
}

}  // namespace pkm::crr_cru
