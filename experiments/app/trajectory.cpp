// `pkmopt trajectory`: a mechanism along a motion.

#include <iostream>
#include <numeric>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/report/csv_table.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/setup/motion_section.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct TrajectoryArguments : DesignArguments, ModeArguments {
  std::string motion;
  std::size_t samples = 201;
  std::string csv, zeta;
  std::vector<std::string> wrench;
  bool allow_infeasible = false;
};

using Values = std::optional<AxisVector<double>>;

/// A [[motion]] of the study by its name, else a file.
std::shared_ptr<const Motion> find_motion(const Target& target, const std::string& name) {
  if (target.study)
    if (const NamedMotion* known = find_named(target.study->motions, name)) return known->motion;
  return load_motion_toml(name, motion_names(*target.mechanism));
}

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

/// Names of the above, as far as any sample has a chain.
std::vector<std::string> chain_columns(const AuxiliaryChain* chain, const Trajectory& trajectory) {
  std::vector<std::string> names;
  for (const TrajectoryPoint& p : trajectory.points)
    if (names.empty())
      for (const auto& [name, value] : chain_values(chain, p)) names.push_back(name);
  return names;
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
  const auto chain = chain_columns(mechanism.chain(), trajectory);
  columns.insert(columns.end(), chain.begin(), chain.end());
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
    const NamedValues turning = chain_values(mechanism.chain(), p);
    for (const auto& [name, value] : turning) table.add(value);
    if (turning.empty()) table.add_empty(chain.size());
  }
  return table;
}

Json summary_json(const Mechanism& mechanism, const Trajectory& trajectory) {
  const Axes& joints = mechanism.info().joints;
  const TrajectorySummary& s = trajectory.summary;
  Json json = {{"infeasible", s.infeasible}, {"peak_speed", axes_json(joints, s.peak_speed)}};
  if (!mechanism.dynamics()) return json;
  const auto number_or_null = [&s](double value) { return s.has_forces ? Json(value) : Json(); };
  const auto values_or_null = [&](const AxisVector<double>& values) {
    return axes_json(joints, s.has_forces ? Values(values) : Values());
  };
  json["peak_force"] = values_or_null(s.peak_force);
  json["rms_force"] = values_or_null(s.rms_force);
  json["peak_power"] = values_or_null(s.peak_power);
  json["peak_total_power"] = number_or_null(s.peak_total_power);
  json["least_total_power"] = number_or_null(s.least_total_power);
  json["energy"] = number_or_null(s.energy);
  json["energy_drawn"] = number_or_null(s.energy_drawn);
  return json;
}

Json sample_json(const Mechanism& mechanism, const TrajectoryPoint& p) {
  const MechanismInfo& info = mechanism.info();
  Json json = {{"time", p.motion.time},
               {"pose", axes_json(info.coordinates, p.motion.pose)},
               {"velocity", axes_json(info.coordinates, p.motion.velocity)},
               {"acceleration", axes_json(info.coordinates, p.motion.acceleration)},
               {"joints", axes_json(info.joints, p.joints)},
               {"speeds", axes_json(info.joints, p.speeds)},
               {"accelerations", axes_json(info.joints, p.accelerations)}};
  json["conditioning"] = json_or_null(p.conditioning);
  json["feasible"] = p.feasible;
  json["reason"] = text_or_null(p.reason);
  if (mechanism.dynamics()) {
    json["forces"] = axes_json(info.joints, p.forces);
    json["power"] = axes_json(info.joints, p.power);
  }
  if (p.chain) {
    json["chain"] = values_by_name(chain_values(mechanism.chain(), p));
  }
  return json;
}

Json trajectory_json(const Mechanism& mechanism, const std::string& mode, const std::string& motion,
                     const Trajectory& trajectory) {
  Json samples = Json::array();
  for (const auto& point : trajectory.points) samples.push_back(sample_json(mechanism, point));
  return {{"mechanism", mechanism.info().name},
          {"mode", mode},
          {"motion", motion},
          {"duration", trajectory.duration},
          {"periodic", trajectory.periodic},
          {"summary", summary_json(mechanism, trajectory)},
          {"samples", samples}};
}

void print_trajectory(const Mechanism& mechanism, const std::string& mode, const std::string& motion,
                      const Trajectory& trajectory) {
  const MechanismInfo& info = mechanism.info();
  const TrajectorySummary& s = trajectory.summary;
  const std::string all = std::to_string(trajectory.points.size());
  std::cout << aligned(
      {{"mechanism", info.name},
       {"mode", mode},
       {"motion", motion + (trajectory.periodic ? " (ends as it begins)" : "")},
       {"duration", number(trajectory.duration, "s")},
       {"samples", all},
       {"feasible", s.infeasible == 0 ? "yes" : "not at " + std::to_string(s.infeasible) + " samples"}});
  std::vector<Row> rows = {{""}};
  for (const AxisInfo& joint : info.joints) rows[0].push_back(joint.name);
  const auto add = [&rows](const std::string& title, const AxisVector<double>& values) {
    rows.push_back({title});
    for (const double value : values) rows.back().push_back(number(value));
  };
  const std::string forces = force_units_of(info.joints);
  add("peak speed [" + units_of(info.joints, "/s") + "]", s.peak_speed);
  if (s.has_forces) {
    add("peak force [" + forces + "]", s.peak_force);
    add("RMS force [" + forces + "]", s.rms_force);
    add("peak power [W]", s.peak_power);
  }
  print_section(std::cout, "joints", rows);
  if (!mechanism.dynamics()) std::cout << "\nmechanism " << info.name << " has no dynamics: no forces, no power\n";
  if (!s.has_forces) return;
  const std::string per = trajectory.periodic ? "per cycle" : "over the motion";
  print_section(std::cout, "all joints together",
                {{"peak power", number(s.peak_total_power, "W")},
                 {"least power", number(s.least_total_power, "W")},
                 {"energy " + per, number(s.energy, "J"), "braking gives back what it takes"},
                 {"energy drawn " + per, number(s.energy_drawn, "J"), "braking gives back nothing"}});
}

int trajectory(const Catalogues& catalogues, const TrajectoryArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = target.info();
  const std::string mode = known_mode(info, arguments);
  const Wrench<double> wrench = parse_wrench(arguments.wrench);
  if (!arguments.wrench.empty() && !mechanism.dynamics())
    throw ConfigError({"", 0, "--wrench"}, "mechanism " + info.name + " has no dynamics, so a wrench has no effect");
  if (!arguments.zeta.empty() && !mechanism.chain())
    throw ConfigError({"", 0, "--zeta"}, "mechanism " + info.name + " has no auxiliary chain");
  const double zeta = arguments.zeta.empty() ? 0 : parse_number(arguments.zeta, "--zeta", "rad");
  const auto motion = find_motion(target, arguments.motion);
  const Trajectory found =
      follow(mechanism, target.parameters, mode, target.limits, *motion, arguments.samples, wrench, zeta);
  if (!arguments.csv.empty()) table_of(mechanism, found).write(arguments.csv);
  if (arguments.json)
    print_json(std::cout, trajectory_json(mechanism, mode, arguments.motion, found));
  else
    print_trajectory(mechanism, mode, arguments.motion, found);
  if (found.summary.infeasible == 0 || arguments.allow_infeasible) return kDone;
  for (const auto& point : found.points)
    if (!point.feasible)
      throw std::runtime_error(std::to_string(found.summary.infeasible) + " of " + std::to_string(found.points.size()) +
                               " samples are infeasible, the first at t = " + with_unit(point.motion.time, "s") + ": " +
                               point.reason + " (--allow-infeasible takes them)");
  return kDone;
}

}  // namespace

void add_trajectory(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<TrajectoryArguments>();
  CLI::App* command =
      app.add_subcommand("trajectory", "A motion: joints, conditioning, and with masses forces and power.");
  add_design_arguments(*command, *arguments);
  command->add_option("--motion", arguments->motion, "A motion in TOML, or the name of a [[motion]] of the study")
      ->type_name("MOTION.toml")
      ->required();
  command->add_option("--samples", arguments->samples, "Poses at equal distances in time, both ends included")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(2, 10'000'000));
  add_mode_options(*command, *arguments);
  add_list_option(*command, "--wrench", arguments->wrench, "Force and moment on the platform, the same all the time",
                  false);
  command->add_option("--zeta", arguments->zeta, "Phase of an auxiliary chain's forks; default 0")->type_name("ANGLE");
  command->add_option("--csv", arguments->csv, "Write all samples to this file, numbers in SI")->type_name("FILE");
  command->add_flag("--allow-infeasible", arguments->allow_infeasible, "Exit code 0 also with infeasible samples");
  command->footer(
      "The limits are those of the study; a bare mechanism has none but its design's. Samples that break a limit\n"
      "are marked with the reason and make the exit code 1. experiments/README.md tells how motions are written.\n"
      "Example: pkmopt trajectory 3crr-r-cru --motion experiments/3crr-r-cru/motions/pick-and-place.toml --csv f.csv");
  command->callback([&session, arguments] { session.exit_code = trajectory(session.catalogues, *arguments); });
}

}  // namespace pkm
