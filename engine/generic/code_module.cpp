#include "engine/mechanism/code_module.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/halton.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm::code {
namespace {

using expression::Node;
using generic::Evaluation;

// Minimum inverse condition number of the Jacobian at test poses in double and in single precision. Rounding errors
// grow near singularities. If too few such poses are found, the minimum is lowered in steps, but not below
// kLeastConditioning.
constexpr double kMinConditioning = 2e-2, kMinConditioningOfFloats = 1e-1, kLeastConditioning = 1e-3;
// distance in each coordinate [m, rad] between a test pose and the start of its forward kinematics
constexpr double kStep = 1e-5;

/// Converts a name to an identifier of all target languages: replaces all characters other than letters and digits.
std::string identifier(const std::string& name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0]))) text.insert(0, "robot_");
  return text;
}

/// Collects the nodes of all generated functions in the mechanism's graph, and copies the nodes that they depend on to
/// the module.
class Collector {
 public:
  Collector(const Evaluation& evaluation, std::size_t mode, Module& module)
      : model_(evaluation.model), graph_(evaluation.model.graph), module_(module), mode_(mode) {}

  void collect(std::span<const double> parameters, const LimitSpec& limits) {
    add_functions();
    std::vector<Node> roots;
    for_each_output([&](Output& output) { roots.insert(roots.end(), output.nodes.begin(), output.nodes.end()); });
    if (std::ranges::any_of(graph_.reachable(roots), [&](Node node) { return graph_[node].solution; }))
      throw std::invalid_argument("code is generated from formulas, and " + model_.info.name +
                                  " has unknowns of [[solve]], which have none");
    replace_limits(limits, roots);
    replace_constants(parameters, roots);
    auto next = roots.begin();
    for_each_output([&](Output& output) {
      std::copy_n(next, output.nodes.size(), output.nodes.begin());
      next += static_cast<std::ptrdiff_t>(output.nodes.size());
    });
    name_inputs();
  }

 private:
  template <class Visit>
  void for_each_output(const Visit& visit) {
    std::vector<Function*> all = {&module_.inverse, &module_.jacobian, &module_.limits};
    if (module_.values) all.push_back(&*module_.values);
    if (module_.equations) all.push_back(&*module_.equations);
    for (Function* const function : all)
      for (Output& output : function->outputs) visit(output);
  }

  static std::vector<Node> nodes_of(const std::vector<generic::Result>& results) {
    std::vector<Node> nodes;
    for (const generic::Result& result : results) nodes.push_back(result.node);
    return nodes;
  }

  void add_functions() {
    const std::size_t n = model_.inputs.coordinates, m = model_.inputs.joints;
    module_.inverse = {"inverse",
                       "Joint coordinates of a pose.",
                       {{"q", m, 1, model_.joints}, {"assembly", model_.domains.size(), 1, nodes_of(model_.domains)}}};
    module_.jacobian = {
        "jacobian", "Jacobian J of the joints: joint rates = J coordinate rates.", {{"J", m, n, model_.jacobian}}};
    module_.limits = {
        "margins", "Margins of all constraints of a pose, which is feasible if none is negative or NaN.", {margins()}};
    Output quantities{"values", 0, 1, {}};
    for (std::size_t i = 0; i < model_.quantities.size(); ++i) {
      const QuantityInfo& info = model_.info.quantities[i];
      if (info.of_motion) continue;
      module_.quantities.push_back({info.name, info.unit, info.meaning});
      quantities.nodes.push_back(model_.quantities[i]);
    }
    quantities.rows = quantities.nodes.size();
    if (quantities.rows > 0)
      module_.values = {"quantities", "Named quantities of a pose; NaN where one is undefined.", {quantities}};
    if (const auto& e = model_.equations)
      module_.equations = {"equations",
                           "Equations of motion in the coordinates x with rates v: J^T tau = M a + h + G - Jw^T w.",
                           {{"J", m, n, e->J},
                            {"Jdot_v", m, 1, e->J_rate_X},
                            {"M", n, n, e->M_X},
                            {"h", n, 1, e->h_X},
                            {"G", n, 1, e->G_X},
                            {"Jw", 6, n, e->J_wrench}}};
  }

  /// The margins that `pkmopt pose` prints, without those that are not given by a formula.
  Output margins() {
    Output output{"margins", 0, 1, {}};
    const auto add = [&](const std::string& name, const std::string& unit, Node node) {
      module_.margins.push_back({name, unit, ""});
      output.nodes.push_back(node);
    };
    for (const generic::Result& domain : model_.domains) add(domain.name, domain.unit, domain.node);
    std::size_t next = 0;
    const auto add_single_ones = [&](std::size_t end) {
      for (; next < end; ++next) add(model_.margins[next].name, model_.margins[next].unit, model_.margins[next].node);
    };
    for (const generic::ReportedMargin& group : model_.reported_margins) {
      add_single_ones(group.first);
      next = group.first + group.count;
      Node value = group.shown ? *group.shown : model_.margins[group.first].node;
      for (std::size_t i = group.first + 1; !group.shown && i < next; ++i)
        value = graph_.apply(expression::operation("min"), std::array{value, model_.margins[i].node});
      add(group.name, group.unit, value);
    }
    add_single_ones(model_.margins.size());
    output.rows = output.nodes.size();
    return output;
  }

  /// Replaces thresholds of limits by numbers, or by formulas of the parameters.
  void replace_limits(const LimitSpec& limits, std::vector<Node>& roots) {
    std::vector<std::optional<Node>> nodes(model_.inputs.count());
    for (std::size_t i = 0; i < model_.inputs.limits; ++i) {
      std::optional<Node>& node = nodes[model_.inputs.limit(i)];
      if (limits.given[i])
        node = graph_.number(*limits.given[i]);
      else if (limits.derived[i] && model_.derived[i])
        node = model_.derived[i];
      else if (model_.limit_parameters[i])
        node = graph_.input(*model_.limit_parameters[i]);
      else
        node = graph_.number(model_.info.limits[i].inactive);
    }
    graph_ = substitute_nodes(graph_, nodes, roots);
  }

  /// Replaces the signs of the working mode, and all inputs other than the pose, by numbers; the parameters, too,
  /// unless they are arguments of the generated functions.
  void replace_constants(std::span<const double> parameters, std::vector<Node>& roots) {
    std::vector<std::optional<double>> numbers(model_.inputs.count());
    for (std::size_t i = 0; i < model_.inputs.signs; ++i) numbers[model_.inputs.sign(i)] = model_.signs[mode_][i];
    for (std::size_t i = 0; i < model_.inputs.extras; ++i) {
      numbers[model_.inputs.extra(i)] = model_.info.inputs[i].value;
      numbers[model_.inputs.extra_rate(i)] = numbers[model_.inputs.extra_acceleration(i)] = 0;
    }
    for (std::size_t i = 0; i < parameters.size() && !module_.options.has_parameters; ++i) numbers[i] = parameters[i];
    module_.graph = substitute_numbers(graph_, numbers, roots);
  }

  void name_inputs() {
    const generic::Inputs& at = model_.inputs;
    module_.inputs.resize(at.count());
    for (std::size_t i = 0; i < at.parameters; ++i) module_.inputs[i] = {'p', i};
    for (std::size_t i = 0; i < at.coordinates; ++i) {
      module_.inputs[at.coordinate(i)] = {'x', i};
      module_.inputs[at.rate(i)] = {'v', i};
    }
  }

  const generic::Model& model_;
  expression::Graph graph_;
  Module& module_;
  std::size_t mode_;
};

template <class Values>
std::vector<double> listed(const Values& values) {
  return {values.begin(), values.end()};
}

/// Inverse condition number of a matrix whose elements may have different units, in the maximum norm.
double inverse_condition(const AxisMatrix<double>& J) {
  const auto norm = [](const AxisMatrix<double>& matrix) {
    double largest = 0;
    for (const double element : matrix) largest = std::max(largest, std::fabs(element));
    return largest;
  };
  if (is_singular(J)) return 0;
  return 1 / (norm(J) * norm(solve(J, AxisMatrix<double>::identity(J.rows()))));
}

/// Feasible poses spread over the ranges of the coordinates, with the results of the engine there; fewer than requested
/// if no more are found.
/// @param min_conditioning  minimum inverse condition number of the Jacobian at these poses
std::vector<Sample> samples_of(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                               const std::string& mode, const Module& module, double min_conditioning) {
  constexpr std::size_t kMaxTrials = 50'000;
  const MechanismInfo& info = mechanism.info();
  const std::size_t n = info.coordinates.size();
  const SampledPoses poses(mechanism, parameters, 0.1);
  std::vector<Sample> samples;
  for (std::size_t trial = 0; trial < kMaxTrials && samples.size() < module.options.samples; ++trial) {
    const Pose<double> pose = poses[trial + 1];
    Sample sample;
    for (std::size_t i = 0; i < n; ++i) {
      sample.velocity.push_back(2 * halton(trial + 1, n + i) - 1);
      sample.acceleration.push_back(2 * halton(trial + 3, n + i) - 1);
    }
    for (std::size_t i = 0; i < 6; ++i) sample.wrench.push_back(2 * halton(trial + 1, i) - 1);
    const PoseReport report = mechanism.inspect(parameters, pose, mode, limits);
    if (!report.feasible || !report.J) continue;
    if (module.has_forward) {
      if (inverse_condition(*report.J) < min_conditioning) continue;
      for (const double step : {kStep, -kStep}) {
        Pose<double> start = pose;
        for (double& coordinate : start) coordinate += step;
        if (sample.start.empty() && mechanism.inspect(parameters, start, mode, limits).assembles)
          sample.start = listed(start);
      }
      if (sample.start.empty()) continue;
    }
    sample.pose = listed(pose);
    sample.joints = listed(*report.joints);
    sample.jacobian = listed(*report.J);
    for (const NamedUnit& margin : module.margins) {
      const auto found = std::ranges::find(report.margins, margin.name, &NamedValues::value_type::first);
      sample.margins.push_back(found == report.margins.end() ? std::nan("") : found->second);
    }
    for (std::size_t i = 0; i < info.quantities.size(); ++i)
      if (!info.quantities[i].of_motion) sample.quantities.push_back(report.quantities[i]);
    if (module.equations && info.joints.size() == n) {
      MotionState<double> state{pose, AxisVector<double>(n)};
      AxisVector<double> acceleration(n);
      Wrench<double> wrench;
      std::ranges::copy(sample.velocity, state.velocity.begin());
      std::ranges::copy(sample.acceleration, acceleration.begin());
      std::ranges::copy(sample.wrench, wrench.begin());
      PoseDynamics<double> found;
      without_drive_trains(mechanism).dynamics()->equations(parameters, mode, {&state, 1}, {&found, 1});
      sample.forces = listed(drive_forces<double>(found, acceleration, wrench));
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace

Module module_of(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                 const std::string& mode, const Options& options, const std::string& title) {
  const Evaluation* const evaluation = generic::evaluation_of(mechanism);
  const MechanismInfo& info = mechanism.info();
  if (!evaluation)
    throw std::invalid_argument("code is generated from the formulas of mechanism files, and " + info.name +
                                " is written in C++");
  Module module;
  module.name = identifier(info.name);
  module.title = title;
  module.options = options;
  for (const Parameter& p : info.parameters) module.parameters.push_back({p.name, p.unit, p.meaning});
  for (const AxisInfo& axis : info.coordinates) module.coordinates.push_back({axis.name, axis.unit, ""});
  for (const AxisInfo& axis : info.joints) module.joints.push_back({axis.name, axis.unit, ""});
  module.design.assign(parameters.begin(), parameters.end());
  module.has_forward = info.joints.size() == info.coordinates.size();
  Collector(*evaluation, mode_index(info, mode), module).collect(parameters, limits);
  if (!module.has_forward)
    module.left_out.push_back("There is no forward kinematics: the numbers of joints and coordinates differ.");
  if (requires_clearance(info, {.method = {}, .fixed = {}, .limits = limits}))
    module.left_out.push_back("The clearance of links is not among the margins.");
  if (generic::first_report_limit(evaluation->model, limits))
    module.left_out.push_back("Limits of quantities that are no formulas are not among the margins.");
  if (mechanism.drive_trains() && module.equations)
    module.left_out.push_back("The forces do not contain the inertia of drive trains.");
  double min_conditioning = options.single_precision ? kMinConditioningOfFloats : kMinConditioning;
  for (; module.samples.size() < options.samples && min_conditioning >= kLeastConditioning; min_conditioning /= 5)
    module.samples = samples_of(mechanism, parameters, limits, mode, module, min_conditioning);
  if (module.samples.empty()) throw DesignError("no feasible pose for a test was found");
  return module;
}

}  // namespace pkm::code
