// (3CRR/R)&CRU and Quadrupteron: the feasible positions at given yaw phi in closed form: the intersection of the ranges
// of the slides and the annuli of the reaches (README.md). Neither depends on the working mode.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/accelerators/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// Range of each coordinate, in the order x, y, z, phi.
using PoseBox = std::array<std::array<double, 2>, 4>;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr PoseBox kEverywhere = {
    {{-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}}};

/// A design and its limits, as quantities that do not depend on the yaw angle phi.
template <class S>
struct Design {
  Geometry<S> g;
  Yaw<S> yaw;
  double c_min;
  /// Squared radii, for each limb, of the annulus in which |C_i - A_i| satisfies |sin theta_i2| >= s_min [m^2].
  std::array<S, 4> in2, out2;
  PoseBox box = kEverywhere;  ///< box outside of which poses are infeasible
};

template <class S>
Design<S> design(const Geometry<S>& g, const Limits& l, const PoseBox& box = kEverywhere) {
  Design<S> d{.g = g, .yaw = yaw(g), .c_min = l.c_min, .in2 = {}, .out2 = {}, .box = box};
  // Equal to 1 - sqrt(1 - s_min^2), without cancellation.
  const double lost = l.s_min * l.s_min / (1 + std::sqrt((1 - l.s_min) * (1 + l.s_min)));
  for (std::size_t i = 0; i < 4; ++i) {
    const S difference = g.l_1[i] - g.l_2[i], sum = g.l_1[i] + g.l_2[i], cut = g.l_1[i] * g.l_2[i] * (2 * lost);
    d.in2[i] = difference * difference + cut;
    d.out2[i] = sum * sum - cut;
  }
  return d;
}

/// Identifies the formula by which an endpoint of an interval is computed.
struct EndpointLabel {
  enum Kind : std::uint8_t {
    slide,     ///< end of the stroke of the slide of limb number `index`
    box,       ///< face of the box that restricts the workspace
    v_bound,   ///< endpoint of interval number `index` of the set v of a slice
    on_circle  ///< point of a circle of the annulus of limb number `index`, below or above the centre
  } kind;
  std::uint8_t index;
  /// Upper: true for an upper endpoint, false for a lower one; outer: true if the circle is the outer one of the
  /// annulus.
  bool upper, outer;

  constexpr EndpointLabel(Kind k = slide, std::size_t i = 0, bool is_upper = false, bool is_outer = false)
      : kind(k), index(static_cast<std::uint8_t>(i)), upper(is_upper), outer(is_outer) {}
  constexpr std::uint64_t hash() const { return ((kind * 16u + index) * 2u + upper) * 2u + outer; }
  friend constexpr bool operator==(EndpointLabel, EndpointLabel) = default;
};

template <class S>
struct Interval {
  S lower, upper;
  EndpointLabel lower_label, upper_label;
};

/// Intersects an interval with [lower, upper]. An endpoint that changes gets the label of the new bound.
template <class S>
void intersect(Interval<S>& interval, const S& lower, const S& upper, EndpointLabel lower_label,
               EndpointLabel upper_label) {
  if (value_of(lower) > value_of(interval.lower)) {
    interval.lower = lower;
    interval.lower_label = lower_label;
  }
  if (value_of(upper) < value_of(interval.upper)) {
    interval.upper = upper;
    interval.upper_label = upper_label;
  }
}

/// The positions that are feasible at one phi: the positions in the ranges of all slides and in the annuli of all
/// limbs.
template <class S>
struct PositionSet {
  std::array<Interval<S>, 3> range;  ///< ranges of x, y, z
  std::array<Vector3<S>, 4> center;  ///< centre of each limb's annulus; the coordinate along e_i has no meaning
  bool singular;                     ///< true if kappa_p < c_min, so that no position is feasible
};

template <class S>
PositionSet<S> position_set(const Design<S>& d, const S& phi) {
  const Geometry<S>& g = d.g;
  const auto [s, c] = sincos(phi);
  const auto arm = arms(g, s, c);
  PositionSet<S> set;
  set.singular = !(value_of(parallel_index(d.yaw, s, c)) >= d.c_min);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) set.center[i][k] = g.L * kLimbs[i].rail[k] - arm[i].to_joint[k];
    const std::size_t e = kLimbs[i].e;
    const Interval<S> stroke = {g.rho_min - arm[i].to_joint[e],
                                g.rho_max - arm[i].to_joint[e],
                                {EndpointLabel::slide, i, false},
                                {EndpointLabel::slide, i, true}};
    if (i < 3)  // limbs 1, 2, 3 slide along x, y, z
      set.range[e] = stroke;
    else
      intersect(set.range[e], stroke.lower, stroke.upper, stroke.lower_label, stroke.upper_label);
  }
  for (std::size_t k = 0; k < 3; ++k)
    intersect(set.range[k], S(d.box[k][0]), S(d.box[k][1]), {EndpointLabel::box, 0, false},
              {EndpointLabel::box, 0, true});
  return set;
}

/// Value of the fixed coordinate. The default of phi is 0. The default of a position is the one at which the slide
/// along its axis is at half stroke, apart from the offset due to the circle of C_1..C_3.
template <class S>
S fixed_value(const Geometry<S>& g, const FixedCoordinate& fixed) {
  if (fixed.kind != FixedCoordinate::Kind::default_value) return S(fixed.value);
  if (fixed.coordinate == 3) return S(0.0);
  const S half = (g.rho_min + g.rho_max) * 0.5;
  return fixed.coordinate == 2 ? S(half + g.h) : half;
}

/// Indices of the axes of planar slices. Slices are normal to the fixed position, and phi is the outer coordinate; if
/// phi is fixed, they are normal to x, which is then the outer coordinate.
struct SliceAxes {
  std::size_t normal, u, v;
  bool outer_is_phi;
};

inline SliceAxes slice_axes(const FixedCoordinate& fixed) {
  const std::size_t n = fixed.coordinate == 3 ? 0 : static_cast<std::size_t>(fixed.coordinate);
  return {.normal = n, .u = n == 0 ? 1u : 0u, .v = n == 2 ? 1u : 2u, .outer_is_phi = fixed.coordinate != 3};
}

}  // namespace pkm::crr_cru
