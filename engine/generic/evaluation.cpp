#include "engine/generic/evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"

namespace pkm::generic {
namespace {

using expression::Program;

template <class Nodes>
void append(std::vector<Node>& to, const Nodes& nodes) {
  to.insert(to.end(), nodes.begin(), nodes.end());
}
void append(std::vector<Node>& to, const std::vector<Result>& results) {
  for (const Result& result : results) to.push_back(result.node);
}
Program program_of(const Graph& graph, const std::optional<Node>& node) {
  return node ? Program(graph, {&*node, 1}) : Program();
}
std::vector<Program> programs_of(const Graph& graph, const std::vector<std::optional<Node>>& nodes) {
  std::vector<Program> programs;
  for (const auto& node : nodes) programs.push_back(program_of(graph, node));
  return programs;
}
/// One program per coordinate, for the lower (side 0) or upper (side 1) end of its range; a program without outputs for
/// a coordinate without a range.
std::vector<Program> programs_of(const Graph& graph, const std::vector<std::optional<std::array<Node, 2>>>& ranges,
                                 std::size_t side) {
  std::vector<Program> programs;
  for (const auto& ends : ranges) programs.push_back(ends ? Program(graph, {&(*ends)[side], 1}) : Program());
  return programs;
}

std::vector<double> numbers_of(std::span<const double> parameters) { return {parameters.begin(), parameters.end()}; }
std::vector<double> numbers_of(std::span<const Dual4> parameters) {
  std::vector<double> numbers;
  for (const Dual4& parameter : parameters) numbers.push_back(parameter.a);
  return numbers;
}
/// Writes the values of those inputs of the graph that are ends of contracted ranges of coordinates. Their derivatives
/// are 0, because the ends are rounded.
template <class S>
void write_range_ends(const Model& model, const bounds::IntervalBox& box, std::span<S> inputs) {
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i) {
    inputs[model.inputs.range_end(i, 0)] = S(box[i].lower);
    inputs[model.inputs.range_end(i, 1)] = S(box[i].upper);
  }
}
bool depends_on_range_ends(const Model& model, const Program& program) {
  return std::ranges::any_of(program.stages().front().inputs, [&](const Program::Input& input) {
    return input.position >= model.inputs.range_end(0, 0);
  });
}

[[noreturn]] void throw_unbounded(const Model& model, std::size_t coordinate) {
  const std::string& name = model.info.coordinates[coordinate].name;
  throw DesignError("mechanism " + model.info.name + " has no [survey] box for " + name +
                    ", and its limbs do not bound it; " + advice_for_box(name));
}
std::array<double, 2> finite_range(const Model& model, std::size_t coordinate, const Interval& range) {
  if (!std::isfinite(range.width())) throw_unbounded(model, coordinate);
  return {range.lower, range.upper};
}

}  // namespace

Evaluation::Evaluation(Model source) : model(std::move(source)) {
  std::optional<limbs::Term> mass;
  for (const BodyNodes& body : model.bodies) mass = mass ? *mass + model.term(body.mass) : model.term(body.mass);
  const Graph& graph = model.graph;
  if (mass) total_mass = program_of(graph, mass->node());
  std::vector<Node> nodes = model.joints;
  for (const auto* const list : {&model.domains, &model.margins, &model.angles}) append(nodes, *list);
  constraints = Program(graph, nodes);
  nodes.clear();
  for (const ReportedMargin& margin : model.reported_margins)
    if (margin.shown) nodes.push_back(*margin.shown);
  append(nodes, model.quantities);
  reported = Program(graph, nodes);
  nodes.clear();
  for (const JointRange& range : model.ranges) append(nodes, std::array{range.from, range.to});
  append(nodes, model.required);
  requirements = Program(graph, nodes);
  joints = Program(graph, model.joints);
  closures = Program(graph, model.closures);
  tests = Program(graph, model.test_nodes);
  nodes.clear();
  for (const LinkNodes& link : model.links) {
    append(nodes, link.from);
    append(nodes, link.to);
    nodes.push_back(link.radius);
  }
  links = Program(graph, nodes);
  origin = Program(graph, model.origin);
  nodes.assign(model.origin.begin(), model.origin.end());
  for (const auto& row : model.rotation) append(nodes, row);
  for (const auto& direction : model.rotation_directions) append(nodes, direction);
  frame = Program(graph, nodes);
  nodes.clear();
  for (const RodNodes& rod : model.rods)
    for (const auto* const end : {&rod.C, &rod.B}) append(nodes, *end);
  rods = Program(graph, nodes);
  if (const auto& e = model.equations) {
    nodes = model.joints;
    append(nodes, model.domains);
    for (const auto* const list : {&e->J, &e->J_rate_X, &e->M_X, &e->h_X, &e->G_X, &e->J_wrench}) append(nodes, *list);
    const std::array<Groups, 2> stages = {Inputs::kDesign, ~Inputs::kDesign};
    motion = Program(graph, nodes, stages);
    motion_batch.emplace(motion, 1, motion.outputs());
    nodes.clear();
    for (const MassCheck& check : model.masses) nodes.push_back(check.node);
    masses = Program(graph, nodes);
  }
  nodes = model.force_scales;
  for (const auto& tension : model.tensions)
    if (tension) append(nodes, *tension);
  drive_limits = Program(graph, nodes);
  if (model.size) size = program_of(graph, model.size->node);
  length = program_of(graph, model.length);
  radius = program_of(graph, model.radius);
  derived = programs_of(graph, model.derived);
  default_values = programs_of(graph, model.default_values);
  lower = programs_of(graph, model.box, 0);
  upper = programs_of(graph, model.box, 1);
  reach_lower = programs_of(graph, model.reach, 0);
  reach_upper = programs_of(graph, model.reach, 1);
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
void Evaluation::fill_inputs(std::span<const S> parameters, const WorkspacePlan& plan, std::size_t mode,
                             std::vector<S>& values) const {
  using Kind = FixedCoordinate::Kind;
  values.resize(model.inputs.count());
  fill_inputs<S>(parameters, plan.limits, mode, values);
  for (const int coordinate : sweep_of(model.info, plan).fixed) {
    const auto i = static_cast<std::size_t>(coordinate);
    const FixedCoordinate fixed = how_fixed(plan, coordinate);
    if (fixed.kind == Kind::integrated) continue;
    std::optional<S> value = S(fixed.kind == Kind::listed ? fixed.values.front() : fixed.value);
    if (fixed.kind == Kind::default_value) value = of_design<S>(default_values[i], parameters);
    if (!value) throw_no_default_value(model.info, coordinate);
    values[model.inputs.coordinate(i)] = *value;
  }
  const auto is_integrated = [](const FixedCoordinate& fixed) { return fixed.kind == Kind::integrated; };
  if (!model.contracted_box || (plan.box() && std::ranges::none_of(plan.fixed, is_integrated))) return;
  const bounds::IntervalBox box = contract(numbers_of(parameters), plan.limits, mode, &plan);
  write_range_ends<S>(model, box, values);
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
    if constexpr (std::is_same_v<S, double> || std::is_same_v<S, Dual4>)
      if (model.contracted_box && depends_on_range_ends(model, program))
        write_range_ends<S>(model, contract(numbers_of(parameters), no_limits(model.info), 0, nullptr), values);
    program.run_all<S>(values, registers);
    return std::optional<S>(registers[program.outputs().front()]);
  });
}

std::optional<std::array<double, 2>> Evaluation::range(std::span<const double> parameters, const LimitSpec& limits,
                                                       std::size_t mode, std::size_t coordinate) const {
  if (model.is_contracted[coordinate]) {
    const Interval range = contract(parameters, limits, mode, nullptr)[coordinate];
    if (!std::isfinite(range.width())) return {};
    return {{range.lower, range.upper}};
  }
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

std::array<double, 2> Evaluation::required_range(std::span<const double> parameters, const WorkspacePlan& plan,
                                                 std::size_t mode, std::size_t coordinate) const {
  if (model.is_contracted[coordinate]) {
    return finite_range(model, coordinate, contract(parameters, plan.limits, mode, &plan)[coordinate]);
  }
  if (const auto known = range(parameters, plan.limits, mode, coordinate)) return *known;
  throw_unbounded(model, coordinate);
}

bounds::IntervalBox Evaluation::contract(std::span<const double> parameters, const LimitSpec& limits, std::size_t mode,
                                         const WorkspacePlan* plan) const {
  const std::vector<Interval> design(parameters.begin(), parameters.end());
  std::vector<Interval> inputs(model.inputs.count());
  fill_inputs<Interval>(design, limits, mode, inputs);
  bounds::IntervalBox start;
  const auto range_of = [](const std::optional<std::array<double, 2>>& ends) {
    return ends ? std::optional(Interval((*ends)[0], (*ends)[1])) : std::nullopt;
  };
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i) {
    std::optional<Interval> given;
    if (!model.is_contracted[i]) {
      given = range_of(range(parameters, limits, mode, i));
    } else if (const auto from = of_design<double>(reach_lower[i], parameters)) {
      given = Interval(*from, *of_design<double>(reach_upper[i], parameters));
    }
    start[i] = given.value_or(widest_range(model, i));
  }
  if (plan) {
    const Sweep& sweep = sweep_of(model.info, *plan);
    if (const auto& box = plan->box())
      for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
        start[static_cast<std::size_t>(sweep.swept[axis])] = {(*box)[axis][0], (*box)[axis][1]};
    for (const int coordinate : sweep.fixed) {
      const auto i = static_cast<std::size_t>(coordinate);
      const FixedCoordinate fixed = how_fixed(*plan, coordinate);
      if (fixed.kind == FixedCoordinate::Kind::integrated) continue;
      if (fixed.kind == FixedCoordinate::Kind::listed) {
        const auto [from, to] = std::ranges::minmax(fixed.values);
        start[i] = {from, to};
      } else if (fixed.kind == FixedCoordinate::Kind::value) {
        start[i] = fixed.value;
      } else if (const auto value = of_design<double>(default_values[i], parameters)) {
        start[i] = *value;
      }
    }
  }
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i)
    if (!(start[i].lower <= start[i].upper)) return start;  // an empty range, in which no pose is feasible
  if (model.contracted_box->covers(inputs)) return model.contracted_box->find(inputs, start);
  return ContractedBox(model, inputs).find(inputs, start);
}

Box Evaluation::search_box(std::span<const double> parameters, const WorkspacePlan& plan, std::size_t mode,
                           const std::vector<int>& swept) const {
  if (const auto given = plan.box()) return *given;
  Box box;
  box.fill({0, 1});
  const auto is_contracted = [this](int i) { return bool(model.is_contracted[static_cast<std::size_t>(i)]); };
  std::optional<bounds::IntervalBox> contracted;
  if (std::ranges::any_of(swept, is_contracted)) contracted = contract(parameters, plan.limits, mode, &plan);
  for (std::size_t axis = 0; axis < swept.size(); ++axis) {
    const auto i = static_cast<std::size_t>(swept[axis]);
    box[axis] = is_contracted(swept[axis]) ? finite_range(model, i, (*contracted)[i])
                                           : required_range(parameters, plan, mode, i);
  }
  return box;
}

template void Evaluation::thresholds(std::span<const double>, const LimitSpec&, std::span<double>) const;
template void Evaluation::thresholds(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const;
template void Evaluation::fill_inputs(std::span<const double>, const LimitSpec&, std::size_t, std::span<double>) const;
template void Evaluation::fill_inputs(std::span<const Dual4>, const LimitSpec&, std::size_t, std::span<Dual4>) const;
template void Evaluation::fill_inputs(std::span<const Taylor>, const LimitSpec&, std::size_t, std::span<Taylor>) const;
template void Evaluation::fill_inputs(std::span<const Interval>, const LimitSpec&, std::size_t,
                                      std::span<Interval>) const;
template void Evaluation::fill_inputs(std::span<const double>, const WorkspacePlan&, std::size_t,
                                      std::vector<double>&) const;
template void Evaluation::fill_inputs(std::span<const Dual4>, const WorkspacePlan&, std::size_t,
                                      std::vector<Dual4>&) const;
template std::optional<double> Evaluation::of_design(const Program&, std::span<const double>) const;
template std::optional<Dual4> Evaluation::of_design(const Program&, std::span<const Dual4>) const;
template std::optional<Taylor> Evaluation::of_design(const Program&, std::span<const Taylor>) const;

}  // namespace pkm::generic
