// Reader of [[drive_train]].

#include <algorithm>
#include <cmath>

#include "engine/config/motor_table.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {
namespace {

/// Refuses keys that affect forces only, if the mechanism has no dynamics.
void expect_forces(const ConfigValue& table, const Unsupported& no_forces) {
  if (!no_forces) return;
  for (const char* const key :
       {"rotor_inertia", "shaft_inertia", "efficiency", "coulomb", "viscous", "slow_speed", "motor"})
    if (const auto given = table.find(key))
      throw given->refusal("inertias and losses of drive trains need dynamics, but " + *no_forces +
                           "; gear and lead need none");
}

/// Whether the table has only keys that need no transmission: stiffness and limits of the joint.
bool needs_no_transmission(const ConfigValue& table) {
  return table.keys().size() > 1 && std::ranges::all_of(table.keys(), [](const std::string& key) {
           return key == "joint" || key == "stiffness" || key == "peak_force" || key == "peak_speed" ||
                  key == "peak_acceleration";
         });
}

/// Reads the limits of a joint (speed, acceleration, force) from the table of its drive train.
/// @param motors  the [[motor]]s of the study
/// @param limits  limits of this joint from earlier tables; those that this table gives replace them
JointLimits read_limits(const ConfigValue& table, const AxisInfo& joint, const std::vector<Motor>& motors,
                        JointLimits limits) {
  const bool turns = joint.turns();
  if (const auto speed = table.find("peak_speed")) limits.speed = speed->positive(turns ? "rad/s" : "m/s");
  if (const auto most = table.find("peak_acceleration"))
    limits.acceleration = most->positive(turns ? "rad/s^2" : "m/s^2");
  if (const auto force = table.find("peak_force")) {
    const std::string unit = turns ? "N m" : "N";
    // If the peak force is a formula of the parameters, only the mechanism can evaluate it; NaN marks this here.
    limits.force =
        !force->is_text() ? force->positive(unit) : parse_quantity(force->text("text"), unit).value_or(std::nan(""));
  }
  if (const auto name = table.find("motor")) {
    if (motors.empty())
      throw name->refusal("the study has no [[motor]]; add one with name = \"" + name->text("the name of a [[motor]]") +
                          "\"");
    limits.motor = *find_named(motors, name->word(names_of(motors)));
    if (const auto rotor = table.find("rotor_inertia"))
      throw rotor->refusal("the motor gives the inertia of the rotor, too; give one of them");
  }
  return limits;
}

DriveTrain read_train(const ConfigValue& table, const AxisInfo& joint, const JointLimits& limits) {
  const bool turns = joint.turns();
  DriveTrain train;
  train.ratio = table.number_at("gear");
  const auto lead = table.find("lead");
  if (turns && lead)
    throw lead->refusal("the joint " + joint.name + " is revolute; the key lead applies to prismatic joints only");
  if (!turns) {
    const ConfigValue way =
        table.at("lead", "the travel of " + joint.name + " per revolution of its screw, such as \"10 mm\"");
    train.ratio *= 2 * kPi / way.number();
  }
  train.rotor = limits.motor ? limits.motor->rotor : table.number_at("rotor_inertia");
  train.shaft = table.number_at("shaft_inertia");
  train.efficiency = table.number_at("efficiency");
  train.coulomb = table.find_number("coulomb", turns ? "N m" : "N", 0).value_or(0);
  train.viscous = table.find_number("viscous", turns ? "N m s/rad" : "N s/m", 0).value_or(0);
  if (const auto slow = table.find("slow_speed")) train.slow = slow->positive(turns ? "rad/s" : "m/s");
  return train;
}

}  // namespace

void read_drive_trains(const ConfigValue& root, StudyDraft& draft) {
  const std::vector<ConfigValue> tables = root.tables("drive_train");
  const std::vector<Motor> motors = read_motors(root);
  if (tables.empty()) return;
  const auto& joints = draft.info().joints;
  const Unsupported no_forces = why_no_joint_forces(*draft.parts.mechanism);
  std::vector<std::string> names = {"all"};
  for (const AxisInfo& joint : joints) names.push_back(joint.name);
  std::vector<std::optional<JointLimits>> limits(joints.size());
  DriveTrains trains(joints.size());
  const bool are_trains = !std::ranges::all_of(tables, needs_no_transmission);
  for (const ConfigValue& table : tables) {
    if (are_trains) expect_forces(table, no_forces);
    const ConfigValue value = table.at("joint", "a joint, or \"all\"");
    const std::string& joint = value.word(names);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joint != "all" && joint != joints[i].name) continue;
      if (limits[i] && are_trains) throw value.refusal("the joint " + joints[i].name + " has a drive train already");
      limits[i] = read_limits(table, joints[i], motors, limits[i].value_or(JointLimits()));
      if (are_trains) trains[i] = read_train(table, joints[i], *limits[i]);
    }
  }
  std::vector<JointLimits> all;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!limits[i] && are_trains)
      throw tables.front().refusal("the joint " + joints[i].name +
                                   " has no drive train; give one for every joint, or none");
    all.push_back(limits[i].value_or(JointLimits()));
  }
  draft.parts.mechanism =
      with_drive_trains(draft.parts.mechanism, are_trains ? std::move(trains) : DriveTrains(), std::move(all));
}

}  // namespace pkm
