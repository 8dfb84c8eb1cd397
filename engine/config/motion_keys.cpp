// Keys of motions, drive trains and motors.

#include "engine/config/key_specs.hpp"
#include "engine/config/study_keys.hpp"

namespace pkm {
namespace {

/// Copies descriptions of keys such that their numbers may be formulas of parameters (motion_formulas.hpp).
std::vector<OptionSpec> with_formulas(std::vector<OptionSpec> keys) {
  for (OptionSpec& key : keys)
    if (key.kind == OptionKind::number) key.kind = OptionKind::formula;
  return keys;
}

/// Keys that determine the duration of a move: `time`, or peak accelerations and speeds.
std::vector<OptionSpec> pace_keys() {
  return {{.name = "time", .unit = "s", .meaning = "duration of a move", .positive = true},
          {.name = "acceleration",
           .unit = "m/s^2",
           .meaning = "peak acceleration, which determines the duration",
           .positive = true},
          {.name = "angular_acceleration", .unit = "rad/s^2", .meaning = "peak angular acceleration", .positive = true},
          {.name = "speed", .unit = "m/s", .meaning = "peak speed", .positive = true},
          {.name = "angular_speed", .unit = "rad/s", .meaning = "peak angular speed", .positive = true}};
}

OptionSpec wait_key(const std::string& where) {
  return {.name = "wait", .unit = "s", .initial = 0.0, .lower = 0, .meaning = "time at rest " + where};
}

OptionSpec law_key() {
  return {.name = "law",
          .kind = OptionKind::word,
          .initial = "quintic",
          .choices = {"quintic", "cycloid", "trapezoid"},
          .meaning = "time law of a move: polynomial of degree 5, cycloid, or trapezoidal speed in thirds of the time"};
}

std::vector<TableVariant> motion_variants() {
  static const TableSpec point = [] {
    TableSpec table = {.meaning = "a point; coordinates that are not given keep their values",
                       .keys = {wait_key("at the point")},
                       .named = {{.unit = kUnitOfEntry, .meaning = "value of the coordinate"}},
                       .noun = "key"};
    for (OptionSpec& key : pace_keys()) table.keys.push_back(std::move(key));
    table.keys = with_formulas(table.keys);
    table.named = with_formulas(table.named);
    return table;
  }();
  std::vector<OptionSpec> points = {
      {.name = "points",
       .kind = OptionKind::list,
       .required = true,
       .meaning = "the points, at least two; the first has all coordinates",
       .parts = {{.kind = OptionKind::table, .table = &point}}},
      law_key(),
      {.name = "back", .kind = OptionKind::flag, .initial = false, .meaning = "also move back along the points"}};
  for (OptionSpec& key : pace_keys()) points.push_back(std::move(key));
  return {
      {"points", "moves from point to point", points},
      {"pick-and-place",
       "lift, move sideways, lower, and back",
       {{.name = "lift", .unit = "m", .required = true, .meaning = "height of the lift along z"},
        {.name = "reach", .unit = "m", .required = true, .meaning = "distance sideways"},
        {.name = "lift_time", .unit = "s", .required = true, .meaning = "duration of the lift", .positive = true},
        {.name = "reach_time",
         .unit = "s",
         .required = true,
         .meaning = "duration of the move sideways",
         .positive = true},
        {.name = "overlap",
         .unit = "s",
         .initial = 0.0,
         .lower = 0,
         .meaning = "time by which lift and move sideways overlap"},
        {.name = "direction",
         .unit = "rad",
         .initial = 0.0,
         .meaning = "direction of the move sideways in the plane x, y"},
        {.name = "turn", .unit = "rad", .initial = 0.0, .meaning = "rotation during the move sideways"},
        wait_key("at both ends"),
        {.name = "cycle",
         .kind = OptionKind::word,
         .initial = "half",
         .choices = {"half", "whole"},
         .meaning = "half: from start to end; whole: also back to the start"},
        law_key()}},
      {"oscillation",
       "sinusoidal motion of x, y and z about a pose",
       {{.name = "amplitude", .unit = "m", .required = true, .meaning = "amplitude", .positive = true},
        {.name = "period", .unit = "s", .required = true, .meaning = "duration of one period", .positive = true},
        {.name = "cycles", .initial = 1.0, .meaning = "number of periods", .positive = true}}},
      {"formulas",
       "every coordinate is a formula of the time t [s]",
       {{.name = "duration", .unit = "s", .required = true, .meaning = "duration of the motion", .positive = true}}}};
}

/// Description of the table of a motion.
/// @param in_study  true for a [[motion]] of a study, which has a name
TableSpec motion_table(bool in_study) {
  TableSpec table = {
      .header = in_study ? "[[motion]]" : "",
      .meaning = "path of the platform as a function of time; numbers may be formulas of parameters",
      .keys = {},
      .choice = "type",
      .variants = motion_variants(),
      .named = {{.kind = OptionKind::formula,
                 .unit = kUnitOfEntry,
                 .meaning = "value at the start, or formula of the time t [s] and of parameters, of a coordinate or an "
                            "input of the mechanism"}}};
  if (in_study) {
    table.keys.push_back({.name = "name",
                          .kind = OptionKind::word,
                          .required = true,
                          .meaning = "name for objectives and constraints to refer to"});
    table.keys.push_back(
        {.name = "follow",
         .kind = OptionKind::flag,
         .initial = true,
         .meaning = "false: the motion may violate limits of poses (no constraint `motion` is added)"});
  }
  table.keys.push_back(
      {.name = "type", .kind = OptionKind::word, .required = true, .choices = {}, .meaning = "kind of motion"});
  for (TableVariant& variant : table.variants) {
    table.keys.back().choices.push_back(variant.word);
    variant.keys = with_formulas(variant.keys);
  }
  return table;
}

}  // namespace

const TableSpec& motion_keys() {
  static const TableSpec spec = motion_table(true);
  return spec;
}

const TableSpec& motion_file_keys() {
  static const TableSpec spec = motion_table(false);
  return spec;
}

const TableSpec& motor_keys() {
  static const TableSpec point = {
      .meaning = "a point of the curve of the peak torque",
      .keys = {{.name = "speed", .unit = "rad/s", .required = true, .lower = 0, .meaning = "speed of the motor"},
               {.name = "torque", .unit = "N m", .required = true, .lower = 0, .meaning = "peak torque there"}},
      .noun = "key"};
  static const TableSpec spec = {
      .header = "[[motor]]",
      .meaning = "a motor, in a motor file or a study",
      .keys = {
          {.name = "name", .kind = OptionKind::word, .required = true, .meaning = "name of the motor"},
          {.name = "continuous_torque",
           .unit = "N m",
           .required = true,
           .meaning = "torque that the motor can supply continuously",
           .positive = true},
          {.name = "peak_torque",
           .unit = "N m",
           .required = true,
           .meaning = "torque for short times, at least `continuous_torque`",
           .positive = true},
          {.name = "speed", .unit = "rad/s", .required = true, .meaning = "maximum speed", .positive = true},
          {.name = "rotor_inertia", .unit = "kg m^2", .required = true, .lower = 0, .meaning = "inertia of the rotor"},
          {.name = "curve",
           .kind = OptionKind::list,
           .meaning = "peak torque over the speed, linear between the points; default: constant",
           .parts = {{.kind = OptionKind::table, .table = &point}}}}};
  return spec;
}

const TableSpec& motor_file_keys() {
  static const TableSpec spec = {
      .header = "", .meaning = "motors", .keys = {required(tables_key("motor", motor_keys()))}, .noun = "table"};
  return spec;
}

const TableSpec& drive_train_keys() {
  constexpr double kMinEfficiency = 1e-3;
  static const TableSpec numbers = {
      .header = "[[drive_train]]",
      .meaning = "gear or screw, rotor and losses between a joint and its motor; given for all joints, or for none",
      .keys = {
          {.name = "joint", .kind = OptionKind::word, .required = true, .meaning = "name of a joint, or \"all\""},
          {.name = "gear",
           .initial = 1.0,
           .meaning = "gear ratio: revolutions of the motor per revolution of the joint or screw",
           .positive = true},
          {.name = "lead",
           .unit = "m",
           .meaning = "required for prismatic joints: travel per revolution of the screw",
           .positive = true},
          {.name = "rotor_inertia", .unit = "kg m^2", .initial = 0.0, .lower = 0, .meaning = "inertia of the rotor"},
          {.name = "shaft_inertia",
           .unit = "kg m^2",
           .initial = 0.0,
           .lower = 0,
           .meaning = "inertia on the shaft of the joint or screw"},
          {.name = "efficiency",
           .initial = 1.0,
           .lower = kMinEfficiency,
           .upper = 1,
           .meaning = "efficiency of gear and screw"},
          {.name = "coulomb",
           .unit = kUnitOfEntry,
           .initial = 0.0,
           .lower = 0,
           .meaning = "Coulomb friction at the joint [N or N m]"},
          {.name = "viscous",
           .unit = kUnitOfEntry,
           .initial = 0.0,
           .lower = 0,
           .meaning = "viscous friction at the joint [N s/m or N m s/rad]"},
          {.name = "slow_speed",
           .unit = kUnitOfEntry,
           .meaning = "joint speed below which the Coulomb friction is smoothed [m/s or rad/s]",
           .positive = true},
          formula_key("stiffness", kUnitOfEntry,
                      "stiffness after the gear [N/m or N m/rad], for the quantity `stiffness`; instead of the limb's "
                      "drive_stiffness"),
          formula_key(
              "peak_force", kUnitOfEntry,
              "maximum force or torque after the gear [N or N m], for the quantity `acceleration` and for fastest "
              "motions"),
          {.name = "peak_speed",
           .unit = kUnitOfEntry,
           .meaning = "maximum speed of the joint [m/s or rad/s], for fastest motions",
           .positive = true},
          {.name = "peak_acceleration",
           .unit = kUnitOfEntry,
           .meaning = "maximum acceleration of the joint [m/s^2 or rad/s^2], for fastest motions",
           .positive = true},
          {.name = "motor",
           .kind = OptionKind::word,
           .meaning =
               "name of a [[motor]] of the study: the inertia of its rotor, and its limits for fastest motions"}}};
  static const TableSpec spec = [] {
    TableSpec table = numbers;
    for (OptionSpec& key : table.keys)
      if (key.kind == OptionKind::number) key = or_key_of_row(key);
    return table;
  }();
  return spec;
}

}  // namespace pkm
