#include "experiments/app/motion_samples.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/core/unit.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/joint_forces.hpp"
#include "experiments/app/motion_inputs.hpp"

namespace pkm {
namespace {

/// The inputs with their rates and accelerations, then the quantities; undefined values are NaN.
NamedValues input_and_quantity_values(const MechanismInfo& info, const TrajectoryPoint& p) {
  NamedValues values;
  for (std::size_t i = 0; i < p.motion.inputs.size(); ++i) {
    const auto& [value, rate, acceleration] = p.motion.inputs[i];
    const std::string& name = info.inputs[i].name;
    values.insert(values.end(), {{name, value}, {name + "_speed", rate}, {name + "_acceleration", acceleration}});
  }
  const NamedValues quantities = pose_quantities_of(info, p.quantities);
  values.insert(values.end(), quantities.begin(), quantities.end());
  return values;
}

bool has_joint_forces(const TrajectoryPoint& p) { return p.reactions && p.reactions->reason.empty(); }

}  // namespace

CsvTable trajectory_table(const Mechanism& mechanism, const Trajectory& trajectory) {
  const MechanismInfo& info = mechanism.info();
  std::vector<std::string> columns = {"time"};
  const auto add_names = [&](const Axes& axes, const std::string& suffix) {
    for (const AxisInfo& axis : axes) columns.push_back(axis.name + suffix);
  };
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.coordinates, suffix);
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.joints, suffix);
  for (const char* name : {"conditioning", "feasible", "reason"}) columns.emplace_back(name);
  if (!why_no_joint_forces(mechanism)) {
    for (const char* suffix : {"_force", "_power"}) add_names(info.joints, suffix);
    columns.emplace_back("power");
  }
  if (mechanism.drive_trains())
    for (const char* suffix : {"_motor_torque", "_motor_speed"}) add_names(info.joints, suffix);
  const auto with_values = std::ranges::find_if(trajectory.points, [](const auto& p) { return !p.quantities.empty(); });
  NamedValues named;
  if (with_values != trajectory.points.end()) named = input_and_quantity_values(info, *with_values);
  for (const auto& [name, value] : named) columns.push_back(name);
  const auto with_joints = std::ranges::find_if(trajectory.points, has_joint_forces);
  const auto reactions =
      with_joints == trajectory.points.end() ? std::vector<JointReaction>() : with_joints->reactions->joints;
  for (const JointReaction& joint : reactions)
    for (const char* component : {"_Fx", "_Fy", "_Fz", "_Mx", "_My", "_Mz"}) columns.push_back(joint.name + component);
  CsvTable table(columns);
  const auto add = [&](const std::optional<AxisVector<double>>& values) {
    values ? table.add(*values) : table.add_empty(info.joints.size());
  };
  for (const TrajectoryPoint& p : trajectory.points) {
    table.begin_row();
    table.add(p.motion.time);
    for (const auto* values : {&p.motion.pose, &p.motion.velocity, &p.motion.acceleration}) table.add(*values);
    for (const auto* values : {&p.joints, &p.speeds, &p.accelerations}) add(*values);
    p.conditioning ? table.add(*p.conditioning) : table.add_empty(1);
    table.add(p.feasible ? 1.0 : 0.0);
    table.add(p.reason);
    if (!why_no_joint_forces(mechanism)) {
      add(p.forces);
      add(p.power);
      p.power ? table.add(std::accumulate(p.power->begin() + 1, p.power->end(), (*p.power)[0])) : table.add_empty(1);
    }
    if (mechanism.drive_trains()) {
      add(p.torques);
      add(p.motor_speeds);
    }
    if (p.quantities.empty())
      table.add_empty(named.size());
    else
      for (const auto& [name, value] : input_and_quantity_values(info, p)) table.add(value);
    if (!has_joint_forces(p)) {
      table.add_empty(6 * reactions.size());
      continue;
    }
    for (const JointReaction& joint : p.reactions->joints)
      for (const auto* const components : {&joint.force, &joint.couple})
        for (const auto& component : *components) component ? table.add(*component) : table.add_empty(1);
  }
  return table;
}

Json sample_json(const Mechanism& mechanism, const TrajectoryPoint& p) {
  const MechanismInfo& info = mechanism.info();
  Json json = {{"time", p.motion.time},
               {"pose", axes_json(info.coordinates, p.motion.pose)},
               {"velocity", axes_json(info.coordinates, p.motion.velocity)},
               {"acceleration", axes_json(info.coordinates, p.motion.acceleration)},
               {"joints", axes_json(info.joints, p.joints)},
               {"speeds", axes_json(info.joints, p.speeds)},
               {"accelerations", axes_json(info.joints, p.accelerations)},
               {"conditioning", json_or_null(p.conditioning)},
               {"feasible", p.feasible},
               {"reason", text_or_null(p.reason)}};
  if (!why_no_joint_forces(mechanism)) {
    json["forces"] = axes_json(info.joints, p.forces);
    json["power"] = axes_json(info.joints, p.power);
  }
  if (mechanism.drive_trains()) {
    json["motor_torque"] = axes_json(info.joints, p.torques);
    json["motor_speed"] = axes_json(info.joints, p.motor_speeds);
  }
  if (p.reactions) json["reactions"] = has_joint_forces(p) ? reactions_json(*p.reactions) : Json();
  if (!info.quantities.empty()) json["quantities"] = values_by_name(input_and_quantity_values(info, p));
  return json;
}

std::string sample_location(const Trajectory& trajectory, const TrajectoryPoint& point) {
  return " at t = " + with_unit(point.motion.time, "s") + " (sample " +
         std::to_string(&point - trajectory.points.data() + 1) + ")";
}

}  // namespace pkm
