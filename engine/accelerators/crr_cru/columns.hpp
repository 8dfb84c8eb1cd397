// (3CRR/R)&CRU and Quadrupteron: exact volumes, and weighted samples, by quadrature of closed-form sections.
//
// With phi held, sections are normal to x and the outer coordinate is x; otherwise sections lie on the plane of the
// position that is held and the outer coordinate is phi.
#pragma once

#include <type_traits>

#include "engine/accelerators/crr_cru/breaks.hpp"
#include "engine/math/dual.hpp"

namespace pkm::crr_cru {

/// Storage that surveys reuse.
template <class S>
struct ColumnScratch {
  std::vector<Break<S>> breaks;
  std::vector<Piece<S>> pieces;
  std::vector<QuadratureCell<S>> integrals;
  Structure structure;
};

/// A break of the structure with its derivatives: where two ends meet, that of an implicit function (README.md).
/// @param still  the same design without derivatives, for those by t
template <class S>
S moving_break(const Sweeping<S>& s, const Sweeping<double>& plain, const Sweeping<Dual<1>>& still, double at,
               double whole, Structure& structure) {
  const double beside = 1e-9 * whole;
  double least = 1e-4 * whole, t = at;
  BreakCode first, second;
  for (const double candidate : {at - beside, at + beside}) {
    const Section<double> cross = section_at(plain, candidate);
    find_structure(cross, structure);
    const auto compare = [&](const BreakCode& a, const BreakCode& b) {
      const double apart = std::fabs(break_at(cross, b) - break_at(cross, a));
      if (!(apart > 0 && apart < least)) return;
      least = apart;
      t = candidate;
      first = a;
      second = b;
    };
    for (std::size_t i = 0; i < structure.columns.size(); ++i) {
      const Column& column = structure.columns[i];
      compare(column.lower, column.upper);
      if (i > 0) compare(structure.columns[i - 1].upper, column.lower);
      for (std::size_t end = 0; end < 2 * cross.u.size; ++end) {
        const BreakCode edge = BreakCode::end_of_u(end);
        compare(edge, column.lower);
        compare(column.upper, edge);
      }
    }
  }
  if (t == at) return S(at);
  const auto apart = [&](const auto& sweep, const auto& outer) {
    const auto cross = section_at(sweep, outer);
    return break_at(cross, second) - break_at(cross, first);
  };
  return implicit_root(at, apart(s, S(t)), apart(still, Dual<1>::variable(t, 0)).v[0]);
}

/// Fills scratch.pieces. Every decision depends on values only.
/// @param plain, still  the same design without derivatives
template <class S>
void find_outer_pieces(const Sweeping<S>& s, const Sweeping<double>& plain, const Sweeping<Dual<1>>& still,
                       ColumnScratch<S>& scratch) {
  // In x, only where a corner of two circles crosses a third does a break have no closed form; in phi, most are such.
  const int samples = s.cuts.outer_is_phi ? 192 : 48;
  scratch.breaks.clear();
  scratch.pieces.clear();
  if (s.cuts.outer_is_phi) {  // the box may leave no phi at all
    breaks_in_phi(s, scratch.breaks);
  } else {
    if (s.frame.singular) return;
    breaks_in_x(s, scratch.breaks);
  }
  const auto signature = [&](double outer) {
    find_structure(section_at(plain, outer), scratch.structure);
    return scratch.structure.signature;
  };
  const auto moving = [&](double at) {
    if constexpr (std::is_same_v<S, double>)
      return at;
    else
      return moving_break(s, plain, still, at, value_of(scratch.breaks.back().at) - value_of(scratch.breaks.front().at),
                          scratch.structure);
  };
  find_pieces(scratch.breaks, signature, moving, samples, scratch.pieces);
}

/// Area of the section at a value of the outer coordinate, in closed form [m^2].
template <class S>
S area_at(const Sweeping<S>& s, const S& outer, ColumnScratch<S>& scratch) {
  const Section<S> cross = section_at(s, outer);
  find_structure(values(cross), scratch.structure);
  return area(cross, scratch.structure);
}

/// What rounding leaves of the integral of area_at over the pieces [m^3 or m^2 rad].
template <class S>
double roundoff(const Sweeping<S>& s, const std::vector<Piece<S>>& pieces) {
  if (pieces.empty()) return 0;
  const auto& out2 = s.design.out2;
  const double size =  // of the terms that the area is a difference of
      value_of(s.design.g.L) + std::sqrt(value_of(max(max(out2[0], out2[1]), max(out2[2], out2[3]))));
  return 4e-16 * size * size * (value_of(pieces.back().upper) - value_of(pieces.front().lower));
}

/// Whether an end of the column over u is a circle that begins or ends there.
template <class S>
bool ends_like_a_root(const Section<S>& cross, const Column& column, double u) {
  constexpr double kRoundoff = 1e-9;
  for (std::size_t k = 0; k < column.ends; ++k) {
    if (!column.end[k].on_circle()) continue;
    const Arc<S> arc = arc_of(cross, column.end[k]);
    const double w = u - value_of(arc.ring->u), radius2 = value_of(*arc.radius2);
    if (std::fabs(radius2 - w * w) < kRoundoff * radius2) return true;
  }
  return false;
}

/// Calls visit(column, u, weight) at the nodes of `rule` over u on every smooth piece of the section.
template <class S, class Visit>
void visit_columns(const Section<S>& cross, const Structure& structure, const GaussRule& rule, const Visit& visit) {
  for (const Column& column : structure.columns) {
    Piece<S> piece{break_at(cross, column.lower), break_at(cross, column.upper)};
    piece.sqrt_at_lower = ends_like_a_root(cross, column, value_of(piece.lower));
    piece.sqrt_at_upper = ends_like_a_root(cross, column, value_of(piece.upper));
    visit_nodes(piece, rule,
                [&](const S& u, const S& jacobian, double weight) { visit(column, u, S(jacobian * weight)); });
  }
}

/// The area by `rule` over u, of the exact lengths of the columns along v.
template <class S>
S area_of_columns(const Sweeping<S>& s, const S& outer, const GaussRule& rule, ColumnScratch<S>& scratch,
                  std::int64_t& columns) {
  const Section<S> cross = section_at(s, outer);
  find_structure(values(cross), scratch.structure);
  S sum(0.0);
  visit_columns(cross, scratch.structure, rule, [&](const Column& column, const S& u, const S& weight) {
    S length(0.0);
    for (std::size_t k = 0; k < column.ends; k += 2)
      length += end_at(cross, column.end[k + 1], u) - end_at(cross, column.end[k], u);
    sum += length * weight;
    ++columns;
  });
  return sum;
}

/// Calls visit(position, weight) at nodes of the section at a value of the outer coordinate: `rule` over u and over
/// every interval of v.
template <class S, class Visit>
void visit_positions(const Sweeping<S>& s, const S& outer, const GaussRule& rule, ColumnScratch<S>& scratch,
                     const Visit& visit) {
  const Section<S> cross = section_at(s, outer);
  find_structure(values(cross), scratch.structure);
  Vector3<S> at;
  at[s.cuts.normal] = s.cuts.outer_is_phi ? s.held : outer;
  visit_columns(cross, scratch.structure, rule, [&](const Column& column, const S& u, const S& weight) {
    at[s.cuts.u] = u;
    for (std::size_t k = 0; k < column.ends; k += 2) {
      const Piece<S> interval{end_at(cross, column.end[k], u), end_at(cross, column.end[k + 1], u)};
      visit_nodes(interval, rule, [&](const S& v, const S& jacobian, double inner) {
        at[s.cuts.v] = v;
        visit(at, S(weight * jacobian * inner));
      });
    }
  });
}

}  // namespace pkm::crr_cru
