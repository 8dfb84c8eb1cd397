// Writes the spanning tree of a multibody model as URDF, and its loop closures.
#include <algorithm>

#include "engine/core/formatted.hpp"
#include "engine/export/multibody_files.hpp"
#include "engine/export/multibody_xml.hpp"

namespace pkm {
namespace {

using Eigen::Vector3d;
using Type = MultibodyModel::JointType;

constexpr double kUnlimited = 1e6;  // effort, speed or travel, where URDF requires a limit but the model has none

std::string urdf_origin(const Vector3d& xyz, const Vector3d& rpy = Vector3d::Zero()) {
  return "<origin" + xml_attribute("xyz", xyz) + xml_attribute("rpy", rpy) + "/>";
}

std::string urdf_link(const MultibodyModel& model, std::size_t index) {
  const MultibodyModel::Body& body = model.bodies[index];
  const Vector3d origin = frame_origin(model, index);
  std::string text = "  <link" + xml_attribute("name", body.name) + ">\n";
  if (index > 0) {
    const auto moment = [&](const char* name, Eigen::Index i, Eigen::Index k) {
      return xml_attribute(name, body.inertia(i, k));
    };
    text += "    <inertial>" + urdf_origin(body.centre - origin) + "<mass" + xml_attribute("value", body.mass) +
            "/><inertia" + moment("ixx", 0, 0) + moment("ixy", 0, 1) + moment("ixz", 0, 2) + moment("iyy", 1, 1) +
            moment("iyz", 1, 2) + moment("izz", 2, 2) + "/></inertial>\n";
  }
  for (const MultibodyModel::Shape& shape : body.shapes) {
    const Vector3d along = shape.to - shape.from;
    const double length = along.norm();
    text += "    <visual>" + urdf_origin((shape.from + shape.to) / 2 - origin, angles_of_z(along)) + "<geometry>" +
            (length > 0 ? "<cylinder" + xml_attribute("radius", shape.radius) + xml_attribute("length", length)
                        : "<sphere" + xml_attribute("radius", shape.radius)) +
            "/></geometry></visual>\n";
  }
  return text + "  </link>\n";
}

std::string urdf_joint(const MultibodyModel& model, const MultibodyModel::Joint& joint) {
  const bool slides = joint.type == Type::prismatic, turns = joint.type == Type::revolute;
  const auto& drive = joint.drive;
  const bool is_limited = slides || (drive && drive->range);
  const std::string type = slides ? "prismatic" : !turns ? "fixed" : is_limited ? "revolute" : "continuous";
  std::string text = "  <joint" + xml_attribute("name", joint.name) + xml_attribute("type", type) + "><parent" +
                     xml_attribute("link", model.bodies[joint.parent].name) + "/><child" +
                     xml_attribute("link", model.bodies[joint.child].name) + "/>" +
                     urdf_origin(joint.point - frame_origin(model, joint.parent));
  if (slides || turns) text += "<axis" + xml_attribute("xyz", joint.axes[0]) + "/>";
  if (is_limited || drive) {
    text += "<limit";
    if (is_limited) {
      const bool known = drive && drive->range;
      text += xml_attribute("lower", known ? (*drive->range)[0] - drive->position : -kUnlimited) +
              xml_attribute("upper", known ? (*drive->range)[1] - drive->position : kUnlimited);
    }
    text += xml_attribute("effort", drive && drive->peak_force ? *drive->peak_force : kUnlimited) +
            xml_attribute("velocity", kUnlimited) + "/>";
  }
  if (drive && (drive->viscous > 0 || drive->coulomb > 0))
    text += "<dynamics" + xml_attribute("damping", drive->viscous) + xml_attribute("friction", drive->coulomb) + "/>";
  return text + "</joint>\n";
}

std::string closure_type(Type type) {
  switch (type) {
    case Type::fixed:
      return "fixed";
    case Type::prismatic:
      return "prismatic";
    case Type::revolute:
      return "revolute";
    case Type::universal:
      return "universal";
    case Type::ball:
      return "spherical";
  }
  return "";
}

std::string urdf_constraint(const MultibodyModel& model, const MultibodyModel::Joint& joint) {
  std::string text =
      "  <constraint" + xml_attribute("name", joint.name) + xml_attribute("type", closure_type(joint.type)) + ">";
  const auto end = [&](const std::string& side, std::size_t body) {
    text += '<' + side + xml_attribute("link", model.bodies[body].name) + "/><" + side + "_origin" +
            xml_attribute("xyz", Vector3d(joint.point - frame_origin(model, body))) + xml_attribute("rpy", "0 0 0") +
            "/>";
    if (joint.axes.empty()) return;
    text +=
        '<' + side + "_axis" + xml_attribute("xyz", side == "parent" ? joint.axes.front() : joint.axes.back()) + "/>";
  };
  end("parent", joint.parent);
  end("child", joint.child);
  return text + "</constraint>\n";
}

MultibodyModel urdf_model(const MultibodyModel& model) { return with_revolute_joints(for_simulators(model)); }

}  // namespace

std::string urdf_text(const MultibodyModel& of_mechanism, const std::string& title) {
  MultibodyModel model = urdf_model(of_mechanism);
  model.notes.insert(
      model.notes.begin(),
      "All joints are at 0 in the reference pose. The elements constraint close the loops; programs that "
      "ignore them find the same in the YAML file beside this file, with the positions of the drives.");
  if (std::ranges::any_of(model.tree, [](const auto& joint) { return joint.drive.has_value(); }))
    model.notes.push_back("The number " + xml_number(kUnlimited) +
                          " in a limit means that the limit is unknown to pkmopt.");
  if (std::ranges::any_of(model.tree, [](const auto& joint) { return joint.drive && joint.drive->inertia > 0; }))
    model.notes.push_back("URDF cannot express the inertia of the drive trains, which is left out.");
  std::string text =
      "<?xml version=\"1.0\"?>\n<robot" + xml_attribute("name", model.name) + ">\n" + model_comments(model, title);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) text += urdf_link(model, i);
  for (const MultibodyModel::Joint& joint : model.tree) text += urdf_joint(model, joint);
  text += "  <link name=\"platform_frame\"/>\n  <joint name=\"to_platform_frame\" type=\"fixed\"><parent" +
          xml_attribute("link", model.bodies[model.platform].name) + "/><child link=\"platform_frame\"/>" +
          urdf_origin(model.origin - frame_origin(model, model.platform), roll_pitch_yaw(model.rotation)) +
          "</joint>\n";
  for (const MultibodyModel::Joint& joint : model.closures) text += urdf_constraint(model, joint);
  return text + "</robot>\n";
}

std::string loop_closures_yaml(const MultibodyModel& of_mechanism, const std::string& urdf_file,
                               const std::string& title) {
  const MultibodyModel model = urdf_model(of_mechanism);
  const auto list = [](const Vector3d& v) {
    std::string numbers = xml_numbers(v);
    for (auto at = numbers.find(' '); at != std::string::npos; at = numbers.find(' ', at + 2)) numbers.insert(at, ",");
    return '[' + numbers + ']';
  };
  // Names are quoted, because YAML reads an unquoted y or no as a truth value.
  const auto quoted = [](const std::string& name) { return '"' + name + '"'; };
  std::string text =
      "# Loop closures of " + urdf_file + ": " + title +
      ". Units are m and rad.\n# Points and axes are in the frame of the link. A drive's position in the "
      "mechanism is position_at_zero + its position in the URDF file.\nrobot: " +
      quoted(model.name) + "\nreference_pose:\n";
  for (const auto& [coordinate, value] : model.pose)
    text += "  " + quoted(coordinate) + ": " + xml_number(value) + '\n';
  text += "drives:\n";
  for (const MultibodyModel::Joint& joint : model.tree)
    if (joint.drive)
      text += "  - {joint: " + quoted(joint.name) + ", position_at_zero: " + xml_number(joint.drive->position) + "}\n";
  text += model.closures.empty() ? "loop_closures: []\n" : "loop_closures:\n";
  for (const MultibodyModel::Joint& joint : model.closures) {
    text += "  - name: " + quoted(joint.name) + "\n    type: " + closure_type(joint.type) + '\n';
    const auto end = [&](const std::string& side, std::size_t body) {
      text += "    " + side + ": " + quoted(model.bodies[body].name) + "\n    " + side +
              "_point: " + list(joint.point - frame_origin(model, body)) + '\n';
      if (!joint.axes.empty())
        text += "    " + side + "_axis: " + list(side == "parent" ? joint.axes.front() : joint.axes.back()) + '\n';
    };
    end("parent", joint.parent);
    end("child", joint.child);
  }
  return text;
}

}  // namespace pkm
