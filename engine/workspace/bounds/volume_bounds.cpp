#include "engine/workspace/bounds/volume_bounds.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

namespace pkm::bounds {
namespace {

class BranchAndBound {
 public:
  BranchAndBound(const Constraints& constraints, const Ranges& ranges, const BoundsOptions& options, ProofTree* tree)
      : tree_(tree),
        constraints_(constraints),
        options_(options),
        outer_axes_(constraints.axes() - 1),
        whole_{ranges[0], ranges[1]},
        grid_{ranges[outer_axes_][0], ranges[outer_axes_][1]},
        pruner_(constraints_, grid_, whole_),
        scratch_(workers(), pruner_.make_scratch()) {}

  VolumeBounds run() {
    ColumnBox root{.side = whole_};
    OpenConstraints open;
    for (std::size_t k = 0; k < constraints_.size(); ++k) open.set(k);
    root.open.push_back({0, ColumnGrid::kSteps, open});
    if (tree_) tree_->resize(1);
    leaves_.push_back({.box = std::move(root)});
    enclosures_.resize(1);
    prune(0, scratch_[0]);
    VolumeBounds bounds{.boxes = 1, .examined = 1};
    while (true) {
      Interval sum(0.0);
      for (const Enclosure& enclosure : enclosures_) sum += enclosure.volume;
      bounds.lower = sum.lower;
      bounds.upper = sum.upper;
      bounds.boxes = leaves_.size();
      bounds.stopped = options_.stop && options_.stop();
      if (bounds.gap() <= options_.gap || bounds.stopped || leaves_.size() >= options_.max_boxes || outer_axes_ == 0)
        return bounds;
      const std::vector<std::size_t> selected = select_leaves(bounds);
      if (selected.empty()) return bounds;
      const std::size_t first = leaves_.size();
      leaves_.resize(first + selected.size());
      enclosures_.resize(leaves_.size());
      const std::size_t node = tree_ ? tree_->size() : 0;
      if (tree_) tree_->resize(node + 2 * selected.size());
      for (std::size_t i = 0; i < selected.size(); ++i) {
        Leaf &lower = leaves_[selected[i]], &upper = leaves_[first + i];
        const std::size_t axis = longest_axis(lower.box);
        if (tree_) tree_->bisect(lower.node, axis, node + 2 * i);
        upper = lower;
        lower.box.side[axis][1] = upper.box.side[axis][0] = 0.5 * (lower.box.side[axis][0] + lower.box.side[axis][1]);
        lower.node = node + 2 * i;
        upper.node = lower.node + 1;
      }
      parallel_for(selected.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        for (std::size_t i = begin; i < end; ++i) {
          prune(selected[i], scratch_[worker]);
          prune(first + i, scratch_[worker]);
        }
      });
      bounds.examined += 2 * selected.size();
    }
  }

 private:
  struct Leaf {
    ColumnBox box;
    std::size_t node = 0;  ///< index of the leaf's node in the proof tree
  };

  /// Enclosure of the volume over a leaf, in an array of its own because all of them are read after each round.
  struct Enclosure {
    Interval volume{0.0};
    double width = 0;  ///< width of `volume`; 0 if bisection cannot reduce it
  };

  /// Selects the leaves with the widest enclosures for bisection: as many as could be sufficient to reach the required
  /// gap, but at most those with 3/4 of the total width.
  std::vector<std::size_t> select_leaves(const VolumeBounds& bounds) {
    order_.clear();
    for (std::size_t i = 0; i < enclosures_.size(); ++i)
      if (enclosures_[i].width > 0) order_.emplace_back(-enclosures_[i].width, i);
    const double total = bounds.upper - bounds.lower;
    const double excess = total - options_.gap * (bounds.upper + bounds.lower) / 2;
    const double sufficient = std::min(0.75 * total, 1.5 * excess);
    std::ranges::sort(order_);
    std::vector<std::size_t> selected;
    double sum = 0;
    for (const auto& [negative_width, i] : order_) {
      if (!(sum < sufficient)) break;
      sum -= negative_width;
      selected.push_back(i);
    }
    return selected;
  }

  /// Axis of the longest side of a box, relative to the range of the axis.
  std::size_t longest_axis(const ColumnBox& box) const {
    const auto share = [&](std::size_t axis) {
      return (box.side[axis][1] - box.side[axis][0]) / (whole_[axis][1] - whole_[axis][0]);
    };
    return outer_axes_ == 2 && share(1) > share(0) ? 1 : 0;
  }
  /// @return true if the longest side has a midpoint in double precision
  bool can_bisect(const ColumnBox& box) const {
    const auto& [from, to] = box.side[longest_axis(box)];
    const double middle = 0.5 * (from + to);
    return from < middle && middle < to;
  }

  void prune(std::size_t i, ColumnPruner::Scratch& scratch) {
    Leaf& leaf = leaves_[i];
    // The stop request is tested for each leaf as well, because pruning all selected leaves may take long.
    const bool skipped = options_.stop && options_.stop();
    std::vector<Step> steps;
    pruner_.prune(leaf.box, scratch, tree_ ? &steps : nullptr, skipped);
    if (tree_) tree_->record(leaf.node, steps);
    const bool is_open = !leaf.box.open.empty() && can_bisect(leaf.box);
    enclosures_[i] = {leaf.box.volume, is_open ? leaf.box.volume.width() : 0};
  }

  ProofTree* tree_;
  const Constraints& constraints_;
  const BoundsOptions& options_;
  std::size_t outer_axes_;
  std::array<std::array<double, 2>, kMaxOuterAxes> whole_;
  ColumnGrid grid_;
  ColumnPruner pruner_;
  std::vector<ColumnPruner::Scratch> scratch_;  ///< scratch memory of each worker thread
  std::vector<Leaf> leaves_;
  std::vector<Enclosure> enclosures_;                  ///< for each leaf, the enclosure of its volume
  std::vector<std::pair<double, std::size_t>> order_;  ///< pairs (-width of the enclosure, index of the leaf), sorted
};

}  // namespace

VolumeBounds volume_bounds(const Constraints& constraints, const Ranges& ranges, const BoundsOptions& options,
                           ProofTree* tree) {
  return BranchAndBound(constraints, ranges, options, tree).run();
}

}  // namespace pkm::bounds
