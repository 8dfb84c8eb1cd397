#include "engine/survey/bounds/conditions.hpp"

#include <algorithm>

#include "engine/graph/derivative.hpp"

namespace pkm::bounds {

using graph::Graph, graph::Groups, graph::Node, graph::Program;

namespace {

// Of the inputs, which are regrouped: what stays, and the axes.
constexpr Groups kFixed = 1;
constexpr Groups axis_group(std::size_t axis) { return 2U << axis; }

}  // namespace

Conditions::Conditions(Graph graph, const std::vector<NamedCondition>& conditions, std::vector<std::size_t> axes,
                       std::vector<Interval> inputs)
    : axes_(std::move(axes)) {
  std::vector<Node> roots;
  for (const NamedCondition& condition : conditions) roots.push_back(condition.node);
  const auto group_of = [&](std::size_t input) {
    const auto axis = std::ranges::find(axes_, input);
    return axis == axes_.end() ? kFixed : axis_group(static_cast<std::size_t>(axis - axes_.begin()));
  };
  std::vector<double> numbers;
  graph = graph::without_numbers(graph, inputs.size(), group_of, numbers, roots);
  inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  std::vector<Node> coordinates;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    coordinates.push_back(graph.input(axes_[axis], axis_group(axis)));
  for (std::size_t k = 0; k < roots.size(); ++k) {
    if (std::find(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(k), roots[k]) !=
        roots.begin() + static_cast<std::ptrdiff_t>(k))
      continue;  // the same once more
    Condition made{.name = conditions[k].name,
                   .node = conditions[k].node,
                   .value = part_of(graph, {roots[k]}, inputs),
                   .slope = {}};
    std::vector<Node> slopes = {roots[k]};
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      made.depends[axis] = (graph[roots[k]].groups & axis_group(axis)) != 0;
      slopes.push_back(graph::derivative(graph, roots[k], coordinates[axis]));
    }
    made.slope = part_of(graph, slopes, inputs);
    all_.push_back(std::move(made));
  }
}

Conditions::Part Conditions::part_of(const Graph& graph, const std::vector<Node>& outputs,
                                     const std::vector<Interval>& inputs) {
  constexpr Groups kAxes = ~kFixed;
  Part part{Program(graph, outputs, std::array{kFixed, kAxes}), start_.size()};
  start_.resize(start_.size() + part.program.registers());
  const std::span<Interval> registers = std::span(start_).subspan(part.first);
  part.program.start(registers);
  part.program.run<Interval>(0, inputs, registers);
  return part;
}

std::span<Interval> Conditions::run(const Part& part, const Place& place, Room& room) const {
  const std::span<Interval> registers = std::span(room).subspan(part.first, part.program.registers());
  for (const Program::Input& input : part.program.stages()[1].inputs)
    for (std::size_t axis = 0; axis < axes_.size(); ++axis)
      if (axes_[axis] == input.position) registers[input.to] = place[axis];
  part.program.run(1, registers);
  return registers;
}

Interval Conditions::value(std::size_t k, const Place& place, Room& room) const {
  const Part& part = all_[k].value;
  return run(part, place, room)[part.program.outputs().front()];
}

Slope Conditions::slope(std::size_t k, const Place& place, Room& room) const {
  const Condition& condition = all_[k];
  const std::span<Interval> registers = run(condition.slope, place, room);
  const std::vector<std::uint32_t>& outputs = condition.slope.program.outputs();
  Slope slope{.value = registers[outputs[0]], .by = {}};
  slope.is_known = slope.value.is_continuous();
  for (std::size_t axis = 0; axis < kMostAxes; ++axis) {
    if (axis >= axes_.size()) break;
    slope.by[axis] = registers[outputs[axis + 1]];
    const bool known = slope.by[axis].is_defined() && !slope.by[axis].is_empty();
    if (axis + 1 == axes_.size()) slope.is_known_along = known && slope.value.is_continuous();
    slope.is_known = slope.is_known && known;
  }
  return slope;
}

}  // namespace pkm::bounds
