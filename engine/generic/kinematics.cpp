#include "engine/generic/kinematics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "engine/generic/clearance.hpp"
#include "engine/generic/conditioning.hpp"
#include "engine/generic/eigen_matrix.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

using expression::Program;

/// Derivatives of the outputs of a program with respect to its inputs [first, first + count).
/// @return outputs x count
AxisMatrix<double> derivatives(const Program& program, std::span<const double> inputs, std::size_t first,
                               std::size_t count) {
  return with_scratch<Taylor>(inputs.size() + program.registers(), [&](std::span<Taylor> scratch) {
    const std::span<Taylor> x = scratch.first(inputs.size()), registers = scratch.subspan(inputs.size());
    std::ranges::copy(inputs, x.begin());
    AxisMatrix<double> D(program.outputs().size(), count);
    for (std::size_t j = 0; j < count; ++j) {
      x[first + j].d = 1;
      program.run_all<Taylor>(x, registers);
      for (std::size_t i = 0; i < D.rows(); ++i) D(i, j) = registers[program.outputs()[i]].d;
      x[first + j].d = 0;
    }
    return D;
  });
}

AxisVector<double> axis_vector(std::span<const double> values) {
  AxisVector<double> axes(values.size());
  std::ranges::copy(values, axes.begin());
  return axes;
}

/// Computes PoseReport::T, which maps the rates of the coordinates to the twist of the platform.
/// @param inputs  values of the graph's inputs, including the pose
AxisMatrix<double> twist_at(const Evaluation& e, const std::vector<double>& inputs) {
  // index of the first element of rotation_directions among the outputs of Evaluation::frame
  constexpr std::size_t kDirections = 12;
  const std::size_t n = e.model.inputs.coordinates;
  const std::vector<double> frame = outputs_of(e.frame, inputs);
  const AxisMatrix<double> rates = derivatives(e.origin, inputs, e.model.inputs.coordinate(0), n);
  AxisMatrix<double> T(6, n);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < n; ++j) {
      T(k, j) = rates(k, j);
      T(3 + k, j) = frame[kDirections + 3 * j + k];
    }
  return T;
}

/// Values of the graph's inputs for a design and a pose.
std::vector<double> inputs_at(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                              std::size_t mode, const LimitSpec& limits) {
  std::vector<double> inputs = e.inputs(parameters, limits, mode);
  std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e.model.inputs.coordinate(0)));
  return inputs;
}

/// Combines the margins of a pose into the groups that are reported as single margins (Model::reported_margins).
/// @param shown  values of those ReportedMargin::shown that exist, in the order of the groups
NamedValues reported_margins(const Model& model, const NamedValues& margins,
                             std::vector<double>::const_iterator shown) {
  NamedValues list;
  std::size_t next = 0;
  for (const ReportedMargin& group : model.reported_margins) {
    list.insert(list.end(), margins.begin() + static_cast<std::ptrdiff_t>(next),
                margins.begin() + static_cast<std::ptrdiff_t>(group.first));
    next = group.first + group.count;
    double value = group.shown ? *shown++ : margins[group.first].second;
    for (std::size_t i = group.first; !group.shown && i < next; ++i) value = std::fmin(value, margins[i].second);
    list.emplace_back(group.name, value);
  }
  list.insert(list.end(), margins.begin() + static_cast<std::ptrdiff_t>(next), margins.end());
  return list;
}

/// Adds the quantities that depend on the pose only (not those of the design or of motions) to a report: angles and
/// lengths to report.angles, all others to report.indices.
void add_quantities(const Model& model, std::vector<double>::const_iterator values, PoseReport& report) {
  for (const QuantityInfo& quantity : model.info.quantities) {
    const double value = *values++;
    if (quantity.of_design || quantity.of_motion) continue;
    const bool is_length_or_angle = quantity.unit == "rad" || quantity.unit == "m";
    (is_length_or_angle ? report.angles : report.indices).emplace_back(quantity.name, value);
  }
}

void add_clearance(const Model& model, const NearestBodies<double>& nearest, const LimitSpec& limits,
                   PoseReport& report) {
  report.angles.emplace_back("clearance", nearest.clearance);
  const auto limit = clearance_of(model, limits);
  if (!limit) return;
  report.margins.emplace_back(kClearanceLimit, nearest.clearance - *limit);
  if (nearest.clearance >= *limit || !report.reason.empty()) return;
  report.reason = std::string(kClearanceLimit) + " is violated";
  if (nearest.clearance == nearest.clearance)
    report.reason +=
        ": " + nearest.first + " and " + nearest.second + (nearest.clearance < 0 ? " overlap" : " are too near");
}

/// Adds Jq, G and J of qdot = J Xdot, Jq qdot = G Xdot, their determinants and the conditioning to a report.
/// @param inputs  values of the graph's inputs, including the pose and its joint positions
void add_jacobians(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                   std::span<const double> inputs, PoseReport& report);

}  // namespace

PoseReport inspect_pose(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                        std::size_t mode, const LimitSpec& limits) {
  const Model& model = e.model;
  const Inputs& at = model.inputs;
  std::vector<double> inputs = inputs_at(e, parameters, pose, mode, limits);
  const std::vector<double> values = outputs_of(e.constraints, inputs);
  auto next = values.begin();
  const auto named = [&](const std::vector<Result>& results) {
    NamedValues list;
    for (const Result& result : results) list.emplace_back(result.name, *next++);
    return list;
  };
  PoseReport report;
  report.joints = axis_vector({values.data(), at.joints});
  next += static_cast<std::ptrdiff_t>(at.joints);
  report.margins = named(model.domains);
  const auto first_violated = [](const NamedValues& margins) {
    return std::ranges::find_if_not(margins, is_satisfied, &NamedValues::value_type::second);
  };
  if (const auto domain = first_violated(report.margins); domain != report.margins.end())
    report.reason = model.domains[static_cast<std::size_t>(domain - report.margins.begin())].consequence;
  const NamedValues margins = named(model.margins);
  report.angles = named(model.angles);
  for (std::size_t i = 0; i < at.joints && report.reason.empty(); ++i)
    if (!std::isfinite(values[i])) report.reason = model.info.joints[i].name + " is undefined";
  report.assembles = report.reason.empty();
  const std::vector<double> shown = outputs_of(e.reported, inputs);
  const auto quantities = shown.end() - std::ssize(model.quantities);
  report.quantities.assign(quantities, shown.end());
  const NamedValues listed = reported_margins(model, margins, shown.begin());
  report.margins.insert(report.margins.end(), listed.begin(), listed.end());
  if (!report.assembles) return report;
  add_quantities(model, quantities, report);
  if (const auto margin = first_violated(margins); margin != margins.end())
    report.reason = margin->first + " is violated";
  if (const auto nearest = nearest_bodies(e, inputs, limits.obstacles)) add_clearance(model, *nearest, limits, report);

  std::ranges::copy(*report.joints, inputs.begin() + static_cast<std::ptrdiff_t>(at.joint(0)));
  add_jacobians(e, parameters, pose, inputs, report);
  visit_report_margins(model, limits, report, [&](const std::string& name, double margin) {
    report.margins.emplace_back(name, margin);
    if (report.reason.empty() && !is_satisfied(margin)) report.reason = name + " is violated";
  });
  report.feasible = report.reason.empty();
  report.T = twist_at(e, inputs);
  return report;
}

namespace {

void add_jacobians(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                   std::span<const double> inputs, PoseReport& report) {
  const Inputs& at = e.model.inputs;
  const AxisMatrix<double> Jq =
      AxisMatrix<double>::zero(at.joints, at.joints) - derivatives(e.closures, inputs, at.joint(0), at.joints);
  const AxisMatrix<double> G = derivatives(e.closures, inputs, at.coordinate(0), at.coordinates);
  report.Jq = Jq;
  report.G = G;
  report.det_Jq = eigen(Jq).determinant();
  if (at.joints == at.coordinates) report.det_G = eigen(G).determinant();
  if (is_singular(Jq)) return;
  report.J = derivatives(e.joints, inputs, at.coordinate(0), at.coordinates);
  report.conditioning = conditioning_of(e.model, characteristic_lengths(e, parameters), pose, *report.J);
}

}  // namespace

PoseReport inspect_sample(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                          std::span<double> inputs) {
  const Inputs& at = e.model.inputs;
  PoseReport report;
  report.assembles = report.feasible = true;
  report.joints = with_scratch<double>(e.joints.registers(), [&](std::span<double> registers) {
    e.joints.run_all<double>(inputs, registers);
    AxisVector<double> joints(at.joints);
    for (std::size_t i = 0; i < at.joints; ++i) joints[i] = registers[e.joints.outputs()[i]];
    return joints;
  });
  std::ranges::copy(*report.joints, inputs.begin() + static_cast<std::ptrdiff_t>(at.joint(0)));
  add_jacobians(e, parameters, pose, inputs, report);
  return report;
}

bool assembles_at(const Evaluation& e, const std::vector<double>& inputs) {
  const std::vector<double> values = outputs_of(e.constraints, inputs);
  const auto joints = values.begin() + static_cast<std::ptrdiff_t>(e.model.inputs.joints),
             domains = joints + std::ssize(e.model.domains);
  return std::all_of(values.begin(), joints, [](double q) { return std::isfinite(q); }) &&
         std::all_of(joints, domains, is_satisfied);
}

std::vector<double> quantities_at(const Evaluation& e, std::span<const double> parameters, std::size_t mode,
                                  const LimitSpec& limits, const MotionSample& at) {
  const Inputs& of = e.model.inputs;
  if (e.model.quantities.empty()) return {};
  std::vector<double> inputs = e.inputs(parameters, limits, mode);
  const auto put = [&](const auto& values, std::size_t position) {
    std::ranges::copy(values, inputs.begin() + static_cast<std::ptrdiff_t>(position));
  };
  put(at.pose, of.coordinate(0));
  put(at.velocity, of.rate(0));
  put(at.acceleration, of.acceleration(0));
  for (std::size_t i = 0; i < at.inputs.size(); ++i) {
    inputs[of.extra(i)] = at.inputs[i].value;
    inputs[of.extra_rate(i)] = at.inputs[i].rate;
    inputs[of.extra_acceleration(i)] = at.inputs[i].acceleration;
  }
  const std::vector<double> reported = outputs_of(e.reported, inputs);
  return {reported.end() - std::ssize(e.model.quantities), reported.end()};
}

std::optional<Influence<double>> influence_at(const Evaluation& e, std::span<const double> parameters,
                                              const Pose<double>& pose, std::size_t mode) {
  const Inputs& at = e.model.inputs;
  const std::vector<double> inputs = inputs_at(e, parameters, pose, mode, no_limits(e.model.info));
  if (!assembles_at(e, inputs)) return {};
  std::vector<Taylor> moving(inputs.begin(), inputs.end());
  const auto second_derivatives = [&](const AxisVector<double>& velocity) {
    for (std::size_t j = 0; j < at.coordinates; ++j) moving[at.coordinate(j)].d = velocity[j];
    const std::vector<Taylor> joints = outputs_of(e.joints, moving);
    AxisVector<double> terms(at.joints);
    for (std::size_t i = 0; i < at.joints; ++i) terms[i] = joints[i].dd;
    return terms;
  };
  const Influence<double> found{derivatives(e.joints, inputs, at.coordinate(0), at.coordinates),
                                quadratic_form_matrices(at.coordinates, second_derivatives)};
  for (std::size_t i = 0; i < at.joints; ++i)
    if (!std::ranges::all_of(found.H[i], [](double x) { return std::isfinite(x); })) return {};
  return found;
}

}  // namespace pkm::generic
