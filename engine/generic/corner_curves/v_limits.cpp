#include "engine/generic/corner_curves/v_limits.hpp"

#include <algorithm>

#include "engine/math/roots.hpp"

namespace pkm::generic::corner_curves {
namespace {

using Cell = LimitScratch::Cell;
using Search = LimitScratch::Search;

constexpr int kMaxBisections = 8;  // maximum number of successive bisections of the range of v
// Number of bisections before the sign of the curvature is used, because the limit is often monotone in a shorter
// subinterval.
constexpr int kBisectionsBeforeCurvature = 3;

int sign_of(const Interval& x) { return x.lower > 0 ? 1 : x.upper < 0 ? -1 : 0; }

class LimitRootFinder {
 public:
  LimitRootFinder(const SlicePlan& plan, const Subinterval<double>& outer, const std::array<Samples, 2>& v,
                  LimitScratch& s)
      : plan_(plan), program_(plan.limits), outer_(outer), s_(s) {
    low_ = *std::ranges::min_element(v[0]);
    high_ = *std::ranges::max_element(v[1]);
  }

  LimitState run() {
    s_.roots.clear();
    s_.folds.clear();
    s_.searches.clear();
    for (const auto& input : program_.stages()[1].inputs) s_.intervals[input.to] = Interval(outer_.lower, outer_.upper);
    program_.run<Interval>(1, std::span(s_.intervals));
    s_.signs.clear();
    for (const std::size_t limit : s_.active) {
      s_.cells.clear();
      if (!bisect(limit, end_of_search(limit, low_, low_ - high_), end_of_search(limit, high_, high_ - low_), 0) ||
          !add_searches(limit))
        return LimitState::unresolved;
    }
    for (std::size_t n = 0; n < kNodes && !s_.searches.empty(); ++n) {
      evaluate_limits_at_t(plan_, map_node(outer_, 0.5 * (1 + chebyshev_nodes()[n])).point, s_);
      for (Search& search : s_.searches) solve(search, n);
    }
    for (const Search& search : s_.searches)
      if (!add_roots(search)) return LimitState::unresolved;
    if (!s_.folds.empty()) return LimitState::divided;
    for (std::size_t i = 0; i < s_.active.size(); ++i)
      if (s_.signs[i] <= 0 && std::ranges::find(s_.roots, s_.active[i], &LimitRoot::limit) == s_.roots.end())
        return LimitState::violated;
    return LimitState::resolved;
  }

 private:
  std::uint32_t at(std::size_t limit, std::size_t derivative) const {
    return program_.outputs()[3 * limit + derivative];
  }
  /// The value of v at which the search for roots ends, slightly beyond the end `end` of the range of v, because in a
  /// segment of t a root may leave the range. If possible, the sign of the limit is certified there, so that no root
  /// passes this value.
  /// @param outwards  vector from the opposite end of the range to `end`
  double end_of_search(std::size_t limit, double end, double outwards) {
    for (const double margin : {0.03, 0.05, 0.08, 0.3, 0.6})
      if (sign_beside(cell_of(limit, end + margin * outwards, end + margin * outwards)) != 0)
        return end + margin * outwards;
    return end;
  }
  Cell cell_of(std::size_t limit, double lower, double upper) {
    for (const auto& input : program_.stages()[2].inputs) s_.intervals[input.to] = Interval(lower, upper);
    program_.run<Interval>(2, std::span(s_.intervals));
    const Interval& f = s_.intervals[at(limit, 0)];
    Cell cell{lower, upper, 0, 0, 0, f.is_empty()};
    cell.sign = f.lower >= 0 ? 1 : f.is_certified_violated() ? -1 : 0;
    if (cell.sign == 0 && f.is_continuous()) {
      cell.slope = sign_of(s_.intervals[at(limit, 1)]);
      cell.curvature = sign_of(s_.intervals[at(limit, 2)]);
    }
    return cell;
  }
  /// Bisects an interval of v recursively, and appends the subintervals to s_.cells.
  /// @return false if a subinterval that overlaps the range of v remains undecided
  bool bisect(std::size_t limit, double lower, double upper, int bisections) {
    const Cell cell = cell_of(limit, lower, upper);
    const bool is_decided =
        cell.sign != 0 || cell.slope != 0 || (cell.curvature != 0 && bisections >= kBisectionsBeforeCurvature);
    if (is_decided || bisections == kMaxBisections) {
      s_.cells.push_back(cell);
      return is_decided || upper < low_ || lower > high_;
    }
    const double middle = 0.5 * (lower + upper);
    return bisect(limit, lower, middle, bisections + 1) && bisect(limit, middle, upper, bisections + 1);
  }

  /// Finds the groups of adjacent cells that contain roots of a limit, and appends an element to s_.searches for each
  /// group.
  /// @return false if the number of roots is unknown
  bool add_searches(std::size_t limit) {
    const std::vector<Cell>& cells = s_.cells;
    // sign: sign of the limit above the cells considered so far; first_sign: first known sign in the range of v; 0:
    // unknown
    int sign = 0, first_sign = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].is_undefined) continue;
      if (cells[i].sign != 0) {
        if (sign != 0 && cells[i].sign != sign) return false;
        sign = cells[i].sign;
        if (first_sign == 0 && cells[i].upper >= low_ && cells[i].lower <= high_) first_sign = sign;
        continue;
      }
      const std::size_t first = i;
      int slope = cells[i].slope, curvature = cells[i].curvature;
      while (i + 1 < cells.size() && cells[i + 1].sign == 0) {
        ++i;
        if (cells[i].slope != slope) slope = 0;
        if (cells[i].curvature != curvature) curvature = 0;
      }
      const double lower = cells[first].lower, upper = cells[i].upper;
      sign = 0;
      if (upper < low_ || lower > high_) continue;
      int below = first > 0 ? sign_beside(cells[first - 1]) : cell_of(limit, lower, lower).sign,
          above = i + 1 < cells.size() ? sign_beside(cells[i + 1]) : cell_of(limit, upper, upper).sign;
      // A monotone limit whose root is an end of the range of v, apart from rounding errors, has one sign in the range.
      if (slope != 0 && above == 0 && below == -slope && is_root(limit, upper, lower)) above = below;
      if (slope != 0 && below == 0 && above == slope && is_root(limit, lower, upper)) below = above;
      if (below == 0 || above == 0 || (slope == 0 && curvature == 0)) return false;
      sign = above;
      if (first_sign == 0) first_sign = below;
      if (below == above && (slope != 0 || curvature != below)) continue;  // no root
      s_.searches.push_back({limit, lower, upper, below, below == above ? curvature : 0, 0, {}, {}, {}, true});
    }
    s_.signs.push_back(first_sign);
    return true;
  }
  /// Whether a limit is 0 at v apart from rounding errors, compared with its values at another v.
  bool is_root(std::size_t limit, double v, double other) {
    const auto value_at = [&](double place) {
      cell_of(limit, place, place);
      return s_.intervals[at(limit, 0)];
    };
    const Interval there = value_at(other), here = value_at(v);
    return std::fmax(-here.lower, here.upper) <= 1e-13 * std::fmax(-there.lower, there.upper);
  }
  static int sign_beside(const Cell& cell) { return cell.is_undefined ? 0 : cell.sign; }

  /// Computes the roots, and the extremum, of a limit in the interval of a search, at the Chebyshev node n.
  /// evaluate_limits_at_t() must have been called for this node.
  void solve(Search& search, std::size_t n) {
    const auto guess = [&](const Samples& v) { return n > 0 ? v[n - 1] : 0.5 * (search.lower + search.upper); };
    if (search.curvature == 0) {
      search.root[0][n] =
          root_of(search.limit, 0, search.lower, search.upper, search.sign_at_lower, guess(search.root[0]));
      return;
    }
    const auto slope_at = [&](double v) {
      evaluate_limits_at_v(plan_, v, s_);
      search.scale = std::max(search.scale, std::fabs(s_.registers[at(search.limit, 0)]));
      return s_.registers[at(search.limit, 1)] * search.curvature;
    };
    search.has_extremum = search.has_extremum && slope_at(search.lower) < 0 && slope_at(search.upper) > 0;
    if (!search.has_extremum) return;
    const double extremum =
        root_of(search.limit, 1, search.lower, search.upper, -search.curvature, guess(search.extremum));
    evaluate_limits_at_v(plan_, extremum, s_);
    search.extremum[n] = extremum;
    search.value_there[n] = s_.registers[at(search.limit, 0)];
    if (search.value_there[n] * search.curvature >= 0) return;
    search.root[0][n] = root_of(search.limit, 0, search.lower, extremum, search.sign_at_lower, search.lower);
    search.root[1][n] = root_of(search.limit, 0, extremum, search.upper, -search.sign_at_lower, search.upper);
  }

  /// A root along v of a limit (`derivative` = 0) or of its first derivative (1), by Newton's method with a bracket.
  /// @param sign_at_lower  sign of the function at `lower`
  /// @param v              start value of Newton's method
  double root_of(std::size_t limit, std::size_t derivative, double lower, double upper, int sign_at_lower, double v) {
    const auto limit_at = [&](double x) {
      evaluate_limits_at_v(plan_, x, s_);
      return ValueAndDerivative{s_.registers[at(limit, derivative)], s_.registers[at(limit, derivative + 1)]};
    };
    const auto converged = [](const ValueAndDerivative&, double x, double next) {
      return std::fabs(next - x) <= 2 * kUnitRoundoff * std::fabs(next);
    };
    return refine_root_newton(limit_at, lower, upper, sign_at_lower > 0, v, converged);
  }

  /// Refines the position of a fold near t by Newton's method. This is necessary because roots near a fold vary like
  /// the square root of the distance from it, so that they magnify an error of its position.
  LimitFold fold_near(const Search& search, double t) {
    double v = 0.5 * (search.lower + search.upper);
    const auto extremum = [&](double place) {
      evaluate_limits_at_t(plan_, place, s_);
      v = root_of(search.limit, 1, search.lower, search.upper, -search.curvature, v);
      evaluate_limits_at_v(plan_, v, s_);
      return s_.registers[at(search.limit, 0)];
    };
    const double step = 1e-4 * (outer_.upper - outer_.lower);
    const double by_t = (extremum(t + step) - extremum(t - step)) / (2 * step);
    for (int i = 0; i < 3; ++i) {
      const double next = t - extremum(t) / by_t;
      if (!(std::fabs(next - t) < step)) break;
      t = next;
    }
    extremum(t);
    return {search.limit, t, v};
  }

  /// Appends the roots of a search and, if its two roots merge, their folds.
  /// @return false if the interpolation error of the extremum is too large
  bool add_roots(const Search& search) {
    constexpr double kConverged = 1e-11;
    if (search.curvature == 0) {
      s_.roots.push_back({search.limit, search.sign_at_lower < 0, search.root[0]});
      return true;
    }
    if (!search.has_extremum) return false;
    double largest = 0;
    for (const double value : search.value_there) largest = std::max(largest, std::fabs(value));
    Samples series;
    to_coefficients(search.value_there, series);
    const double error = interpolation_error(series, 1e-15 * std::fmax(largest, search.scale));
    if (!(error <= kConverged * std::fmax(largest, search.scale))) return false;
    s_.isolated.clear();
    isolate_roots(series, error, s_.isolated);
    for (const Root& root : s_.isolated) {
      const LimitFold fold = fold_near(search, map_node(outer_, 0.5 * (1 + root.at)).point);
      const double closest = kAtEnd * (outer_.upper - outer_.lower);
      if (fold.t - outer_.lower > closest && outer_.upper - fold.t > closest) s_.folds.push_back(fold);
    }
    if (search.value_there[kNodes / 2] * search.curvature >= 0) return true;
    s_.roots.push_back({search.limit, search.sign_at_lower < 0, search.root[0]});
    s_.roots.push_back({search.limit, search.sign_at_lower > 0, search.root[1]});
    return true;
  }

  const SlicePlan& plan_;
  const expression::Program& program_;
  const Subinterval<double>& outer_;
  LimitScratch& s_;
  double low_, high_;  ///< minimum of the lower, and maximum of the upper bound of v in the segment
};

}  // namespace

void start_limits(const SlicePlan& plan, std::span<const double> inputs, const std::array<Interval, 2>& box,
                  LimitScratch& scratch) {
  const expression::Program& program = plan.limits;
  scratch.active.clear();
  if (program.outputs().empty()) return;
  scratch.inputs.assign(inputs.begin(), inputs.end());
  scratch.intervals.resize(program.registers());
  program.start<Interval>(scratch.intervals);
  program.run<Interval>(0, scratch.inputs, scratch.intervals);
  for (const std::size_t stage : {1, 2}) {
    for (const auto& input : program.stages()[stage].inputs) scratch.intervals[input.to] = box[stage - 1];
    program.run<Interval>(stage, std::span(scratch.intervals));
  }
  // a limit may be undefined in part of the box, but there another constraint is violated
  for (std::size_t limit = 0; 3 * limit < program.outputs().size(); ++limit)
    if (!(scratch.intervals[program.outputs()[3 * limit]].lower >= 0)) scratch.active.push_back(limit);
  if (scratch.active.empty()) return;
  scratch.registers.resize(program.registers());
  program.start<double>(scratch.registers);
  program.run<double>(0, inputs, scratch.registers);
}

void evaluate_limits_at_t(const SlicePlan& plan, double t, LimitScratch& scratch) {
  for (const auto& input : plan.limits.stages()[1].inputs) scratch.registers[input.to] = t;
  plan.limits.run<double>(1, std::span(scratch.registers));
}
void evaluate_limits_at_v(const SlicePlan& plan, double v, LimitScratch& scratch) {
  for (const auto& input : plan.limits.stages()[2].inputs) scratch.registers[input.to] = v;
  plan.limits.run<double>(2, std::span(scratch.registers));
}

LimitState find_limit_roots(const SlicePlan& plan, const Subinterval<double>& outer, const std::array<Samples, 2>& v,
                            LimitScratch& scratch) {
  if (scratch.active.empty()) {
    scratch.roots.clear();
    scratch.folds.clear();
    return LimitState::resolved;
  }
  return LimitRootFinder(plan, outer, v, scratch).run();
}

}  // namespace pkm::generic::corner_curves
