#include "engine/workspace/bounds/volume_bounds.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

namespace pkm::bounds {
namespace {

class Search {
 public:
  Search(const Conditions& conditions, const Ranges& ranges, const BoundsOptions& options, ProofTree* tree)
      : tree_(tree),
        conditions_(conditions),
        options_(options),
        outer_(conditions.axes() - 1),
        whole_{ranges[0], ranges[1]},
        heights_{ranges[outer_][0], ranges[outer_][1]},
        examination_(conditions_, heights_, whole_),
        rooms_(workers(), examination_.room()) {}

  VolumeBounds run() {
    ColumnBox all{.side = whole_};
    Open open;
    for (std::size_t k = 0; k < conditions_.size(); ++k) open.set(k);
    all.open.push_back({0, Heights::kSteps, open});
    if (tree_) tree_->resize(1);
    boxes_.push_back({.box = std::move(all)});
    found_.resize(1);
    examine(0, rooms_[0]);
    VolumeBounds found{.boxes = 1, .examined = 1};
    while (true) {
      Interval sum(0.0);
      for (const Found& found_there : found_) sum += found_there.volume;
      found.lower = sum.lower;
      found.upper = sum.upper;
      found.boxes = boxes_.size();
      found.stopped = options_.stop && options_.stop();
      if (found.gap() <= options_.gap || found.stopped || boxes_.size() >= options_.most_boxes || outer_ == 0)
        return found;
      const std::vector<std::size_t> split = worst(found);
      if (split.empty()) return found;
      const std::size_t first = boxes_.size();
      boxes_.resize(first + split.size());
      found_.resize(boxes_.size());
      const std::size_t node = tree_ ? tree_->size() : 0;
      if (tree_) tree_->resize(node + 2 * split.size());
      for (std::size_t i = 0; i < split.size(); ++i) {
        Leaf &one = boxes_[split[i]], &other = boxes_[first + i];
        const std::size_t axis = longest(one.box);
        if (tree_) tree_->split(one.node, axis, node + 2 * i);
        other = one;
        one.box.side[axis][1] = other.box.side[axis][0] = 0.5 * (one.box.side[axis][0] + one.box.side[axis][1]);
        one.node = node + 2 * i;
        other.node = one.node + 1;
      }
      parallel_for(split.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        for (std::size_t i = begin; i < end; ++i) {
          examine(split[i], rooms_[worker]);
          examine(first + i, rooms_[worker]);
        }
      });
      found.examined += 2 * split.size();
    }
  }

 private:
  struct Leaf {
    ColumnBox box;
    std::size_t node = 0;  ///< of the tree
  };

  /// Of a box, beside it: all of them are looked at after each round.
  struct Found {
    Interval volume{0.0};
    double width = 0;  ///< of the volume, where halving may narrow it
  };

  /// The boxes with most of what is unknown: so many that halving them could be enough, at most 3/4 of it.
  std::vector<std::size_t> worst(const VolumeBounds& bounds) {
    order_.clear();
    for (std::size_t i = 0; i < found_.size(); ++i)
      if (found_[i].width > 0) order_.emplace_back(-found_[i].width, i);
    const double unknown = bounds.upper - bounds.lower;
    const double wanted = unknown - options_.gap * (bounds.upper + bounds.lower) / 2;
    const double enough = std::min(0.75 * unknown, 1.5 * wanted);
    std::ranges::sort(order_);
    std::vector<std::size_t> split;
    double sum = 0;
    for (const auto& [width, i] : order_) {
      if (!(sum < enough)) break;
      sum -= width;
      split.push_back(i);
    }
    return split;
  }

  /// The side that is the greatest share of the whole.
  std::size_t longest(const ColumnBox& box) const {
    const auto share = [&](std::size_t axis) {
      return (box.side[axis][1] - box.side[axis][0]) / (whole_[axis][1] - whole_[axis][0]);
    };
    return outer_ == 2 && share(1) > share(0) ? 1 : 0;
  }
  bool may_halve(const ColumnBox& box) const {
    const auto& [from, to] = box.side[longest(box)];
    const double middle = 0.5 * (from + to);
    return from < middle && middle < to;
  }

  void examine(std::size_t i, ColumnExamination::Room& room) {
    Leaf& leaf = boxes_[i];
    const bool skipped = options_.stop && options_.stop();  // a round may take long
    if (tree_) {
      std::vector<Step> steps;
      examination_.examine(leaf.box, room, &steps, skipped);
      tree_->note(leaf.node, steps);
    } else {
      examination_.examine(leaf.box, room, nullptr, skipped);
    }
    const bool is_open = !leaf.box.open.empty() && may_halve(leaf.box);
    found_[i] = {leaf.box.volume, is_open ? leaf.box.volume.width() : 0};
  }

  ProofTree* tree_;
  const Conditions& conditions_;
  const BoundsOptions& options_;
  std::size_t outer_;
  std::array<std::array<double, 2>, kMostOuter> whole_;
  Heights heights_;
  ColumnExamination examination_;
  std::vector<ColumnExamination::Room> rooms_;
  std::vector<Leaf> boxes_;
  std::vector<Found> found_;
  std::vector<std::pair<double, std::size_t>> order_;
};

}  // namespace

VolumeBounds volume_bounds(const Conditions& conditions, const Ranges& ranges, const BoundsOptions& options,
                           ProofTree* tree) {
  return Search(conditions, ranges, options, tree).run();
}

}  // namespace pkm::bounds
