// Writes a multibody model as SDF, the format of the simulation program Gazebo.
#include <algorithm>

#include "engine/export/multibody_files.hpp"
#include "engine/export/multibody_xml.hpp"

namespace pkm {
namespace {

using Eigen::Vector3d;
using Type = MultibodyModel::JointType;

std::string element(const std::string& name, const std::string& text) {
  return '<' + name + '>' + text + "</" + name + '>';
}
std::string element(const std::string& name, double value) { return element(name, xml_number(value)); }
std::string sdf_pose(const Vector3d& xyz, const Vector3d& rpy = Vector3d::Zero()) {
  return element("pose", xml_numbers(xyz) + ' ' + xml_numbers(rpy));
}

std::string sdf_link(const MultibodyModel& model, std::size_t index) {
  const MultibodyModel::Body& body = model.bodies[index];
  const Vector3d origin = frame_origin(model, index);
  std::string text = "    <link" + xml_attribute("name", body.name) + ">" + sdf_pose(origin) + '\n';
  if (index > 0) {
    const Eigen::Matrix3d& I = body.inertia;
    text += "      " +
            element("inertial", sdf_pose(body.centre - origin) + element("mass", body.mass) +
                                    element("inertia", element("ixx", I(0, 0)) + element("ixy", I(0, 1)) +
                                                           element("ixz", I(0, 2)) + element("iyy", I(1, 1)) +
                                                           element("iyz", I(1, 2)) + element("izz", I(2, 2)))) +
            '\n';
  }
  for (std::size_t k = 0; k < body.shapes.size(); ++k) {
    const MultibodyModel::Shape& shape = body.shapes[k];
    const Vector3d along = shape.to - shape.from;
    const double length = along.norm();
    text += "      <visual" + xml_attribute("name", "visual_" + std::to_string(k + 1)) + ">" +
            sdf_pose((shape.from + shape.to) / 2 - origin, angles_of_z(along)) +
            element("geometry", length > 0
                                    ? element("cylinder", element("radius", shape.radius) + element("length", length))
                                    : element("sphere", element("radius", shape.radius))) +
            "</visual>\n";
  }
  return text + "    </link>\n";
}

std::string sdf_joint(const MultibodyModel& model, const MultibodyModel::Joint& joint) {
  constexpr std::array kNames = {"fixed", "prismatic", "revolute", "universal", "ball"};
  const auto& drive = joint.drive;
  const std::string type = joint.type == Type::revolute && !(drive && drive->range)
                               ? "continuous"
                               : kNames[static_cast<std::size_t>(joint.type)];
  std::string text = "    <joint" + xml_attribute("name", joint.name) + xml_attribute("type", type) + ">" +
                     element("parent", model.bodies[joint.parent].name) +
                     element("child", model.bodies[joint.child].name) +
                     sdf_pose(joint.point - frame_origin(model, joint.child));
  for (std::size_t k = 0; k < joint.axes.size(); ++k) {
    std::string axis = element("xyz", xml_numbers(joint.axes[k]));
    std::string limit;
    if (drive && drive->range)
      limit += element("lower", (*drive->range)[0] - drive->position) +
               element("upper", (*drive->range)[1] - drive->position);
    if (drive && drive->peak_force) limit += element("effort", *drive->peak_force);
    if (!limit.empty()) axis += element("limit", limit);
    if (drive && (drive->viscous > 0 || drive->coulomb > 0))
      axis += element("dynamics", element("damping", drive->viscous) + element("friction", drive->coulomb));
    text += element(k == 0 ? "axis" : "axis2", axis);
  }
  return text + "</joint>\n";
}

}  // namespace

std::string sdf_text(const MultibodyModel& of_mechanism, const std::string& title) {
  MultibodyModel model = for_simulators(of_mechanism);
  std::string drives;
  for (const MultibodyModel::Joint& joint : model.tree)
    if (joint.drive) drives += (drives.empty() ? "" : ", ") + joint.name + " = " + xml_number(joint.drive->position);
  model.notes.insert(model.notes.begin(),
                     "All joints are at 0 in the reference pose, where the drives of the mechanism "
                     "are at " +
                         drives + ".");
  if (std::ranges::any_of(model.tree, [](const auto& joint) { return joint.drive && joint.drive->inertia > 0; }))
    model.notes.push_back("SDF cannot express the inertia of the drive trains, which is left out.");
  std::string text = "<?xml version=\"1.0\"?>\n<sdf version=\"1.7\">\n" + model_comments(model, title) + "  <model" +
                     xml_attribute("name", model.name) + ">\n    <joint name=\"to_world\" type=\"fixed\">" +
                     element("parent", "world") + element("child", model.bodies[0].name) + "</joint>\n";
  for (std::size_t i = 0; i < model.bodies.size(); ++i) text += sdf_link(model, i);
  for (const auto* const list : {&model.tree, &model.closures})
    for (const MultibodyModel::Joint& joint : *list) text += sdf_joint(model, joint);
  text += "    <frame name=\"platform_frame\"" + xml_attribute("attached_to", model.bodies[model.platform].name) + ">" +
          sdf_pose(model.origin - frame_origin(model, model.platform), roll_pitch_yaw(model.rotation)) + "</frame>\n";
  return text + "  </model>\n</sdf>\n";
}

}  // namespace pkm
