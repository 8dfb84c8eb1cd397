#include "engine/generic/design_facts.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::generic {

std::vector<std::optional<std::array<double, 2>>> joint_ranges(const Evaluation& e,
                                                               std::span<const double> parameters) {
  const std::vector<AxisInfo>& joints = e.model.info.joints;
  std::vector<std::optional<std::array<double, 2>>> found(joints.size());
  const std::vector<double> values = outputs_of(e.requirements, e.inputs(parameters, no_limits(e.model.info), 0));
  for (std::size_t k = 0; k < e.model.ranges.size(); ++k) {
    const auto joint = std::ranges::find(joints, e.model.ranges[k].joint, &AxisInfo::name);
    if (joint == joints.end()) continue;
    const std::array range = {values[2 * k], values[2 * k + 1]};
    if (std::isfinite(range[0]) && std::isfinite(range[1]))
      found[static_cast<std::size_t>(joint - joints.begin())] = range;
  }
  return found;
}

std::vector<std::pair<std::string, double>> body_masses(const Evaluation& e, std::span<const double> parameters) {
  std::vector<Node> nodes;
  for (const BodyNodes& body : e.model.bodies) nodes.push_back(body.mass);
  const std::vector<double> values =
      outputs_of(expression::Program(e.model.graph, nodes), e.inputs(parameters, no_limits(e.model.info), 0));
  std::vector<std::pair<std::string, double>> masses;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > 0) masses.emplace_back(e.model.bodies[i].name, values[i]);
  return masses;
}

DrivePlaces::DrivePlaces(const Evaluation& e, std::span<const double> parameters, std::size_t mode)
    : coordinates_(e.model.inputs.coordinate(0)) {
  const Model& model = e.model;
  if (!model.jointed) return;
  std::vector<Node> nodes;
  for (const JointNodes& joint : model.jointed->joints) {
    if (!joint.drive) continue;
    driven_.push_back(&joint);
    nodes.insert(nodes.end(), joint.point.begin(), joint.point.end());
    nodes.insert(nodes.end(), joint.drive->axis.begin(), joint.drive->axis.end());
    nodes.push_back(model.joints[joint.drive->joint]);
  }
  program_ = expression::Program(model.graph, nodes);
  inputs_ = e.inputs(parameters, no_limits(model.info), mode);
}

std::vector<PlacedDrive> DrivePlaces::operator()(const Pose<double>& pose) const {
  if (driven_.empty()) return {};
  std::vector<double> inputs = inputs_;
  std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(coordinates_));
  const std::vector<double> values = outputs_of(program_, inputs);
  std::vector<PlacedDrive> placed;
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    const double* const v = &values[7 * k];
    const JointNodes& joint = *driven_[k];
    const double length = std::hypot(v[3], v[4], v[5]);
    const PlacedDrive drive{.joint = joint.drive->joint,
                            .position = v[6],
                            .rotates = joint.drive->turns,
                            .on_base = !joint.from,
                            .point = {v[0], v[1], v[2]},
                            .axis = {v[3] / length, v[4] / length, v[5] / length}};
    if (placed.empty() || placed.back().joint != drive.joint)
      placed.push_back(drive);
    else  // the second of two parallel rods on one slide, which is half-way between them
      for (std::size_t i = 0; i < 3; ++i) placed.back().point[i] = (placed.back().point[i] + drive.point[i]) / 2;
  }
  return placed;
}

}  // namespace pkm::generic
