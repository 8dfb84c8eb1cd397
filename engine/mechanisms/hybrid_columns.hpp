// Hybrid robot: exact volume, and weighted samples, by quadrature over beta of closed-form x-z sections.
#pragma once

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

/// A break of the structure with its derivatives. There two heights of a section meet: both ends of a strip that
/// closes, or two ends of z that change places. With a and b those heights, a(p, beta(p)) = b(p, beta(p)) gives beta' =
/// -(d(a - b)/dp) / (d(a - b)/dbeta); which they are, and that quotient, show a little beside the break. A Newton step
/// from there ends at it.
/// @param plain, still  the same design without derivatives, and for those by beta
/// @param at            the break, to `beside`
template <class S>
S moving_break(const Frame<S>& f, const Frame<double>& plain, const Frame<Dual<1>>& still, double at, double beside,
               StripScratch& scratch, Structure& structure) {
  double least = 1e-3 * value_of(f.z_high), beta = at;
  StripEnd first, second;
  for (const double candidate : {at - beside, at + beside}) {
    const Section<double> s = section(plain, candidate);
    find_strips(s, scratch, structure);
    const auto compare = [&](const StripEnd& a, const StripEnd& b) {
      const double apart = std::fabs(b.z - a.z);
      if (!(apart > 0 && apart < least)) return;
      least = apart;
      beta = candidate;
      first = a;
      second = b;
    };
    const auto end = [&](StripEnd::Kind kind, std::size_t index) {
      const bool lower = kind == StripEnd::Kind::lower;
      return StripEnd{lower ? s.lower[index] : s.upper[index], kind, static_cast<std::uint8_t>(index), {}, {}};
    };
    const StripEnd low = end(StripEnd::Kind::lower, structure.lower),
                   high = end(StripEnd::Kind::upper, structure.upper);
    compare(low, high);
    compare(low, end(StripEnd::Kind::lower, structure.next_lower));
    compare(high, end(StripEnd::Kind::upper, structure.next_upper));
    for (std::size_t i = 0; i < structure.strips.size(); ++i) {
      const Strip& strip = structure.strips[i];
      compare(strip.from, strip.to);
      compare(low, strip.from);  // where nothing is left of a strip's beginning or end
      compare(strip.to, high);
      if (i > 0) compare(structure.strips[i - 1].to, strip.from);
    }
  }
  if (beta == at) return S(at);
  const auto apart = [&](const auto& frame, const auto& outer) {
    const auto s = section(frame, outer);
    return height(s, second) - height(s, first);
  };
  const Dual<1> by_beta = apart(still, Dual<1>::variable(beta, 0));
  const double step = -by_beta.a / by_beta.v[0];
  if (!(std::fabs(step) <= 4 * beside)) return S(at);
  if constexpr (std::is_same_v<S, double>) {
    return beta + step;
  } else {
    const S by_design = apart(f, S(beta));
    return S(beta + step) - (by_design - value_of(by_design)) / by_beta.v[0];
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
  constexpr double kBeside = 1e-7;
  const double beside = kBeside * (plain.l.beta_max - plain.l.beta_min);
  const auto moving = [&](double at) {
    return moving_break(f, plain, still, at, beside, scratch.strips, scratch.structure);
  };
  find_pieces(scratch.breaks, signature, moving, kSamples, scratch.pieces, kBeside);
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
