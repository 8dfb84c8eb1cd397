#include "engine/workspace/bounds/parametric_constraints.hpp"

#include <algorithm>

#include "engine/expression/derivative.hpp"
#include "engine/workspace/bounds/pose_box.hpp"

namespace pkm::bounds {

using expression::Graph, expression::Groups, expression::Node, expression::Program, expression::Rates;

void ParametricConstraints::add(Graph graph, const std::vector<ParametricConstraint>& constraints,
                                const std::vector<std::size_t>& axes, std::vector<Interval> inputs) {
  std::vector<Node> roots;  // the nodes of the constraints, then the entries of their matrices
  for (const ParametricConstraint& constraint : constraints) roots.push_back(constraint.node);
  for (const ParametricConstraint& constraint : constraints)
    roots.insert(roots.end(), constraint.matrix.begin(), constraint.matrix.end());
  std::vector<double> numbers;
  graph = expression::without_numbers(
      graph, inputs.size(), [](std::size_t) { return Groups{1}; }, numbers, roots);
  inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  std::vector<std::vector<Node>> outputs;  // for each constraint, the nodes of its value and of its derivatives
  for (std::size_t k = 0; k < constraints.size(); ++k) outputs.push_back({roots[k]});
  for (const std::size_t axis : axes) {
    Rates rates(graph);
    rates.set_rate(graph.input(axis), graph.number(1));
    for (std::size_t k = 0; k < constraints.size(); ++k) outputs[k].push_back(rates.of(roots[k]).node());
  }
  std::span<const Node> entries = std::span(roots).subspan(constraints.size());
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const std::span<const Node> matrix = entries.first(constraints[k].matrix.size());
    entries = entries.subspan(matrix.size());
    const auto here = roots.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(roots.begin(), here, *here) != here) continue;
    all_.push_back({constraints[k].name, constraints[k].is_strict, graphs_.size(), Program(graph, {&roots[k], 1}),
                    Program(graph, outputs[k]), Program(graph, matrix), constraints[k].columns});
  }
  graphs_.push_back({axes, std::move(inputs)});
}

ParametricConstraints::Scratch ParametricConstraints::make_scratch() const {
  Scratch scratch;
  for (const OfGraph& graph : graphs_) {
    scratch.inputs.push_back(graph.inputs);
    std::vector<double>& numbers = scratch.numbers.emplace_back();
    for (const Interval& input : graph.inputs) numbers.push_back(input.middle());
  }
  return scratch;
}

namespace {

template <class S>
void place(std::span<const S> point, const std::vector<std::size_t>& axes, std::vector<S>& inputs) {
  for (std::size_t axis = 0; axis < axes.size(); ++axis) inputs[axes[axis]] = point[axis];
}

}  // namespace

Interval ParametricConstraints::value(std::size_t k, std::span<const Interval> sides, Scratch& scratch) const {
  const Constraint& constraint = all_[k];
  std::vector<Interval>& inputs = scratch.inputs[constraint.graph];
  place(sides, graphs_[constraint.graph].axes, inputs);
  constraint.value.run_all<Interval>(inputs, scratch.registers);
  return scratch.registers[constraint.value.outputs().front()];
}

void ParametricConstraints::gradient(std::size_t k, std::span<const Interval> sides, Gradient& to,
                                     Scratch& scratch) const {
  const Constraint& constraint = all_[k];
  std::vector<Interval>& inputs = scratch.inputs[constraint.graph];
  place(sides, graphs_[constraint.graph].axes, inputs);
  constraint.gradient.run_all<Interval>(inputs, scratch.registers);
  const std::vector<std::uint32_t>& outputs = constraint.gradient.outputs();
  to.value = scratch.registers[outputs.front()];
  to.is_known = to.value.is_continuous();
  to.by_axis.resize(axes());
  for (std::size_t axis = 0; axis < axes(); ++axis) {
    to.by_axis[axis] = scratch.registers[outputs[axis + 1]];
    to.is_known = to.is_known && to.by_axis[axis].is_defined() && !to.by_axis[axis].is_empty();
  }
}

bool ParametricConstraints::has_one_sign(std::size_t k, std::span<const Interval> sides, Scratch& scratch) const {
  const Constraint& constraint = all_[k];
  if (constraint.columns == 0) return false;
  std::vector<Interval>& inputs = scratch.inputs[constraint.graph];
  place(sides, graphs_[constraint.graph].axes, inputs);
  constraint.matrix.run_all<Interval>(inputs, scratch.registers);
  std::vector<Interval> entries;
  for (const std::uint32_t output : constraint.matrix.outputs()) {
    entries.push_back(scratch.registers[output]);
    if (!entries.back().is_continuous()) return false;
  }
  return has_full_rank(entries, entries.size() / constraint.columns, constraint.columns);
}

double ParametricConstraints::gradient(std::size_t k, std::span<const double> point, std::vector<double>& by_axis,
                                       Scratch& scratch) const {
  const Constraint& constraint = all_[k];
  std::vector<double>& inputs = scratch.numbers[constraint.graph];
  place(point, graphs_[constraint.graph].axes, inputs);
  constraint.gradient.run_all<double>(inputs, scratch.number_registers);
  const std::vector<std::uint32_t>& outputs = constraint.gradient.outputs();
  by_axis.resize(axes());
  for (std::size_t axis = 0; axis < axes(); ++axis) by_axis[axis] = scratch.number_registers[outputs[axis + 1]];
  return scratch.number_registers[outputs.front()];
}

}  // namespace pkm::bounds
