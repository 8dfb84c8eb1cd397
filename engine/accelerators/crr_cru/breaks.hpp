// (3CRR/R)&CRU and Quadrupteron: sections by the outer coordinate of a survey, and the breaks of their areas that have
// a closed form.
#pragma once

#include <span>

#include "engine/accelerators/crr_cru/section.hpp"
#include "engine/math/critical_values.hpp"

namespace pkm::crr_cru {

/// A design and what its survey holds.
template <class S>
struct Sweeping {
  Design<S> design;
  Cuts cuts;
  S held;          ///< value of the held coordinate
  Frame<S> frame;  ///< where phi is held
};

template <class S>
Sweeping<S> sweeping(const Design<S>& d, const Held& held) {
  Sweeping<S> s{.design = d, .cuts = cuts(held), .held = fixed_value(d.g, held), .frame = {}};
  if (!s.cuts.outer_is_phi) s.frame = frame(d, s.held);
  return s;
}

/// The section at a value of the outer coordinate.
template <class S>
Section<S> section_at(const Sweeping<S>& s, const S& outer) {
  return s.cuts.outer_is_phi ? section(s.design, frame(s.design, outer), s.cuts, s.held)
                             : section(s.design, s.frame, s.cuts, outer);
}

/// Breaks where phi is the outer coordinate: kappa_p = c_min, and where the held position meets the end of a slide.
template <class S>
void breaks_in_phi(const Sweeping<S>& s, std::vector<Break<S>>& breaks) {
  const Geometry<S>& g = s.design.g;
  const S delta = offset(s.design.yaw), half(acos(s.design.c_min));
  const S first = max(S(-delta - half), S(s.design.box[3][0])), last = min(S(half - delta), S(s.design.box[3][1]));
  if (!(value_of(first) < value_of(last))) return;
  breaks.push_back({first});
  breaks.push_back({last});
  // held + radius cos(phi + angle) = bound, for the slides along the held coordinate
  const auto add = [&](const S& radius, const S& angle) {
    for (const S& bound : {g.rho_min, g.rho_max}) {
      const S cosine = (bound - s.held) / radius;
      if (!(value_of(cosine) > -1 && value_of(cosine) < 1)) continue;
      for (const double sign : {-1.0, 1.0})
        for (const double turn : {-2 * kPi, 0.0, 2 * kPi}) {
          const S at = acos(cosine) * sign - angle + turn;
          if (value_of(at) > value_of(first) && value_of(at) < value_of(last)) breaks.push_back({at});
        }
    }
  };
  const bool rigid = g.platform == Platform::rigid;
  const double quarter = kPi / 2;
  if (rigid && s.cuts.normal == 0 && value_of(g.r) > 0) add(g.r, atan2(g.sin_beta[0], g.cos_beta[0]));
  if (rigid && s.cuts.normal == 1 && value_of(g.r) > 0) add(g.r, S(atan2(g.sin_beta[1], g.cos_beta[1]) - quarter));
  if (s.cuts.normal == 1) add(g.l, S(-quarter));
}

/// Breaks where x is the outer coordinate, with phi held. The circles of limbs 3, and 2 and 4, end u = y and v = z at a
/// given x; the area has a break where such a circle begins or ends, and where its end passes the slides' range, the
/// middle or a tangent of limb 1's ring, the ring's crossing with the slides' range, or the other limb's circle.
template <class S>
void breaks_in_x(const Sweeping<S>& s, std::vector<Break<S>>& breaks) {
  const Design<S>& d = s.design;
  const auto& range = s.frame.range;
  const double first = value_of(range[0].lower), last = value_of(range[0].upper);
  breaks.push_back({range[0].lower});
  breaks.push_back({range[0].upper});
  const auto add = [&](const S& at, bool root) {
    if (value_of(at) > first && value_of(at) < last) breaks.push_back({at, root, root});
  };
  struct Line {
    S at;
    bool tangent;
  };
  // where along one axis the circles of a limb's ring begin, end, and cross lines of the other axis
  const auto visit_circles = [&](std::size_t limb, std::size_t along, std::size_t across, std::span<const Line> lines,
                                 const auto& visit) {
    const Vector3<S>& center = s.frame.center[limb];
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
  std::array<Line, 15> room;
  const auto find_levels = [&](std::size_t axis) {
    std::size_t n = 0;
    const auto keep = [&](const S& at, bool tangent) {
      const bool inside = value_of(at) >= value_of(range[axis].lower) && value_of(at) <= value_of(range[axis].upper);
      if (inside) room[n++] = {at, tangent};
    };
    const std::size_t other = 3 - axis;
    keep(range[axis].lower, false);
    keep(range[axis].upper, false);
    keep(s.frame.center[0][axis], false);
    visit_circles(0, axis, other, std::array<Line, 2>{{{range[other].lower, false}, {range[other].upper, false}}},
                  keep);
    return std::span<const Line>(room).first(n);
  };
  visit_circles(2, 0, 1, find_levels(1), add);
  const std::span<const Line> levels = find_levels(2);
  visit_circles(1, 0, 2, levels, add);
  visit_circles(3, 0, 2, levels, add);

  const Vector3<S>&p = s.frame.center[1], &q = s.frame.center[3];
  const S dx = q[0] - p[0], dz = q[2] - p[2], apart2 = dx * dx + dz * dz;
  for (const S& one2 : {d.in2[1], d.out2[1]})
    for (const S& two2 : {d.in2[3], d.out2[3]}) {
      const S share = (one2 - two2 + apart2) / (apart2 * 2.0), under = one2 / apart2 - share * share;
      if (!(value_of(under) > 0)) continue;
      const S middle = p[0] + share * dx, swing = dz * sqrt(under);
      add(middle - swing, false);
      add(middle + swing, false);
    }
}

}  // namespace pkm::crr_cru
