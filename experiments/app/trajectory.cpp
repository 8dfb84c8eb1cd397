// `pkmopt trajectory`: computes joints, conditioning, actuator forces and power of a mechanism along a motion.

#include <algorithm>

#include "engine/config/assignments.hpp"
#include "engine/config/motor_table.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/export/tables.hpp"
#include "engine/math/rounding.hpp"
#include "engine/mechanism/redundant_drives.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/fastest.hpp"
#include "experiments/app/joint_forces.hpp"
#include "experiments/app/motion_inputs.hpp"
#include "experiments/app/motion_samples.hpp"
#include "experiments/app/motor_check.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct TrajectoryArguments : DesignArguments,
                             ModeArguments,
                             InputArguments,
                             ReactionArguments,
                             FastestArguments,
                             TableOutput {
  std::string motion;
  std::size_t samples = 201;
  std::string motors;
  std::vector<std::string> wrench;
  bool allow_infeasible = false;
};

using Values = std::optional<AxisVector<double>>;

/// Explains which peaks are missing from the summary and why; "" if none is missing.
std::string missing_peaks(const Mechanism& mechanism, const Trajectory& trajectory) {
  const std::string name = "\nmechanism " + mechanism.info().name + " has no ";
  if (!mechanism.dynamics())
    return name + "dynamics: forces and power are not computed\n" +
           (mechanism.velocities() ? "" : name.substr(1) + "influence coefficients: speeds are not computed\n");
  if (const Unsupported reason = why_no_drive_forces(mechanism))
    return '\n' + *reason + ": forces and power are not computed\n";
  if (trajectory.summary.has_forces) return "";
  const auto first = std::ranges::find_if(trajectory.points, [](const auto& p) { return !p.forces; });
  return "\npeak forces and energies are unknown: forces are undefined" + sample_location(trajectory, *first) + ": " +
         first->reason + '\n';
}

void report_summary(const Mechanism& mechanism, const Trajectory& trajectory, Printout& out) {
  const MechanismInfo& info = mechanism.info();
  const TrajectorySummary& s = trajectory.summary;
  Json& json = out.json["summary"] = {{"infeasible", s.infeasible}};
  std::vector<Row> rows = {{""}}, totals;
  for (const AxisInfo& joint : info.joints) rows[0].push_back(joint.name);
  const auto add = [&](const std::string& key, const std::string& title, const Values& values) {
    json[key] = axes_json(info.joints, values);
    Row& row = rows.emplace_back(Row{title});
    for (std::size_t i = 0; i < info.joints.size(); ++i) row.push_back(values ? number((*values)[i]) : "-");
  };
  const auto add_total = [&](const std::string& key, const std::string& title, double value, const std::string& unit,
                             const std::string& note = "") {
    json[key] = s.has_forces ? Json(value) : Json();
    totals.push_back({title, s.has_forces ? number(value, unit) : "-", note});
  };
  const auto if_known = [&s](const AxisVector<double>& values) { return s.has_forces ? Values(values) : Values(); };
  const std::string forces = units_of(assignable_forces(info));
  const std::string force = forces == "N m" ? "torque [N m]" : "force [" + forces + "]";
  const std::string per = trajectory.periodic ? "per cycle" : "over the motion";
  add("peak_speed", "peak speed [" + units_of(info.joints, "/s") + "]", s.peak_speed);
  if (const Unsupported reason = why_no_drive_forces(mechanism)) {
    json["no_forces"] = *reason;
  } else {
    add("peak_force", "peak " + force, if_known(s.peak_force));
    add("rms_force", "RMS " + force, if_known(s.rms_force));
    add("peak_power", "peak power [W]", if_known(s.peak_power));
    if (mechanism.drive_trains()) {
      add("peak_motor_torque", "motor, peak torque [N m]", if_known(s.peak_torque));
      add("rms_motor_torque", "motor, RMS torque [N m]", if_known(s.rms_torque));
      add("peak_motor_speed", "motor, peak speed [rad/s]", if_known(s.peak_motor_speed));
    }
    add_total("peak_total_power", "peak power", s.peak_total_power, "W");
    add_total("least_total_power", "minimum power", s.min_total_power, "W");
    // If all drawn energy is also returned, the sum is only a rounding error, which is printed as 0.
    add_total("energy", "energy " + per, zero_if_rounding_error(s.energy, s.energy_drawn), "J",
              "with regeneration while braking");
    add_total("energy_drawn", "energy drawn " + per, s.energy_drawn, "J", "without regeneration");
  }
  out.add_table("joints", rows);
  out.add_table("all joints together", totals);
  out.text += missing_peaks(mechanism, trajectory);
}

std::string trajectory(const Target& given, const TrajectoryArguments& arguments, Printout& out) {
  Target target = given;
  std::vector<std::string> inputs = target.files;
  for (const std::string& file : {arguments.motion, arguments.motors})
    if (!file.empty()) inputs.push_back(file);
  expect_fastest(arguments);
  const std::string mode = parse_mode(target.info(), arguments);
  const Wrench<double> wrench = parse_wrench(arguments.wrench);
  const Unsupported no_forces = why_no_drive_forces(*target.mechanism);
  if (!arguments.wrench.empty() && no_forces)
    throw ConfigError({"", 0, "--wrench"}, *no_forces + ", so a wrench has no effect");
  if (!arguments.motors.empty() && !target.mechanism->drive_trains())
    throw ConfigError({"", 0, "--motors"}, "no drive trains", "a study with [[drive_train]]");
  if (const Unsupported no_inertia = why_no_joint_forces(*target.mechanism); no_inertia && !arguments.motors.empty())
    throw ConfigError({"", 0, "--motors"}, *no_inertia + ", so motor torques cannot be computed");
  expect_reactions(*target.mechanism, arguments);
  auto motion = with_given_inputs(*target.mechanism, find_motion(target, arguments.motion), arguments);
  std::vector<Motor> motors;
  if (!arguments.motors.empty()) motors = load_motors_toml(arguments.motors);
  const MotionLimits limits = parse_limits(*target.mechanism, arguments, motors);
  target.mechanism = with_motor(target.mechanism, arguments, limits);
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = target.info();
  check_outputs({arguments.csv}, inputs, if_forced(arguments.force));
  std::optional<FastestMotion> fastest;
  if (arguments.fastest) {
    fastest =
        fastest_motion({mechanism, target.parameters, mode, limits, wrench}, motion, arguments, arguments.samples);
    motion = fastest->motion;
  }
  Trajectory found =
      compute_trajectory(mechanism, target.parameters, mode, target.limits, *motion, arguments.samples, wrench);
  if (arguments.any()) {
    add_reactions(mechanism, target.parameters, mode, wrench, found);
    for (TrajectoryPoint& point : found.points) select_joints(arguments, *point.reactions);
  }
  if (!arguments.csv.empty()) write_table(arguments, trajectory_table(mechanism, found));

  const std::string infeasible = std::to_string(found.summary.infeasible), all = std::to_string(found.points.size());
  out.add("mechanism", info.name);
  out.add("mode", mode);
  out.add("motion", arguments.motion, arguments.motion + (found.periodic ? " (periodic)" : ""));
  out.add("duration", found.duration, number(found.duration, "s"));
  if (fastest) report_fastest(info, *fastest, arguments, out);
  out.json["periodic"] = found.periodic;
  out.head.push_back({"samples", all});
  out.head.push_back({"feasible", found.summary.infeasible == 0 ? "yes" : "not at " + infeasible + " samples"});
  report_summary(mechanism, found, out);
  if (arguments.any()) report_reactions(found, out);
  if (arguments.reactions) report_rods(target, mode, found, out);
  if (!motors.empty() && found.summary.has_forces) report_motor_check(target, mode, found, motors, out);
  out.json["samples"] = Json::array();
  for (const auto& point : found.points)
    if (out.as_json) out.json["samples"].push_back(sample_json(mechanism, point));
  const auto first = std::ranges::find(found.points, false, &TrajectoryPoint::feasible);
  if (first == found.points.end() || arguments.allow_infeasible) return "";
  return infeasible + " of " + all + " samples are infeasible, the first" + sample_location(found, *first) + ": " +
         first->reason + " (--allow-infeasible accepts them)";
}

}  // namespace

void add_trajectory(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<TrajectoryArguments>(
      app, session, "trajectory", "Evaluate a motion: joints, conditioning and, if masses are known, forces and power.",
      "Limits are those of the study; without a study, only those that follow from the design, such as joint ranges.\n"
      "Samples that violate a limit are marked with the reason, and the exit code is 1. The format of motion files is\n"
      "described in docs/reference/motion/file.md.\n"
      "Example: pkmopt trajectory 3crr-r-cru --motion experiments/3crr-r-cru/motions/pick-and-place.toml --csv f.csv",
      trajectory);
  add_option(command, "--motion MOTION.toml", arguments.motion,
             "A motion in TOML, a table of times and poses in CSV, or the name of a [[motion]] of the study")
      ->required();
  add_integer(command, "--samples N", arguments.samples, 2, 10'000'000,
              "Number of samples, equally spaced in time, both ends included")
      ->default_str(std::to_string(arguments.samples));
  add_mode_options(command, arguments);
  add_list_option(command, "--wrench", arguments.wrench, "Constant force and moment on the platform; default: 0");
  add_input_option(command, arguments);
  add_option(command, "--motors MOTORS.toml", arguments.motors,
             "Check which motors of this table can perform the motion with the study's drive trains");
  add_fastest_options(command, arguments);
  add_reaction_options(command, arguments);
  add_table_output(command, arguments, "Write all samples to this file, in SI units");
  command.add_flag("--allow-infeasible", arguments.allow_infeasible, "Exit code 0 also with infeasible samples");
}

}  // namespace pkm
