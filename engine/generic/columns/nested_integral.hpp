// Nested adaptive Gauss-Kronrod quadrature of the areas of planar slices, or of the lengths of columns, over the outer
// coordinates.
//
// In each outer coordinate the integrand is smooth between consecutive critical values, i.e. while the type of the
// slice is constant. The type is sampled, every change is bracketed to rounding accuracy, and an interval whose
// quadrature nodes differ in type is subdivided. Changes between two samples can be missed.
#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/columns/column.hpp"
#include "engine/generic/columns/component_search.hpp"
#include "engine/generic/columns/critical_value_sensitivity.hpp"
#include "engine/generic/columns/critical_value_solver.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// The slice at a value of an outer coordinate.
struct Slice {
  double at = 0, measure = 0, error = 0;
  SliceType hash = 0;          ///< type; 0: empty
  std::uint32_t violated = 0;  ///< if the slice is empty: 1 + number of the violated independent constraint
};

/// Bound of an integration interval: a critical value, a bound of the search box, or an independent constraint (1 + its
/// number).
using IntervalBound = std::uint32_t;
inline constexpr IntervalBound kCriticalValue = 0, kBox = ~IntervalBound{0};

/// A critical value. `below` and `above` are slices just below and just above it.
struct CriticalValue {
  double at;
  bool root;  ///< the measure or its derivative can have a square-root singularity there
  Slice below, above;
  bool is_box = false;
  double missed_error = 0;  ///< error that a discontinuity of the measure indicates
};

/// An interval of an outer coordinate in which the type is constant.
struct SmoothInterval {
  Subinterval<double> piece;
  Slice below, above;  ///< just inside its endpoints
  IntervalBound lower = kCriticalValue, upper = kCriticalValue;
  double beyond_lower = 0, beyond_upper = 0;  ///< measures of slices just outside its endpoints
  std::array<double, NestedRule::kNodes> at{}, weight{};
  double value = 0, error = 0;
  double irreducible_error = 0;  ///< error that subdivision cannot reduce
  double missed_at_ends =
      0;  ///< error of the polynomial through the nodes at the endpoints, if derivatives will be computed
  int one_sided_bisections = 0;  ///< consecutive bisections that left nearly all of a change in this half
  std::size_t kept = 0;          ///< index in IntegralScratch::kept of the entry of its first node
};

inline constexpr int kMaxDepth = 10;        ///< depth of subdivision
inline constexpr int kSamplesOfLines = 64;  ///< samples of the outermost coordinate, if slices are lines
inline constexpr double kClearDistance =
    1e-11;  ///< relative to the range: distance from a critical value at which types are reliable
inline constexpr double kDiscontinuity =
    1e-7;  ///< relative to the largest slice: larger differences are not rounding errors

/// Scratch memory of NestedIntegral.
struct IntegralScratch {
  struct Level {
    std::vector<SmoothInterval> parts;
    std::array<std::vector<CriticalValue>, kMaxDepth + 1>
        critical_values;  ///< critical values of the range, and of intervals by their depth
    double at = 0;        ///< current value of the coordinate
    /// Intervals of this coordinate at values of the next outer one, in ascending order.
    struct ExpectedIntervals {
      double outside;
      std::vector<std::array<double, 2>> parts;
    };
    std::vector<ExpectedIntervals> seen;
    std::size_t seen_count = 0;    ///< elements of `seen` in use
    std::vector<double> hints;     ///< where components are expected
    std::vector<double> places;    ///< abscissas of the first samples
    std::vector<Slice> scanned;    ///< slices at these samples
    double largest = 0;            ///< largest measure so far
    double irreducible_error = 0;  ///< error of intervals that are not subdivided further
    CriticalValueSolver solver;    ///< for the critical value being bracketed
    BoundaryFeatures features;     ///< features of the last slice
  };
  PlanarSliceScratch planar_slice;
  ColumnScratch column;
  SearchScratch search;
  std::vector<double> registers, adjoints;
  std::vector<double> own;         ///< derivatives of one constraint with respect to the registers
  std::vector<double> univariate;  ///< registers of SlicePlan::univariate
  SignChangeScratch changes;       ///< sign changes of its constraints along the first coordinate
  std::vector<double> ends;        ///< the sorted abscissas of these changes, and the ends of the range
  expression::Rows rows;           ///< registers of several lines, for SIMD batches
  std::vector<Dual4> dual_registers,
      along;  ///< registers with derivatives with respect to the design, and to an outer coordinate
  std::vector<Level> levels;
  bool has_hints = false;     ///< boxes of the component search provide samples of the inner coordinates
  bool is_scanning = false;   ///< the outermost coordinate is being sampled
  bool measured = false;      ///< the measure is complete: further slices change nothing
  bool for_gradient = false;  ///< derivatives will be computed
  /// If derivatives will be computed and there are two outer coordinates: intervals of the inner one at the nodes of
  /// the outermost one.
  std::vector<std::vector<SmoothInterval>> kept;
  std::unique_ptr<IntegralScratch> other;  ///< for the other side of a critical value
  long evaluations = 0;
  long max_evaluations = 0;  ///< limit, after which the search for critical values ends; undecided parts count as error
};

class NestedIntegral {
 public:
  /// @param tolerance  relative
  NestedIntegral(SlicePlan plan, double tolerance);

  const SlicePlan& plan() const {
    return std::visit([](const auto& each) -> const SlicePlan& { return each.plan(); }, innermost_);
  }
  /// Limits of the work. When one is reached, undecided parts of the workspace count as error.
  struct Budget {
    long evaluations = 0;             ///< evaluations of slices; 0: a limit that is rarely reached
    long operations = 1'000'000'000;  ///< interval operations for transcendental constraints: about ten seconds
  };
  /// @param inputs  values of the graph's inputs, including the fixed coordinates
  Integral<double> measure(std::span<const double> inputs, IntegralScratch& scratch, const Budget& budget) const;
  Integral<double> measure(std::span<const double> inputs, IntegralScratch& scratch) const {
    return measure(inputs, scratch, Budget{});
  }
  /// measure() with critical values that are accurate enough for derivatives, and with intermediate results for
  /// add_gradient().
  Integral<double> measure_for_gradient(std::span<const double> inputs, IntegralScratch& scratch) const;
  /// Adds the derivatives of the measure with respect to the inputs of the graph, after measure_for_gradient().
  void add_gradient(std::span<double> by_input, IntegralScratch& scratch) const;
  /// Calls visit(outer coordinates, v, z, weight) at quadrature nodes inside the columns, after measure(). S is double
  /// or Dual4: nodes are functions of the design, so that sums over them have derivatives.
  template <class S, class Visit>
  void for_each_node(std::span<const S> inputs, const GaussRule& outer, const GaussRule& inner,
                     IntegralScratch& scratch, const Visit& visit) const {
    if constexpr (Derivative<S>) start_dual(inputs, scratch);
    std::vector<S> place;
    visit_nodes(0, S(1.0), outer, inner, place, scratch, visit);
  }

 private:
  using CriticalValues = std::vector<CriticalValue>;

  std::size_t levels() const { return plan().order.outer.size(); }
  bool ends_in_lines() const { return std::holds_alternative<Column>(innermost_); }
  Integral<double> measure_all(std::span<const double> inputs, IntegralScratch& scratch, const Budget& budget) const;
  void set(std::size_t level, double at, IntegralScratch& scratch) const;
  /// Whether the budget is used up. Parts of the workspace that are undecided by then count as error.
  bool is_exhausted(const IntegralScratch& scratch) const;
  /// Finds all sign changes of constraints along the first coordinate. @return upper bound of the part of the measure
  /// that sign changes which remain unknown can affect
  double find_univariate_changes(std::span<const double> inputs, IntegralScratch& scratch) const;
  /// The measure over the coordinates from `level` on, with the coordinates before `level` set.
  Slice inside(std::size_t level, IntegralScratch& scratch) const;
  /// Sets the coordinate of `level`. @return the slice there
  Slice slice(std::size_t level, double at, IntegralScratch& scratch) const;
  /// The slice at a value of the coordinate of `level` that is set already.
  Slice set_slice(std::size_t level, double at, IntegralScratch& scratch) const;
  /// Computes the slices at several values of the coordinate of `level`.
  void find_slices(std::size_t level, std::span<const double> places, std::span<Slice> slices,
                   IntegralScratch& scratch) const;
  void choose_samples(std::size_t level, double low, double high, IntegralScratch& scratch) const;
  static void add_samples_between_changes(double low, double high, IntegralScratch& scratch);
  static void add_expected_samples(double outside, IntegralScratch::Level& own);
  static void record_intervals(double outside, IntegralScratch::Level& own);
  Slice integrate(std::size_t level, IntegralScratch& scratch) const;
  bool is_discontinuous(const Slice& low, const Slice& high, std::size_t level, const IntegralScratch& scratch) const;
  void search_empty_gaps(IntegralScratch& scratch) const;
  void search_sparse_components(IntegralScratch& scratch) const;
  void refine_support(IntegralScratch& scratch) const;
  void add_hints(double at, IntegralScratch& scratch) const;
  void resample_changes(std::size_t level, IntegralScratch& scratch) const;
  void find_critical_values(std::size_t level, Slice from, Slice& to, double whole, CriticalValues& critical_values,
                            IntegralScratch& scratch) const;
  /// Finds the boundary features of the last slice.
  void find_features(std::size_t level, BoundaryFeatures& features, const IntegralScratch& scratch) const;
  /// Brackets a critical value between two slices of different type. @param extrapolates  false: by bisection only
  void bracket(std::size_t level, Slice& low, Slice& high, double whole, bool extrapolates,
               IntegralScratch& scratch) const;
  void add_intervals(std::size_t level, const CriticalValues& critical_values, double whole, int depth,
                     IntegralScratch& scratch) const;
  void add_interval(std::size_t level, SmoothInterval part, double whole, int depth, IntegralScratch& scratch) const;
  void refine(std::size_t level, double whole, IntegralScratch& scratch) const;

  void add_gradient(std::size_t level, double factor, IntegralScratch& scratch) const;
  void add_side(std::size_t level, const SmoothInterval& part, bool upper, double factor,
                IntegralScratch& scratch) const;
  double slope_of_independent(std::size_t level, IntervalBound closing, double at, IntegralScratch& scratch) const;

  struct OneSided;
  /// visit(weight, slope): weight of a point, and derivative with respect to the coordinate of the constraint that the
  /// point violates beyond the critical value. scratch.own has its derivatives with respect to the registers.
  using OneSidedVisitor = std::function<void(double, double)>;
  static bool may_jump(std::size_t level, const SmoothInterval& part, bool upper, const IntegralScratch& scratch);
  /// Visits quadrature nodes in the set that is feasible on one side of an endpoint only, if the measure is
  /// discontinuous there. @param side  1: above the endpoint, -1: below it
  void visit_one_sided(std::size_t level, const SmoothInterval& part, bool upper, double side, IntegralScratch& scratch,
                       const OneSidedVisitor& visit) const;
  /// The part of a discontinuity due to points that violate no constraint on the other side.
  double unexplained_jump(std::size_t level, const CriticalValue& at, IntegralScratch& scratch) const;
  void visit_one_sided(std::size_t level, double weight, bool in_is_empty, bool out_is_empty,
                       const OneSided& one_sided_points) const;
  void visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                     const OneSided& one_sided_points) const;
  double slope_of_violated(double v, double z, const OneSided& one_sided_points) const;

  void start_dual(std::span<const Dual4> inputs, IntegralScratch& scratch) const;
  void set_dual(std::size_t level, const Dual4& at, IntegralScratch& scratch) const;
  /// The intervals before bisection, so that sums over nodes are continuous functions of the design.
  static std::vector<SmoothInterval> merged_intervals(std::size_t level, const IntegralScratch& scratch);
  /// @param below  upper endpoint of the previous interval; null if there is none
  Subinterval<Dual4> differentiable_piece(std::size_t level, const SmoothInterval& part, const Dual4* below,
                                          IntegralScratch& scratch) const;
  Dual4 differentiable_end(std::size_t level, const SmoothInterval& part, bool upper, IntegralScratch& scratch) const;

  /// Calls visit(outer coordinates, v, z, weight) at the quadrature nodes of the coordinates from `level` on; to be
  /// called after inside(level).
  template <class S, class Visit>
  void visit_nodes(std::size_t level, const S& weight, const GaussRule& outer, const GaussRule& inner,
                   std::vector<S>& place, IntegralScratch& scratch, const Visit& visit) const {
    if (level == levels()) {
      if (const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_)) {
        const auto ends = [&] {
          if constexpr (Derivative<S>)
            return PlanarSliceSensitivity(*planar_slice, scratch.planar_slice, scratch.dual_registers,
                                          scratch.registers);
          else
            return PlanarSliceValues{scratch.planar_slice};
        }();
        planar_slice->for_each_node(outer, inner, scratch.planar_slice, ends,
                                    [&](const S& v, const S& z, const S& own) { visit(place, v, z, weight * own); });
      } else {
        const Column& column = std::get<Column>(innermost_);
        const auto end_of = [&](const std::pair<double, EndLabel>& end) -> S {
          if constexpr (Derivative<S>)
            return column.differentiable_end(end, scratch.dual_registers);
          else
            return end.first;
        };
        column.for_each_node<S>(inner, scratch.column, end_of,
                                [&](const S& z, const S& own) { visit(place, S(0), z, weight * own); });
      }
      return;
    }
    Subinterval<S> piece;
    const S* below = nullptr;
    for (const SmoothInterval& part : merged_intervals(level, scratch)) {
      if constexpr (Derivative<S>)
        piece = differentiable_piece(level, part, below, scratch);
      else
        piece = part.piece;
      below = &piece.upper;
      pkm::visit_nodes(piece, outer, [&](const S& at, const S& jacobian, double own) {
        slice(level, value_of(at), scratch);
        if constexpr (Derivative<S>) set_dual(level, at, scratch);
        place.push_back(at);
        visit_nodes<S>(level + 1, weight * jacobian * own, outer, inner, place, scratch, visit);
        place.pop_back();
      });
    }
  }

  std::variant<PlanarSlice, Column> innermost_;
  std::optional<expression::BatchStage>
      lines_;                                  ///< if slices are lines: the operations that differ from one to the next
  std::vector<std::uint32_t> line_registers_;  ///< registers of this stage that Column reads
  std::vector<WithDerivative> univariate_;     ///< registers of SlicePlan::univariate
  double tolerance_;
};

}  // namespace pkm::generic
