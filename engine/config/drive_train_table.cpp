// Reader of [[drive_train]].

#include <algorithm>

#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {
namespace {

/// Refuses keys that affect forces only, if the mechanism has no dynamics.
void expect_forces(const ConfigValue& table, const Unsupported& no_forces) {
  if (!no_forces) return;
  for (const char* const key : {"rotor_inertia", "shaft_inertia", "efficiency", "coulomb", "viscous", "slow_speed"})
    if (const auto given = table.find(key))
      throw given->refusal("inertias and losses of drive trains need dynamics, but " + *no_forces +
                           "; gear and lead need none");
}

/// Whether the table has only keys that pose quantities need: stiffness and peak_force.
bool is_for_quantities(const ConfigValue& table) {
  return table.keys().size() > 1 && std::ranges::all_of(table.keys(), [](const std::string& key) {
           return key == "joint" || key == "stiffness" || key == "peak_force";
         });
}

DriveTrain read_train(const ConfigValue& table, const AxisInfo& joint) {
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
  train.rotor = table.number_at("rotor_inertia");
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
  if (tables.empty()) return;
  const auto& joints = draft.info().joints;
  const Unsupported no_forces = why_no_joint_forces(*draft.parts.mechanism);
  std::vector<std::string> names = {"all"};
  for (const AxisInfo& joint : joints) names.push_back(joint.name);
  std::vector<std::optional<DriveTrain>> trains(joints.size());
  if (std::ranges::all_of(tables, is_for_quantities)) {
    for (const ConfigValue& table : tables) table.at("joint", "a joint, or \"all\"").word(names);
    return;  // stiffness and peak_force are read with the quantities of the mechanism
  }
  for (const ConfigValue& table : tables) {
    expect_forces(table, no_forces);
    const ConfigValue value = table.at("joint", "a joint, or \"all\"");
    const std::string& joint = value.word(names);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joint != "all" && joint != joints[i].name) continue;
      if (trains[i]) throw value.refusal("the joint " + joints[i].name + " has a drive train already");
      trains[i] = read_train(table, joints[i]);
    }
  }
  DriveTrains all;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!trains[i])
      throw tables.front().refusal("the joint " + joints[i].name +
                                   " has no drive train; give one for every joint, or none");
    all.push_back(*trains[i]);
  }
  draft.parts.mechanism = with_drive_trains(draft.parts.mechanism, std::move(all));
}

}  // namespace pkm
