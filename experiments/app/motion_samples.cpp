#include "experiments/app/motion_samples.hpp"

#include "engine/core/unit.hpp"
#include "engine/mechanism/redundant_drives.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/joint_forces.hpp"

namespace pkm {
namespace {

bool has_joint_forces(const TrajectoryPoint& p) { return p.reactions && p.reactions->reason.empty(); }

}  // namespace

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
  if (!why_no_drive_forces(mechanism)) {
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
