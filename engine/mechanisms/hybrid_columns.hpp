// Hybrid robot: exact volume, and weighted samples, by quadrature over beta of closed-form x-z sections.
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/math/pieces.hpp"
#include "engine/mechanisms/hybrid_strips.hpp"

namespace pkm::hybrid {

/// Storage that surveys reuse.
template <class S>
struct ColumnScratch {
  std::vector<Break<S>> breaks;
  std::vector<Piece<S>> pieces;
  std::vector<Integral<S>> integrals;
  StripScratch strips;
  Structure structure;
};

/// The section at a beta, its strips in scratch.structure.
template <class S>
Section<S> section_of(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  Section<S> s = section(f, beta);
  if constexpr (std::is_same_v<S, double>)
    find_strips(s, scratch.strips, scratch.structure);
  else
    find_strips(values(s), scratch.strips, scratch.structure);
  return s;
}

/// What happens to a section at a break: two heights meet, or two edges at a height.
struct Event {
  StripEnd first, second;
  bool across = false;  ///< `left` and `right` meet at `first`; `second` means nothing
  Edge left, right;
};

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

/// How far the two are apart: 0 at the break.
template <class S>
S distance(const Section<S>& s, const Event& event) {
  if (event.across) return edge_at_end(s, event.right, event.first) - edge_at_end(s, event.left, event.first);
  return height(s, event.second) - height(s, event.first);
}

/// The event between two sections near each other that have different structures; false: nothing is seen to meet.
inline bool find_event(const Section<double>& s, const Structure& below, const Section<double>& t,
                       const Structure& above, Event& event) {
  using Kind = StripEnd::Kind;
  const auto end = [&](Kind kind, std::size_t index) {
    const double z = kind == Kind::lower ? s.lower[index] : kind == Kind::upper ? s.upper[index] : s.hole_end;
    return StripEnd{z, kind, static_cast<std::uint8_t>(index), {}, {}};
  };
  const auto changes = [&](const Event& candidate) {
    return (distance(s, candidate) >= 0) != (distance(t, candidate) >= 0);
  };
  const StripEnd low = end(Kind::lower, below.lower), high = end(Kind::upper, below.upper), hole = end(Kind::hole, 0);
  const auto take = [&](const Event& candidate) {
    event = candidate;
    return true;
  };
  if (below.lower != above.lower) return take({low, end(Kind::lower, above.lower), false, {}, {}});
  if (below.upper != above.upper) return take({high, end(Kind::upper, above.upper), false, {}, {}});
  for (const StripEnd& other : {high, hole})
    if (const Event closes{low, other, false, {}, {}}; changes(closes)) return take(closes);
  if (const Event covers{hole, high, false, {}, {}}; hole.z > low.z && changes(covers)) return take(covers);
  for (const StripEnd& at : {low, high, hole}) {
    if (at.z < low.z || at.z > high.z) continue;
    std::array<Edge, 2 * kCurves> edge;
    std::array<double, 2 * kCurves> in_s, in_t;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      edge[k] = {static_cast<std::uint8_t>(k / 2), static_cast<std::uint8_t>(k % 2)};
      in_s[k] = edge_at_end(s, edge[k], at);
      in_t[k] = edge_at_end(t, edge[k], at);
    }
    for (std::size_t i = 0; i < edge.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if ((in_s[i] >= in_s[j]) == (in_t[i] >= in_t[j])) continue;
        const bool apart = edge[j].curve >= kCurveQ && edge[i].curve >= kCurveQ && edge[i].side != edge[j].side;
        if (!apart) return take({at, {}, true, edge[j], edge[i]});  // the chain's -x and x never meet but at a tip
      }
  }
  double least = 1e-3 * high.z;
  const auto closes_from = [&](const Structure& here, const Structure& there) {
    for (const Strip& strip : here.strips) {
      const bool stays = std::ranges::any_of(there.strips, [&](const Strip& of) { return alike(of, strip); });
      if (stays || strip.to.z - strip.from.z >= least) continue;
      least = strip.to.z - strip.from.z;
      event = {strip.from, strip.to, false, {}, {}};
    }
  };
  closes_from(below, above);
  closes_from(above, below);
  return least < 1e-3 * high.z;
}

/// A break of the structure with its derivatives. With a and b the two that meet there, a(p, beta(p)) = b(p, beta(p))
/// gives beta' = -(d(a - b)/dp) / (d(a - b)/dbeta). Which they are, and that quotient, show a little beside the break;
/// a Newton step ends at it.
/// @param plain, still  the same design without derivatives, and for those by beta
/// @param at            the break, to much less than `beside`
template <class S>
S moving_break(const Frame<S>& f, const Frame<double>& plain, const Frame<Dual<1>>& still, double at, double beside,
               StripScratch& scratch, Structure& structure) {
  thread_local Structure before;
  const double low = at - beside, high = at + beside;
  const Section<double> below = section(plain, low), above = section(plain, high);
  find_strips(below, scratch, before);
  find_strips(above, scratch, structure);
  Event event;
  if (!find_event(below, before, above, structure, event)) return S(at);
  // Heights where edges meet are known on the side where the strip is
  const auto known_in = [&](const Structure& of) {
    return std::ranges::any_of(of.strips, [&](const Strip& s) { return s.from.z == event.first.z; });
  };
  const double beta = !event.across && !known_in(before) && known_in(structure) ? high : low;
  const Dual<1> apart = distance(section(still, Dual<1>::variable(beta, 0)), event);
  const double step = -apart.a / apart.v[0];
  if (!(std::fabs(step) <= 8 * beside)) return S(at);
  if constexpr (std::is_same_v<S, double>) {
    return beta + step;
  } else {
    const S by_design = distance(section(f, S(beta)), event);
    return S(beta + step) - (by_design - value_of(by_design)) / apart.v[0];
  }
}

/// Fills scratch.pieces. Every decision depends on values only.
/// @param plain, still  the same design without derivatives
template <class S>
void find_outer_pieces(const Frame<S>& f, const Frame<double>& plain, const Frame<Dual<1>>& still,
                       ColumnScratch<S>& scratch) {
  constexpr int kSamples = 48;
  scratch.breaks.clear();
  scratch.pieces.clear();
  if (f.empty) return;
  scratch.breaks.push_back({f.l.beta_min});
  scratch.breaks.push_back({f.l.beta_max});
  const auto signature = [&](double beta) {
    find_strips(section(plain, beta), scratch.strips, scratch.structure);
    return scratch.structure.signature;
  };
  constexpr double kWidth = 1e-10;
  const double beside = 50 * kWidth * (plain.l.beta_max - plain.l.beta_min);
  const auto moving = [&](double at) {
    return moving_break(f, plain, still, at, beside, scratch.strips, scratch.structure);
  };
  find_pieces(scratch.breaks, signature, moving, kSamples, scratch.pieces, kWidth);
}

/// Area of the section at a beta [m^2].
template <class S>
S area_at(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  const Section<S> s = section_of(f, beta, scratch);
  return area(s, scratch.structure);
}

/// What rounding leaves of the integral of area_at over the pieces [m^2 rad].
template <class S>
double roundoff(const Frame<S>& f, const std::vector<Piece<S>>& pieces) {
  if (pieces.empty()) return 0;
  double size = value_of(max(f.g.L1, max(f.g.L2, f.g.L3)));  // of the terms that the area is a difference of
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(value_of(f.lo[i])) + std::fabs(value_of(f.hi[i]));
  return 4e-16 * size * value_of(f.z_high) * (value_of(pieces.back().upper) - value_of(pieces.front().lower));
}

/// Calls visit(z, length, weight) at the nodes of `rule` over z on every strip of the section: the exact length of the
/// column of x there.
template <class S, class Visit>
void visit_columns(const Frame<S>& f, const S& beta, const GaussRule& rule, ColumnScratch<S>& scratch,
                   const Visit& visit) {
  const Section<S> s = section_of(f, beta, scratch);
  for (const Strip& strip : scratch.structure.strips) {
    const Piece<S> piece{height(s, strip.from), height(s, strip.to), true, true};
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const auto [z, jacobian] = map_node(piece, rule.node[i]);
      visit(z, S(edge_at(s, strip.right, z) - edge_at(s, strip.left, z)), S(jacobian * rule.weight[i]));
    }
  }
}

}  // namespace pkm::hybrid
