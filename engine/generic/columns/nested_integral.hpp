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

/// The slice at the value `at` of an outer coordinate: its measure (area or length), the error of the measure, and its
/// type.
struct Slice {
  double at = 0, measure = 0, error = 0;
  SliceType hash = 0;  ///< type of the slice; 0 if it is empty
  /// 1 + index of the independent constraint that is violated; 0 if the slice is not empty, or empty for another
  /// reason.
  std::uint32_t violated = 0;
};

/// Bound of an integration interval: kCriticalValue, kBox (a bound of the search box), or 1 + the index of an
/// independent constraint.
using IntervalBound = std::uint32_t;
inline constexpr IntervalBound kCriticalValue = 0, kBox = ~IntervalBound{0};

/// A critical value `at` of an outer coordinate, with the slices just below and just above it.
struct CriticalValue {
  double at;
  bool root;  ///< true: the measure or its derivative can have a square-root singularity there
  Slice below, above;
  bool is_box = false;
  /// Estimated error of the integral if the measure is discontinuous, because a component may have been missed;
  /// otherwise 0.
  double missed_error = 0;
};

/// An interval of an outer coordinate in which the type is constant.
struct SmoothInterval {
  Subinterval<double> piece;
  Slice below, above;  ///< slices just inside the lower and the upper endpoint
  IntervalBound lower = kCriticalValue, upper = kCriticalValue;
  double beyond_lower = 0, beyond_upper = 0;  ///< measures of the slices just outside the lower and the upper endpoint
  std::array<double, NestedRule::kNodes> at{}, weight{};
  double value = 0, error = 0;
  double irreducible_error = 0;  ///< error that subdivision cannot reduce
  /// Error at the endpoints of the polynomial through the nodes; computed only if derivatives will be computed.
  double missed_at_ends = 0;
  /// Number of consecutive bisections that left nearly all of a change of the measure in this half.
  int one_sided_bisections = 0;
  std::size_t kept = 0;  ///< index in IntegralScratch::kept of the entry that belongs to the first node
};

inline constexpr int kMaxDepth = 10;        ///< maximum depth of the recursive subdivision at critical values
inline constexpr int kSamplesOfLines = 64;  ///< number of samples of the outermost coordinate if slices are lines
/// Relative to the range of the coordinate: distance from a critical value at which the type is reliable.
inline constexpr double kClearDistance = 1e-11;
/// Relative to the largest slice: larger differences of two measures are not rounding errors.
inline constexpr double kDiscontinuity = 1e-7;

/// Scratch memory of NestedIntegral.
struct IntegralScratch {
  struct Level {
    std::vector<SmoothInterval> parts;
    /// Critical values of the whole range [0], and of intervals at each depth of the subdivision.
    std::array<std::vector<CriticalValue>, kMaxDepth + 1> critical_values;
    double at = 0;  ///< current value of the coordinate of this level
    /// Intervals that were found in this coordinate at one value `outside` of the next outer coordinate, in ascending
    /// order.
    struct ExpectedIntervals {
      double outside;
      std::vector<std::array<double, 2>> parts;
    };
    std::vector<ExpectedIntervals> seen;
    std::size_t seen_count = 0;    ///< number of elements of `seen` that are in use
    std::vector<double> hints;     ///< values of the coordinate at which components are expected
    std::vector<double> places;    ///< values of the coordinate for the first samples
    std::vector<Slice> scanned;    ///< slices at the first samples
    double largest = 0;            ///< largest measure of a slice of this level so far
    double irreducible_error = 0;  ///< sum of the errors of intervals that are not subdivided further
    CriticalValueSolver solver;    ///< extrapolates the critical value that is being bracketed
    BoundaryFeatures features;     ///< boundary features of the last slice
  };
  PlanarSliceScratch planar_slice;
  ColumnScratch column;
  SearchScratch search;
  std::vector<double> registers, adjoints;
  std::vector<double> own;         ///< derivatives of one constraint with respect to the registers
  std::vector<double> univariate;  ///< registers of SlicePlan::univariate
  SignChangeScratch changes;  ///< sign changes of the constraints in SlicePlan::univariate, along the first coordinate
  std::vector<double> ends;   ///< coordinates of these sign changes and of the ends of the range, in ascending order
  expression::Rows rows;      ///< rows of `lines_`, which evaluates several lines in one SIMD batch
  /// Registers with derivatives: with respect to the design, and with respect to an outer coordinate.
  std::vector<Dual4> dual_registers, along;
  std::vector<Level> levels;
  bool has_hints = false;     ///< true: boxes of the component search provide samples of the inner coordinates
  bool is_scanning = false;   ///< true: the outermost coordinate is being sampled, not yet integrated over
  bool measured = false;      ///< true: the measure is complete, and further slices do not change it
  bool for_gradient = false;  ///< true: derivatives will be computed after this measure
  /// If derivatives will be computed and there are two outer coordinates: intervals of the inner one at the nodes of
  /// the outermost one.
  std::vector<std::vector<SmoothInterval>> kept;
  std::unique_ptr<IntegralScratch> other;  ///< scratch memory for slices on the opposite side of a critical value
  long evaluations = 0;
  /// Limit of `evaluations`, beyond which the search for critical values ends and undecided parts count as error.
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
  /// Finds all sign changes of the constraints in SlicePlan::univariate along the first coordinate.
  /// @return upper bound of the measure that sign changes which were not found can affect
  double find_univariate_changes(std::span<const double> inputs, IntegralScratch& scratch) const;
  /// The integral over the coordinates from `level` on, for the current values of the coordinates before `level`.
  Slice inside(std::size_t level, IntegralScratch& scratch) const;
  /// Sets the coordinate of `level` to `at`. @return the slice at this value
  Slice slice(std::size_t level, double at, IntegralScratch& scratch) const;
  /// The slice at the value `at` of the coordinate of `level`, which has been set to it already.
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
  /// Finds the boundary features of the slice of `level` that was computed last.
  void find_features(std::size_t level, BoundaryFeatures& features, const IntegralScratch& scratch) const;
  /// Brackets a critical value between two slices of different type.
  /// @param extrapolates  true: extrapolate from boundary features; false: bisect only
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
  /// visit(weight, slope), called for a point that violates a constraint beyond the critical value: weight of the
  /// point, and derivative of this constraint with respect to the coordinate. scratch.own has its derivatives with
  /// respect to the registers.
  using OneSidedVisitor = std::function<void(double, double)>;
  static bool may_jump(std::size_t level, const SmoothInterval& part, bool upper, const IntegralScratch& scratch);
  /// If the measure is discontinuous at an endpoint of an interval, visits quadrature nodes in the set of points that
  /// are feasible on one side of this endpoint only.
  /// @param side  1: feasible above the endpoint; -1: feasible below it
  void visit_one_sided(std::size_t level, const SmoothInterval& part, bool upper, double side, IntegralScratch& scratch,
                       const OneSidedVisitor& visit) const;
  /// The part of a discontinuity of the measure that points cause for which no constraint is violated on the opposite
  /// side.
  double unexplained_jump(std::size_t level, const CriticalValue& at, IntegralScratch& scratch) const;
  void visit_one_sided(std::size_t level, double weight, bool in_is_empty, bool out_is_empty,
                       const OneSided& one_sided_points) const;
  void visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                     const OneSided& one_sided_points) const;
  double slope_of_violated(double v, double z, const OneSided& one_sided_points) const;

  void start_dual(std::span<const Dual4> inputs, IntegralScratch& scratch) const;
  void set_dual(std::size_t level, const Dual4& at, IntegralScratch& scratch) const;
  /// The intervals before they were bisected; their endpoints, and thus sums over nodes, are continuous functions of
  /// the design.
  static std::vector<SmoothInterval> merged_intervals(std::size_t level, const IntegralScratch& scratch);
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
  /// The operations that differ from one line to the next, for batches of lines; absent if slices are planar.
  std::optional<expression::BatchStage> lines_;
  std::vector<std::uint32_t> line_registers_;  ///< registers of this batch stage that Column reads
  /// Registers of the constraints in SlicePlan::univariate and of their derivatives.
  std::vector<WithDerivative> univariate_;
  double tolerance_;
};

}  // namespace pkm::generic
