#include "engine/export/multibody_xml.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "engine/core/formatted.hpp"
#include "engine/export/xml_text.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm {
namespace {

using Eigen::Vector3d;
using Body = MultibodyModel::Body;
using Joint = MultibodyModel::Joint;
using Type = MultibodyModel::JointType;

constexpr double kMinimumMass = 1e-6;  // smallest mass of a body, relative to the total mass

/// The smallest mass and the smallest moment of inertia that a body may have.
struct Minimum {
  double mass, inertia;
};
Minimum minimum_of(const MultibodyModel& model) {
  double total = 0, size = 0;
  for (const Body& body : model.bodies) total += body.mass;
  for (const Joint& joint : model.tree) size = std::max(size, (joint.point - model.origin).norm());
  return {kMinimumMass * total, kMinimumMass * total * size * size};
}

/// Raises principal moments of inertia to a minimum, and then the two smaller ones by equal amounts until the largest
/// does not exceed their sum.
/// @return true if a moment has changed
bool make_physical(Eigen::Matrix3d& inertia, double minimum) {
  constexpr double kRounding = 1e-9;  // relative allowance for rounding errors
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(inertia)};
  Vector3d moments = solver.eigenvalues();  // in ascending order
  moments = moments.cwiseMax(minimum);
  if (const double lack = moments[2] - moments[0] - moments[1]; lack > 0)
    moments.head<2>().array() += lack / 2 + kRounding * moments[2];
  if ((moments - solver.eigenvalues()).cwiseAbs().maxCoeff() <= kRounding * moments[2]) return false;
  inertia = solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
  return true;
}

void add_note_on_small_bodies(double mass, MultibodyModel& model) {
  model.notes.push_back(
      "Some universal and ball joints consist of two or three revolute joints; the bodies between them, between_.., "
      "have "
      "the mass " +
      xml_number(mass) + " kg each.");
}

/// Makes a name of valid characters that is not in `used`, and adds it to `used`.
std::string distinct(const std::string& name, std::set<std::string>& used) {
  std::string candidate = plain_name(name);
  for (int k = 2; !used.insert(candidate).second; ++k) candidate = plain_name(name) + '_' + std::to_string(k);
  return candidate;
}

}  // namespace

std::string xml_number(double value) { return formatted("%.15g", value); }

std::string xml_numbers(const Eigen::Vector3d& of) {
  constexpr double kRounding = 1e-15;
  const Eigen::Vector3d v = (of.array().abs() < kRounding).select(0, of);
  return xml_number(v[0]) + ' ' + xml_number(v[1]) + ' ' + xml_number(v[2]);
}

std::string xml_attribute(const std::string& name, const std::string& value) {
  return ' ' + name + "=\"" + xml_text(value) + '"';
}
std::string xml_attribute(const std::string& name, double value) { return xml_attribute(name, xml_number(value)); }
std::string xml_attribute(const std::string& name, const Eigen::Vector3d& value) {
  return xml_attribute(name, xml_numbers(value));
}

std::string xml_comment(std::string text) {
  for (auto at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.insert(at + 1, " ");
  return "  <!-- " + xml_text(text) + " -->\n";
}

std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

MultibodyModel for_simulators(MultibodyModel model) {
  std::set<std::string> bodies, joints;
  for (Body& body : model.bodies) body.name = distinct(body.name, bodies);
  for (auto* const list : {&model.tree, &model.closures})
    for (Joint& joint : *list) joint.name = distinct(joint.name, joints);
  model.name = plain_name(model.name);
  const auto [mass, inertia] = minimum_of(model);
  std::string changed;
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& body = model.bodies[i];
    const bool is_light = body.mass < mass;
    body.mass = std::max(body.mass, mass);
    if (make_physical(body.inertia, inertia) || is_light) changed += (changed.empty() ? "" : ", ") + body.name;
  }
  if (!changed.empty())
    model.notes.push_back("Masses are at least " + xml_number(mass) + " kg and principal moments of inertia at least " +
                          xml_number(inertia) +
                          " kg m^2, and no moment is larger than the sum of the other two, because simulation "
                          "programs require this; the mechanism has smaller values for " +
                          changed + ".");
  return model;
}

MultibodyModel with_revolute_joints(const MultibodyModel& model) {
  MultibodyModel split = model;
  split.tree.clear();
  const auto [mass, inertia] = minimum_of(model);
  for (const Joint& joint : model.tree) {
    std::vector<Vector3d> axes = joint.axes;
    if (joint.type == Type::ball) axes = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    if (axes.size() < 2) {
      split.tree.push_back(joint);
      continue;
    }
    std::size_t parent = joint.parent;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string name = joint.name + "_axis_" + std::to_string(k + 1);
      std::size_t child = joint.child;
      if (k + 1 < axes.size()) {
        child = split.bodies.size();
        split.bodies.push_back({"between_" + joint.name + '_' + std::to_string(k + 1), mass, joint.point,
                                Eigen::Matrix3d(Vector3d::Constant(inertia).asDiagonal())});
      }
      split.tree.push_back({name, Type::revolute, parent, child, joint.point, {axes[k]}});
      parent = child;
    }
  }
  if (split.bodies.size() > model.bodies.size()) add_note_on_small_bodies(mass, split);
  return split;
}

MultibodyModel without_universal_closures(const MultibodyModel& model) {
  MultibodyModel simple = model;
  const auto [mass, inertia] = minimum_of(model);
  for (Joint& joint : simple.closures) {
    if (joint.type != Type::universal) continue;
    const std::size_t between = simple.bodies.size();
    simple.bodies.push_back(
        {"between_" + joint.name, mass, joint.point, Eigen::Matrix3d(Vector3d::Constant(inertia).asDiagonal())});
    simple.tree.push_back(
        {joint.name + "_axis_1", Type::revolute, joint.parent, between, joint.point, {joint.axes[0]}});
    joint = {joint.name, Type::revolute, between, joint.child, joint.point, {joint.axes[1]}};
  }
  if (simple.bodies.size() > model.bodies.size()) add_note_on_small_bodies(mass, simple);
  return simple;
}

Eigen::Vector3d frame_origin(const MultibodyModel& model, std::size_t body) {
  const auto joint = std::ranges::find(model.tree, body, &MultibodyModel::Joint::child);
  return joint == model.tree.end() ? Eigen::Vector3d::Zero() : joint->point;
}

std::string model_comments(const MultibodyModel& model, const std::string& title) {
  std::string pose;
  for (const auto& [coordinate, value] : model.pose)
    pose += (pose.empty() ? "" : ", ") + coordinate + " = " + xml_number(value);
  std::string text = xml_comment(title + ". Units are m, kg, s, rad. Reference pose: " + pose + ".");
  for (const std::string& note : model.notes) text += xml_comment(note);
  return text;
}

Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R) {
  const double across = std::hypot(R(0, 0), R(1, 0)), pitch = std::atan2(-R(2, 0), across);
  if (across < 1e-12) return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Vector3d angles_of_z(const Eigen::Vector3d& direction) {
  return {0, std::atan2(std::hypot(direction[0], direction[1]), direction[2]), std::atan2(direction[1], direction[0])};
}

}  // namespace pkm
