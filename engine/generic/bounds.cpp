#include "engine/generic/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/generic/interval_constraints.hpp"
#include "engine/generic/tolerances/interval_jacobians.hpp"
#include "engine/workspace/bounds/force_balance.hpp"
#include "engine/workspace/bounds/pose_box.hpp"
#include "engine/workspace/bounds/proof.hpp"
#include "engine/workspace/bounds/separation.hpp"

namespace pkm::generic {
namespace {

using bounds::Ranges;

/// Values of the inputs of the mechanism's expression graph, as intervals: the parameters of a design, and the fixed
/// coordinates.
std::vector<Interval> inputs_of(const Mechanism& mechanism, const Evaluation& e, std::span<const double> parameters,
                                const WorkspacePlan& plan, std::size_t mode) {
  const std::vector<Interval> design(parameters.begin(), parameters.end());
  std::vector<Interval> inputs(e.model.inputs.count());
  e.fill_inputs<Interval>(design, plan.limits, mode, inputs);
  for (const int coordinate : sweep_of(mechanism.info(), plan).fixed)
    inputs[e.model.inputs.coordinate(static_cast<std::size_t>(coordinate))] =
        fixed_value(mechanism, parameters, plan, coordinate);
  return inputs;
}

/// The balance of the drive forces; the model has one.
bounds::BalanceFormulas balance_of(const Model& model) {
  const BalanceNodes& balance = *model.balance;
  const std::size_t n = model.inputs.coordinates;
  bounds::BalanceFormulas formulas{.joints = model.inputs.joints,
                                   .coordinates = n,
                                   .is_limited = {},
                                   .half_axes = {},
                                   .is_closure = balance.loads.empty(),
                                   .all = balance.J};
  const auto append = [&](const std::vector<Node>& nodes) {
    formulas.all.insert(formulas.all.end(), nodes.begin(), nodes.end());
  };
  for (const auto& tension : model.tensions) {
    formulas.is_limited.push_back(tension.has_value());
    if (tension) append({(*tension)[0], (*tension)[1]});
  }
  for (const BalanceNodes::Loads& loads : balance.loads) {
    formulas.half_axes.push_back(loads.half_axes.size());
    append(loads.centre);
    for (const auto& axis : loads.half_axes) append(axis);
  }
  if (formulas.is_closure) formulas.half_axes.push_back(0);
  return formulas;
}

/// Decides the margin of cables by the balance of forces.
void decide_by_balance(const Model& model, const IntervalConstraints& constraints, const std::vector<std::size_t>& axes,
                       const std::vector<Interval>& inputs, bounds::Constraints& conditions) {
  if (!constraints.balance) return;
  conditions.decide_by_balance(constraints.all[*constraints.balance].node,
                               std::make_shared<bounds::ForceBalance>(model.graph, balance_of(model), axes, inputs));
}

}  // namespace

void require_bounds(const Model& model, const WorkspacePlan& plan) {
  if (plan.home)
    throw std::invalid_argument(
        "certified bounds of a volume count all components of the workspace, and not only the one that holds the home "
        "pose; remove home");
  refuse_limits_without_formula(model, plan.limits);
  for (const int coordinate : sweep_of(model.info, plan).fixed) {
    const FixedCoordinate fixed = how_fixed(plan, coordinate);
    const bool integrated = fixed.kind == FixedCoordinate::Kind::integrated;
    if (integrated || (fixed.kind == FixedCoordinate::Kind::listed && fixed.values.size() > 1))
      throw std::invalid_argument("certified bounds need a single value of " +
                                  model.info.coordinates[static_cast<std::size_t>(coordinate)].name +
                                  ", but the workspace analysis " +
                                  (integrated ? "integrates over it" : "has several") + "; fix it at one value");
  }
}

VolumeBounds bound_volume(const Mechanism& mechanism, const Evaluation& e, std::span<const double> parameters,
                          const WorkspacePlan& plan, std::size_t mode, const BoundsOptions& options) {
  require_bounds(e.model, plan);
  const std::vector<int>& swept = sweep_of(mechanism.info(), plan).swept;
  const Ranges given = e.search_box(parameters, plan, mode, swept);
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (!(given[i][0] < given[i][1])) return {.innermost = swept[i]};
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (!std::isfinite(given[i][1] - given[i][0]))
      throw std::invalid_argument("certified bounds: the range of " +
                                  mechanism.info().coordinates[static_cast<std::size_t>(swept[i])].name +
                                  " is longer than the largest double, 1.8e308");
  const std::vector<Interval> inputs = inputs_of(mechanism, e, parameters, plan, mode);
  const IntervalConstraints constraints = interval_constraints(e.model, inputs);

  // Bound the volume with few boxes for each choice of the innermost coordinate, and keep the choice with the smallest
  // difference between upper and lower bound.
  struct Order {
    bounds::Constraints conditions;
    Ranges ranges;
    /// Index of the mechanism's coordinate for each axis of the boxes, by axis; the last axis is the innermost one.
    std::vector<std::size_t> coordinates;
  };
  std::optional<Order> best;
  double min_gap = 0;
  for (std::size_t last = swept.size(); last-- > 0;) {
    std::vector<std::size_t> coordinates, positions;
    Ranges ranges{};
    for (std::size_t i = 0; i < swept.size(); ++i) {
      const std::size_t axis = i == swept.size() - 1 ? last : i + (i >= last);
      coordinates.push_back(static_cast<std::size_t>(swept[axis]));
      positions.push_back(e.model.inputs.coordinate(coordinates.back()));
      ranges[i] = given[axis];
    }
    Order order{bounds::Constraints(constraints.graph, constraints.all, positions, inputs), ranges, coordinates};
    if (order.conditions.size() > bounds::kMaxConstraints)
      throw std::invalid_argument("certified bounds support at most " + std::to_string(bounds::kMaxConstraints) +
                                  " constraints, but mechanism " + mechanism.info().name + " has " +
                                  std::to_string(order.conditions.size()));
    BoundsOptions few = options;
    few.max_boxes = std::min<std::size_t>(options.max_boxes, 1024);
    const VolumeBounds tried = bounds::volume_bounds(order.conditions, order.ranges, few);
    if (best && tried.upper - tried.lower >= min_gap) continue;
    min_gap = tried.upper - tried.lower;
    best.emplace(std::move(order));
  }
  bounds::ProofTree tree;
  VolumeBounds found = bounds::volume_bounds(best->conditions, best->ranges, options, options.proof ? &tree : nullptr);
  found.innermost = static_cast<int>(best->coordinates.back());
  if (!options.proof) return found;

  const MechanismInfo& info = mechanism.info();
  bounds::Statement statement{.graph = constraints.graph,
                              .constraints = best->conditions,
                              .axes = {},
                              .positions = {},
                              .ranges = best->ranges,
                              .inputs = inputs,
                              .input_names = std::vector<std::string>(inputs.size()),
                              .title = info.name + ", " + info.title};
  for (const std::size_t coordinate : best->coordinates) {
    statement.axes.push_back(info.coordinates[coordinate].name);
    statement.positions.push_back(e.model.inputs.coordinate(coordinate));
  }
  for (std::size_t i = 0; i < info.parameters.size(); ++i) statement.input_names[i] = info.parameters[i].name;
  for (std::size_t i = 0; i < e.model.inputs.limits; ++i)
    statement.input_names[e.model.inputs.limit(i)] = "limit " + info.limits[i].name;
  for (std::size_t i = 0; i < info.coordinates.size(); ++i)
    statement.input_names[e.model.inputs.coordinate(i)] = info.coordinates[i].name;
  for (std::size_t i = 0; i < info.inputs.size(); ++i)
    statement.input_names[e.model.inputs.extra(i)] = info.inputs[i].name;
  *options.proof = bounds::proof_text(statement, found, tree);
  return found;
}

namespace {

/// Values of the inputs of the mechanism's expression graph for a design, as intervals; those of the coordinates are 0.
std::vector<Interval> inputs_of(const Evaluation& e, std::span<const double> parameters, const LimitSpec& limits,
                                std::size_t mode) {
  refuse_limits_without_formula(e.model, limits);
  const std::vector<Interval> design(parameters.begin(), parameters.end());
  std::vector<Interval> inputs(e.model.inputs.count());
  e.fill_inputs<Interval>(design, limits, mode, inputs);
  return inputs;
}

bounds::Matrices jacobians_along(const Motion& motion, const Model& model, std::vector<Interval> inputs) {
  Graph graph;
  std::vector<bounds::NamedMatrix> named = jacobians(model, graph, inputs);
  std::vector<Node> entries;
  for (const auto& matrix : named) entries.insert(entries.end(), matrix.entries.begin(), matrix.entries.end());
  const std::size_t time = substitute_motion(motion, model.inputs, graph, inputs, entries);
  auto entry = entries.begin();
  for (auto& matrix : named)
    for (Node& node : matrix.entries) node = *entry++;
  return {graph, named, {time}, inputs};
}

}  // namespace

PoseCertificate certify_solid(const Evaluation& e, std::span<const double> parameters, const WorkspacePlan& plan,
                              std::size_t mode, const PoseSolid& poses, const BoundsOptions& options) {
  std::vector<Interval> inputs = inputs_of(e, parameters, plan.limits, mode);
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < poses.ranges.size(); ++i) axes.push_back(e.model.inputs.coordinate(i));
  const IntervalConstraints constraints = interval_constraints(e.model, inputs);
  bounds::Constraints conditions(constraints.graph, constraints.all, axes, inputs);
  decide_by_balance(e.model, constraints, axes, inputs, conditions);
  Graph graph;
  std::optional<bounds::Matrices> matrices;
  const Unsupported not_examined = refuse_jacobians(e.model.inputs);
  if (!not_examined) {
    const auto named = jacobians(e.model, graph, inputs);
    matrices.emplace(graph, named, axes, inputs);
  }
  PoseCertificate found = bounds::certify(conditions, matrices ? &*matrices : nullptr, poses, options);
  if (not_examined) found.regular.detail = *not_examined;
  return found;
}

PoseCertificate certify_motion(const Evaluation& e, std::span<const double> parameters, const LimitSpec& limits,
                               std::size_t mode, const Motion& motion, const BoundsOptions& options) {
  const std::vector<Interval> design = inputs_of(e, parameters, limits, mode);
  IntervalConstraints constraints = interval_constraints(e.model, design);
  std::vector<Node> roots;
  for (const auto& constraint : constraints.all) roots.push_back(constraint.node);
  std::vector<Interval> inputs = design;
  const std::size_t time = substitute_motion(motion, e.model.inputs, constraints.graph, inputs, roots);
  for (std::size_t i = 0; i < roots.size(); ++i) constraints.all[i].node = roots[i];
  bounds::Constraints conditions(constraints.graph, constraints.all, {time}, inputs);
  if (constraints.balance) {
    Graph graph = e.model.graph;
    bounds::BalanceFormulas balance = balance_of(e.model);
    std::vector<Interval> balance_inputs = design;
    const std::size_t at = substitute_motion(motion, e.model.inputs, graph, balance_inputs, balance.all);
    conditions.decide_by_balance(
        constraints.all[*constraints.balance].node,
        std::make_shared<bounds::ForceBalance>(graph, balance, std::vector{at}, balance_inputs));
  }
  std::optional<bounds::Matrices> matrices;
  const Unsupported not_examined = refuse_jacobians(e.model.inputs);
  if (!not_examined) matrices = jacobians_along(motion, e.model, design);

  const auto certify_until = [&](double end, const bounds::Matrices* regular) {
    return bounds::certify(conditions, regular, {.ranges = {{0, end}}}, options);
  };
  PoseCertificate found = certify_until(motion.duration(), matrices ? &*matrices : nullptr);
  const auto time_of = [](const PropertyResult& finding) { return (*finding.pose)[0]; };
  // The infeasible instant that was found need not be the first one: search before it repeatedly, until no earlier one
  // is found.
  double later = motion.duration();
  while (found.feasible.kind == PropertyResult::Kind::fails &&
         later - time_of(found.feasible) > 1e-6 * motion.duration()) {
    later = time_of(found.feasible);
    PoseCertificate before = certify_until(later, nullptr);
    found.boxes += before.boxes;
    if (before.feasible.kind == PropertyResult::Kind::fails) found.feasible = before.feasible;
  }
  if (not_examined) found.regular.detail = *not_examined;
  for (PropertyResult* const finding : {&found.feasible, &found.regular})
    if (finding->pose) {
      finding->time = time_of(*finding);
      finding->pose = motion.at(*finding->time).pose;
    }
  return found;
}

Separation separate_poses(const Evaluation& e, std::span<const double> parameters, const WorkspacePlan& plan,
                          std::size_t mode, const Pose<double>& from, const Pose<double>& to,
                          const BoundsOptions& options) {
  std::vector<Interval> inputs = inputs_of(e, parameters, plan.limits, mode);
  for (std::size_t i = 0; i < from.size(); ++i) inputs[e.model.inputs.coordinate(i)] = from[i];
  const std::vector<int>& swept = sweep_of(e.model.info, plan).swept;
  const Box box = e.search_box(parameters, plan, mode, swept);
  std::vector<bounds::SeparationAxis> axes;
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const auto coordinate = static_cast<std::size_t>(swept[i]);
    positions.push_back(e.model.inputs.coordinate(coordinate));
    axes.push_back({box[i], from[coordinate], to[coordinate],
                    e.model.info.coordinates[coordinate].turns() && box[i][1] - box[i][0] > 2 * kPi * (1 - 1e-12)});
  }
  const IntervalConstraints constraints = interval_constraints(e.model, inputs);
  const bounds::Constraints conditions(constraints.graph, constraints.all, positions, inputs);
  Graph graph;
  std::optional<bounds::Matrices> matrices;
  if (e.model.inputs.joints == e.model.inputs.coordinates) {
    const auto named = jacobians(e.model, graph, inputs);
    matrices.emplace(graph, named, positions, inputs);
  }
  return bounds::separate(conditions, matrices ? &*matrices : nullptr, axes, options);
}

}  // namespace pkm::generic
