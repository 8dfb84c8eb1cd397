// Hybrid robot: decomposition of a slice into strips, intervals of z over which x is between two curves.
//
// The active lower bound of x is the upper envelope of curves, and the active upper bound is a lower envelope; x is
// feasible between them where the former is below the latter. Every curve is a constant plus or minus a square root
// that is concave in z. Tangents and chords can therefore prove that two curves do not intersect between two heights;
// without such a proof, the interval is bisected. The intersections of active curves are the bounds of strips.
//
// The hole (-H, H) is excluded by subtracting two decompositions, one of which has H among its curves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/accelerators/hybrid/slice.hpp"
#include "engine/math/critical_values.hpp"
#include "engine/math/sqrt_quadratic_integral.hpp"

namespace pkm::hybrid {

/// An end of a strip in z: one of the bounds of z of the slice, or the intersection of two edges.
struct StripBound {
  enum class Kind : std::uint8_t { lower, upper, hole, intersection };
  double z = 0;
  Kind kind = Kind::intersection;
  std::uint8_t index = 0;  ///< index of the bound among the slice's bounds of z; unused for an intersection
  Edge first, second;      ///< the two edges that intersect; unused for a bound of z
};

struct Strip {
  StripBound from, to;
  Edge left, right;
};

/// Returns true if the combinatorial types are equal, ignoring numerical values.
inline bool same_type(const StripBound& p, const StripBound& q) {
  return p.kind == q.kind && p.index == q.index && p.first == q.first && p.second == q.second;
}
inline bool same_type(const Strip& p, const Strip& q) {
  return same_type(p.from, q.from) && same_type(p.to, q.to) && p.left == q.left && p.right == q.right;
}

struct Decomposition {
  /// Non-empty strips in ascending z. Where the feasible x has a hole, two strips, one on each side of the hole, have
  /// the same interval of z.
  std::vector<Strip> strips;
  std::size_t lower = 0, upper = 0;  ///< indices of those lower and upper bounds of z that are active
  enum class Hole {
    none,
    below,
    all
    /// The part of the range of z in which the feasible x has a hole.
  } hole = Hole::none;
};
inline bool same_type(const Decomposition& p, const Decomposition& q) {
  return std::ranges::equal(p.strips, q.strips, [](const Strip& a, const Strip& b) { return same_type(a, b); });
}

/// Scratch memory of decompose().
struct StripScratch {
  struct EnvelopeInterval {  ///< an interval of z on which one curve is the envelope
    double from, to;
    std::uint8_t curve;
  };
  std::vector<EnvelopeInterval> left, right;
  std::vector<Strip> outer, inner;
};

void decompose(const Slice<double>& s, StripScratch& scratch, Decomposition& decomposition);

/// Updates the heights of a decomposition for a nearby slice of the same type. Additional strips are not detected.
/// @return false if the type of the slice differs; the heights are then meaningless
bool track(const Slice<double>& s, Decomposition& decomposition);

/// The x of an edge at a height z.
template <class S>
S edge_at(const Slice<S>& s, const Edge& edge, const S& z) {
  return s.constant(edge) + s.curve[edge.curve].root(z) * s.sign(edge);
}

/// Integral of the x of an edge over z.
template <class S>
S edge_integral(const Slice<S>& s, const Edge& edge, const S& from, const S& to) {
  const Curve<S>& c = s.curve[edge.curve];
  const S length = to - from;
  return s.constant(edge) * length +
         sqrt_quadratic_integral(length, c.root(from), c.root(to), c.curvature()) * s.sign(edge);
}

/// The z of a bound of a strip, with derivatives; for an intersection, they follow from the implicit function theorem.
template <class S>
S height(const Slice<S>& s, const StripBound& end) {
  if (end.kind == StripBound::Kind::lower) return s.lower[end.index];
  if (end.kind == StripBound::Kind::upper) return s.upper[end.index];
  if (end.kind == StripBound::Kind::hole) return s.hole_end;
  const S z(end.z), apart = edge_at(s, end.second, z) - edge_at(s, end.first, z);
  const auto derivative = [&](const Edge& edge) {
    const Curve<S>& c = s.curve[edge.curve];
    const double root = value_of(c.root(z));
    return root > 0 ? s.sign(edge) * value_of(c.derivative(z, S(root))) : 0.0;
  };
  const double by_z = derivative(end.second) - derivative(end.first);
  return implicit_root(end.z, apart, by_z);
}

/// The strip bound for one of the slice's bounds of z.
inline StripBound end_of_z(const Slice<double>& s, StripBound::Kind kind, std::size_t index = 0) {
  StripBound end{.kind = kind, .index = static_cast<std::uint8_t>(index)};
  end.z = height(s, end);
  return end;
}

/// Area of a slice in closed form [m^2], from the integrals along the edges of its strips; an edge that continues in
/// the next strip has one integral. Derivatives of intersections are omitted, because the length of columns is
/// continuous there, so that the contributions of two strips cancel.
template <class S>
S area(const Slice<S>& s, const Decomposition& decomposition) {
  S sum(0.0);
  const std::vector<Strip>& strips = decomposition.strips;
  const auto end = [&](const StripBound& e) {
    return e.kind == StripBound::Kind::intersection ? S(e.z) : height(s, e);
  };
  const auto add = [&](Edge Strip::*side, double sign) {
    for (std::size_t i = 0, next; i < strips.size(); i = next) {
      const Edge& edge = strips[i].*side;
      next = i + 1;
      while (next < strips.size() && strips[next].*side == edge && strips[next].from.z == strips[next - 1].to.z) ++next;
      sum += edge_integral(s, edge, end(strips[i].from), end(strips[next - 1].to)) * sign;
    }
  };
  add(&Strip::right, 1);
  add(&Strip::left, -1);
  return sum;
}

}  // namespace pkm::hybrid
