#include "engine/workspace/bounds/conditions.hpp"

#include <algorithm>

#include "engine/expression/derivative.hpp"
#include "engine/expression/interval_steps.hpp"

namespace pkm::bounds {

using expression::Graph, expression::Groups, expression::Node, expression::Program;

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
  graph = expression::without_numbers(graph, inputs.size(), group_of, numbers, roots);
  inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  std::vector<Node> coordinates;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    coordinates.push_back(graph.input(axes_[axis], axis_group(axis)));
  std::vector<Node> outputs;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    if (std::find(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(k), roots[k]) !=
        roots.begin() + static_cast<std::ptrdiff_t>(k))
      continue;  // the same once more
    Condition made{.name = conditions[k].name, .node = conditions[k].node, .value = {}, .slope = {}};
    outputs.push_back(roots[k]);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      made.depends[axis] = (graph[roots[k]].groups & axis_group(axis)) != 0;
      outputs.push_back(expression::derivative(graph, roots[k], coordinates[axis]));
    }
    all_.push_back(std::move(made));
  }
  const Groups last = axis_group(axes_.size() - 1);
  const Program program(graph, outputs, std::array{kFixed, ~(kFixed | last), last});
  const std::size_t width = 1 + axes_.size();
  for (std::size_t k = 0; k < all_.size(); ++k) {
    all_[k].value = part_of(program, k * width, 1);
    all_[k].slope = part_of(program, k * width, width);
  }
  registers_.resize(axes_.size());
  for (const Program::Stage& stage : program.stages())
    for (const Program::Input& input : stage.inputs)
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        if (axes_[axis] == input.position) registers_[axis] = input.to;
  start_.registers_.resize(program.registers());
  start_.since_.resize(program.registers());
  program.start<Interval>(start_.registers_);
  program.run<Interval>(0, inputs, start_.registers_);
}

Conditions::Part Conditions::part_of(const Program& program, std::size_t first_output, std::size_t count) {
  Part part{.outputs = {}, .outer = {}, .last = {}, .number = start_.computed_.size()};
  start_.computed_.push_back(0);
  std::vector<bool> wanted(program.registers());
  for (std::size_t i = 0; i < count; ++i) {
    part.outputs.push_back(program.outputs()[first_output + i]);
    wanted[part.outputs.back()] = true;
  }
  const auto collect = [&](const Program::Stage& stage, std::vector<Program::Step>& to) {
    for (auto step = stage.steps.rbegin(); step != stage.steps.rend(); ++step) {
      if (!wanted[step->to]) continue;
      for (std::size_t i = 0; i < step->count; ++i) wanted[step->from[i]] = true;
      to.push_back(*step);
    }
    std::ranges::reverse(to);
  };
  collect(program.stages()[2], part.last);
  collect(program.stages()[1], part.outer);
  return part;
}

void Conditions::enter(const Place& place, Room& room) const {
  for (std::size_t axis = 0; axis + 1 < axes_.size(); ++axis)
    if (registers_[axis]) room.registers_[*registers_[axis]] = place[axis];
  room.box_ = ++room.now_;
  room.along_ = Interval::empty();  // which is like none
}

void Conditions::run(const Part& part, const Interval& along, Room& room) const {
  if (room.computed_[part.number] != room.box_) {
    expression::run_steps(part.outer, room.box_, room.since_, room.registers_);
    room.computed_[part.number] = room.box_;
  }
  if (along.lower != room.along_.lower || along.upper != room.along_.upper) {
    room.along_ = along;
    room.along_since_ = ++room.now_;
    if (registers_.back()) room.registers_[*registers_.back()] = along;
  }
  expression::run_steps(part.last, room.along_since_, room.since_, room.registers_);
}

Interval Conditions::value(std::size_t k, const Interval& along, Room& room) const {
  run(all_[k].value, along, room);
  return room.registers_[all_[k].value.outputs.front()];
}

Slope Conditions::slope(std::size_t k, const Interval& along, Room& room) const {
  run(all_[k].slope, along, room);
  const std::span<const Interval> registers = room.registers_;
  const std::vector<std::uint32_t>& outputs = all_[k].slope.outputs;
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
