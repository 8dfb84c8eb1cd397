#include "engine/workspace/bounds/constraints.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "engine/expression/derivative.hpp"
#include "engine/expression/interval_steps.hpp"
#include "engine/workspace/bounds/force_balance.hpp"

namespace pkm::bounds {

using expression::Graph, expression::Groups, expression::Node, expression::Program;

namespace {

// Bits that state which inputs of the graph a value depends on: one bit for the constant inputs, and one for each axis.
constexpr Groups kConstant = 1;
constexpr Groups axis_group(std::size_t axis) { return 2U << axis; }

}  // namespace

Constraints::Constraints(Graph graph, const std::vector<NamedConstraint>& constraints, std::vector<std::size_t> axes,
                         std::vector<Interval> inputs)
    : axes_(std::move(axes)) {
  std::vector<Node> roots;
  for (const NamedConstraint& constraint : constraints) roots.push_back(constraint.node);
  const auto group_of = [&](std::size_t input) {
    const auto axis = std::ranges::find(axes_, input);
    return axis == axes_.end() ? kConstant : axis_group(static_cast<std::size_t>(axis - axes_.begin()));
  };
  std::vector<double> numbers;
  graph = expression::without_numbers(graph, inputs.size(), group_of, numbers, roots);
  inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  std::vector<Node> coordinates;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    coordinates.push_back(graph.input(axes_[axis], axis_group(axis)));
  std::vector<Node> outputs;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    const auto here = roots.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(roots.begin(), here, *here) != here) continue;  // the constraint is identical to an earlier one
    Constraint constraint{.name = constraints[k].name, .node = constraints[k].node, .value = {}, .derivatives = {}};
    outputs.push_back(roots[k]);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      constraint.depends[axis] = (graph[roots[k]].groups & axis_group(axis)) != 0;
      outputs.push_back(expression::derivative(graph, roots[k], coordinates[axis]));
    }
    all_.push_back(std::move(constraint));
  }
  const Groups last = axis_group(axes_.size() - 1);
  program_ = Program(graph, outputs, std::array{kConstant, ~(kConstant | last), last});
  const std::size_t width = 1 + axes_.size();
  for (std::size_t k = 0; k < all_.size(); ++k) {
    all_[k].value = extract(k * width, 1);
    all_[k].derivatives = extract(k * width, width);
  }
  registers_.resize(axes_.size());
  for (const Program::Stage& stage : program_.stages())
    for (const Program::Input& input : stage.inputs)
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        if (axes_[axis] == input.position) registers_[axis] = input.to;
  initial_.registers_.resize(program_.registers());
  initial_.versions_.resize(program_.registers());
  program_.start<Interval>(initial_.registers_);
  program_.run<Interval>(0, inputs, initial_.registers_);
}

Constraints::Subprogram Constraints::extract(std::size_t first_output, std::size_t count) {
  Subprogram subprogram{.outputs = {}, .outer_steps = {}, .last_steps = {}, .index = initial_.evaluated_.size()};
  initial_.evaluated_.push_back(0);
  std::vector<bool> needed(program_.registers());
  for (std::size_t i = 0; i < count; ++i) {
    subprogram.outputs.push_back(program_.outputs()[first_output + i]);
    needed[subprogram.outputs.back()] = true;
  }
  subprogram.last_steps = program_.stages()[2].steps_for(needed);
  subprogram.outer_steps = program_.stages()[1].steps_for(needed);
  return subprogram;
}

void Constraints::set_box(const IntervalBox& box, Scratch& scratch) const {
  for (std::size_t axis = 0; axis + 1 < axes_.size(); ++axis)
    if (registers_[axis]) scratch.registers_[*registers_[axis]] = box[axis];
  scratch.box_ = box;
  scratch.box_version_ = ++scratch.version_;
  // An empty side differs from the sides of all boxes, so that run() computes all values again.
  scratch.last_side_ = Interval::empty();
}

void Constraints::run(const Subprogram& subprogram, const Interval& last_side, Scratch& scratch) const {
  if (scratch.evaluated_[subprogram.index] != scratch.box_version_) {
    expression::run_steps(subprogram.outer_steps, scratch.box_version_, scratch.versions_, scratch.registers_);
    scratch.evaluated_[subprogram.index] = scratch.box_version_;
  }
  if (last_side.lower != scratch.last_side_.lower || last_side.upper != scratch.last_side_.upper) {
    scratch.last_side_ = last_side;
    scratch.last_version_ = ++scratch.version_;
    if (registers_.back()) scratch.registers_[*registers_.back()] = last_side;
  }
  expression::run_steps(subprogram.last_steps, scratch.last_version_, scratch.versions_, scratch.registers_);
}

void Constraints::decide_by_balance(Node node, std::shared_ptr<const ForceBalance> balance) {
  balance_ = std::move(balance);
  balanced_ = static_cast<std::size_t>(std::ranges::find(all_, node, &Constraint::node) - all_.begin());
}

Interval Constraints::value(std::size_t k, const Interval& last_side, Scratch& scratch) const {
  if (balance_ && k == balanced_) {
    scratch.box_[axes_.size() - 1] = last_side;
    const auto sides = std::span(scratch.box_).first(axes_.size());
    constexpr double kMax = std::numeric_limits<double>::max(), kMin = std::numeric_limits<double>::denorm_min();
    if (!std::ranges::all_of(sides, &Interval::is_number)) switch (balance_->examine(scratch.box_)) {
        case ForceBalance::Result::balanced:
          return {0, kMax};
        case ForceBalance::Result::not_balanced:
          return {-kMax, -kMin};
        case ForceBalance::Result::undecided:
          break;
      }
  }
  run(all_[k].value, last_side, scratch);
  return scratch.registers_[all_[k].value.outputs.front()];
}

Derivatives Constraints::derivatives(std::size_t k, const Interval& last_side, Scratch& scratch) const {
  run(all_[k].derivatives, last_side, scratch);
  const std::span<const Interval> registers = scratch.registers_;
  const std::vector<std::uint32_t>& outputs = all_[k].derivatives.outputs;
  Derivatives found{.value = registers[outputs[0]], .by_axis = {}};
  found.is_known = found.value.is_continuous();
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (axis >= axes_.size()) break;
    found.by_axis[axis] = registers[outputs[axis + 1]];
    const bool known = found.by_axis[axis].is_defined() && !found.by_axis[axis].is_empty();
    if (axis + 1 == axes_.size()) found.is_last_derivative_known = known && found.value.is_continuous();
    found.is_known = found.is_known && known;
  }
  return found;
}

}  // namespace pkm::bounds
