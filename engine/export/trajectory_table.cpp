#include <algorithm>
#include <numeric>

#include "engine/export/tables.hpp"
#include "engine/mechanism/redundant_drives.hpp"

namespace pkm {
namespace {

bool has_joint_forces(const TrajectoryPoint& p) { return p.reactions && p.reactions->reason.empty(); }

}  // namespace

CsvTable trajectory_table(const Mechanism& mechanism, const Trajectory& trajectory) {
  const MechanismInfo& info = mechanism.info();
  std::vector<std::string> columns = {"time"};
  const auto add_names = [&](const std::vector<AxisInfo>& axes, const std::string& suffix) {
    for (const AxisInfo& axis : axes) columns.push_back(axis.name + suffix);
  };
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.coordinates, suffix);
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.joints, suffix);
  for (const char* name : {"conditioning", "feasible", "reason"}) columns.emplace_back(name);
  if (!why_no_drive_forces(mechanism)) {
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
    if (!why_no_drive_forces(mechanism)) {
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

}  // namespace pkm
