// Hybrid robot: exact volume, and weighted samples, by quadrature over beta of closed-form x-z sections.
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/accelerators/hybrid/critical_values.hpp"
#include "engine/accelerators/hybrid/conditioning.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::hybrid {

/// Storage that surveys reuse.
template <class S>
struct ColumnScratch {
  BreakScratch breaks;
  std::vector<Piece<S>> pieces;  ///< one for each of the stretches
  std::vector<QuadratureCell<S>> parts;
  StripScratch strips;
  Structure structure;  ///< of a beta outside of the pieces
  PoseList poses;       ///< whose conditioning is asked for
};

/// The structure of a section: that of the stretch around beta, followed from where it was asked for last.
template <class S>
const Structure& structure_of(const Section<double>& s, double beta, ColumnScratch<S>& scratch) {
  const auto around = [&](const Piece<S>& p) { return value_of(p.lower) < beta && beta < value_of(p.upper); };
  const auto piece = std::ranges::find_if(scratch.pieces, around);
  const bool known = piece != scratch.pieces.end();
  Structure& structure =
      known ? scratch.breaks.stretches[static_cast<std::size_t>(piece - scratch.pieces.begin())].structure
            : scratch.structure;
  if (!known || !follow_strips(s, structure)) find_strips(s, scratch.strips, structure);
  return structure;
}

/// A section with its structure.
template <class S>
struct Cut {
  Section<S> section;
  const Structure& structure;
};
template <class S>
Cut<S> cut(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  const Section<S> s = section(f, beta);
  if constexpr (std::is_same_v<S, double>)
    return {s, structure_of(s, beta, scratch)};
  else
    return {s, structure_of(values(s), value_of(beta), scratch)};
}

/// Fills scratch.pieces. Every decision depends on values only.
/// @param plain, still  the same design without derivatives
template <class S>
void find_outer_pieces(const Frame<S>& f, const Frame<double>& plain, const Frame<Dual<1>>& still,
                       ColumnScratch<S>& scratch) {
  find_stretches(plain, still, scratch.breaks);
  scratch.pieces.clear();
  for (std::size_t i = 0; i < scratch.breaks.count; ++i) {
    const Stretch& s = scratch.breaks.stretches[i];
    const bool first = s.lower == plain.l.beta_min, last = s.upper == plain.l.beta_max;
    const bool joins = i > 0 && scratch.breaks.stretches[i - 1].upper == s.lower;
    const S lower = first        ? f.l.beta_min
                    : joins      ? scratch.pieces.back().upper
                    : s.at_lower ? moving_break(f, still, s.lower, *s.at_lower)
                                 : S(s.lower);
    const S upper = last ? f.l.beta_max : s.at_upper ? moving_break(f, still, s.upper, *s.at_upper) : S(s.upper);
    const bool sqrt_at_lower = !first && (!s.at_lower || has_root(*s.at_lower)),
               sqrt_at_upper = !last && (!s.at_upper || has_root(*s.at_upper));
    scratch.pieces.push_back({lower, upper, sqrt_at_lower, sqrt_at_upper});
  }
}

/// Area of the section at a beta [m^2].
template <class S>
S area_at(const Frame<S>& f, const S& beta, ColumnScratch<S>& scratch) {
  const Cut<S> c = cut(f, beta, scratch);
  return area(c.section, c.structure);
}

/// What rounding leaves of the integral of area_at over the pieces [m^2 rad].
template <class S>
double roundoff(const Frame<S>& f, const std::vector<Piece<S>>& pieces) {
  if (pieces.empty()) return 0;
  double size = value_of(max(f.g.L1, max(f.g.L2, f.g.L3)));  // of the terms that the area is a difference of
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(value_of(f.lo[i])) + std::fabs(value_of(f.hi[i]));
  return 4e-16 * size * value_of(f.z_high) * (value_of(pieces.back().upper) - value_of(pieces.front().lower));
}

/// The integral of the sections' areas over the pieces [m^2 rad].
template <class S>
Integral<S> volume(const Frame<S>& f, double tolerance, ColumnScratch<S>& scratch) {
  return integrate<S>([&](const S& beta) { return area_at(f, beta, scratch); }, scratch.pieces, tolerance,
                      roundoff(f, scratch.pieces), scratch.parts, {.rule = patterson_rule()});
}

/// Calls visit(z, length, weight) at the nodes of `rule` over z on every strip of the section: the exact length of the
/// column of x there.
template <class S, class Visit>
void visit_columns(const Frame<S>& f, const S& beta, const GaussRule& rule, ColumnScratch<S>& scratch,
                   const Visit& visit) {
  const Cut<S> c = cut(f, beta, scratch);
  const Section<S>& s = c.section;
  for (const Strip& strip : c.structure.strips) {
    const Piece<S> piece{height(s, strip.from), height(s, strip.to), true, true};
    visit_nodes(piece, rule, [&](const S& z, const S& jacobian, double weight) {
      visit(z, S(edge_at(s, strip.right, z) - edge_at(s, strip.left, z)), S(jacobian * weight));
    });
  }
}

}  // namespace pkm::hybrid
