// (3CRR/R)&CRU and Quadrupteron: exact volumes and weighted samples, by quadrature of the closed-form areas of slices
// over the outer coordinate.
//
// If phi is fixed, slices are normal to x, which is the outer coordinate. Otherwise a position is fixed: slices are in
// the plane normal to it, and phi is the outer coordinate.
#pragma once

#include <type_traits>

#include "engine/accelerators/crr_cru/critical_values.hpp"
#include "engine/math/dual.hpp"

namespace pkm::crr_cru {

/// Scratch memory of one workspace analysis.
template <class S>
struct ColumnScratch {
  std::vector<CriticalValue<S>> critical_values;
  std::vector<Subinterval<S>> intervals;  ///< subintervals of the outer coordinate between critical values
  std::vector<QuadratureCell<S>> integrals;
  Decomposition decomposition;
};

/// Adds derivatives to a critical value of the outer coordinate that was found by bisection. There, two critical points
/// of the slice coincide (README.md); the implicit function theorem, applied to the difference of their coordinates u,
/// which is 0, gives the derivatives. These are 0 if neither a column nor a gap between columns vanishes at the value.
/// @param plain     the design in double precision
/// @param by_outer  the design with zero derivatives, for derivatives with respect to the outer coordinate
/// @param at        the critical value
/// @param range     length of the range of the outer coordinate
template <class S>
S lift_critical_value(const SlicedDesign<S>& s, const SlicedDesign<double>& plain,
                      const SlicedDesign<Dual<1>>& by_outer, double at, double range, Decomposition& decomposition) {
  const double offset = 1e-9 * range;
  double smallest = 1e-4 * range, t = at;
  CriticalPoint first, second;  // ends of the smallest column, or gap between columns, near `at`
  for (const double candidate : {at - offset, at + offset}) {
    const Slice<double> slice = slice_at(plain, candidate);
    decompose(slice, decomposition);
    const auto compare = [&](const CriticalPoint& a, const CriticalPoint& b) {
      const double distance = std::fabs(abscissa(slice, b) - abscissa(slice, a));
      if (!(distance > 0 && distance < smallest)) return;
      smallest = distance;
      t = candidate;
      first = a;
      second = b;
    };
    for (std::size_t i = 0; i < decomposition.columns.size(); ++i) {
      const Column& column = decomposition.columns[i];
      compare(column.lower, column.upper);
      if (i > 0) compare(decomposition.columns[i - 1].upper, column.lower);
      for (std::size_t end = 0; end < 2 * slice.u.size; ++end) {
        const CriticalPoint edge = CriticalPoint::end_of_u(end);
        compare(edge, column.lower);
        compare(column.upper, edge);
      }
    }
  }
  if (t == at) return S(at);
  const auto distance = [&](const auto& design, const auto& outer) {
    const auto slice = slice_at(design, outer);
    return abscissa(slice, second) - abscissa(slice, first);
  };
  return implicit_root(at, distance(s, S(t)), distance(by_outer, Dual<1>::variable(t, 0)).v[0]);
}

/// Fills scratch.intervals with the subintervals of the outer coordinate on which slices are not empty and have one
/// combinatorial type. Where the subintervals end depends on values only, never on derivatives.
/// @param plain     the design in double precision
/// @param by_outer  the design with zero derivatives, for derivatives with respect to the outer coordinate
template <class S>
void find_outer_intervals(const SlicedDesign<S>& s, const SlicedDesign<double>& plain,
                          const SlicedDesign<Dual<1>>& by_outer, ColumnScratch<S>& scratch) {
  // Triple intersections of circles are the only critical values of x without a closed form, but most critical values
  // of phi have none, so that phi needs more samples.
  const int samples = s.axes.outer_is_phi ? 192 : 48;
  auto& values = scratch.critical_values;
  values.clear();
  scratch.intervals.clear();
  if (s.axes.outer_is_phi) {
    add_critical_values_of_phi(s, values);
  } else {
    if (s.positions.singular) return;
    add_critical_values_of_x(s, values);
  }
  const auto signature = [&](double outer) {
    decompose(slice_at(plain, outer), scratch.decomposition);
    return scratch.decomposition.signature;
  };
  const auto lift = [&](double at) {
    if constexpr (std::is_same_v<S, double>)
      return at;
    else
      return lift_critical_value(s, plain, by_outer, at, value_of(values.back().at) - value_of(values.front().at),
                                 scratch.decomposition);
  };
  find_subintervals(values, signature, lift, samples, scratch.intervals);
}

/// The slice at a value of the outer coordinate. Its decomposition is stored in scratch.decomposition.
template <class S>
Slice<S> decomposed_slice(const SlicedDesign<S>& s, const S& outer, ColumnScratch<S>& scratch) {
  const Slice<S> slice = slice_at(s, outer);
  decompose(values(slice), scratch.decomposition);
  return slice;
}

/// Area of the slice at a value of the outer coordinate, computed in closed form [m^2].
template <class S>
S area_at(const SlicedDesign<S>& s, const S& outer, ColumnScratch<S>& scratch) {
  const Slice<S> slice = decomposed_slice(s, outer, scratch);
  return area(slice, scratch.decomposition);
}

/// Estimate of the rounding error of the integral of area_at() over the outer coordinate [m^3 or m^2 rad].
template <class S>
double roundoff(const SlicedDesign<S>& s, const std::vector<Subinterval<S>>& intervals) {
  if (intervals.empty()) return 0;
  const auto& out2 = s.design.out2;
  const double size =  // magnitude of the terms that cancel in the area
      value_of(s.design.g.L) + std::sqrt(value_of(max(max(out2[0], out2[1]), max(out2[2], out2[3]))));
  return 4e-16 * size * size * (value_of(intervals.back().upper) - value_of(intervals.front().lower));
}

/// True if u is a turning point of a circle that bounds the column in v. The length of the column then varies like a
/// square root near u.
template <class S>
bool has_sqrt_singularity(const Slice<S>& slice, const Column& column, double u) {
  constexpr double kRoundoff = 1e-9;
  for (std::size_t k = 0; k < column.ends; ++k) {
    if (column.end[k].kind != EndpointLabel::on_circle) continue;
    const Arc<S> arc = arc_of(slice, column.end[k]);
    const double w = u - value_of(arc.annulus->u), radius2 = value_of(*arc.radius2);
    if (std::fabs(radius2 - w * w) < kRoundoff * radius2) return true;
  }
  return false;
}

/// Calls visit(slice, column, u, weight) at the nodes of a quadrature rule over u in every cell of the decomposition of
/// the slice at `outer`.
template <class S, class Visit>
void visit_columns(const SlicedDesign<S>& s, const S& outer, const GaussRule& rule, ColumnScratch<S>& scratch,
                   const Visit& visit) {
  const Slice<S> slice = decomposed_slice(s, outer, scratch);
  for (const Column& column : scratch.decomposition.columns) {
    Subinterval<S> interval{abscissa(slice, column.lower), abscissa(slice, column.upper)};
    interval.sqrt_at_lower = has_sqrt_singularity(slice, column, value_of(interval.lower));
    interval.sqrt_at_upper = has_sqrt_singularity(slice, column, value_of(interval.upper));
    visit_nodes(interval, rule,
                [&](const S& u, const S& jacobian, double weight) { visit(slice, column, u, S(jacobian * weight)); });
  }
}

/// Area of the slice at `outer` [m^2], by quadrature over u of the exact lengths of its columns.
/// @param columns  increased by the number of columns that are evaluated
template <class S>
S area_of_columns(const SlicedDesign<S>& s, const S& outer, const GaussRule& rule, ColumnScratch<S>& scratch,
                  std::int64_t& columns) {
  S sum(0.0);
  visit_columns(s, outer, rule, scratch, [&](const Slice<S>& slice, const Column& column, const S& u, const S& weight) {
    S length(0.0);
    for (std::size_t k = 0; k < column.ends; k += 2)
      length += end_at(slice, column.end[k + 1], u) - end_at(slice, column.end[k], u);
    sum += length * weight;
    ++columns;
  });
  return sum;
}

/// Calls visit(position, weight) at the nodes of a product quadrature rule in the slice at `outer`: over u, and over
/// every interval of v.
template <class S, class Visit>
void visit_positions(const SlicedDesign<S>& s, const S& outer, const GaussRule& rule, ColumnScratch<S>& scratch,
                     const Visit& visit) {
  Vector3<S> at;
  at[s.axes.normal] = s.axes.outer_is_phi ? s.fixed : outer;
  visit_columns(s, outer, rule, scratch, [&](const Slice<S>& slice, const Column& column, const S& u, const S& weight) {
    at[s.axes.u] = u;
    for (std::size_t k = 0; k < column.ends; k += 2) {
      const Subinterval<S> interval{end_at(slice, column.end[k], u), end_at(slice, column.end[k + 1], u)};
      visit_nodes(interval, rule, [&](const S& v, const S& jacobian, double inner) {
        at[s.axes.v] = v;
        visit(at, S(weight * jacobian * inner));
      });
    }
  });
}

}  // namespace pkm::crr_cru
