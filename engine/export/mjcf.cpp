// Writes a multibody model as MJCF, the format of the simulation program MuJoCo.
#include <algorithm>

#include <Eigen/Geometry>

#include "engine/export/multibody_files.hpp"
#include "engine/export/multibody_xml.hpp"

namespace pkm {
namespace {

using Eigen::Vector3d;
using Type = MultibodyModel::JointType;

std::string mjcf_joint(const MultibodyModel::Joint& joint) {
  if (joint.type == Type::fixed) return "";
  if (joint.type == Type::ball) return "<joint" + xml_attribute("name", joint.name) + " type=\"ball\"/>";
  std::string text;
  for (std::size_t k = 0; k < joint.axes.size(); ++k) {
    const std::string number = joint.axes.size() > 1 ? "_axis_" + std::to_string(k + 1) : "";
    text += "<joint" + xml_attribute("name", joint.name + number) +
            xml_attribute("type", joint.type == Type::prismatic ? "slide" : "hinge") +
            xml_attribute("axis", joint.axes[k]);
    if (const auto& drive = joint.drive) {
      text += xml_attribute("ref", drive->position);
      if (drive->range)
        text += " limited=\"true\"" +
                xml_attribute("range", xml_number((*drive->range)[0]) + ' ' + xml_number((*drive->range)[1]));
      if (drive->inertia > 0) text += xml_attribute("armature", drive->inertia);
      if (drive->viscous > 0) text += xml_attribute("damping", drive->viscous);
      if (drive->coulomb > 0) text += xml_attribute("frictionloss", drive->coulomb);
    }
    text += "/>";
  }
  return text;
}

/// The element of a body with all its children; for the base, this is the element <worldbody>.
std::string mjcf_body(const MultibodyModel& model, std::size_t index, const std::string& indent) {
  const MultibodyModel::Body& body = model.bodies[index];
  const Vector3d origin = frame_origin(model, index);
  std::string text;
  for (const MultibodyModel::Joint& joint : model.tree)
    if (joint.child == index) {
      text += indent + "<body" + xml_attribute("name", body.name) +
              xml_attribute("pos", Vector3d(origin - frame_origin(model, joint.parent))) + ">\n";
      const Eigen::Matrix3d& I = body.inertia;
      const std::string six = xml_numbers(I.diagonal()) + ' ' + xml_numbers({I(0, 1), I(0, 2), I(1, 2)});
      text += indent + "  <inertial" + xml_attribute("pos", Vector3d(body.centre - origin)) +
              xml_attribute("mass", body.mass) + xml_attribute("fullinertia", six) + "/>\n";
      if (const std::string joints = mjcf_joint(joint); !joints.empty()) text += indent + "  " + joints + '\n';
    }
  for (const MultibodyModel::Shape& shape : body.shapes) {
    const Vector3d from = shape.from - origin, to = shape.to - origin;
    text += indent + "  <geom" +
            ((to - from).norm() > 0
                 ? " type=\"capsule\"" + xml_attribute("fromto", xml_numbers(from) + ' ' + xml_numbers(to))
                 : " type=\"sphere\"" + xml_attribute("pos", from)) +
            xml_attribute("size", shape.radius) + "/>\n";
  }
  if (index == model.platform) {
    const Eigen::Quaterniond q(model.rotation);
    text += indent + "  <site name=\"platform_frame\"" + xml_attribute("pos", Vector3d(model.origin - origin)) +
            xml_attribute("quat", xml_number(q.w()) + ' ' + xml_numbers(q.vec())) + "/>\n";
  }
  for (const MultibodyModel::Joint& joint : model.tree)
    if (joint.parent == index) text += mjcf_body(model, joint.child, indent + "  ");
  return index == 0 ? text : text + indent + "</body>\n";
}

/// Constraint elements for a joint that closes a loop. A revolute joint is represented by two points on its axis, `arm`
/// apart, at each of which both bodies have to coincide.
std::string mjcf_closure(const MultibodyModel& model, const MultibodyModel::Joint& joint, double arm) {
  const std::string bodies = xml_attribute("body1", model.bodies[joint.parent].name) +
                             (joint.child ? xml_attribute("body2", model.bodies[joint.child].name) : "");
  const auto connect = [&](const std::string& name, const Vector3d& point) {
    return "    <connect" + xml_attribute("name", name) + bodies +
           xml_attribute("anchor", Vector3d(point - frame_origin(model, joint.parent))) + "/>\n";
  };
  if (joint.type == Type::fixed) return "    <weld" + xml_attribute("name", joint.name) + bodies + "/>\n";
  std::string text = connect(joint.name, joint.point);
  if (joint.type == Type::revolute) text += connect(joint.name + "_axis", joint.point + arm * joint.axes[0]);
  return text;
}

}  // namespace

std::string mjcf_text(const MultibodyModel& of_mechanism, const std::string& title) {
  constexpr double kTimestep = 0.0005;  // time step of the simulation [s]
  MultibodyModel model = without_universal_closures(for_simulators(of_mechanism));
  model.notes.insert(
      model.notes.begin(),
      {"The positions of the drives are those of the mechanism; all other joints are at 0 in the reference pose.",
       "MuJoCo closes the loops by soft constraints: solimp 0.9999 permits accelerations of 1e-4 of those without the "
       "constraint, and errors decay with the time constant solref = 1 ms."});
  double arm = 0;
  for (const MultibodyModel::Joint& joint : model.tree) arm = std::max(arm, (joint.point - model.origin).norm() / 4);
  std::string closures, motors;
  for (const MultibodyModel::Joint& joint : model.closures) closures += mjcf_closure(model, joint, arm);
  for (const MultibodyModel::Joint& joint : model.tree)
    if (const auto& drive = joint.drive) {
      motors += "    <motor" + xml_attribute("name", joint.name) + xml_attribute("joint", joint.name);
      if (drive->peak_force)
        motors += " ctrllimited=\"true\"" +
                  xml_attribute("ctrlrange", xml_number(-*drive->peak_force) + ' ' + xml_number(*drive->peak_force));
      motors += "/>\n";
    }
  return "<mujoco" + xml_attribute("model", model.name) + ">\n" + model_comments(model, title) +
         "  <compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n"
         "  <option" +
         xml_attribute("timestep", kTimestep) +
         " gravity=\"0 0 -9.81\" solver=\"Newton\" tolerance=\"1e-12\" iterations=\"100\"/>\n"
         "  <default>\n    <geom contype=\"0\" conaffinity=\"0\"/>\n"
         "    <equality" +
         xml_attribute("solref", "0.001 1") + xml_attribute("solimp", "0.9999 0.9999 0.001 0.5 2") +
         "/>\n  </default>\n  <worldbody>\n" + mjcf_body(model, 0, "  ") + "  </worldbody>\n  <equality>\n" + closures +
         "  </equality>\n  <actuator>\n" + motors + "  </actuator>\n</mujoco>\n";
}

}  // namespace pkm
