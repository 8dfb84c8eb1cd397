// (3CRR/R)&CRU and Quadrupteron: the feasible positions at given phi, as the ranges of slides and the rings of reaches
// that they are made of, in closed form (README.md). Neither depends on the working mode.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/accelerators/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// Ranges of x, y, z, phi.
using PoseBox = std::array<std::array<double, 2>, 4>;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr PoseBox kEverywhere = {
    {{-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}}};

/// What all phi of one design have in common.
template <class S>
struct Design {
  Geometry<S> g;
  Yaw<S> yaw;
  double c_min;
  std::array<S, 4> in, out;    ///< ends of |C_i - A_i| where |sin theta_i2| >= s_min [m]
  std::array<S, 4> in2, out2;  ///< their squares
  PoseBox box = kEverywhere;   ///< poses outside do not count
};

template <class S>
Design<S> design(const Geometry<S>& g, const Limits& l, const PoseBox& box = kEverywhere) {
  Design<S> d{.g = g, .yaw = yaw(g), .c_min = l.c_min, .in = {}, .out = {}, .in2 = {}, .out2 = {}, .box = box};
  const double lost = l.s_min * l.s_min / (1 + std::sqrt((1 - l.s_min) * (1 + l.s_min)));  // 1 - sqrt(1 - s_min^2)
  for (std::size_t i = 0; i < 4; ++i) {
    const S difference = g.l_1[i] - g.l_2[i], sum = g.l_1[i] + g.l_2[i], cut = g.l_1[i] * g.l_2[i] * (2 * lost);
    d.in2[i] = difference * difference + cut;
    d.out2[i] = sum * sum - cut;
    d.in[i] = sqrt_or_zero(d.in2[i]);
    d.out[i] = sqrt_or_zero(d.out2[i]);
  }
  return d;
}

/// Which formula an end of an interval follows.
class EndCode {
 public:
  constexpr EndCode() = default;
  /// The end of a limb's slide.
  static constexpr EndCode slide(std::size_t limb, bool upper) { return EndCode(4u * upper + limb); }
  /// The end of the box.
  static constexpr EndCode box(bool upper) { return EndCode(8u + upper); }
  /// The end of a section's v: 2 interval + (0 lower, 1 upper).
  static constexpr EndCode of_v(std::size_t end) { return EndCode(end); }
  /// Below or above the centre of a circle of the limb's ring.
  static constexpr EndCode circle(std::size_t limb, bool outer, bool upper) {
    return EndCode(kCircles + 4 * limb + 2u * outer + upper);
  }

  constexpr bool on_circle() const { return number_ >= kCircles; }
  constexpr std::size_t limb() const { return (number_ - kCircles) / 4; }
  constexpr bool outer() const { return number_ & 2; }
  constexpr bool upper() const { return number_ & 1; }  ///< not of slides
  constexpr std::size_t number() const { return number_; }
  friend constexpr bool operator==(EndCode, EndCode) = default;

 private:
  static constexpr std::size_t kCircles = 16;
  explicit constexpr EndCode(std::size_t number) : number_(static_cast<std::uint8_t>(number)) {}
  std::uint8_t number_ = 0;
};

template <class S>
struct Interval {
  S lower, upper;
  EndCode lower_code, upper_code;
};

/// Leaves what is in another range, too.
template <class S>
void narrow(Interval<S>& range, const S& lower, const S& upper, EndCode lower_code, EndCode upper_code) {
  if (value_of(lower) > value_of(range.lower)) {
    range.lower = lower;
    range.lower_code = lower_code;
  }
  if (value_of(upper) < value_of(range.upper)) {
    range.upper = upper;
    range.upper_code = upper_code;
  }
}

template <class S>
struct Frame {
  std::array<Interval<S>, 3> range;  ///< of x, y, z
  std::array<Vector3<S>, 4> center;  ///< of the limbs' rings; the coordinate along e_i has no meaning
  bool singular;                     ///< kappa_p < c_min: no position is feasible
};

template <class S>
Frame<S> frame(const Design<S>& d, const S& phi) {
  const Geometry<S>& g = d.g;
  const auto [s, c] = sincos(phi);
  const auto arm = arms(g, s, c);
  Frame<S> f;
  f.singular = !(value_of(parallel_index(d.yaw, s, c)) >= d.c_min);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) f.center[i][k] = g.L * kLimbs[i].rail[k] - arm[i].to_joint[k];
    const std::size_t e = kLimbs[i].e;
    const S lower = g.rho_min - arm[i].to_joint[e], upper = g.rho_max - arm[i].to_joint[e];
    if (i < 3)  // limbs 1, 2, 3 slide along x, y, z
      f.range[e] = {lower, upper, EndCode::slide(i, false), EndCode::slide(i, true)};
    else
      narrow(f.range[e], lower, upper, EndCode::slide(i, false), EndCode::slide(i, true));
  }
  for (std::size_t k = 0; k < 3; ++k)
    narrow(f.range[k], S(d.box[k][0]), S(d.box[k][1]), EndCode::box(false), EndCode::box(true));
  return f;
}

/// What a survey holds: one coordinate at a value, or at the design's own middle: phi = 0, and the position at which
/// the slides of limbs 1, 2, 3 without the circle's shift are half way.
struct Held {
  std::size_t coordinate = 3;
  bool middle = true;
  double value = 0;
};

template <class S>
S fixed_value(const Geometry<S>& g, const Held& held) {
  if (!held.middle) return S(held.value);
  if (held.coordinate == 3) return S(0.0);
  const S half = (g.rho_min + g.rho_max) * 0.5;
  return held.coordinate == 2 ? S(half + g.h) : half;
}

/// The coordinate along which surveys cut the workspace into plane sections, and the section's axes. Sections are
/// normal to the position that is held, or to x where phi is held; the outer coordinate counts the sections.
struct Cuts {
  std::size_t normal, u, v;
  bool outer_is_phi;
};

inline Cuts cuts(const Held& held) {
  const std::size_t n = held.coordinate == 3 ? 0 : held.coordinate;
  return {.normal = n, .u = n == 0 ? 1u : 0u, .v = n == 2 ? 1u : 2u, .outer_is_phi = held.coordinate != 3};
}

}  // namespace pkm::crr_cru
