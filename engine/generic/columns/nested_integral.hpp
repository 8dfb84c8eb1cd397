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

/// The slice at the value `at` of an outer coordinate: its measure, i.e. its area or length or the integral of these
/// over the coordinates in between, the error of the measure, and the type of the slice.
struct Slice {
  double at = 0, measure = 0, error = 0;
  SliceType hash = 0;  ///< hash value of the type of the slice; 0 if the slice is empty
  /// 1 + index of a constraint that is independent of the inner coordinates and violated in the slice; 0 if there is no
  /// such constraint.
  std::uint32_t violated = 0;
};

/// The kind of an endpoint of an integration interval: kCriticalValue; kBox, a bound of the search box; or 1 + the
/// index of the independent constraint that is violated beyond the endpoint.
using IntervalBound = std::uint32_t;
inline constexpr IntervalBound kCriticalValue = 0, kBox = ~IntervalBound{0};

/// A value `at` of an outer coordinate at which the type of the slices changes, with the slices just below and just
/// above it.
struct CriticalValue {
  double at;
  bool root;  ///< true: the measure or its derivative can have a square-root singularity at this value
  Slice below, above;
  bool is_box = false;
  /// Estimated error of the integral because a component may have been missed on one side, if the measure is
  /// discontinuous at this critical value; otherwise 0.
  double missed_error = 0;
};

/// An interval of an outer coordinate in which the type of the slices is constant, with its quadrature nodes and
/// integral.
struct SmoothInterval {
  Subinterval<double> piece;
  Slice below, above;  ///< slices just inside the lower and the upper endpoint of the interval
  IntervalBound lower = kCriticalValue, upper = kCriticalValue;
  /// Measures of the slices just outside the lower and the upper endpoint of the interval.
  double beyond_lower = 0, beyond_upper = 0;
  std::array<double, NestedRule::kNodes> at{}, weight{};
  double value = 0, error = 0;
  double irreducible_error = 0;  ///< part of the error of the integral that subdivision of the interval cannot reduce
  /// Error, at the endpoints of the interval, of the polynomial through the measures at the nodes; computed only if
  /// derivatives will be computed.
  double missed_at_ends = 0;
  /// Number of consecutive bisections, the last of which made this interval, in which one of the two halves contained
  /// nearly all of the change of the measure.
  int one_sided_bisections = 0;
  /// Index in IntegralScratch::kept of the list of intervals of the other outer coordinate at the first node of this
  /// interval; the lists at its other nodes follow.
  std::size_t kept = 0;
};

inline constexpr int kMaxDepth = 10;        ///< maximum depth of the recursive subdivision at critical values
inline constexpr int kSamplesOfLines = 64;  ///< number of samples of the outermost coordinate if the slices are lines
/// Distance from a critical value at which rounding errors do not affect the type, relative to the range of the
/// coordinate.
inline constexpr double kClearDistance = 1e-11;
/// A larger difference of two measures, relative to the largest slice, is not due to rounding errors.
inline constexpr double kDiscontinuity = 1e-7;

/// Scratch memory of NestedIntegral.
struct IntegralScratch {
  struct Level {
    std::vector<SmoothInterval> parts;
    /// Critical values: [0] those in the whole range of the coordinate; [d] those in an interval at depth d of the
    /// subdivision.
    std::array<std::vector<CriticalValue>, kMaxDepth + 1> critical_values;
    double at = 0;  ///< current value of this outer coordinate
    /// Intervals of this coordinate with non-empty slices, in ascending order, that were found at a value `outside` of
    /// the next outer coordinate.
    struct ExpectedIntervals {
      double outside;
      std::vector<std::array<double, 2>> parts;
    };
    std::vector<ExpectedIntervals> seen;
    std::size_t seen_count = 0;    ///< number of elements of `seen` that are in use
    std::vector<double> hints;     ///< values of this coordinate at which the component search expects feasible points
    std::vector<double> places;    ///< values of this coordinate at which the first slices are evaluated
    std::vector<Slice> scanned;    ///< slices at the coordinate values in `places`
    double largest = 0;            ///< largest measure of all slices at values of this outer coordinate so far
    double irreducible_error = 0;  ///< sum of those errors of intervals that further subdivision cannot reduce
    CriticalValueSolver solver;    ///< extrapolates the critical value that is being located
    BoundaryFeatures features;     ///< boundary features of the slice of this outer coordinate that was evaluated last
  };
  PlanarSliceScratch planar_slice;
  ColumnScratch column;
  SearchScratch search;
  std::vector<double> registers, adjoints;
  std::vector<double> own;         ///< derivatives of a single constraint with respect to the registers
  std::vector<double> univariate;  ///< values of the registers of the program SlicePlan::univariate
  SignChangeScratch changes;       ///< sign changes found by find_univariate_changes()
  /// Values of the first coordinate at the sign changes in `changes` and at the ends of its range, in ascending order.
  std::vector<double> ends;
  expression::Rows rows;  ///< values of the registers of NestedIntegral::lines_, for several lines at once
  /// Values of the registers with their derivatives with respect to the design, and (`along`) to an outer coordinate.
  std::vector<Dual4> dual_registers, along;
  std::vector<Level> levels;
  bool has_hints = false;     ///< true: boxes of the component search provide samples of the inner coordinates
  bool is_scanning = false;   ///< true: the outermost coordinate is still being sampled to find critical values
  bool measured = false;      ///< true: the measure has been computed, and later slices do not change it
  bool for_gradient = false;  ///< true: derivatives will be computed after this measure
  /// If derivatives will be computed and there are two outer coordinates: for nodes of the outermost coordinate, the
  /// intervals of the other outer coordinate.
  std::vector<std::vector<SmoothInterval>> kept;
  std::unique_ptr<IntegralScratch> other;  ///< scratch memory for slices on the opposite side of a critical value
  long evaluations = 0;
  /// When `evaluations` reaches this limit, the search for critical values ends, and undecided parts count as error.
  long max_evaluations = 0;
};

class NestedIntegral {
 public:
  /// @param tolerance  relative error of the integral that is accepted
  NestedIntegral(SlicePlan plan, double tolerance);

  const SlicePlan& plan() const {
    return std::visit([](const auto& each) -> const SlicePlan& { return each.plan(); }, innermost_);
  }
  /// Limits of the work. When one is reached, undecided parts of the workspace count as error.
  struct Budget {
    long evaluations = 0;             ///< maximum number of evaluated slices; 0: a default limit that is rarely reached
    long operations = 1'000'000'000;  ///< interval operations for transcendental constraints: about ten seconds
  };
  /// Volume of the workspace with an estimate of its error.
  /// @param inputs  values of the graph's inputs, including the fixed coordinates
  Integral<double> measure(std::span<const double> inputs, IntegralScratch& scratch, const Budget& budget) const;
  Integral<double> measure(std::span<const double> inputs, IntegralScratch& scratch) const {
    return measure(inputs, scratch, Budget{});
  }
  /// The number of interval operations that the slice in the middle of the range of the outermost coordinate takes; if
  /// they exceed `limit`, little more than `limit`. At least one coordinate must be outer.
  long operations_of_middle_slice(std::span<const double> inputs, IntegralScratch& scratch, long limit) const;
  /// Volume of the workspace with an estimate of its error. Locates critical values accurately enough for derivatives,
  /// and keeps the intermediate results that add_gradient() needs.
  Integral<double> measure_for_gradient(std::span<const double> inputs, IntegralScratch& scratch) const;
  /// Adds the derivatives of the measure with respect to the graph's inputs to by_input; to be called after
  /// measure_for_gradient().
  void add_gradient(std::span<double> by_input, IntegralScratch& scratch) const;
  /// Prepares for_each_node() without a measure, if there is one outer coordinate and all of its critical values are
  /// known to about 1e-6 of its range.
  /// @param critical_values  in ascending order; values at which the type of the slice does not change are ignored
  void place_nodes(std::span<const double> inputs, std::span<const double> critical_values,
                   IntegralScratch& scratch) const;
  /// Calls visit(outer coordinates, v, z, weight) at quadrature nodes inside the columns, after measure() or
  /// place_nodes(). S is double or Dual4: nodes are functions of the design, so that sums over them have derivatives.
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
  void start(std::span<const double> inputs, IntegralScratch& scratch, const Budget& budget) const;
  void set(std::size_t level, double at, IntegralScratch& scratch) const;
  /// Whether the budget is used up. Parts of the workspace that are undecided at that time count as error.
  bool is_exhausted(const IntegralScratch& scratch) const;
  /// Finds all sign changes of the constraints in SlicePlan::univariate along the first coordinate: the outermost one,
  /// or v if there is none.
  /// @return upper bound of the volume that is uncertain because sign changes may not have been found
  double find_univariate_changes(std::span<const double> inputs, IntegralScratch& scratch) const;
  /// The slice that is the integral over the coordinates from `level` on, for the current values of the preceding
  /// coordinates.
  Slice inside(std::size_t level, IntegralScratch& scratch) const;
  /// Sets the coordinate of `level` to `at`. @return the slice at this value of the coordinate
  Slice slice(std::size_t level, double at, IntegralScratch& scratch) const;
  /// Returns the slice at the value `at` of the coordinate of `level`, which set() has set to this value already.
  Slice set_slice(std::size_t level, double at, IntegralScratch& scratch) const;
  /// Computes the slices at the values `places` of the coordinate of `level`.
  void find_slices(std::size_t level, std::span<const double> places, std::span<Slice> slices,
                   IntegralScratch& scratch) const;
  void choose_samples(std::size_t level, double low, double high, IntegralScratch& scratch) const;
  static void add_samples_between_changes(double low, double high, IntegralScratch& scratch);
  static void add_expected_samples(double outside, IntegralScratch::Level& own);
  static void record_intervals(double outside, IntegralScratch::Level& own);
  Slice integrate(std::size_t level, IntegralScratch& scratch) const;
  void place_intervals(std::span<const double> values, IntegralScratch& scratch) const;
  void find_all_critical_values(std::size_t level, double low, double high, CriticalValues& critical_values,
                                IntegralScratch& scratch) const;
  bool is_discontinuous(const Slice& low, const Slice& high, std::size_t level, const IntegralScratch& scratch) const;
  void search_empty_gaps(IntegralScratch& scratch) const;
  void search_sparse_components(IntegralScratch& scratch) const;
  void refine_support(IntegralScratch& scratch) const;
  void add_hints(double at, IntegralScratch& scratch) const;
  void resample_changes(std::size_t level, IntegralScratch& scratch) const;
  void find_critical_values(std::size_t level, Slice from, Slice& to, double whole, CriticalValues& critical_values,
                            IntegralScratch& scratch) const;
  /// Finds the boundary features of the slice of `level` that was computed last.
  void find_features(std::size_t level, BoundaryFeatures& features, const IntegralScratch& scratch) const;
  /// Narrows the interval between two slices, `low` and `high`, of different type around a critical value.
  /// @param whole         length of the range of the coordinate
  /// @param extrapolates  true: extrapolate the critical value from boundary features; false: bisect only
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
  /// Function visit(weight, slope), which is called for quadrature points that are feasible on one side of a critical
  /// value and violate a constraint on the other side. weight: weight of the point; slope: derivative of this
  /// constraint with respect to the coordinate. scratch.own has the derivatives of the constraint with respect to the
  /// registers.
  using OneSidedVisitor = std::function<void(double, double)>;
  static bool may_jump(std::size_t level, const SmoothInterval& part, bool upper, const IntegralScratch& scratch);
  /// If the measure is discontinuous at the lower or upper endpoint of an interval, visits quadrature nodes in the set
  /// of points that are feasible on one side of this endpoint only.
  /// @param side  1: points that are feasible above the endpoint; -1: below it
  void visit_one_sided(std::size_t level, const SmoothInterval& part, bool upper, double side, IntegralScratch& scratch,
                       const OneSidedVisitor& visit) const;
  /// The part of a discontinuity of the measure at a critical value that no violated constraint explains: it is due to
  /// points that are feasible on one side and violate no constraint on the other side.
  double unexplained_jump(std::size_t level, const CriticalValue& at, IntegralScratch& scratch) const;
  void visit_one_sided(std::size_t level, double weight, bool in_is_empty, bool out_is_empty,
                       const OneSided& one_sided_points) const;
  void visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                     const OneSided& one_sided_points) const;
  double slope_of_violated(double v, double z, const OneSided& one_sided_points) const;

  void start_dual(std::span<const Dual4> inputs, IntegralScratch& scratch) const;
  void set_dual(std::size_t level, const Dual4& at, IntegralScratch& scratch) const;
  /// The intervals of a level, where those that originate from bisection of one interval are merged again. Their
  /// endpoints, and thus sums over their nodes, are continuous functions of the design.
  static std::vector<SmoothInterval> merged_intervals(std::size_t level, const IntegralScratch& scratch);
  /// An interval whose endpoints have derivatives with respect to the design.
  /// @param below  upper endpoint of the previous interval; null for the first interval
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
  /// Those operations of the program that differ from one line to the next, for batches of lines; std::nullopt if the
  /// slices are planar.
  std::optional<expression::BatchStage> lines_;
  std::vector<std::uint32_t> line_registers_;  ///< registers of `lines_` that Column reads
  /// Registers of the values and derivatives of the constraints in SlicePlan::univariate.
  std::vector<WithDerivative> univariate_;
  double tolerance_;
};

}  // namespace pkm::generic
