// Hybrid robot: the breaks of beta, between which sections keep their structure.
//
// Structures are searched for at some beta. Where two neighbours differ, the event that changes the one into the other
// is read off them, and Newton's method goes to it, in beta and the heights of the two meetings together. Structures
// close to it on both sides show whether it was the only one in between; else the search goes on there.
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "engine/accelerators/hybrid/strips.hpp"

namespace pkm::hybrid {

/// A section of a design without derivatives.
struct Sample {
  double beta = 0;
  Section<double> section;
  Structure structure;
};

/// What happens to a section at a break.
struct Event {
  enum class Kind : std::uint8_t {
    heights,  ///< `first` and `second` meet
    edges,    ///< `left` and `right` meet at `first`, an end of z
    touch     ///< `left` and `right` touch at the height of `first`, where one strip ends and the next begins
  } kind = Kind::heights;
  StripEnd first, second;
  Edge left, right;
};

/// A range of beta with one structure.
struct Stretch {
  double lower = 0, upper = 0;
  std::optional<Event> at_lower, at_upper;  ///< that change the structure there, where known
  Structure structure;                      ///< near the lower end
};

/// Storage that searches reuse.
struct BreakScratch {
  std::vector<Stretch> stretches;
  std::size_t count = 0;  ///< of them in use
  std::deque<Sample> samples;
  StripScratch strips;
};

/// Fills scratch.stretches with the ranges on which sections are not empty, in their order.
/// @param plain, still  the same design without derivatives
void find_stretches(const Frame<double>& plain, const Frame<Dual<1>>& still, BreakScratch& scratch);

/// The curve that begins or ends at an end of z, where its root is 0; kCurves: none.
inline std::size_t tip(const StripEnd& end) {
  if (end.kind == StripEnd::Kind::hole) return kCurveH;
  if (end.kind == StripEnd::Kind::meeting) return kCurves;
  if (end.index == kEndP1 || end.index == kEndP2) return kCurveP;
  if (end.index == kEndL && end.kind == StripEnd::Kind::upper) return kCurveL;
  return end.index == kEndQ && end.kind == StripEnd::Kind::lower ? std::size_t{kCurveQ} : std::size_t{kCurves};
}

/// x of an edge at an end of z, where a root of the section may begin.
template <class S>
S edge_at_end(const Section<S>& s, const Edge& edge, const StripEnd& end) {
  return edge.curve == tip(end) ? S(0.0) : edge_at(s, edge, height(s, end));
}

/// Whether areas behave like a power 3/2 beside an event: edges touch, or an end of z passes where a root begins.
inline bool has_root(const Event& event) {
  const auto is_tip = [](const StripEnd& end) { return tip(end) != kCurves; };
  return event.kind == Event::Kind::touch || is_tip(event.first) ||
         (event.kind == Event::Kind::heights && is_tip(event.second));
}

/// How far the two are apart: 0 at the break.
template <class S>
S distance(const Section<S>& s, const Event& event) {
  if (event.kind == Event::Kind::touch) {  // where it is stationary in z
    const S z(event.first.z);
    return edge_at(s, event.right, z) - edge_at(s, event.left, z);
  }
  if (event.kind == Event::Kind::edges)
    return edge_at_end(s, event.right, event.first) - edge_at_end(s, event.left, event.first);
  return height(s, event.second) - height(s, event.first);
}

/// The beta of an event of a design, with its derivatives: with a and b the two that meet there, a(p, beta(p)) =
/// b(p, beta(p)) gives beta' = -(d(a - b)/dp) / (d(a - b)/dbeta).
template <class S>
S moving_break(const Frame<S>& f, const Frame<Dual<1>>& still, double at, const Event& event) {
  if constexpr (std::is_same_v<S, double>) {
    return at;
  } else {
    const double by_beta = distance(section(still, Dual<1>::variable(at, 0)), event).v[0];
    return implicit_root(at, distance(section(f, S(at)), event), by_beta);
  }
}

}  // namespace pkm::hybrid
