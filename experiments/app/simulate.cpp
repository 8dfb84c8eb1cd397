// `pkmopt simulate`: computes the motion of a mechanism under given actuator forces and a given wrench (forward
// dynamics).

#include "engine/config/assignments.hpp"
#include "engine/core/unit.hpp"
#include "engine/dynamics/simulation.hpp"
#include "engine/export/tables.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct SimulateArguments : DesignArguments, MotionArguments, TableOutput {
  std::vector<std::string> forces, wrench;
  std::string duration, step;
};

double parse_time(const std::string& text, const std::string& option) {
  const double value = parse_number(text, option, "s");
  if (!(value > 0)) throw ConfigError({"", 0, option}, text, "a number > 0 s");
  return value;
}

SimulationSetup simulation_setup(const Target& target, const Dynamics& dynamics, const std::string& mode,
                                 const SimulateArguments& arguments) {
  constexpr double kMaxSteps = 1e7;
  const MechanismInfo& info = target.info();
  SimulationSetup setup;
  setup.dynamics = [&target, &dynamics, mode](const MotionState<double>& state) {
    PoseDynamics<double> d;
    dynamics.equations(std::span<const double>(target.parameters), mode, {&state, 1}, {&d, 1});
    return d;
  };
  setup.forces = [tau = axis_vector(parse_some_assignments(arguments.forces, "--forces", assignable_forces(info)))](
                     double) { return tau; };
  if (const DriveTrains* const trains = target.mechanism->drive_trains())
    setup.friction = [trains](const AxisVector<double>& speeds) {
      AxisVector<double> forces = speeds;
      for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = (*trains)[i].friction(speeds[i]);
      return forces;
    };
  setup.wrench = parse_wrench(arguments.wrench);
  setup.refuse = [&target, mode](const Pose<double>& pose) {
    const PoseReport report = target.mechanism->inspect(target.parameters, pose, mode, target.limits);
    return report.feasible ? std::string() : "the pose is no longer feasible: " + report.reason;
  };
  setup.duration = parse_time(arguments.duration, "--duration");
  setup.step = parse_time(arguments.step, "--step");
  if (setup.duration / setup.step > kMaxSteps)
    throw ConfigError({"", 0, "--step"}, arguments.step, "at most 1e7 steps in the duration");
  return setup;
}

Json state_json(const MechanismInfo& info, const SimulationState& s) {
  return {{"time", s.time},
          {"pose", values_by_name(info.coordinates, s.pose)},
          {"velocity", values_by_name(info.coordinates, s.velocity)},
          {"acceleration", values_by_name(info.coordinates, s.acceleration)},
          {"kinetic_energy", s.kinetic_energy},
          {"work_of_drives", s.work_of_drives},
          {"work_of_friction", s.work_of_friction},
          {"work_of_weight", s.work_of_weight},
          {"work_of_wrench", s.work_of_wrench}};
}

std::string simulate_target(const Target& target, const SimulateArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const Dynamics& dynamics = require_capability(target.mechanism->dynamics(), "simulate", "dynamics", info);
  const std::string mode = parse_mode(info, arguments);
  const MotionSample at = parse_motion(*target.mechanism, arguments);
  const auto setup = simulation_setup(target, dynamics, mode, arguments);
  check_outputs({arguments.csv}, target.files, if_forced(arguments.force));
  const Simulation run = simulate(setup, at.pose, at.velocity);
  if (run.states.empty()) throw std::runtime_error("nothing to simulate: " + run.stopped);
  if (!arguments.csv.empty()) write_table(arguments, simulation_table(info, run, target.mechanism->drive_trains()));

  const SimulationState &first = run.states.front(), &last = run.states.back();
  out.add("mechanism", info.name);
  out.add("mode", mode);
  out.json["imbalance"] = run.imbalance;
  out.json["turned_over"] = run.turned_over;
  out.json["states"] = Json::array();
  for (const auto& state : run.states)
    if (out.as_json) out.json["states"].push_back(state_json(info, state));
  out.json["stopped"] = text_or_null(run.stopped);
  out.head.push_back({"steps", std::to_string(run.states.size() - 1)});
  out.head.push_back({"end", number(last.time, "s")});
  std::vector<Row> rows = {{"", "start", "end", "speed at end"}};
  for (std::size_t i = 0; i < info.coordinates.size(); ++i) {
    const auto& [name, unit] = info.coordinates[i];
    rows.push_back(
        {name, number(first.pose[i], unit), number(last.pose[i], unit), number(last.velocity[i], unit + "/s")});
  }
  out.add_table("pose", rows);
  std::vector<Row> energy = {
      {"kinetic energy, start", number(first.kinetic_energy, "J")},
      {"work of the actuators", number(last.work_of_drives, "J")},
      {"work of gravity", number(last.work_of_weight, "J")},
      {"work of the wrench", number(last.work_of_wrench, "J")},
      {"kinetic energy, end", number(last.kinetic_energy, "J")},
      {"maximum imbalance", number(run.imbalance, "J"), "of " + number(run.turned_over, "J") + " exchanged"}};
  if (target.mechanism->drive_trains())
    energy.insert(energy.begin() + 2, {"work of friction", number(last.work_of_friction, "J")});
  out.add_table("energy", energy);
  return run.stopped.empty() ? "" : "the simulation ended early: " + run.stopped;
}

}  // namespace

void add_simulate(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<SimulateArguments>(
      app, session, "simulate", "Simulate the motion of a mechanism under given forces, starting at a pose.",
      "Ends early, with a message and exit code 1, if the mechanism leaves its reach, its joint ranges or the study's\n"
      "limits, approaches a singularity, or violates the energy balance by more than 1e-9 of the energy exchanged.\n"
      "Example: pkmopt simulate 3crr-r-cru --at x=0.2,y=0.17,z=0.22,phi=0.3 --forces rho3=8 --duration 0.1s --step "
      "1ms",
      simulate_target);
  add_list_option(command, "--at", arguments.at, "Initial pose: all coordinates")->required();
  add_list_option(command, "--velocity", arguments.velocity, "Initial rates of the coordinates; default: at rest");
  add_list_option(command, "--forces", arguments.forces, "Constant forces of the actuators; default: 0");
  add_list_option(command, "--wrench", arguments.wrench, "Constant force and moment on the platform; default: 0");
  add_option(command, "--duration TIME", arguments.duration, "Time to simulate")->required();
  add_option(command, "--step TIME", arguments.step, "Time step between two states")->required();
  add_mode_options(command, arguments);
  add_table_output(command, arguments, "Write all states to this file, in SI units");
}

}  // namespace pkm
