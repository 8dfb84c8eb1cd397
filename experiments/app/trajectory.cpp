// `pkmopt trajectory`: a mechanism along a motion.

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/math/rounding.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/setup/motor_table.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/joint_forces.hpp"
#include "experiments/app/motion_samples.hpp"
#include "experiments/app/motor_fits.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct TrajectoryArguments : DesignArguments, ModeArguments, ReactionArguments, TableOutput {
  std::string motion;
  std::size_t samples = 201;
  std::string zeta;
  std::string motors;
  std::vector<std::string> wrench;
  bool allow_infeasible = false;
};

using Values = std::optional<AxisVector<double>>;

/// Why peaks of the summary are absent; "" where they are all there.
std::string why_absent(const Mechanism& mechanism, const Trajectory& trajectory) {
  const std::string name = "\nmechanism " + mechanism.info().name + " has no ";
  if (!mechanism.dynamics())
    return name + "dynamics: no forces, no power\n" +
           (mechanism.velocities() ? "" : name.substr(1) + "influence coefficients: no speeds\n");
  if (const Refusal reason = no_joint_forces(mechanism)) return '\n' + *reason + ": no forces, no power\n";
  if (trajectory.summary.has_forces) return "";
  const auto first = std::ranges::find_if(trajectory.points, [](const auto& p) { return !p.forces; });
  return "\npeaks and energies of the forces are not known: the motion has none" + place_of(trajectory, *first) + ": " +
         first->reason + '\n';
}

void tell_summary(const Mechanism& mechanism, const Trajectory& trajectory, Printout& out) {
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
  const std::string per = trajectory.periodic ? "per cycle" : "over the motion";
  add("peak_speed", "peak speed [" + units_of(info.joints, "/s") + "]", s.peak_speed);
  if (const Refusal reason = no_joint_forces(mechanism)) {
    json["no_forces"] = *reason;
  } else {
    add("peak_force", "peak force [" + forces + "]", if_known(s.peak_force));
    add("rms_force", "RMS force [" + forces + "]", if_known(s.rms_force));
    add("peak_power", "peak power [W]", if_known(s.peak_power));
    if (mechanism.drive_trains()) {
      add("peak_motor_torque", "motor, peak torque [N m]", if_known(s.peak_torque));
      add("rms_motor_torque", "motor, RMS torque [N m]", if_known(s.rms_torque));
      add("peak_motor_speed", "motor, peak speed [rad/s]", if_known(s.peak_motor_speed));
    }
    add_total("peak_total_power", "peak power", s.peak_total_power, "W");
    add_total("least_total_power", "least power", s.least_total_power, "W");
    // What goes in and out again leaves roundings.
    add_total("energy", "energy " + per, beyond_rounding(s.energy, s.energy_drawn), "J",
              "braking gives back what it takes");
    add_total("energy_drawn", "energy drawn " + per, s.energy_drawn, "J", "braking gives back nothing");
  }
  out.section("joints", rows);
  out.section("all joints together", totals);
  out.text += why_absent(mechanism, trajectory);
}

std::string trajectory(const Target& target, const TrajectoryArguments& arguments, Printout& out) {
  std::vector<std::string> inputs = target.files;
  for (const std::string& file : {arguments.motion, arguments.motors})
    if (!file.empty()) inputs.push_back(file);
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = target.info();
  const std::string mode = known_mode(info, arguments);
  const Wrench<double> wrench = parse_wrench(arguments.wrench);
  const Refusal no_forces = no_joint_forces(mechanism);
  if (!arguments.wrench.empty() && no_forces)
    throw ConfigError({"", 0, "--wrench"}, *no_forces + ", so a wrench has no effect");
  if (!arguments.motors.empty() && !mechanism.drive_trains())
    throw ConfigError({"", 0, "--motors"}, "no drive trains", "a study with [[drive_train]]");
  if (const Refusal reason = no_joint_forces(mechanism); reason && !arguments.motors.empty())
    throw ConfigError({"", 0, "--motors"}, *reason + ", so no torques of its motors");
  expect_reactions(mechanism, arguments);
  if (arguments.any() && no_forces)
    throw ConfigError({"", 0, arguments.reactions ? "--reactions" : "--joint"},
                      *no_forces + ", so no forces in its joints");
  if (!arguments.zeta.empty() && !mechanism.chain())
    throw ConfigError({"", 0, "--zeta"}, "mechanism " + info.name + " has no auxiliary chain");
  const double zeta = arguments.zeta.empty() ? 0 : parse_number(arguments.zeta, "--zeta", "rad");
  const auto motion = find_motion(target, arguments.motion);
  std::vector<Motor> motors;
  if (!arguments.motors.empty()) motors = load_motors_toml(arguments.motors);
  check_outputs({arguments.csv}, inputs, if_forced(arguments.force));
  Trajectory found =
      follow(mechanism, target.parameters, mode, target.limits, *motion, arguments.samples, wrench, zeta);
  if (arguments.any()) {
    add_reactions(mechanism, target.parameters, mode, wrench, found);
    for (TrajectoryPoint& point : found.points) keep_joints(arguments, *point.reactions);
  }
  if (!arguments.csv.empty()) write_table(arguments, table_of(mechanism, found));

  const std::string infeasible = std::to_string(found.summary.infeasible), all = std::to_string(found.points.size());
  out.say("mechanism", info.name);
  out.say("mode", mode);
  out.say("motion", arguments.motion, arguments.motion + (found.periodic ? " (ends as it begins)" : ""));
  out.say("duration", found.duration, number(found.duration, "s"));
  out.json["periodic"] = found.periodic;
  out.head.push_back({"samples", all});
  out.head.push_back({"feasible", found.summary.infeasible == 0 ? "yes" : "not at " + infeasible + " samples"});
  tell_summary(mechanism, found, out);
  if (arguments.any()) tell_reactions(found, out);
  if (!motors.empty() && found.summary.has_forces) tell_motors(target, mode, found, motors, out);
  out.json["samples"] = Json::array();
  for (const auto& point : found.points)
    if (out.for_programs) out.json["samples"].push_back(sample_json(mechanism, point));
  const auto first = std::ranges::find(found.points, false, &TrajectoryPoint::feasible);
  if (first == found.points.end() || arguments.allow_infeasible) return "";
  return infeasible + " of " + all + " samples are infeasible, the first" + place_of(found, *first) + ": " +
         first->reason + " (--allow-infeasible takes them)";
}

}  // namespace

void add_trajectory(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<TrajectoryArguments>(
      app, session, "trajectory", "A motion: joints, conditioning, and with masses forces and power.",
      "The limits are those of the study; a bare mechanism has none but its design's. Samples that break a limit\n"
      "are marked with the reason and make the exit code 1. experiments/README.md tells how motions are written.\n"
      "Example: pkmopt trajectory 3crr-r-cru --motion experiments/3crr-r-cru/motions/pick-and-place.toml --csv f.csv",
      trajectory);
  add_option(command, "--motion MOTION.toml", arguments.motion,
             "A motion in TOML, or the name of a [[motion]] of the study")
      ->required();
  add_integer(command, "--samples N", arguments.samples, 2, 10'000'000,
              "Poses at equal distances in time, both ends included")
      ->default_str(std::to_string(arguments.samples));
  add_mode_options(command, arguments);
  add_list_option(command, "--wrench", arguments.wrench, "Force and moment on the platform, the same all the time");
  add_option(command, "--zeta ANGLE", arguments.zeta, "Phase of an auxiliary chain's forks; default 0");
  add_option(command, "--motors MOTORS.toml", arguments.motors,
             "A table of motors: which of them do the motion, with the study's drive trains, and their reserve");
  add_reaction_options(command, arguments);
  add_table_output(command, arguments, "Write all samples to this file, numbers in SI");
  command.add_flag("--allow-infeasible", arguments.allow_infeasible, "Exit code 0 also with infeasible samples");
}

}  // namespace pkm
