#include "engine/workspace/bounds/separation.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/core/team.hpp"
#include "engine/math/disjoint_sets.hpp"

namespace pkm::bounds {
namespace {

/// A part of the search box: a node of the tree of bisections.
struct Part {
  IntervalBox sides;
  /// Indices of the constraints that are not proven to be satisfied everywhere on the part.
  std::vector<std::size_t> open;
  bool is_removed = false;  ///< true: no path enters the part, or both its halves are removed
  bool is_free = false;     ///< true: all poses of the part are feasible and regular
  /// Index in the tree of the lower half; the upper half has the next index; 0: the part is a leaf.
  std::size_t child = 0;
};

class BranchAndPrune {
 public:
  BranchAndPrune(const Constraints& constraints, const Matrices* matrices, std::span<const SeparationAxis> axes,
                 const BoundsOptions& options)
      : constraints_(constraints), matrices_(matrices), axes_(axes), options_(options) {
    for (std::size_t i = 0; i < workers(); ++i)
      scratch_.push_back({constraints.make_scratch(), matrices ? matrices->initial_scratch() : Matrices::Scratch()});
  }

  Separation run() {
    Separation result;
    for (const SeparationAxis& axis : axes_)
      for (const double value : {axis.from, axis.to})
        if (!(value >= axis.range[0] && value <= axis.range[1]))
          return {Separation::Kind::undecided, "one of the poses is outside of the box of the workspace", 0};
    if (matrices_)
      for (std::size_t k = 0; k < matrices_->size(); ++k) {
        signs_.push_back(matrices_->determinant_sign(k, point(&SeparationAxis::from), scratch_[0].matrices));
        const int other = matrices_->determinant_sign(k, point(&SeparationAxis::to), scratch_[0].matrices);
        if (signs_[k] * other < 0) return {Separation::Kind::signs, matrices_->name(k), 0};
      }
    Part all;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis)
      all.sides[axis] = {axes_[axis].range[0], axes_[axis].range[1]};
    for (std::size_t k = 0; k < constraints_.size(); ++k) all.open.push_back(k);
    parts_ = {all};
    std::vector<std::size_t> leaves = {0};
    const auto stopped = [&] { return options_.stop && options_.stop(); };
    while (true) {
      parallel_for(leaves.size(), [&](std::size_t i, std::size_t end, std::size_t worker) {
        for (; i < end && !stopped(); ++i) examine(parts_[leaves[i]], scratch_[worker]);
      });
      result.boxes += leaves.size();
      if (remove_unreached()) {
        result.kind = Separation::Kind::boxes;
        return result;
      }
      leaves.clear();
      for (std::size_t i = 0, count = parts_.size(); i < count; ++i)
        if (parts_[i].child == 0 && !parts_[i].is_removed && !parts_[i].is_free) bisect(i, leaves);
      if (stopped()) result.detail = "the search was stopped";
      if (leaves.empty()) result.detail = "boxes that are feasible everywhere connect the poses";
      if (result.boxes + leaves.size() > options_.max_boxes)
        result.detail = "the search ended after " + std::to_string(result.boxes) + " boxes";
      if (!result.detail.empty()) return result;
    }
  }

 private:
  struct Scratch {
    Constraints::Scratch constraints;
    Matrices::Scratch matrices;
  };

  IntervalBox point(double SeparationAxis::*value) const {
    IntervalBox box;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) box[axis] = Interval(axes_[axis].*value);
    return box;
  }

  void examine(Part& part, Scratch& scratch) const {
    constraints_.set_box(part.sides, scratch.constraints);
    std::vector<std::size_t> open;
    for (const std::size_t k : part.open) {
      const Interval value = constraints_.value(k, part.sides[axes_.size() - 1], scratch.constraints);
      if (value.is_certified_satisfied()) continue;
      if (value.is_certified_violated()) {
        part.is_removed = true;
        return;
      }
      open.push_back(k);
    }
    part.open = std::move(open);
    if (!matrices_) {
      part.is_free = part.open.empty();
      return;
    }
    const std::optional<std::size_t> undecided = matrices_->first_undecided(part.sides, scratch.matrices);
    part.is_free = part.open.empty() && !undecided;
    // A matrix before the first undecided one has full rank on the part, so that its determinant has one sign there:
    // that at the midpoint.
    IntervalBox middle = part.sides;
    for (Interval& side : middle) side = Interval(side.middle());
    for (std::size_t k = 0; k < undecided.value_or(matrices_->size()); ++k)
      if (signs_[k] * matrices_->determinant_sign(k, middle, scratch.matrices) < 0) part.is_removed = true;
  }

  void bisect(std::size_t index, std::vector<std::size_t>& leaves) {
    std::size_t widest = 0;
    double width = 0;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const double share = parts_[index].sides[axis].width() / (axes_[axis].range[1] - axes_[axis].range[0]);
      if (share > width) {
        width = share;
        widest = axis;
      }
    }
    const Interval side = parts_[index].sides[widest];
    const double middle = side.middle();
    if (!(side.lower < middle && middle < side.upper)) return;
    parts_[index].child = parts_.size();
    for (const Interval& half : {Interval(side.lower, middle), Interval(middle, side.upper)}) {
      Part part = parts_[index];
      part.child = 0;
      part.sides[widest] = half;
      leaves.push_back(parts_.size());
      parts_.push_back(std::move(part));
    }
    parts_[index].open = {};
  }

  /// Removes the leaves that are not connected with the first pose. @return true if no remaining leaf contains the
  /// second pose
  bool remove_unreached() {
    sets_ = DisjointSets(parts_.size());
    std::array<double, kMaxAxes> no_shift{};
    for (const Part& part : parts_)
      if (part.child != 0 && !part.is_removed) join(part.child, part.child + 1, no_shift);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      if (!axes_[axis].is_periodic) continue;
      std::array<double, kMaxAxes> shift{};
      shift[axis] = axes_[axis].range[1] - axes_[axis].range[0];
      join(0, 0, shift);
    }
    std::vector<bool> is_reached(parts_.size(), false);
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (is_leaf(i) && contains(i, &SeparationAxis::from)) is_reached[sets_.root(i)] = true;
    bool separated = true;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!is_leaf(i)) continue;
      if (!is_reached[sets_.root(i)])
        parts_[i].is_removed = true;
      else if (contains(i, &SeparationAxis::to))
        separated = false;
    }
    // Visit the parts from the last to the first: the halves of a part have higher indices than the part.
    for (std::size_t i = parts_.size(); i-- > 0;)
      if (const std::size_t lower = parts_[i].child; lower != 0)
        parts_[i].is_removed = parts_[lower].is_removed && parts_[lower + 1].is_removed;
    return separated;
  }
  bool is_leaf(std::size_t i) const { return parts_[i].child == 0 && !parts_[i].is_removed; }
  bool contains(std::size_t i, double SeparationAxis::*value) const {
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const Interval& side = parts_[i].sides[axis];
      const double x = axes_[axis].*value;
      if (!(side.lower <= x && x <= side.upper)) return false;
    }
    return true;
  }

  /// Unites, in the disjoint sets, leaves below part a with leaves below part b that touch them.
  /// @param shift  is added to the coordinates of part b, for ends of periodic axes
  void join(std::size_t a, std::size_t b, const std::array<double, kMaxAxes>& shift) {
    if (parts_[a].is_removed || parts_[b].is_removed) return;
    // The two ends of a periodic axis coincide only up to rounding errors.
    constexpr double kTouch = 1e-12;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const Interval &first = parts_[a].sides[axis], &second = parts_[b].sides[axis];
      const double tolerance = shift[axis] == 0 ? 0 : kTouch * shift[axis];
      if (second.lower + shift[axis] > first.upper + tolerance || second.upper + shift[axis] < first.lower - tolerance)
        return;
    }
    const std::size_t lower = parts_[a].child, upper = parts_[b].child;
    if (lower != 0) {
      join(lower, b, shift);
      join(lower + 1, b, shift);
    } else if (upper != 0) {
      join(a, upper, shift);
      join(a, upper + 1, shift);
    } else if (is_leaf(a) && is_leaf(b)) {
      sets_.unite(a, b);
    }
  }

  const Constraints& constraints_;
  const Matrices* matrices_;
  std::span<const SeparationAxis> axes_;
  const BoundsOptions& options_;
  std::vector<Scratch> scratch_;  ///< scratch memory of each worker thread
  std::vector<int> signs_;        ///< for each matrix, the sign of its determinant at the first pose
  std::vector<Part> parts_;       ///< the tree of parts; the first part is the whole box
  DisjointSets sets_;             ///< sets of connected parts, by index of the part
};

}  // namespace

Separation separate(const Constraints& constraints, const Matrices* matrices, std::span<const SeparationAxis> axes,
                    const BoundsOptions& options) {
  return BranchAndPrune(constraints, matrices, axes, options).run();
}

}  // namespace pkm::bounds
