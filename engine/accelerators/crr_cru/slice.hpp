// (3CRR/R)&CRU and Quadrupteron: planar slices of the feasible positions at given phi, in closed form (README.md).
//
// A slice is U x V, two unions of intervals, intersected with one or two annuli. Its cell decomposition
// (`Decomposition`) is determined in double precision; values and derivatives follow from its formulas.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accelerators/crr_cru/position_set.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::crr_cru {

/// Disjoint intervals in ascending order. The hole of an annulus divides at most one of them in two, so with four limbs
/// there are at most five.
template <class S>
struct IntervalSet {
  static constexpr std::size_t kMaxSize = 5;
  std::array<Interval<S>, kMaxSize> interval;
  std::size_t size = 0;

  void add(const Interval<S>& i) {
    if (value_of(i.lower) < value_of(i.upper)) interval[size++] = i;
  }
};

/// Intersects a set of intervals on a line with the annulus of a limb.
/// @param center          coordinate of the annulus' centre along the line
/// @param outer2, inner2  squared half chords of its circles: R^2 minus the squared distance of the line from the
/// centre
template <class S>
void intersect_annulus(IntervalSet<S>& set, const S& center, const S& outer2, const S& inner2, std::size_t limb) {
  using Label = EndpointLabel;
  const IntervalSet<S> before = set;
  set.size = 0;
  if (!(value_of(outer2) > 0)) return;
  const S outer = sqrt(outer2), from = center - outer, to = center + outer;
  const bool hollow = value_of(inner2) > 0;
  const S inner = sqrt_or_zero(inner2), hole_from = center - inner, hole_to = center + inner;
  for (std::size_t i = 0; i < before.size; ++i) {
    Interval<S> part = before.interval[i];
    intersect(part, from, to, {Label::on_circle, limb, false, true}, {Label::on_circle, limb, true, true});
    if (!hollow || value_of(hole_from) >= value_of(part.upper) || value_of(hole_to) <= value_of(part.lower)) {
      set.add(part);
      continue;
    }
    set.add({part.lower, hole_from, part.lower_label, {Label::on_circle, limb, false}});
    set.add({hole_to, part.upper, {Label::on_circle, limb, true}, part.upper_label});
  }
}

/// An annulus, in the plane of a slice, to which a limb restricts the position.
template <class S>
struct Annulus {
  S u, v;       ///< coordinates of the centre [m]
  S in2, out2;  ///< squared inner and squared outer radius [m^2]
  std::size_t limb;
};

template <class S>
struct Slice {
  IntervalSet<S> u, v;
  std::array<Annulus<S>, 2> annulus;
  std::size_t annuli = 0;
};

/// The slice of a position set on the plane in which coordinate number `axes.normal` has the value `at`. If the slice
/// is empty, u or v is empty.
template <class S>
Slice<S> slice(const Design<S>& d, const PositionSet<S>& set, const SliceAxes& axes, const S& at) {
  Slice<S> s;
  const auto& across = set.range[axes.normal];
  if (set.singular || value_of(at) < value_of(across.lower) || value_of(at) > value_of(across.upper)) return s;
  s.u.add(set.range[axes.u]);
  s.v.add(set.range[axes.v]);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& center = set.center[i];
    // True if the plane of the limb's rods contains the axis u, or the axis v.
    const bool has_u = kLimbs[i].e != axes.u, has_v = kLimbs[i].e != axes.v;
    if (has_u && has_v) {
      s.annulus[s.annuli++] = {.u = center[axes.u], .v = center[axes.v], .in2 = d.in2[i], .out2 = d.out2[i], .limb = i};
      continue;
    }
    const S away = at - center[axes.normal], away2 = away * away;
    intersect_annulus(has_u ? s.u : s.v, center[has_u ? axes.u : axes.v], S(d.out2[i] - away2), S(d.in2[i] - away2), i);
  }
  return s;
}

/// A critical value of u: at it, the formula of an endpoint in v of the column changes.
struct CriticalPoint {
  enum class Kind : std::uint8_t { end_of_u, turning_point, intersection_with_v, intersection_of_circles };
  Kind kind = Kind::end_of_u;
  std::uint8_t first = 0;   ///< index of an endpoint of the set u, or of a circle: 2 * annulus + (0: inner, 1: outer)
  std::uint8_t second = 0;  ///< index of an endpoint of the set v, or of a circle of the other annulus
  std::int8_t sign = 1;     ///< +1 or -1: which of two intersections it is; unused if there is only one

  static CriticalPoint end_of_u(std::size_t end) { return {.first = static_cast<std::uint8_t>(end)}; }
};

/// A cell of the decomposition of a slice: an interval of u over which each endpoint of the feasible v has one formula.
struct Column {
  CriticalPoint lower, upper;  ///< lower and upper end of the interval of u
  /// Labels of the endpoints of v, whose kind is v_bound or on_circle: lower and upper endpoint of each interval.
  std::array<EndpointLabel, 2 * IntervalSet<double>::kMaxSize> end;
  std::size_t ends = 0;
};

/// Cell decomposition of a slice: its non-empty columns in ascending u. Adjacent columns differ in their endpoints.
struct Decomposition {
  std::vector<Column> columns;
  std::uint64_t signature = 0;  ///< hash of the combinatorial type; 0: the slice is empty

  struct Candidate {
    double u;
    CriticalPoint point;
  };
  std::vector<Candidate> candidates;  ///< scratch memory of decompose()
};

void decompose(const Slice<double>& s, Decomposition& decomposition);

/// Converts a slice with derivatives to one with values only.
template <class S>
Slice<double> values(const Slice<S>& s) {
  Slice<double> v;
  const auto copy = [](const IntervalSet<S>& from, IntervalSet<double>& to) {
    to.size = from.size;
    for (std::size_t i = 0; i < from.size; ++i) {
      const auto& part = from.interval[i];
      to.interval[i] = {value_of(part.lower), value_of(part.upper), part.lower_label, part.upper_label};
    }
  };
  copy(s.u, v.u);
  copy(s.v, v.v);
  v.annuli = s.annuli;
  for (std::size_t i = 0; i < s.annuli; ++i)
    v.annulus[i] = {value_of(s.annulus[i].u), value_of(s.annulus[i].v), value_of(s.annulus[i].in2),
                    value_of(s.annulus[i].out2), s.annulus[i].limb};
  return v;
}

/// An endpoint of one of the intervals of a set.
/// @param end  2 * (index of the interval) + (0: lower endpoint, 1: upper endpoint)
template <class S>
const S& end_of(const IntervalSet<S>& set, std::size_t end) {
  return end % 2 == 0 ? set.interval[end / 2].lower : set.interval[end / 2].upper;
}

/// Squared radius of a circle that bounds an annulus of a slice.
/// @param circle  2 * (index of the annulus) + (0: inner circle, 1: outer circle)
template <class S>
const S& radius2(const Slice<S>& s, std::size_t circle) {
  return circle % 2 == 0 ? s.annulus[circle / 2].in2 : s.annulus[circle / 2].out2;
}

/// The value of u at a critical point; meaningless if the critical point does not exist.
/// @param exists  if not null, receives whether the critical point exists
template <class S>
S abscissa(const Slice<S>& s, const CriticalPoint& point, bool* exists = nullptr) {
  using Kind = CriticalPoint::Kind;
  if (exists) *exists = true;
  if (point.kind == Kind::end_of_u) return end_of(s.u, point.first);
  const Annulus<S>& annulus = s.annulus[point.first / 2u];
  const double sign = point.sign;
  S radicand = radius2(s, point.first);
  S from = annulus.u;
  S across(1.0);
  if (point.kind == Kind::intersection_with_v) {
    const S rise = end_of(s.v, point.second) - annulus.v;
    radicand = radicand - rise * rise;
  } else if (point.kind == Kind::intersection_of_circles) {
    const Annulus<S>& other = s.annulus[point.second / 2u];
    const S du = other.u - annulus.u, dv = other.v - annulus.v, distance2 = du * du + dv * dv;
    const S share = (radicand - radius2(s, point.second) + distance2) / (distance2 * 2.0);
    from = annulus.u + share * du;
    across = -dv;
    radicand = radicand / distance2 - share * share;
  }
  if (exists) *exists = value_of(radicand) > 0;
  return from + across * sqrt_or_zero(radicand) * sign;
}

/// One half of a circle of an annulus: the points below or above the centre.
template <class S>
struct Arc {
  const Annulus<S>* annulus;
  const S* radius2;
  double side;  ///< -1: the half below the centre; +1: the half above it
};

template <class S>
Arc<S> arc_of(const Slice<S>& s, EndpointLabel label) {
  const Annulus<S>& annulus = s.annuli > 1 && s.annulus[1].limb == label.index ? s.annulus[1] : s.annulus[0];
  return {&annulus, label.outer ? &annulus.out2 : &annulus.in2, label.upper ? 1.0 : -1.0};
}

/// The v of an endpoint that is not on a circle, but an endpoint of the set v of the slice; it does not depend on u.
template <class S>
const S& bound_of_v(const Slice<S>& s, EndpointLabel label) {
  return end_of(s.v, 2u * label.index + label.upper);
}

/// The v, at a given u, of an endpoint of a column.
template <class S>
S end_at(const Slice<S>& s, EndpointLabel label, const S& u) {
  if (label.kind != EndpointLabel::on_circle) return bound_of_v(s, label);
  const Arc<S> arc = arc_of(s, label);
  const S w = u - arc.annulus->u;
  return arc.annulus->v + sqrt_or_zero(S(*arc.radius2 - w * w)) * arc.side;
}

/// Antiderivative of sqrt(radius2 - w^2) with respect to w. Its derivatives are assembled explicitly, because those of
/// its two terms are unbounded at the turning points of the circle and cancel.
template <class S>
S arc_antiderivative(const S& w, const S& radius2) {
  const double at = value_of(w), square = value_of(radius2);
  const double root = sqrt_or_zero(square - at * at), angle = atan2(at, root);
  return S(0.5 * (at * root + square * angle)) + (w - at) * root + (radius2 - square) * (0.5 * angle);
}

/// Area of a slice in closed form, from its decomposition [m^2].
template <class S>
S area(const Slice<S>& s, const Decomposition& decomposition) {
  S sum(0.0);
  for (const Column& column : decomposition.columns) {
    const S lower = abscissa(s, column.lower), upper = abscissa(s, column.upper), length = upper - lower;
    for (std::size_t k = 0; k < column.ends; ++k) {
      const EndpointLabel label = column.end[k];
      S under = S(0.0);
      if (label.kind != EndpointLabel::on_circle) {
        under = bound_of_v(s, label) * length;
      } else {
        const Arc<S> arc = arc_of(s, label);
        under = arc.annulus->v * length + (arc_antiderivative(S(upper - arc.annulus->u), *arc.radius2) -
                                           arc_antiderivative(S(lower - arc.annulus->u), *arc.radius2)) *
                                              arc.side;
      }
      sum = k % 2 == 0 ? S(sum - under) : S(sum + under);
    }
  }
  return sum;
}

}  // namespace pkm::crr_cru
