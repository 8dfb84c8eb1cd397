#include "engine/generic/evaluation.hpp"

#include <algorithm>
#include <stdexcept>

namespace pkm::generic {
namespace {

using expression::Program;

std::vector<Node> nodes_of(const std::vector<Result>& results) {
  std::vector<Node> nodes;
  for (const Result& result : results) nodes.push_back(result.node);
  return nodes;
}
Program program_of(const Graph& graph, const std::optional<Node>& node) {
  return node ? Program(graph, {&*node, 1}) : Program();
}
/// One program for each node.
template <class NodeOf>
std::vector<Program> programs_of(const Graph& graph, std::size_t count, const NodeOf& node_of) {
  std::vector<Program> programs;
  for (std::size_t i = 0; i < count; ++i) programs.push_back(program_of(graph, node_of(i)));
  return programs;
}

}  // namespace

Evaluation::Evaluation(Model source) : model(std::move(source)) {
  const Graph& graph = model.graph;
  std::vector<Node> all = model.joints;
  for (const auto* const list : {&model.domains, &model.margins, &model.angles})
    std::ranges::copy(nodes_of(*list), std::back_inserter(all));
  constraints = Program(graph, all);
  std::vector<Node> reported_nodes;
  for (const ReportedMargin& margin : model.reported_margins)
    if (margin.shown) reported_nodes.push_back(*margin.shown);
  reported_nodes.insert(reported_nodes.end(), model.quantities.begin(), model.quantities.end());
  reported = Program(graph, reported_nodes);
  std::vector<Node> required;
  for (const JointRange& range : model.ranges) required.insert(required.end(), {range.from, range.to});
  std::ranges::copy(nodes_of(model.required), std::back_inserter(required));
  requirements = Program(graph, required);
  joints = Program(graph, model.joints);
  closures = Program(graph, model.closures);
  tests = Program(graph, model.test_nodes);
  std::vector<Node> placed;
  for (const LinkNodes& link : model.links) {
    std::ranges::copy(link.from, std::back_inserter(placed));
    std::ranges::copy(link.to, std::back_inserter(placed));
    placed.push_back(link.radius);
  }
  links = Program(graph, placed);
  origin = Program(graph, model.origin);
  std::vector<Node> framed(model.origin.begin(), model.origin.end());
  for (const auto& row : model.rotation) std::ranges::copy(row, std::back_inserter(framed));
  for (const auto& axis : model.rotation_directions) std::ranges::copy(axis, std::back_inserter(framed));
  frame = Program(graph, framed);
  std::vector<Node> of_rods;
  for (const RodNodes& rod : model.rods)
    for (const auto* const end : {&rod.C, &rod.B}) std::ranges::copy(*end, std::back_inserter(of_rods));
  rods = Program(graph, of_rods);
  if (const auto& equations = model.equations) {
    std::vector<Node> of_motion = model.joints;
    std::ranges::copy(nodes_of(model.domains), std::back_inserter(of_motion));
    for (const auto* const list :
         {&equations->J, &equations->J_rate_X, &equations->M_X, &equations->h_X, &equations->G_X, &equations->J_wrench})
      std::ranges::copy(*list, std::back_inserter(of_motion));
    const std::array<Groups, 2> stages = {Inputs::kDesign, ~Inputs::kDesign};
    motion = Program(graph, of_motion, stages);
    motion_batch.emplace(motion, 1, motion.outputs());
    std::vector<Node> checked;
    for (const MassCheck& check : model.masses) checked.push_back(check.node);
    masses = Program(graph, checked);
  }
  size = program_of(graph, model.size ? std::optional(model.size->node) : std::nullopt);
  length = program_of(graph, model.length);
  radius = program_of(graph, model.radius);
  const std::size_t coordinates = model.inputs.coordinates;
  const auto end = [&](std::size_t i, std::size_t side) {
    return model.box[i] ? std::optional((*model.box[i])[side]) : std::nullopt;
  };
  derived = programs_of(graph, model.derived.size(), [&](std::size_t i) { return model.derived[i]; });
  lower = programs_of(graph, coordinates, [&](std::size_t i) { return end(i, 0); });
  upper = programs_of(graph, coordinates, [&](std::size_t i) { return end(i, 1); });
  default_values = programs_of(graph, coordinates, [&](std::size_t i) { return model.default_values[i]; });
  const auto reach = [&](std::size_t i, std::size_t side) {
    return model.reach[i] ? std::optional((*model.reach[i])[side]) : std::nullopt;
  };
  reach_lower = programs_of(graph, coordinates, [&](std::size_t i) { return reach(i, 0); });
  reach_upper = programs_of(graph, coordinates, [&](std::size_t i) { return reach(i, 1); });
}

template <class S>
void Evaluation::thresholds(std::span<const S> parameters, const LimitSpec& limits, std::span<S> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& parameter = model.limit_parameters[i];
    values[i] = parameter && !limits.given[i] ? parameters[*parameter]
                                              : S(limits.given[i].value_or(model.info.limits[i].inactive));
    if (limits.derived[i] && !limits.given[i])
      if (const auto found = of_design<S>(derived[i], parameters)) values[i] = *found;
  }
}

template <class S>
void Evaluation::fill_inputs(std::span<const S> parameters, const LimitSpec& limits, std::size_t mode,
                             std::span<S> values) const {
  const Inputs& at = model.inputs;
  std::ranges::fill(values, S(0.0));
  std::ranges::copy(parameters, values.begin());
  thresholds<S>(parameters, limits, values.subspan(at.limit(0), at.limits));
  for (std::size_t i = 0; i < at.signs; ++i) values[at.sign(i)] = S(model.signs[mode][i]);
  for (std::size_t i = 0; i < at.extras; ++i) values[at.extra(i)] = S(model.info.inputs[i].value);
}

template <class S>
std::optional<S> Evaluation::of_design(const Program& program, std::span<const S> parameters) const {
  if (program.outputs().empty()) return {};
  const Inputs& at = model.inputs;
  return with_scratch<S>(at.count() + program.registers(), [&](std::span<S> scratch) {
    const std::span<S> values = scratch.first(at.count()), registers = scratch.subspan(at.count());
    std::ranges::copy(parameters, values.begin());
    for (std::size_t i = 0; i < at.limits; ++i)
      values[at.limit(i)] =
          model.limit_parameters[i] ? parameters[*model.limit_parameters[i]] : S(model.info.limits[i].inactive);
    for (std::size_t i = 0; i < at.signs; ++i) values[at.sign(i)] = S(model.signs.front()[i]);
    program.run_all<S>(values, registers);
    return std::optional<S>(registers[program.outputs().front()]);
  });
}

std::optional<std::array<double, 2>> Evaluation::range(std::span<const double> parameters, const LimitSpec& limits,
                                                       std::size_t mode, std::size_t coordinate) const {
  const auto end = [&](const Program& program) -> std::optional<double> {
    if (program.outputs().empty()) return {};
    return with_scratch<double>(model.inputs.count() + program.registers(), [&](std::span<double> scratch) {
      const std::span<double> values = scratch.first(model.inputs.count()), registers = scratch.subspan(values.size());
      fill_inputs<double>(parameters, limits, mode, values);
      program.run_all<double>(values, registers);
      return registers[program.outputs().front()];
    });
  };
  const auto from = end(lower[coordinate]), to = end(upper[coordinate]);
  if (!from || !to) return {};
  return {{*from, *to}};
}

std::array<double, 2> Evaluation::required_range(std::span<const double> parameters, const LimitSpec& limits,
                                                 std::size_t mode, std::size_t coordinate) const {
  if (const auto known = range(parameters, limits, mode, coordinate)) return *known;
  throw std::invalid_argument("mechanism " + model.info.name + " has no [survey] box for " +
                              model.info.coordinates[coordinate].name + "; give a box");
}

Box Evaluation::search_box(std::span<const double> parameters, const WorkspacePlan& plan, std::size_t mode,
                           const std::vector<int>& swept) const {
  if (const auto given = plan.box()) return *given;
  Box box;
  box.fill({0, 1});
  for (std::size_t axis = 0; axis < swept.size(); ++axis)
    box[axis] = required_range(parameters, plan.limits, mode, static_cast<std::size_t>(swept[axis]));
  return box;
}

template void Evaluation::thresholds(std::span<const double>, const LimitSpec&, std::span<double>) const;
template void Evaluation::thresholds(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const;
template void Evaluation::fill_inputs(std::span<const double>, const LimitSpec&, std::size_t, std::span<double>) const;
template void Evaluation::fill_inputs(std::span<const Dual4>, const LimitSpec&, std::size_t, std::span<Dual4>) const;
template void Evaluation::fill_inputs(std::span<const Taylor>, const LimitSpec&, std::size_t, std::span<Taylor>) const;
template void Evaluation::fill_inputs(std::span<const Interval>, const LimitSpec&, std::size_t,
                                      std::span<Interval>) const;
template std::optional<double> Evaluation::of_design(const Program&, std::span<const double>) const;
template std::optional<Dual4> Evaluation::of_design(const Program&, std::span<const Dual4>) const;
template std::optional<Taylor> Evaluation::of_design(const Program&, std::span<const Taylor>) const;

}  // namespace pkm::generic
