// (3CRR/R)&CRU and Quadrupteron: plane sections of the feasible positions at given phi, in closed form (README.md).
//
// What the section is made of (`Structure`) is found with doubles; values and derivatives follow from its formulas.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accelerators/crr_cru/frame.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::crr_cru {

/// Intervals in ascending order. Two rings leave three of one interval, and five of three.
template <class S>
struct IntervalSet {
  static constexpr std::size_t kMost = 5;
  std::array<Interval<S>, kMost> interval;
  std::size_t size = 0;

  void add(const Interval<S>& i) {
    if (value_of(i.lower) < value_of(i.upper)) interval[size++] = i;
  }
};

/// Leaves what lies in the ring of a limb around `center`.
/// @param outer2, inner2  squared half lengths of the ring's chords, R^2 - (distance of the line)^2
template <class S>
void cut(IntervalSet<S>& set, const S& center, const S& outer2, const S& inner2, std::size_t limb) {
  const IntervalSet<S> before = set;
  set.size = 0;
  if (!(value_of(outer2) > 0)) return;
  const S outer = sqrt(outer2), from = center - outer, to = center + outer;
  const bool hollow = value_of(inner2) > 0;
  const S inner = sqrt_or_zero(inner2), hole_from = center - inner, hole_to = center + inner;
  for (std::size_t i = 0; i < before.size; ++i) {
    Interval<S> part = before.interval[i];
    narrow(part, from, to, EndCode::circle(limb, true, false), EndCode::circle(limb, true, true));
    if (!hollow || value_of(hole_from) >= value_of(part.upper) || value_of(hole_to) <= value_of(part.lower)) {
      set.add(part);
      continue;
    }
    set.add({part.lower, hole_from, part.lower_code, EndCode::circle(limb, false, false)});
    set.add({hole_to, part.upper, EndCode::circle(limb, false, true), part.upper_code});
  }
}

/// A ring in the section's plane.
template <class S>
struct Ring {
  S u, v;       ///< centre [m]
  S in2, out2;  ///< squared radii [m^2]
  std::size_t limb;
};

template <class S>
struct Section {
  IntervalSet<S> u, v;
  std::array<Ring<S>, 2> ring;
  std::size_t rings = 0;
};

/// The section of a frame on the plane where coordinate `c.normal` is `at`. Empty u or v: no position is feasible.
template <class S>
Section<S> section(const Design<S>& d, const Frame<S>& f, const Cuts& c, const S& at) {
  Section<S> s;
  const auto& across = f.range[c.normal];
  if (f.singular || value_of(at) < value_of(across.lower) || value_of(at) > value_of(across.upper)) return s;
  s.u.add(f.range[c.u]);
  s.v.add(f.range[c.v]);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool has_u = kLimbs[i].e != c.u, has_v = kLimbs[i].e != c.v;  // the rods' plane
    if (has_u && has_v) {
      s.ring[s.rings++] = {.u = f.center[i][c.u], .v = f.center[i][c.v], .in2 = d.in2[i], .out2 = d.out2[i], .limb = i};
      continue;
    }
    const S away = at - f.center[i][c.normal], away2 = away * away;
    cut(has_u ? s.u : s.v, f.center[i][has_u ? c.u : c.v], S(d.out2[i] - away2), S(d.in2[i] - away2), i);
  }
  return s;
}

/// Where the column over u changes its formulas.
struct BreakCode {
  enum class Kind : std::uint8_t { end_of_u, extreme, crossing_v, crossing_ring };
  Kind kind = Kind::end_of_u;
  std::uint8_t first = 0;   ///< end of u, or circle: 2 ring + (0 inner, 1 outer)
  std::uint8_t second = 0;  ///< end of v, or the other ring's circle
  std::int8_t sign = 1;     ///< side

  static BreakCode end_of_u(std::size_t end) { return {.first = static_cast<std::uint8_t>(end)}; }
};

struct Column {
  BreakCode lower, upper;                                   ///< in u
  std::array<EndCode, 2 * IntervalSet<double>::kMost> end;  ///< of the column's intervals: of v or on circles
  std::size_t ends = 0;
};

/// What a section is made of: columns in ascending u, neighbours with different formulas.
struct Structure {
  std::vector<Column> columns;
  std::uint64_t signature = 0;  ///< of all formulas; 0: empty

  struct Candidate {
    double u;
    BreakCode code;
  };
  std::vector<Candidate> candidates;  ///< working storage
};

void find_structure(const Section<double>& s, Structure& structure);

/// The values of a section with derivatives.
template <class S>
Section<double> values(const Section<S>& s) {
  Section<double> v;
  const auto copy = [](const IntervalSet<S>& from, IntervalSet<double>& to) {
    to.size = from.size;
    for (std::size_t i = 0; i < from.size; ++i) {
      const auto& part = from.interval[i];
      to.interval[i] = {value_of(part.lower), value_of(part.upper), part.lower_code, part.upper_code};
    }
  };
  copy(s.u, v.u);
  copy(s.v, v.v);
  v.rings = s.rings;
  for (std::size_t i = 0; i < s.rings; ++i)
    v.ring[i] = {value_of(s.ring[i].u), value_of(s.ring[i].v), value_of(s.ring[i].in2), value_of(s.ring[i].out2),
                 s.ring[i].limb};
  return v;
}

template <class S>
const S& end_of(const IntervalSet<S>& set, std::size_t end) {
  return end % 2 == 0 ? set.interval[end / 2].lower : set.interval[end / 2].upper;
}

/// Squared radius of a circle: 2 ring + (0 inner, 1 outer).
template <class S>
const S& circle2(const Section<S>& s, std::size_t circle) {
  return circle % 2 == 0 ? s.ring[circle / 2].in2 : s.ring[circle / 2].out2;
}

/// Where a break lies. NaN or a complex pair's real part where it does not exist: `exists` tells.
template <class S>
S break_at(const Section<S>& s, const BreakCode& code, bool* exists = nullptr) {
  using Kind = BreakCode::Kind;
  if (exists) *exists = true;
  if (code.kind == Kind::end_of_u) return end_of(s.u, code.first);
  const Ring<S>& ring = s.ring[code.first / 2u];
  const double sign = code.sign;
  S under = circle2(s, code.first);
  S from = ring.u;
  S across(1.0);
  if (code.kind == Kind::crossing_v) {
    const S rise = end_of(s.v, code.second) - ring.v;
    under = under - rise * rise;
  } else if (code.kind == Kind::crossing_ring) {
    const Ring<S>& other = s.ring[code.second / 2u];
    const S du = other.u - ring.u, dv = other.v - ring.v, apart = du * du + dv * dv;
    const S share = (under - circle2(s, code.second) + apart) / (apart * 2.0);
    from = ring.u + share * du;
    across = -dv;
    under = under / apart - share * share;
  }
  if (exists) *exists = value_of(under) > 0;
  return from + across * sqrt_or_zero(under) * sign;
}

/// The circle of an end code: its ring in the section and squared radius.
template <class S>
struct Arc {
  const Ring<S>* ring;
  const S* radius2;
  double side;  ///< -1 below the centre, +1 above
};

template <class S>
Arc<S> arc_of(const Section<S>& s, EndCode code) {
  const Ring<S>& ring = s.rings > 1 && s.ring[1].limb == code.limb() ? s.ring[1] : s.ring[0];
  return {&ring, code.outer() ? &ring.out2 : &ring.in2, code.upper() ? 1.0 : -1.0};
}

/// v of an end of the column over u.
template <class S>
S end_at(const Section<S>& s, EndCode code, const S& u) {
  if (!code.on_circle()) return end_of(s.v, code.number());
  const Arc<S> arc = arc_of(s, code);
  const S w = u - arc.ring->u;
  return arc.ring->v + sqrt_or_zero(S(*arc.radius2 - w * w)) * arc.side;
}

/// Primitive of sqrt(radius2 - w^2). Its derivatives are put together by hand, since those of its terms grow without
/// bound towards the circle's extremes and cancel.
template <class S>
S arc_primitive(const S& w, const S& radius2) {
  const double at = value_of(w), square = value_of(radius2);
  const double root = sqrt_or_zero(square - at * at), angle = atan2(at, root);
  return S(0.5 * (at * root + square * angle)) + (w - at) * root + (radius2 - square) * (0.5 * angle);
}

/// Area [m^2].
template <class S>
S area(const Section<S>& s, const Structure& structure) {
  S sum(0.0);
  for (const Column& column : structure.columns) {
    const S lower = break_at(s, column.lower), upper = break_at(s, column.upper), length = upper - lower;
    for (std::size_t k = 0; k < column.ends; ++k) {
      const EndCode code = column.end[k];
      S under = S(0.0);
      if (!code.on_circle()) {
        under = end_of(s.v, code.number()) * length;
      } else {
        const Arc<S> arc = arc_of(s, code);
        under = arc.ring->v * length + (arc_primitive(S(upper - arc.ring->u), *arc.radius2) -
                                        arc_primitive(S(lower - arc.ring->u), *arc.radius2)) *
                                           arc.side;
      }
      sum = k % 2 == 0 ? S(sum - under) : S(sum + under);
    }
  }
  return sum;
}

}  // namespace pkm::crr_cru
