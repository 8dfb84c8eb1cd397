#include "engine/generic/tolerances/certified_tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/generic/evaluation.hpp"
#include "engine/generic/interval_constraints.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/generic/tolerances/angle_elimination.hpp"
#include "engine/generic/tolerances/interval_jacobians.hpp"
#include "engine/generic/tolerances/rank_conditions.hpp"
#include "engine/generic/tolerances/tolerance_allocation.hpp"
#include "engine/workspace/bounds/deviation_box.hpp"

namespace pkm::generic {
namespace {

using bounds::ParametricConstraint, bounds::ParametricConstraints;
using expression::Term;

/// Whether a formula depends on parameters only, and not on thresholds or signs.
bool depends_on_parameters_only(const Model& model, Node node) {
  return std::ranges::all_of(model.graph.reachable({&node, 1}), [&](Node each) {
    const std::int32_t input = model.graph[each].input;
    return input < 0 || static_cast<std::size_t>(input) < model.inputs.parameters;
  });
}

/// The formulas of all constraints that a pose has to satisfy.
std::vector<Node> constraint_nodes(const Model& model) {
  std::vector<Node> nodes = model.defined;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) nodes.push_back(result.node);
  return nodes;
}

/// A copy of the model in which formulas replace the thresholds that depend on parameters, and in which a pose also has
/// to satisfy the requirements of the design.
Model model_with_thresholds(Model model, const LimitSpec& limits) {
  const Inputs& at = model.inputs;
  model.margins.insert(model.margins.end(), model.required.begin(), model.required.end());
  std::vector<std::optional<Node>> thresholds(at.count());
  for (std::size_t i = 0; i < at.limits; ++i) {
    if (limits.given[i]) continue;
    if (limits.derived[i] && model.derived[i]) {
      if (depends_on_parameters_only(model, *model.derived[i])) thresholds[at.limit(i)] = model.derived[i];
    } else if (model.limit_parameters[i]) {
      thresholds[at.limit(i)] = model.graph.input(*model.limit_parameters[i]);
    }
  }
  std::vector<Node> roots = constraint_nodes(model);
  model.graph = expression::substitute_nodes(model.graph, thresholds, roots);
  auto root = roots.begin();
  for (Node& node : model.defined) node = *root++;
  for (auto* const list : {&model.domains, &model.margins})
    for (Result& result : *list) result.node = *root++;
  return model;
}

class ToleranceProblem {
 public:
  ToleranceProblem(const Evaluation& e, std::span<const double> parameters, const LimitSpec& limits, std::size_t mode,
                   const PoseSet& poses, const ToleranceProportions& proportions)
      : e_(e),
        parameters_(parameters),
        limits_(limits),
        mode_(mode),
        poses_(poses),
        proportions_(proportions),
        ranges_(poses.motion ? std::vector<std::array<double, 2>>{{0, poses.motion->duration()}} : poses.ranges),
        no_singularities_(refuse_jacobians(e.model.inputs)) {
    refuse_limits_without_formula(e.model, limits);
  }

  CertifiedTolerances certify(const BoundsOptions& options) const {
    const auto stop = [&] { return options.stop && options.stop(); };
    CertifiedTolerances found;
    found.largest_scale = largest_scale();
    found.no_singularities = no_singularities_;
    const std::optional<bounds::Violation> known = search(found.largest_scale, stop);
    // Constraints whose deviations are restricted to smaller values have tighter enclosures.
    const ParametricConstraints close = constraints(known ? known->scale : found.largest_scale);
    const bounds::DeviationBox box = bounds::largest_deviation_box(close, ranges_, found.largest_scale, known,
                                                                   {options.gap, options.max_boxes, stop});
    found.scale = box.certified;
    found.boxes = box.boxes;
    found.stopped = box.stopped;
    if (box.violation) found.violation = violation(*box.violation, close);
    return found;
  }

  /// Searches locally for a violation with a small scale of at most `scale`. @return std::nullopt if none was found
  std::optional<bounds::Violation> search(double scale, const std::function<bool()>& stop) const {
    const ParametricConstraints wide = constraints(scale);
    return bounds::ViolationSearch(wide, ranges_).search(scale, stop);
  }

  std::size_t axes_of_poses() const { return ranges_.size(); }

 private:
  /// The scale of the deviations at which a parameter could become 0.
  double largest_scale() const {
    double scale = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < proportions_.parameters.size(); ++i) {
      const double value = std::fabs(parameters_[proportions_.parameters[i]]);
      if (value > 0) scale = std::min(scale, value / proportions_.sizes[i]);
    }
    if (!std::isfinite(scale)) throw std::invalid_argument("tolerances: every parameter that deviates is 0");
    return scale;
  }

  /// Values of the graph's inputs for all robots whose deviations are at most `scale` times
  /// ToleranceProportions::sizes.
  std::vector<Interval> inputs(double scale) const {
    std::vector<Interval> robots(parameters_.begin(), parameters_.end());
    for (std::size_t i = 0; i < proportions_.parameters.size(); ++i)
      robots[proportions_.parameters[i]] += Interval(-scale, scale) * Interval(proportions_.sizes[i]);
    std::vector<Interval> values(e_.model.inputs.count());
    e_.fill_inputs<Interval>(robots, limits_, mode_, values);
    return values;
  }

  /// All constraints, and the conditions against singularities, as functions of the coordinates (for a motion, of the
  /// time) and of the deviations relative to their sizes.
  /// @param scale  the functions are valid for relative deviations of at most this
  ParametricConstraints constraints(double scale) const {
    ParametricConstraints made;
    const Model model = model_with_thresholds(e_.model, limits_);
    std::vector<Interval> values = inputs(scale);
    IntervalConstraints of_poses = interval_constraints(model, values);
    std::vector<ParametricConstraint> all;
    for (const auto& constraint : of_poses.all) all.push_back({constraint.name, constraint.node});
    add(made, std::move(of_poses.graph), all, std::move(values));
    if (no_singularities_) return made;
    values = inputs(scale);
    Graph graph;
    all.clear();
    std::vector<bounds::NamedMatrix> matrices = jacobians(e_.model, graph, values);
    const auto is_sign = [&](Node node) {
      // If the node is not an input, its index -1 becomes a huge number.
      const auto input = static_cast<std::size_t>(graph[node].input);
      return input >= e_.model.inputs.sign(0) && input < e_.model.inputs.sign(e_.model.inputs.signs);
    };
    for (bounds::NamedMatrix& matrix : matrices) {
      eliminate_angles(graph, is_sign, matrix.entries);
      const std::vector<Node> conditions = rank_conditions(graph, matrix);
      for (const Node node : conditions) all.push_back({matrix.name, node, true});
      if (conditions.size() > 1) continue;  // the elements of a diagonal matrix
      all.back().matrix = matrix.entries;
      all.back().columns = matrix.columns;
    }
    add(made, std::move(graph), all, std::move(values));
    return made;
  }

  /// Replaces the coordinates in the constraints by formulas of the motion, if there is one, and the parameters by sums
  /// of value and deviation, and adds the constraints to `to`.
  void add(ParametricConstraints& to, Graph graph, std::vector<ParametricConstraint>& constraints,
           std::vector<Interval> values) const {
    const Inputs& at = e_.model.inputs;
    std::vector<Node> roots;
    for (const ParametricConstraint& constraint : constraints) roots.push_back(constraint.node);
    for (const ParametricConstraint& constraint : constraints)
      roots.insert(roots.end(), constraint.matrix.begin(), constraint.matrix.end());
    std::vector<std::size_t> axes;
    if (poses_.motion)
      axes.push_back(substitute_motion(*poses_.motion, at, graph, values, roots));
    else
      for (std::size_t i = 0; i < ranges_.size(); ++i) axes.push_back(at.coordinate(i));
    std::vector<std::optional<Node>> deviating(at.parameters);
    for (std::size_t i = 0; i < proportions_.parameters.size(); ++i) {
      const std::size_t parameter = proportions_.parameters[i];
      const auto input = [&](double value) {
        values.emplace_back(value);
        return Term(graph, graph.input(values.size() - 1));
      };
      const Term deviation = input(0);
      axes.push_back(values.size() - 1);
      deviating[parameter] = (input(parameters_[parameter]) + input(proportions_.sizes[i]) * deviation).node();
    }
    graph = expression::substitute_nodes(graph, deviating, roots);
    auto entry = roots.begin() + static_cast<std::ptrdiff_t>(constraints.size());
    for (ParametricConstraint& constraint : constraints)
      for (Node& each : constraint.matrix) each = *entry++;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      constraints[k].node = roots[k];
      if (constraints[k].is_strict && is_negative(graph, roots[k], axes, values))
        constraints[k].node = (-Term(graph, roots[k])).node();
    }
    to.add(std::move(graph), constraints, axes, std::move(values));
  }

  /// Whether a formula is negative for the robot without deviations at the middle of all ranges of pose or time.
  bool is_negative(const Graph& graph, Node node, const std::vector<std::size_t>& axes,
                   std::vector<Interval> values) const {
    for (std::size_t i = 0; i < ranges_.size(); ++i) values[axes[i]] = Interval(ranges_[i][0], ranges_[i][1]).middle();
    return outputs_of<Interval>(expression::Program(graph, {&node, 1}), values).front().upper < 0;
  }

  ToleranceViolation violation(const bounds::Violation& found, const ParametricConstraints& constraints) const {
    ToleranceViolation made{.scale = found.scale,
                            .parameters = std::vector(parameters_.begin(), parameters_.end()),
                            .constraint = constraints.name(found.constraint),
                            .pose = Pose<double>(ranges_.size()),
                            .time = {}};
    std::copy_n(found.point.begin(), ranges_.size(), made.pose.begin());
    if (poses_.motion) {
      made.time = found.point.front();
      made.pose = poses_.motion->at(*made.time).pose;
    }
    for (std::size_t i = 0; i < proportions_.parameters.size(); ++i)
      made.parameters[proportions_.parameters[i]] += proportions_.sizes[i] * found.point[ranges_.size() + i];
    return made;
  }

  const Evaluation& e_;
  std::span<const double> parameters_;
  const LimitSpec& limits_;
  std::size_t mode_;
  const PoseSet& poses_;
  const ToleranceProportions& proportions_;
  std::vector<std::array<double, 2>> ranges_;
  Unsupported no_singularities_;
};

}  // namespace

std::vector<bool> affects_poses(const Mechanism& mechanism, const LimitSpec& limits) {
  const Model& source = evaluation_of(mechanism)->model;
  const Model model = model_with_thresholds(source, limits);
  std::vector<bool> affects(source.inputs.parameters);
  const auto mark = [&](const Graph& graph, std::span<const Node> nodes) {
    for (const Node node : graph.reachable(nodes)) {
      const std::int32_t input = graph[node].input;
      if (input >= 0 && static_cast<std::size_t>(input) < affects.size())
        affects[static_cast<std::size_t>(input)] = true;
    }
  };
  mark(model.graph, constraint_nodes(model));
  mark(source.graph, source.closures);
  mark(source.graph, source.joints);
  for (std::size_t i = 0; i < source.inputs.limits; ++i)
    if (limits.derived[i] && !limits.given[i] && source.derived[i]) mark(source.graph, {&*source.derived[i], 1});
  return affects;
}

ToleranceProportions cheapest_proportions(const Mechanism& mechanism, std::span<const double> parameters,
                                          const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                          const ToleranceProportions& costs, const std::function<bool()>& stop) {
  constexpr int kMaxCuts = 100;
  constexpr double kClose = 0.995;       // the iteration ends if the smallest violation found has at least this scale
  constexpr double kLargestShare = 0.1;  // maximum size of a tolerance, relative to its parameter
  double largest = 0;
  for (const std::size_t parameter : costs.parameters) largest = std::max(largest, std::fabs(parameters[parameter]));
  if (largest == 0) return costs;  // all parameters are 0: certified_tolerances() reports this as an error
  const std::size_t count = costs.parameters.size();
  std::vector<ToleranceRow> rows(count);
  // Factor by which `costs.sizes` are multiplied; the products are the first proportions that are tried.
  double scale = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const double value = std::fabs(parameters[costs.parameters[i]]);
    rows[i] = {std::vector<double>(count), kLargestShare * (value > 0 ? value : largest)};
    rows[i].coefficients[i] = 1;
    scale = std::min(scale, rows[i].bound / costs.sizes[i]);
  }
  ToleranceProportions made = costs, best = costs;
  for (double& size : made.sizes) size *= scale;
  double minimum_cost = std::numeric_limits<double>::infinity();
  for (int cut = 0; cut < kMaxCuts && !stop(); ++cut) {
    const ToleranceProblem problem(*evaluation_of(mechanism), parameters, limits, mode_index(mechanism.info(), mode),
                                   poses, made);
    const std::optional<bounds::Violation> found = problem.search(1, stop);
    double cost = 0;
    for (std::size_t i = 0; i < count; ++i) cost += costs.sizes[i] / made.sizes[i];
    if (found) cost /= found->scale;
    if (cost < minimum_cost) {
      minimum_cost = cost;
      best = made;
    }
    if (cut > 0 && (!found || found->scale > kClose)) break;
    if (found) {
      if (found->gradient.empty()) break;  // the robot without deviations does not do the task
      ToleranceRow row;
      for (std::size_t i = 0; i < count; ++i) {
        // Change of the constraint if parameter i deviates by its whole tolerance.
        const double effect = std::fabs(found->gradient[problem.axes_of_poses() + i]);
        row.coefficients.push_back(effect / made.sizes[i]);
        row.bound += found->scale * effect;
      }
      if (!(row.bound > 0) || !std::isfinite(row.bound)) break;
      rows.push_back(row);
    }
    made.sizes = allocate_tolerances(costs.sizes, rows);
  }
  return best;
}

CertifiedTolerances certified_tolerances(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                         const ToleranceProportions& proportions, const BoundsOptions& options) {
  return ToleranceProblem(*evaluation_of(mechanism), parameters, limits, mode_index(mechanism.info(), mode), poses,
                          proportions)
      .certify(options);
}

}  // namespace pkm::generic
