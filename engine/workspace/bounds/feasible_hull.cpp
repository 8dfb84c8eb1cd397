#include "engine/workspace/bounds/feasible_hull.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace pkm::bounds {

using expression::Graph, expression::Groups, expression::Node, expression::Program;

namespace {

constexpr Groups kDesignGroup = 1, kAxesGroup = 2;
/// Maximum numbers of operations: for the proof that a slab (the part of a box beside one of its faces) is infeasible,
/// and for the bisection of the bounded box.
constexpr std::size_t kMaxWorkOfSlab = 20'000, kMaxWork = 3'000'000;
/// Maximum number of passes over all faces of a box in which slabs of the same share of its width are cut.
constexpr int kMaxRounds = 16;
/// A face of the box is final if it is this close to a feasible pose, relative to the width of the box, or if the boxes
/// there have become this small.
constexpr double kDistance = 0.02, kSmallestSide = 1.0 / 128;

}  // namespace

FeasibleHull::FeasibleHull(Graph graph, std::vector<Node> constraints, std::vector<std::size_t> axes,
                           std::size_t inputs)
    : axes_(std::move(axes)), inputs_(inputs) {
  const auto group_of = [&](std::size_t input) {
    return std::ranges::count(axes_, input) > 0 ? kAxesGroup : kDesignGroup;
  };
  graph = expression::without_numbers(graph, inputs, group_of, numbers_, constraints);
  program_ = Program(graph, constraints, std::array{kDesignGroup, kAxesGroup});
  registers_.resize(axes_.size());
  const Program::Stage& stage = program_.stages()[1];
  for (const Program::Input& input : stage.inputs)
    registers_[static_cast<std::size_t>(std::ranges::find(axes_, input.position) - axes_.begin())] = input.to;
  for (const std::uint32_t output : program_.outputs()) {
    std::vector<bool> is_needed(program_.registers());
    is_needed[output] = true;
    constraints_.push_back({output, stage.steps_for(is_needed)});
  }
}

class FeasibleHull::Search {
 public:
  Search(const FeasibleHull& hull, std::span<const Interval> inputs)
      : hull_(hull), registers_(hull.program_.registers()), computed_(registers_.size()) {
    std::vector<Interval> all(inputs.begin(), inputs.end());
    all.resize(hull.inputs_);
    all.insert(all.end(), hull.numbers_.begin(), hull.numbers_.end());
    hull.program_.start<Interval>(registers_);
    hull.program_.run<Interval>(0, all, registers_);
    for (std::uint32_t k = 0; k < hull.constraints_.size(); ++k) all_.push_back(k);
  }

  IntervalBox bound(IntervalBox box, double scale) {
    for (bool improves = true; improves;) {
      improves = false;
      for_each_face([&](std::size_t axis, double Interval::*end) {
        if (std::isfinite(box[axis].*end)) return;
        for (const int exponent : {10, 30}) {
          const double limit = std::ldexp(end == &Interval::lower ? -scale : scale, exponent);
          if (!can_cut(box, axis, end, limit)) continue;
          improves = true;
          return;
        }
      });
    }
    return box;
  }

  /// Cuts slabs that are proven infeasible, of half the side and then of smaller shares of it, from each face.
  IntervalBox shave(IntervalBox box) {
    for (double share = 0.5; share > 0.05; share /= 2) {
      bool improves = true;
      for (int round = 0; improves && round < kMaxRounds; ++round) {
        improves = false;
        for_each_face([&](std::size_t axis, double Interval::*end) {
          const double width = box[axis].width();
          if (!(width > 0) || !std::isfinite(width)) return;
          const double limit =
              end == &Interval::lower ? box[axis].lower + share * width : box[axis].upper - share * width;
          improves = can_cut(box, axis, end, limit) || improves;
        });
      }
    }
    return box;
  }

  /// Bounding box of the boxes that bisection does not prove infeasible; std::nullopt: no pose is feasible.
  std::optional<IntervalBox> contract(const IntervalBox& box) {
    const std::size_t begin = work_;
    faces_.assign(2 * axes(), {});
    inner_.fill(Interval::empty());
    add({box, all_});
    IntervalBox hull = box;
    for (bool improves = true; improves;) {
      improves = false;
      for (std::size_t face = 0; face < faces_.size(); ++face) {
        if (!find_hull(hull)) return {};
        const Piece whole = pieces_[faces_[face].top().second];
        const std::size_t axis = longest_side(whole.sides, hull);
        if (is_close(face, hull) || share(whole.sides[axis], hull[axis]) <= kSmallestSide || work_ - begin > kMaxWork)
          continue;
        improves = pieces_[faces_[face].top().second].is_bisected = true;
        for (const Interval& half : halves(whole.sides[axis])) {
          Piece part = whole;
          part.sides[axis] = half;
          add(std::move(part));
        }
      }
    }
    return find_hull(hull) ? std::optional(hull) : std::nullopt;
  }

 private:
  template <class Work>
  void for_each_face(const Work& work) const {
    for (std::size_t axis = 0; axis < axes(); ++axis)
      for (double Interval::*const end : {&Interval::lower, &Interval::upper}) work(axis, end);
  }
  /// Moves an end of a box's side to `limit` if the slab between them is proven infeasible. @return true if it was
  /// moved
  bool can_cut(IntervalBox& box, std::size_t axis, double Interval::*end, double limit) {
    IntervalBox slab = box;
    (end == &Interval::lower ? slab[axis].upper : slab[axis].lower) = limit;
    if (!is_proven_infeasible(slab)) return false;
    box[axis].*end = limit;
    return true;
  }

  using Open = std::vector<std::uint32_t>;  ///< indices of constraints that are not satisfied on the whole box
  struct Piece {
    IntervalBox sides;
    Open open;
    bool is_bisected = false;
  };

  std::size_t axes() const { return hull_.axes_.size(); }

  /// @param open  undecided constraints; those that are proven to be satisfied on the whole box are removed
  /// @return true if the box is proven to contain no feasible pose
  bool is_infeasible(const IntervalBox& box, Open& open) {
    ++version_;
    ++work_;
    for (std::size_t axis = 0; axis < axes(); ++axis)
      if (hull_.registers_[axis]) registers_[*hull_.registers_[axis]] = box[axis];
    std::size_t left = 0;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Constraint& constraint = hull_.constraints_[open[i]];
      expression::run_steps(constraint.steps, version_, computed_, registers_);
      work_ += constraint.steps.size();
      const Interval& value = registers_[constraint.output];
      if (value.is_certified_violated()) return true;
      if (!value.is_certified_satisfied()) open[left++] = open[i];
    }
    open.resize(left);
    return false;
  }

  bool is_proven_infeasible(const IntervalBox& slab) {
    std::vector<Piece> pending{{slab, all_}};
    const std::size_t begin = work_;
    while (!pending.empty()) {
      Piece piece = std::move(pending.back());
      pending.pop_back();
      if (is_infeasible(piece.sides, piece.open)) continue;
      if (piece.open.empty() || work_ - begin > kMaxWorkOfSlab) return false;
      const std::size_t longest = longest_side(piece.sides, slab);
      if (share(piece.sides[longest], slab[longest]) == 0) return false;
      for (const Interval& half : halves(piece.sides[longest])) {
        pending.push_back(piece);
        pending.back().sides[longest] = half;
      }
    }
    return true;
  }

  /// Length of a side relative to the whole range; 0 if it cannot be bisected.
  static double share(const Interval& side, const Interval& whole) {
    return whole.width() > 0 && std::isfinite(whole.width()) ? side.width() / whole.width() : 0;
  }
  std::size_t longest_side(const IntervalBox& box, const IntervalBox& whole) const {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < axes(); ++axis)
      if (share(box[axis], whole[axis]) > share(box[longest], whole[longest])) longest = axis;
    return longest;
  }
  static std::array<Interval, 2> halves(const Interval& side) {
    return {Interval(side.lower, side.middle()), Interval(side.middle(), side.upper)};
  }

  /// Adds a box to `pieces_`, unless it is proven to contain no feasible pose.
  void add(Piece piece) {
    if (is_infeasible(piece.sides, piece.open)) return;
    add_feasible(piece);
    const auto index = static_cast<std::uint32_t>(pieces_.size());
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      faces_[2 * axis].push({-piece.sides[axis].lower, index});
      faces_[2 * axis + 1].push({piece.sides[axis].upper, index});
    }
    pieces_.push_back(std::move(piece));
  }

  /// Adds a box, or its midpoint, to the box of feasible poses if it is feasible.
  void add_feasible(const Piece& piece) {
    IntervalBox feasible = piece.sides;
    if (!piece.open.empty()) {
      for (std::size_t axis = 0; axis < axes(); ++axis) feasible[axis] = piece.sides[axis].middle();
      Open open = piece.open;
      if (is_infeasible(feasible, open) || !open.empty()) return;
    }
    for (std::size_t axis = 0; axis < axes(); ++axis)  // fmin and fmax ignore the NaN of an empty interval
      inner_[axis] = {std::fmin(inner_[axis].lower, feasible[axis].lower),
                      std::fmax(inner_[axis].upper, feasible[axis].upper)};
  }
  /// Whether a known feasible pose is close to a face of `hull`, the bounding box of all boxes not proven infeasible.
  bool is_close(std::size_t face, const IntervalBox& hull) const {
    const Interval &outer = hull[face / 2], &inner = inner_[face / 2];
    const double distance = face % 2 == 0 ? inner.lower - outer.lower : outer.upper - inner.upper;
    return distance <= kDistance * outer.width();
  }

  /// Finds the bounding box of all boxes that are not proven infeasible. @return false if there are none
  bool find_hull(IntervalBox& hull) {
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      auto& boxes = faces_[face];
      while (!boxes.empty() && pieces_[boxes.top().second].is_bisected) boxes.pop();
      if (boxes.empty()) return false;
      const Interval& side = pieces_[boxes.top().second].sides[face / 2];
      (face % 2 == 0 ? hull[face / 2].lower : hull[face / 2].upper) = face % 2 == 0 ? side.lower : side.upper;
    }
    return true;
  }

  const FeasibleHull& hull_;
  std::vector<Interval> registers_;
  std::vector<std::uint64_t> computed_;
  std::uint64_t version_ = 0;
  std::size_t work_ = 0;  ///< number of operations so far
  Open all_;
  std::vector<Piece> pieces_;
  IntervalBox inner_;  ///< bounding box of the feasible poses that are known
  /// For each face of the bounding box, a queue of boxes: how far each extends in the direction of the face, and its
  /// index in `pieces_`.
  std::vector<std::priority_queue<std::pair<double, std::uint32_t>>> faces_;
};

IntervalBox FeasibleHull::bound(std::span<const Interval> inputs, const IntervalBox& start, double scale) const {
  return Search(*this, inputs).bound(start, scale);
}

IntervalBox FeasibleHull::find(std::span<const Interval> inputs, const IntervalBox& start, double scale) const {
  Search search(*this, inputs);
  const IntervalBox bounded = search.bound(start, scale);
  return search.contract(search.shave(bounded)).value_or(bounded);
}

}  // namespace pkm::bounds
