#include "engine/workspace/bounds/deviation_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/team.hpp"

namespace pkm::bounds {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t kBoxesPerRound = 128;

using AxisSides = std::vector<Interval>;
using Gradient = ParametricConstraints::Gradient;

struct SearchBox {
  AxisSides sides;  ///< intervals of the coordinates of the pose, then of the deviations of the parameters
  std::vector<std::uint32_t> open;  ///< indices of the undecided constraints
  double scale = 0;                 ///< no point of the box whose deviations are |d_i| <= scale violates a constraint
  std::uint64_t number = 0;         ///< number of the box in the order of creation
  // Results of examine():
  bool is_decided = false;
  std::size_t axis = 0;  ///< axis of the next bisection
  std::optional<Violation> violation;
};

/// Order of the boxes in a heap: the box with the lowest scale comes first; among boxes with equal scales, the one that
/// was created first.
struct IsExaminedLater {
  bool operator()(const SearchBox& a, const SearchBox& b) const {
    return a.scale != b.scale ? a.scale > b.scale : a.number > b.number;
  }
};

class DeviationBranchAndBound {
 public:
  DeviationBranchAndBound(const ParametricConstraints& constraints, std::span<const std::array<double, 2>> ranges,
                          double scale, std::optional<Violation> known, const DeviationBoxOptions& options)
      : constraints_(constraints),
        ranges_(ranges),
        search_(constraints, ranges),
        options_(options),
        largest_(known ? known->scale : scale),
        violation_(std::move(known)) {
    for (std::size_t i = 0; i < workers(); ++i) workers_.push_back({constraints.make_scratch(), {}, {}});
  }

  DeviationBox run() {
    SearchBox all;
    for (const auto& [from, to] : ranges_) all.sides.emplace_back(from, to);
    while (all.sides.size() < constraints_.axes()) all.sides.emplace_back(-largest_, largest_);
    for (std::size_t k = 0; k < constraints_.size(); ++k) all.open.push_back(static_cast<std::uint32_t>(k));
    heap_.push_back(all);
    DeviationBox found;
    double undivided = kUnbounded;  // minimum scale of the boxes that are too small to be bisected
    std::vector<SearchBox> round;
    while (!heap_.empty() && heap_.front().scale < target()) {
      found.stopped = options_.stop();
      if (found.stopped || found.boxes >= options_.max_boxes) break;
      round.clear();
      while (round.size() < kBoxesPerRound && !heap_.empty() && heap_.front().scale < target()) {
        std::ranges::pop_heap(heap_, IsExaminedLater());
        round.push_back(std::move(heap_.back()));
        heap_.pop_back();
      }
      parallel_for(round.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        for (std::size_t i = begin; i < end && !options_.stop(); ++i) examine(round[i], workers_[worker]);
      });
      found.boxes += round.size();
      for (SearchBox& box : round) {
        if (box.violation && (!violation_ || box.violation->scale < violation_->scale)) violation_ = box.violation;
        if (box.is_decided) continue;
        if (!bisect(box)) undivided = std::min(undivided, box.scale);
      }
    }
    found.certified = std::min(target(), undivided);
    if (!heap_.empty()) found.certified = std::min(found.certified, heap_.front().scale);
    found.violation = violation_;
    return found;
  }

 private:
  struct Worker {
    ParametricConstraints::Scratch scratch;
    Gradient gradient;
    AxisSides point;
  };

  double limit() const { return violation_ ? violation_->scale : largest_; }
  double target() const { return violation_ ? violation_->scale * (1 - options_.gap) : largest_; }

  /// Tries to prove all constraints on a box for deviations up to target(); if this fails, may increase box.scale.
  void examine(SearchBox& box, Worker& worker) const {
    const std::size_t axes = constraints_.axes(), first = ranges_.size();
    const double target = this->target();
    AxisSides sides = box.sides;
    bool has_centre = true;
    for (std::size_t i = first; i < axes; ++i) {
      box.scale = std::max({box.scale, sides[i].lower, -sides[i].upper});
      has_centre = has_centre && sides[i].holds(0);
      sides[i] = Interval(std::max(sides[i].lower, -target), std::min(sides[i].upper, target));
    }
    box.is_decided = box.scale >= target;
    if (box.is_decided) return;
    std::vector<std::uint32_t> open;
    // For each axis, its priority for bisection; the axis with the maximum priority is bisected.
    std::vector<double> priority(axes);
    double scale = target;
    for (const std::uint32_t k : box.open) {
      Gradient& g = worker.gradient;
      if (constraints_.is_satisfied(k, constraints_.value(k, sides, worker.scratch))) continue;
      if (constraints_.has_one_sign(k, sides, worker.scratch)) continue;
      constraints_.gradient(k, sides, g, worker.scratch);
      if (g.is_known && constraints_.is_satisfied(k, lower_bound(k, sides, worker))) continue;
      const double own = has_centre && g.is_known ? scale_of(k, sides, worker) : 0;
      if (own >= target) continue;
      scale = std::min(scale, own);
      open.push_back(k);
      find_violation(k, sides, box, worker);
      add_priority(k, sides, priority, worker);
    }
    box.open = open;
    box.is_decided = open.empty();
    box.scale = std::max(box.scale, scale);
    box.axis = static_cast<std::size_t>(std::ranges::max_element(priority) - priority.begin());
  }

  /// Lower bound of constraint k over a box, as an interval whose lower end is the bound. Axes in which the constraint
  /// is monotonic are set to the end with the smaller value; along the others the mean value form is used.
  /// worker.gradient must contain enclosures of the derivatives over the box, or over a larger one.
  Interval lower_bound(std::size_t k, const AxisSides& sides, Worker& worker) const {
    const std::vector<Interval>& by_axis = worker.gradient.by_axis;
    worker.point = sides;
    Interval change(0.0);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (by_axis[i].lower >= 0)
        worker.point[i] = Interval(sides[i].lower);
      else if (by_axis[i].upper <= 0)
        worker.point[i] = Interval(sides[i].upper);
      else {
        worker.point[i] = Interval(sides[i].middle());
        change += by_axis[i] * (sides[i] - worker.point[i]);
      }
    }
    return constraints_.value(k, worker.point, worker.scratch) + change;
  }

  /// A scale t such that constraint k is satisfied for all deviations |d_i| <= t: from a lower bound of its value
  /// without deviations, and from its derivatives with respect to the deviations.
  double scale_of(std::size_t k, const AxisSides& sides, Worker& worker) const {
    AxisSides nominal = sides;
    Interval slope(0.0);
    for (std::size_t i = ranges_.size(); i < sides.size(); ++i) {
      nominal[i] = Interval(0.0);
      slope += magnitude(worker.gradient.by_axis[i]);
    }
    const double reserve =
        std::max(lower_bound(k, nominal, worker).lower, constraints_.value(k, nominal, worker.scratch).lower);
    if (!(reserve > 0)) return 0;
    return slope.upper > 0 ? rounding::quotient_down(reserve, slope.upper) : kUnbounded;
  }

  /// Searches for a violation of constraint k at the midpoint of the box and at the vertex at which the constraint is
  /// the smallest; keeps it in box.violation if it has a smaller scale than those known.
  void find_violation(std::size_t k, const AxisSides& sides, SearchBox& box, Worker& worker) const {
    std::vector<double> middle, vertex;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Interval &side = sides[i], &slope = worker.gradient.by_axis[i];
      middle.push_back(side.middle());
      vertex.push_back(!worker.gradient.is_known ? side.middle()
                       : slope.lower >= 0        ? side.lower
                       : slope.upper <= 0        ? side.upper
                                                 : side.middle());
    }
    const auto keep = [&](std::optional<Violation> found) {
      if (found && (!box.violation || found->scale < box.violation->scale)) box.violation = std::move(found);
    };
    const auto known = [&] { return box.violation ? box.violation->scale : limit(); };
    const std::size_t poses = ranges_.size();
    for (const std::vector<double>* point : {&middle, &vertex})
      keep(search_.at_pose(k, std::span(*point).first(poses), known(), worker.scratch));
    // at_pose() starts with gradients for zero deviations. If the constraint is far from linear, the worst vertex of
    // the box of deviations may be another one: also search along the ray towards `vertex`.
    std::vector<double> unused, direction(vertex.begin() + static_cast<std::ptrdiff_t>(poses), vertex.end());
    double scale = 0;
    for (const double d : direction) scale = std::max(scale, std::fabs(d));
    if (scale == 0 || !constraints_.is_violated(k, constraints_.gradient(k, vertex, unused, worker.scratch))) return;
    for (double& d : direction) d /= scale;
    keep(search_.along(k, std::span(vertex).first(poses), direction, scale, known(), worker.scratch));
  }

  /// Adds to the priority of each axis its share of the uncertainty of constraint k. The uncertainty is the width of
  /// the mean value form or, if derivatives are unknown, the width of the constraint's value along the single axis.
  void add_priority(std::size_t k, const AxisSides& sides, std::vector<double>& priority, Worker& worker) const {
    std::vector<double> own(sides.size());
    if (worker.gradient.is_known) {
      for (std::size_t i = 0; i < sides.size(); ++i) own[i] = worker.gradient.by_axis[i].width() * sides[i].width();
    } else {
      worker.point = sides;
      for (Interval& side : worker.point) side = Interval(side.middle());
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const Interval middle = worker.point[i];
        worker.point[i] = sides[i];
        const Interval value = constraints_.value(k, worker.point, worker.scratch);
        own[i] = value.is_defined() ? value.width() : kUnbounded;
        worker.point[i] = middle;
      }
    }
    // If an axis has an unbounded share of the uncertainty, only such axes count, in proportion to the lengths of the
    // box's sides relative to the whole range.
    const bool bounded = std::ranges::all_of(own, [](double x) { return std::isfinite(x); });
    double sum = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (!bounded) own[i] = std::isfinite(own[i]) ? 0 : sides[i].width() / whole(i);
      sum += own[i];
    }
    if (sum > 0)
      for (std::size_t i = 0; i < sides.size(); ++i) priority[i] += own[i] / sum;
    else
      for (std::size_t i = 0; i < sides.size(); ++i) priority[i] += whole(i) > 0 ? sides[i].width() / whole(i) : 0;
  }
  double whole(std::size_t axis) const {
    return axis < ranges_.size() ? ranges_[axis][1] - ranges_[axis][0] : 2 * largest_;
  }

  /// Adds the halves of a box to the heap. @return false if its side has no midpoint in double precision
  bool bisect(const SearchBox& box) {
    const Interval& side = box.sides[box.axis];
    const double middle = side.middle();
    if (!(side.lower < middle && middle < side.upper)) return false;
    for (const Interval& half : {Interval(side.lower, middle), Interval(middle, side.upper)}) {
      SearchBox& child = heap_.emplace_back(box);
      child.sides[box.axis] = half;
      child.number = ++boxes_created_;
      child.violation.reset();
      std::ranges::push_heap(heap_, IsExaminedLater());
    }
    return true;
  }

  const ParametricConstraints& constraints_;
  std::span<const std::array<double, 2>> ranges_;
  ViolationSearch search_;
  const DeviationBoxOptions& options_;
  double largest_;
  std::optional<Violation> violation_;
  std::vector<SearchBox> heap_;
  std::uint64_t boxes_created_ = 0;
  std::vector<Worker> workers_;
};

}  // namespace

DeviationBox largest_deviation_box(const ParametricConstraints& constraints,
                                   std::span<const std::array<double, 2>> ranges, double scale,
                                   std::optional<Violation> known, const DeviationBoxOptions& options) {
  return DeviationBranchAndBound(constraints, ranges, scale, std::move(known), options).run();
}

}  // namespace pkm::bounds
