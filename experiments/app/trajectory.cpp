// `pkmopt trajectory`: a mechanism along a motion.

#include <numeric>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/rounding.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/report/csv_table.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/motor_fits.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct TrajectoryArguments : DesignArguments, ModeArguments, TableOutput {
  std::string motion;
  std::size_t samples = 201;
  std::string zeta;
  std::string motors;
  std::vector<std::string> wrench;
  bool allow_infeasible = false;
};

using Values = std::optional<AxisVector<double>>;

/// The auxiliary chain at a sample, NaN for what does not exist; empty where there is no chain.
NamedValues chain_values(const AuxiliaryChain* chain, const TrajectoryPoint& p) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  NamedValues values;
  if (!p.chain) return values;
  const Turning &in = p.motion.input, out = p.chain->turns ? p.chain->output : Turning{kAbsent, kAbsent, kAbsent};
  const auto add = [&values](const std::string& name, const Turning& turning) {
    values.emplace_back(name, turning.angle);
    values.emplace_back(name + "_speed", turning.speed);
    values.emplace_back(name + "_acceleration", turning.acceleration);
  };
  add(chain->input(), in);
  add(chain->output(), out);
  values.insert(values.end(), p.chain->angles.begin(), p.chain->angles.end());
  const auto add_axes = [&](const std::string& name, const Vector<double, 3>& vector) {
    for (std::size_t k = 0; k < 3; ++k)
      values.emplace_back(name + "_" + "xyz"[k], p.chain->turns ? vector[k] : kAbsent);
  };
  add_axes("omega", p.chain->spin.velocity);
  add_axes("alpha", p.chain->spin.acceleration);
  return values;
}

CsvTable table_of(const Mechanism& mechanism, const Trajectory& trajectory) {
  const MechanismInfo& info = mechanism.info();
  std::vector<std::string> columns = {"time"};
  const auto add_names = [&](const Axes& axes, const std::string& suffix) {
    for (const AxisInfo& axis : axes) columns.push_back(axis.name + suffix);
  };
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.coordinates, suffix);
  for (const char* suffix : {"", "_speed", "_acceleration"}) add_names(info.joints, suffix);
  for (const char* name : {"conditioning", "feasible", "reason"}) columns.emplace_back(name);
  if (mechanism.dynamics()) {
    for (const char* suffix : {"_force", "_power"}) add_names(info.joints, suffix);
    columns.emplace_back("power");
  }
  if (mechanism.drive_trains())
    for (const char* suffix : {"_motor_torque", "_motor_speed"}) add_names(info.joints, suffix);
  const auto with_chain = std::ranges::find_if(trajectory.points, [](const auto& p) { return p.chain.has_value(); });
  NamedValues chain;
  if (with_chain != trajectory.points.end()) chain = chain_values(mechanism.chain(), *with_chain);
  for (const auto& [name, value] : chain) columns.push_back(name);
  CsvTable table(columns);
  const auto add = [&](const Values& values) { values ? table.add(*values) : table.add_empty(info.joints.size()); };
  for (const TrajectoryPoint& p : trajectory.points) {
    table.begin_row();
    table.add(p.motion.time);
    for (const auto* values : {&p.motion.pose, &p.motion.velocity, &p.motion.acceleration}) table.add(*values);
    for (const auto* values : {&p.joints, &p.speeds, &p.accelerations}) add(*values);
    p.conditioning ? table.add(*p.conditioning) : table.add_empty(1);
    table.add(p.feasible ? 1.0 : 0.0);
    table.add(p.reason);
    if (mechanism.dynamics()) {
      add(p.forces);
      add(p.power);
      p.power ? table.add(std::accumulate(p.power->begin() + 1, p.power->end(), (*p.power)[0])) : table.add_empty(1);
    }
    if (mechanism.drive_trains()) {
      add(p.torques);
      add(p.motor_speeds);
    }
    for (const auto& [name, value] : chain_values(mechanism.chain(), p)) table.add(value);
    if (!p.chain) table.add_empty(chain.size());
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
  if (mechanism.dynamics()) {
    json["forces"] = axes_json(info.joints, p.forces);
    json["power"] = axes_json(info.joints, p.power);
  }
  if (mechanism.drive_trains()) {
    json["motor_torque"] = axes_json(info.joints, p.torques);
    json["motor_speed"] = axes_json(info.joints, p.motor_speeds);
  }
  if (p.chain) json["chain"] = values_by_name(chain_values(mechanism.chain(), p));
  return json;
}

/// " at t = 0.5 s (sample 51)", counted from 1.
std::string place_of(const Trajectory& trajectory, std::vector<TrajectoryPoint>::const_iterator point) {
  return " at t = " + with_unit(point->motion.time, "s") + " (sample " +
         std::to_string(point - trajectory.points.begin() + 1) + ")";
}

/// Why peaks of the summary are absent; "" where they are all there.
std::string why_absent(const Mechanism& mechanism, const Trajectory& trajectory) {
  const std::string name = "\nmechanism " + mechanism.info().name + " has no ";
  if (!mechanism.dynamics())
    return name + "dynamics: no forces, no power\n" +
           (mechanism.velocities() ? "" : name.substr(1) + "influence coefficients: no speeds\n");
  if (trajectory.summary.has_forces) return "";
  const auto first = std::ranges::find_if(trajectory.points, [](const auto& p) { return !p.forces; });
  return "\npeaks and energies of the forces are not known: the motion has none" + place_of(trajectory, first) + ": " +
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
  if (mechanism.dynamics()) {
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
  check_outputs({arguments.csv}, inputs, if_forced(arguments.force));
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = target.info();
  const std::string mode = known_mode(info, arguments);
  const Wrench<double> wrench = parse_wrench(arguments.wrench);
  if (const Refusal reason = no_joint_forces(mechanism); reason && mechanism.dynamics())
    throw ConfigError({"", 0, "trajectory"}, *reason + ", so no forces of its drives");
  if (!arguments.wrench.empty() && !mechanism.dynamics())
    throw ConfigError({"", 0, "--wrench"}, "mechanism " + info.name + " has no dynamics, so a wrench has no effect");
  if (!arguments.motors.empty() && !mechanism.drive_trains())
    throw ConfigError({"", 0, "--motors"}, "no drive trains", "a study with [[drive_train]]");
  if (!arguments.zeta.empty() && !mechanism.chain())
    throw ConfigError({"", 0, "--zeta"}, "mechanism " + info.name + " has no auxiliary chain");
  const double zeta = arguments.zeta.empty() ? 0 : parse_number(arguments.zeta, "--zeta", "rad");
  const auto motion = find_motion(target, arguments.motion);
  const Trajectory found =
      follow(mechanism, target.parameters, mode, target.limits, *motion, arguments.samples, wrench, zeta);
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
  if (!arguments.motors.empty() && found.summary.has_forces) tell_motors(target, mode, found, arguments.motors, out);
  out.json["samples"] = Json::array();
  for (const auto& point : found.points)
    if (out.for_programs) out.json["samples"].push_back(sample_json(mechanism, point));
  const auto first = std::ranges::find(found.points, false, &TrajectoryPoint::feasible);
  if (first == found.points.end() || arguments.allow_infeasible) return "";
  return infeasible + " of " + all + " samples are infeasible, the first" + place_of(found, first) + ": " +
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
  add_table_output(command, arguments, "Write all samples to this file, numbers in SI");
  command.add_flag("--allow-infeasible", arguments.allow_infeasible, "Exit code 0 also with infeasible samples");
}

}  // namespace pkm
