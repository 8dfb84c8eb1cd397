#include "engine/generic/corner_curves/segments.hpp"

#include <algorithm>

#include "engine/core/stop.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic::corner_curves {
namespace {

constexpr int kMaxDivisions = 12;
constexpr double kFunctionConverged = 1e-11;  // accepted interpolation error, relative to the maximum of the function
constexpr std::size_t kMaxRecursion = 100;
constexpr std::size_t kMaxSegments = 200;

class Divider {
 public:
  Divider(const SlicePlan& plan, const OuterPlan& outer, SegmentScratch& scratch)
      : plan_(plan), outer_(outer), s_(scratch) {}

  bool run() {
    const auto& r = s_.registers;
    const auto range = [&](std::size_t i) { return std::array{r[plan_.range[i][0]], r[plan_.range[i][1]]}; };
    const std::array<double, 2> t = range(0);
    if (!(t[0] < t[1])) return true;
    if (!std::isfinite(t[1] - t[0])) return false;
    level(0).known.assign(outer_.functions.size(), 0);
    return divide({t[0], SegmentEnd::Kind::box}, {t[1], SegmentEnd::Kind::box}, 0, 0);
  }

 private:
  enum class State { undefined, resolved, pending };

  SegmentScratch::Level& level(std::size_t depth) {
    while (s_.levels.size() <= depth) s_.levels.emplace_back();
    return s_.levels[depth];
  }

  /// Divides the interval between two values of the outer coordinate recursively, and appends the segments.
  /// @param depth  recursion depth; level(depth).known must be set
  bool divide(SegmentEnd lower, SegmentEnd upper, std::size_t depth, int divisions) {
    check_stop();
    if (depth == kMaxRecursion) return false;
    const OuterRange range{lower.at, upper.at, lower.has_root, upper.has_root};
    sample(range);
    auto& [ends, known] = level(depth);
    ends.clear();
    const auto divide_further = [&, &known = known](const SegmentEnd& from, const SegmentEnd& to, int count) {
      level(depth + 1).known = known;
      return divide(from, to, depth + 1, count);
    };
    bool is_pending = false, is_empty = false;
    std::array<bool, 2> roots_at_ends{};
    for (std::size_t f = 0; f < outer_.functions.size(); ++f) {
      const bool is_required = outer_.functions[f].is_required;
      const double middle = s_.functions[f].values[kNodes / 2];
      if (known[f] != 0) {
        is_empty = is_empty || (is_required && !is_satisfied(middle));
        continue;
      }
      const State state = find_roots(f, range, ends, roots_at_ends);
      is_pending = is_pending || state == State::pending;
      known[f] = state == State::resolved ? 1 : 0;
      is_empty = is_empty || (is_required && state == State::undefined);
    }
    if (ends.empty() && !is_empty && !is_pending) {
      const LimitState state = find_limit_roots(plan_, range, s_.nodes.v, s_.limits);
      is_empty = state == LimitState::violated;
      is_pending = state == LimitState::unresolved;
      for (const LimitFold& fold : s_.limits.folds)
        ends.push_back({fold.t, SegmentEnd::Kind::fold, fold.limit, true, fold.v});
    }
    lower.has_root = lower.has_root || (roots_at_ends[0] && !ends.empty());
    upper.has_root = upper.has_root || (roots_at_ends[1] && !ends.empty());
    if (!ends.empty()) {
      std::ranges::sort(ends, {}, [](const SegmentEnd& end) { return std::pair(end.at, end.function); });
      ends.push_back(upper);
      SegmentEnd from = lower;
      for (SegmentEnd& to : ends) {
        if (to.at - from.at <= kAtEnd * (upper.at - lower.at)) {
          from.has_root = from.has_root || to.has_root;
          if (&to == &ends.back()) break;
          continue;
        }
        if (!divide_further(from, to, divisions)) return false;
        from = to;
      }
      return true;
    }
    for (std::size_t f = 0; f < outer_.functions.size(); ++f)
      is_empty = is_empty || (known[f] != 0 && outer_.functions[f].is_required &&
                              !is_satisfied(s_.functions[f].values[kNodes / 2]));
    if (is_empty) return true;
    if (!is_pending && add_segment(lower, upper) != SliceCurves::Status::unresolved) return true;
    if (divisions == kMaxDivisions || s_.count >= kMaxSegments) return false;
    const SegmentEnd middle{map_node(range, 0.5).point, SegmentEnd::Kind::division};
    return divide_further(lower, middle, divisions + 1) && divide_further(middle, upper, divisions + 1);
  }

  void sample(const OuterRange& range) {
    auto& r = s_.registers;
    s_.nodes.surfaces.resize(plan_.surfaces.size());
    s_.functions.resize(outer_.functions.size());
    run_outer_stage(outer_, range, kNodes, r, s_.rows);
    const auto at_nodes = [&](std::uint32_t at, Samples& values) {
      const expression::Operand operand = outer_.stage->operand(at);
      if (operand.row)
        std::copy_n(&s_.rows[operand.index * expression::kRow], kNodes, values.begin());
      else
        values.fill(r[at]);
    };
    for (std::size_t k = 0; k < plan_.surfaces.size(); ++k)
      for (std::size_t i = 0; i < 6; ++i) at_nodes(plan_.surfaces[k].coefficients[i], s_.nodes.surfaces[k][i]);
    for (const std::size_t upper : {0, 1}) at_nodes(plan_.range[1][upper], s_.nodes.v[upper]);
    std::array<Samples, 3> arguments{};
    for (std::size_t f = 0; f < outer_.functions.size(); ++f) {
      const OuterFunction& function = outer_.functions[f];
      for (std::size_t i = 0; i < function.arguments(); ++i) at_nodes(function.registers[i], arguments[i]);
      for (std::size_t n = 0; n < kNodes; ++n)
        s_.functions[f].values[n] = function.value({arguments[0][n], arguments[1][n], arguments[2][n]});
    }
    // The frame and the formula read the registers: those at the last node.
    for (std::uint32_t at = 0; at < r.size(); ++at)
      if (const expression::Operand operand = outer_.stage->operand(at); operand.row)
        r[at] = s_.rows[operand.index * expression::kRow + kNodes - 1];
    s_.runs += static_cast<long>(kNodes);
  }

  State find_roots(std::size_t f, const OuterRange& range, std::vector<SegmentEnd>& ends,
                   std::array<bool, 2>& at_ends) {
    const Samples& values = s_.functions[f].values;
    const auto defined = std::ranges::count_if(values, [](double value) { return std::isfinite(value); });
    if (defined == 0) return State::undefined;
    if (defined < static_cast<std::ptrdiff_t>(kNodes)) return State::pending;
    double largest = 0;
    for (const double value : values) largest = std::max(largest, std::fabs(value));
    if (largest == 0) return State::resolved;  // the function is 0 everywhere
    Samples series;
    to_coefficients(values, series);
    const double error = interpolation_error(series, 0);
    if (error > kFunctionConverged * largest) return State::pending;
    s_.roots.clear();
    isolate_roots(series, error + 1e-15 * largest, s_.roots);
    for (const Root& root : s_.roots)
      if (std::fabs(root.at) + root.width >= 1 - kAtEnd)
        at_ends[root.at > 0 ? 1 : 0] = at_ends[root.at > 0 ? 1 : 0] || outer_.functions[f].has_root;
      else
        ends.push_back(
            {map_node(range, 0.5 * (1 + root.at)).point, SegmentEnd::Kind::function, f, outer_.functions[f].has_root});
    return State::resolved;
  }

  SliceCurves::Status add_segment(const SegmentEnd& lower, const SegmentEnd& upper) {
    if (s_.count == s_.segments.size()) s_.segments.emplace_back();
    Segment& segment = s_.segments[s_.count];
    segment.lower = lower;
    segment.upper = upper;
    const auto status = segment.slices.build(plan_, outer_, s_.nodes, s_.limits.roots, frame(), s_.registers.data());
    if (status != SliceCurves::Status::filled) return status;
    segment.integral.outer = {lower.at, upper.at, lower.has_root, upper.has_root};
    segment.integral.curves = segment.slices.curves;
    if (!decompose(segment.integral.curves, segment.slices.formula, segment.integral.decomposition, s_.decomposition))
      return SliceCurves::Status::unresolved;
    if (segment.integral.decomposition.ranges.empty()) return SliceCurves::Status::empty;
    ++s_.count;
    return status;
  }

  /// The square frame around the box of v and z at the last node.
  Frame frame() const {
    const auto& r = s_.registers;
    const double v = r[plan_.range[1][1]] - r[plan_.range[1][0]], z = r[plan_.range[2][1]] - r[plan_.range[2][0]];
    return {0.5 * (r[plan_.range[1][0]] + r[plan_.range[1][1]]), 0.5 * (r[plan_.range[2][0]] + r[plan_.range[2][1]]),
            0.5 * std::fmax(v, z)};
  }

  const SlicePlan& plan_;
  const OuterPlan& outer_;
  SegmentScratch& s_;
};

}  // namespace

void run_outer_stage(const SlicePlan& plan, double t, std::span<double> registers) {
  for (const auto& input : plan.program.stages()[1].inputs) registers[input.to] = t;
  plan.program.run<double>(1, registers);
}

void run_outer_stage(const OuterPlan& outer, const OuterRange& range, std::size_t nodes,
                     std::span<const double> registers, expression::Rows& rows) {
  rows.resize(outer.stage->slots() * expression::kRow);
  for (std::size_t n = 0; n < nodes; ++n) {
    const double t = map_node(range, 0.5 * (1 + chebyshev_nodes(nodes)[n])).point;
    for (const std::uint32_t slot : outer.stage->inputs()) rows[slot * expression::kRow + n] = t;
  }
  outer.stage->run(registers.data(), rows.data(), nodes);
}

bool divide(const SlicePlan& plan, const OuterPlan& outer, SegmentScratch& scratch) {
  scratch.count = 0;
  scratch.runs = 0;
  return Divider(plan, outer, scratch).run();
}

}  // namespace pkm::generic::corner_curves
