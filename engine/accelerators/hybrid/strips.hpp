// Hybrid robot: a section as strips of z over which x runs between two of its curves.
//
// The lower ends of x in force are an upper envelope of curves, the upper ends a lower one, and x has a column where
// the one lies below the other. Every curve is a constant and a root that is concave in z, taken with one sign or the
// other, so tangents and chords tell for certain whether two curves keep apart between two heights where they are
// known. Where they don't, the range is cut; where two change places, there is an end of a strip.
//
// Columns without (-H, H) are columns less those of a section that has H among its curves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/accelerators/hybrid/slice.hpp"
#include "engine/math/critical_values.hpp"
#include "engine/math/sqrt_quadratic_integral.hpp"

namespace pkm::hybrid {

/// A height where a strip ends: an end of z of the section, or where two edges meet.
struct StripEnd {
  enum class Kind : std::uint8_t { lower, upper, hole, meeting };
  double z = 0;
  Kind kind = Kind::meeting;
  std::uint8_t index = 0;  ///< of the end of z
  Edge first, second;      ///< which meet
};

struct Strip {
  StripEnd from, to;
  Edge left, right;
};

/// Whether two are the same but for their numbers.
inline bool alike(const StripEnd& p, const StripEnd& q) {
  return p.kind == q.kind && p.index == q.index && p.first == q.first && p.second == q.second;
}
inline bool alike(const Strip& p, const Strip& q) {
  return alike(p.from, q.from) && alike(p.to, q.to) && p.left == q.left && p.right == q.right;
}

/// A section as strips.
struct Structure {
  std::vector<Strip> strips;         ///< from below, not empty; where there is a hole, two over the same heights
  std::size_t lower = 0, upper = 0;  ///< the ends of z in force
  enum class Hole { none, below, all } hole = Hole::none;  ///< at which of the heights between them there is one
};
inline bool alike(const Structure& p, const Structure& q) {
  return std::ranges::equal(p.strips, q.strips, [](const Strip& a, const Strip& b) { return alike(a, b); });
}

/// What finding strips reuses.
struct StripScratch {
  struct Stretch {  ///< of an envelope
    double from, to;
    std::uint8_t curve;
  };
  std::vector<Stretch> left, right;
  std::vector<Strip> outer, inner;
};

/// @param structure  overwritten
void find_strips(const Section<double>& s, StripScratch& scratch, Structure& structure);

/// Moves a structure to a section near that of its heights. false: it is not seen there, and its heights have no
/// meaning. Strips that begin between those of the structure are not seen.
bool follow_strips(const Section<double>& s, Structure& structure);

/// x of an edge.
template <class S>
S edge_at(const Section<S>& s, const Edge& edge, const S& z) {
  return s.constant(edge) + s.curve[edge.curve].root(z) * s.sign(edge);
}

/// Integral of x along an edge over z.
template <class S>
S edge_integral(const Section<S>& s, const Edge& edge, const S& from, const S& to) {
  const Curve<S>& c = s.curve[edge.curve];
  const S length = to - from;
  return s.constant(edge) * length +
         sqrt_quadratic_integral(length, c.root(from), c.root(to), c.curvature()) * s.sign(edge);
}

/// The height of a strip's end with its derivatives. Where edges meet it is an implicit function of the design.
template <class S>
S height(const Section<S>& s, const StripEnd& end) {
  if (end.kind == StripEnd::Kind::lower) return s.lower[end.index];
  if (end.kind == StripEnd::Kind::upper) return s.upper[end.index];
  if (end.kind == StripEnd::Kind::hole) return s.hole_end;
  const S z(end.z), apart = edge_at(s, end.second, z) - edge_at(s, end.first, z);
  const auto slope = [&](const Edge& edge) {
    const Curve<S>& c = s.curve[edge.curve];
    const double root = value_of(c.root(z));
    return root > 0 ? s.sign(edge) * value_of(c.slope(z, S(root))) : 0.0;
  };
  const double by_z = slope(end.second) - slope(end.first);
  return implicit_root(end.z, apart, by_z);
}

/// An end of z of a section.
inline StripEnd end_of_z(const Section<double>& s, StripEnd::Kind kind, std::size_t index = 0) {
  StripEnd end{.kind = kind, .index = static_cast<std::uint8_t>(index)};
  end.z = height(s, end);
  return end;
}

/// Area of a section in closed form [m^2], from the integrals along the edges of its strips; an edge that goes on in
/// the next strip has one for both. Ends where edges meet are taken as they are: there, lengths do not jump, and what
/// two strips gain and lose is the same.
template <class S>
S area(const Section<S>& s, const Structure& structure) {
  S sum(0.0);
  const std::vector<Strip>& strips = structure.strips;
  const auto end = [&](const StripEnd& e) { return e.kind == StripEnd::Kind::meeting ? S(e.z) : height(s, e); };
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
