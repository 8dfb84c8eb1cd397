#include "engine/workspace/bounds/feasible_hull.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

#include "engine/expression/changed_steps.hpp"

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
  /// The values of the constraints on a box. If the next box differs in few sides, only the steps that depend on
  /// these are run again.
  class Evaluator {
   public:
    Evaluator(const FeasibleHull& hull, std::span<const Interval> inputs)
        : hull_(hull), registers_(hull.program_.registers()), computed_(registers_.size()) {
      std::vector<Interval> all(inputs.begin(), inputs.end());
      all.resize(hull.inputs_);
      all.insert(all.end(), hull.numbers_.begin(), hull.numbers_.end());
      hull.program_.start<Interval>(registers_);
      hull.program_.run<Interval>(0, all, registers_);
      axes_of_.resize(registers_.size());
      for (std::size_t axis = 0; axis < hull.axes_.size(); ++axis)
        if (hull.registers_[axis]) axes_of_[*hull.registers_[axis]] = static_cast<expression::InputSet>(1U << axis);
      for (const Program::Step& step : hull.program_.stages()[1].steps) {
        expression::InputSet axes = 0;
        for (const std::uint32_t operand : step.operands()) axes |= axes_of_[operand];
        std::fill_n(axes_of_.begin() + step.to, step.results(), axes);
      }
      changed_.fill(version_);
    }

    void set_box(const IntervalBox& box) {
      const auto bits = [](const Interval& side) {
        return std::array{std::bit_cast<std::uint64_t>(side.lower), std::bit_cast<std::uint64_t>(side.upper),
                          static_cast<std::uint64_t>(side.decoration)};
      };
      expression::InputSet changed = 0;
      for (std::size_t axis = 0; axis < hull_.axes_.size(); ++axis) {
        if (!hull_.registers_[axis]) continue;
        Interval& side = registers_[*hull_.registers_[axis]];
        if (bits(side) != bits(box[axis])) changed |= static_cast<expression::InputSet>(1U << axis);
        side = box[axis];
      }
      ++version_;
      for (std::size_t set = 0; set < std::size_t{1} << hull_.axes_.size(); ++set)
        if ((set & changed) != 0) changed_[set] = version_;
    }
    const Interval& value(const Constraint& constraint) {
      if (computed_[constraint.output] < changed_[axes_of_[constraint.output]])
        expression::run_changed_steps(constraint.steps, version_, {axes_of_, changed_}, computed_, registers_);
      return registers_[constraint.output];
    }

   private:
    const FeasibleHull& hull_;
    std::vector<Interval> registers_;
    std::vector<expression::InputSet> axes_of_;  ///< by register: the axes that it depends on
    std::uint64_t version_ = 1;                  ///< number of the box
    std::vector<std::uint64_t> computed_;        ///< by register: number of the box for which it was computed
    /// By set of axes: number of the last box in which the side of one of them changed.
    std::array<std::uint64_t, std::size_t{1} << kMaxAxes> changed_;
  };

 public:
  Search(const FeasibleHull& hull, std::span<const Interval> inputs)
      : hull_(hull), boxes_(hull, inputs), points_(boxes_) {
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
    open_ = all_;
    add({box, {0, all_.size()}});
    IntervalBox hull = box;
    for (bool improves = true; improves;) {
      improves = false;
      for (std::size_t face = 0; face < faces_.size(); ++face) {
        if (!find_hull(hull)) return {};
        const std::uint32_t index = faces_[face].top().second;
        const Longest longest = longest_side(pieces_[index].sides, hull);
        if (is_close(face, hull) || longest.share <= kSmallestSide || work_ - begin > kMaxWork) continue;
        improves = is_bisected_[index] = true;
        Piece part = pieces_[index];
        for (const Interval& half : halves(part.sides[longest.axis])) {
          part.sides[longest.axis] = half;
          add(part);
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

  /// A part of `open_`: indices of the constraints that are not satisfied on the whole box.
  struct Open {
    std::size_t begin, end;
    std::size_t size() const { return end - begin; }
  };
  struct Piece {
    IntervalBox sides;
    Open open;
  };

  std::size_t axes() const { return hull_.axes_.size(); }

  /// Appends those constraints of `open` that are not satisfied on the whole box to `open_`.
  /// @return true if the box is proven to contain no feasible pose; the constraints appended are then incomplete
  bool is_infeasible(Evaluator& evaluator, const IntervalBox& box, const Open& open) {
    ++work_;
    evaluator.set_box(box);
    for (std::size_t i = open.begin; i < open.end; ++i) {
      const Constraint& constraint = hull_.constraints_[open_[i]];
      work_ += constraint.steps.size();
      const Interval& value = evaluator.value(constraint);
      if (value.is_certified_violated()) return true;
      if (!value.is_certified_satisfied()) open_.push_back(open_[i]);
    }
    return false;
  }

  /// Depth-first bisection.
  bool is_proven_infeasible(const IntervalBox& slab) {
    open_ = all_;
    pending_.assign(1, {slab, {0, all_.size()}});
    const std::size_t begin = work_;
    while (!pending_.empty()) {
      const Piece piece = pending_.back();
      pending_.pop_back();
      open_.resize(piece.open.end);  // what follows belongs to boxes that are proven infeasible
      if (is_infeasible(boxes_, piece.sides, piece.open)) continue;
      const Open open{piece.open.end, open_.size()};
      if (open.size() == 0 || work_ - begin > kMaxWorkOfSlab) return false;
      const auto [axis, part] = longest_side(piece.sides, slab);
      if (part == 0) return false;
      for (const Interval& half : halves(piece.sides[axis])) {
        pending_.push_back({piece.sides, open});
        pending_.back().sides[axis] = half;
      }
    }
    return true;
  }

  /// Length of a side relative to the whole range; 0 if it cannot be bisected.
  static double share(const Interval& side, const Interval& whole) {
    return whole.width() > 0 && std::isfinite(whole.width()) ? side.width() / whole.width() : 0;
  }
  struct Longest {
    std::size_t axis;
    double share;
  };
  Longest longest_side(const IntervalBox& box, const IntervalBox& whole) const {
    Longest longest{0, share(box[0], whole[0])};
    for (std::size_t axis = 1; axis < axes(); ++axis)
      if (const double each = share(box[axis], whole[axis]); each > longest.share) longest = {axis, each};
    return longest;
  }
  static std::array<Interval, 2> halves(const Interval& side) {
    return {Interval(side.lower, side.middle()), Interval(side.middle(), side.upper)};
  }

  /// Adds a box to `pieces_`, unless it is proven to contain no feasible pose.
  void add(Piece piece) {
    const std::size_t end = open_.size();
    const bool is_excluded = is_infeasible(boxes_, piece.sides, piece.open);
    const Open open{end, open_.size()};
    if (is_excluded || open.size() == piece.open.size())
      open_.resize(end);  // the constraints are those of the box that was bisected
    else
      piece.open = open;
    if (is_excluded) return;
    add_feasible(piece);
    const auto index = static_cast<std::uint32_t>(pieces_.size());
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      faces_[2 * axis].push({-piece.sides[axis].lower, index});
      faces_[2 * axis + 1].push({piece.sides[axis].upper, index});
    }
    pieces_.push_back(piece);
    is_bisected_.push_back(false);
  }

  /// Adds a box, or its midpoint, to the box of feasible poses if it is feasible.
  void add_feasible(const Piece& piece) {
    IntervalBox feasible = piece.sides;
    if (piece.open.size() > 0) {
      for (std::size_t axis = 0; axis < axes(); ++axis) feasible[axis] = piece.sides[axis].middle();
      const std::size_t end = open_.size();
      const bool is_excluded = is_infeasible(points_, feasible, piece.open);
      const bool is_feasible = !is_excluded && open_.size() == end;
      open_.resize(end);
      if (!is_feasible) return;
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
      while (!boxes.empty() && is_bisected_[boxes.top().second]) boxes.pop();
      if (boxes.empty()) return false;
      (face % 2 == 0 ? hull[face / 2].lower : hull[face / 2].upper) =
          face % 2 == 0 ? -boxes.top().first : boxes.top().first;
    }
    return true;
  }

  const FeasibleHull& hull_;
  Evaluator boxes_, points_;  ///< of boxes, and of their midpoints
  std::size_t work_ = 0;      ///< number of operations so far, counted as if every step were run for every box
  std::vector<std::uint32_t> all_, open_;
  std::vector<Piece> pending_, pieces_;
  std::vector<bool> is_bisected_;  ///< by index of `pieces_`
  IntervalBox inner_;              ///< bounding box of the feasible poses that are known
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
