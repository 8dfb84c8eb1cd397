// `pkmopt dynamics`: inertia, coupling and forces at one pose and motion.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/dynamics/coupling.hpp"
#include "engine/setup/assignments.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct DynamicsArguments : DesignArguments, ModeArguments {
  std::vector<std::string> at, velocity, acceleration, wrench;
  bool reactions = false;
};

/// What the command line asks for, and what was found.
struct Found {
  std::string mode;
  AxisVector<double> at, velocity, acceleration;
  Wrench<double> wrench;
  PoseReport pose;
  std::optional<PoseDynamics<double>> dynamics;  ///< absent where the pose does not assemble
  std::optional<Reactions> reactions;
};

Found find(const Target& target, const DynamicsArguments& arguments) {
  const MechanismInfo& info = target.info();
  const Mechanism& mechanism = *target.mechanism;
  const Dynamics* const equations = mechanism.dynamics();
  if (!equations) throw ConfigError({"", 0, "dynamics"}, "mechanism " + info.name + " has no masses, so no dynamics");
  if (arguments.reactions && !mechanism.reactions())
    throw ConfigError({"", 0, "--reactions"}, "mechanism " + info.name + " has no model of the forces in its joints");
  Found f;
  f.mode = known_mode(info, arguments);
  const std::size_t n = info.coordinates.size();  // behind them an auxiliary chain's input
  const auto rates = parse_some_assignments(arguments.velocity, "--velocity", assignable_rates(mechanism, "s"));
  const auto changes =
      parse_some_assignments(arguments.acceleration, "--acceleration", assignable_rates(mechanism, "s^2"));
  f.at = axis_vector(parse_all_assignments(arguments.at, "--at", assignable_coordinates(info)));
  f.velocity = axis_vector(std::span(rates).first(n));
  f.acceleration = axis_vector(std::span(changes).first(n));
  f.wrench = parse_wrench(arguments.wrench);
  const MotionState<double> state{f.at, f.velocity};
  f.pose = mechanism.inspect(target.parameters, state.pose, f.mode, target.limits);
  if (!f.pose.assembles) return f;
  PoseDynamics<double> d;
  equations->equations(std::span<const double>(target.parameters), f.mode, {&state, 1}, {&d, 1});
  f.dynamics = d;
  if (!arguments.reactions) return f;
  f.reactions = mechanism.reactions()->find(target.parameters, f.mode, state, f.acceleration, f.wrench);
  return f;
}

/// Everything that the joints feel.
struct Forces {
  JointSpace<double> at_joints;
  AxisVector<double> dci, tau, q_rate, power;
};

Forces forces(const Found& f) {
  const PoseDynamics<double>& d = *f.dynamics;
  Forces found{joint_space(d), {}, drive_forces(d, f.acceleration, f.wrench), d.J * f.velocity, {}};
  found.dci = coupling_indices(found.at_joints.M_q);
  found.power = found.tau;
  for (std::size_t i = 0; i < found.power.size(); ++i) found.power[i] *= found.q_rate[i];
  return found;
}

Json reactions_json(const Reactions& reactions) {
  Json joints = Json::object();
  for (const JointReaction& joint : reactions.joints) {
    Json couple = Json::array();
    for (const auto& component : joint.couple) couple.push_back(component ? Json(*component) : Json());
    joints[joint.name] = {{"on", joint.on}, {"force", joint.force}, {"couple", couple}};
  }
  Json json = {{"joints", joints}};
  json["reason"] = text_or_null(reactions.reason);
  json["equations"] = reactions.equations;
  json["unknowns"] = reactions.unknowns;
  json["rank"] = reactions.rank;
  return json;
}

Json dynamics_json(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  Json json = {{"mechanism", info.name},
               {"mode", f.mode},
               {"masses", mechanism.dynamics()->mass_model()},
               {"pose", axes_json(info.coordinates, f.at)},
               {"feasible", f.pose.feasible},
               {"assembles", f.pose.assembles},
               {"reason", text_or_null(f.pose.reason)}};
  for (const char* key : {"joints", "J", "Mq", "dci", "tau", "coriolis", "gravity", "joint_speeds", "power"})
    json[key] = nullptr;
  if (f.dynamics) {
    const Forces found = forces(f);
    json["joints"] = axes_json(info.joints, f.dynamics->q);
    json["J"] = matrix_json(f.dynamics->J);
    json["Mq"] = matrix_json(found.at_joints.M_q);
    json["dci"] = vector_json(found.dci);
    json["tau"] = vector_json(found.tau);
    json["coriolis"] = vector_json(found.at_joints.c_q);
    json["gravity"] = vector_json(found.at_joints.G_q);
    json["joint_speeds"] = vector_json(found.q_rate);
    json["power"] = vector_json(found.power);
  }
  if (f.reactions) json["reactions"] = reactions_json(*f.reactions);
  return json;
}

/// Elements of an inertia between joints.
std::string inertia_units(const Axes& joints) {
  const std::string units = units_of(joints);
  return units == "m" ? "kg" : units == "rad" ? "kg m^2" : "kg, kg m, kg m^2";
}

void print_dynamics(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  std::cout << aligned({{"mechanism", info.name},
                        {"mode", f.mode},
                        {"masses", mechanism.dynamics()->mass_model()},
                        {"pose", axes_text(info.coordinates, f.at)},
                        {"assembles", f.pose.assembles ? "yes" : "no: " + f.pose.reason},
                        {"feasible", f.pose.feasible ? "yes" : "no"}});
  if (!f.dynamics) return;
  const Forces found = forces(f);
  std::vector<Row> joints = {
      {"", "position", "speed", "force tau", "of velocities", "of weight", "power", "coupling index"}};
  for (std::size_t i = 0; i < info.joints.size(); ++i) {
    const auto& [name, unit] = info.joints[i];
    const std::string force = force_unit(info.joints[i]);
    joints.push_back({name, number(f.dynamics->q[i], unit), number(found.q_rate[i], unit + "/s"),
                      number(found.tau[i], force), number(found.at_joints.c_q[i], force),
                      number(found.at_joints.G_q[i], force), number(found.power[i], "W"), number(found.dci[i])});
  }
  print_section(std::cout, "joints", joints);
  print_matrix(std::cout, "inertia M_q as the joints feel it (" + inertia_units(info.joints) + ")",
               found.at_joints.M_q);
  print_matrix(std::cout, "J, where qdot = J Xdot", f.dynamics->J);
  if (!f.reactions) return;
  if (!f.reactions->reason.empty()) {
    std::cout << "\nno forces in the joints: " << f.reactions->reason << '\n';
    return;
  }
  std::vector<Row> rows = {{"", "on", "Fx", "Fy", "Fz", "Mx", "My", "Mz"}};
  for (const JointReaction& joint : f.reactions->joints) {
    Row row = {joint.name, joint.on};
    for (const double force : joint.force) row.push_back(number(force));
    for (const auto& couple : joint.couple) row.push_back(couple ? number(*couple) : "undetermined");
    rows.push_back(row);
  }
  print_section(std::cout,
                "forces (N) and couples (N m) in the joints: " + std::to_string(f.reactions->equations) +
                    " equations, " + std::to_string(f.reactions->unknowns) + " unknowns, rank " +
                    std::to_string(f.reactions->rank),
                rows);
}

int dynamics(const Catalogues& catalogues, const DynamicsArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Found found = find(target, arguments);
  if (arguments.json)
    print_json(std::cout, dynamics_json(*target.mechanism, found));
  else
    print_dynamics(*target.mechanism, found);
  if (!found.dynamics)
    throw std::runtime_error("the pose does not assemble in mode " + found.mode + ": " + found.pose.reason);
  return kDone;
}

}  // namespace

void add_dynamics(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<DynamicsArguments>();
  CLI::App* command =
      app.add_subcommand("dynamics", "One pose and motion: inertia, coupling indices, drive forces, joint forces.");
  add_design_arguments(*command, *arguments);
  add_list_option(*command, "--at", arguments->at, "The pose: every coordinate", true);
  add_list_option(*command, "--velocity", arguments->velocity, "Rates of the coordinates; 0 where not given", false);
  add_list_option(*command, "--acceleration", arguments->acceleration,
                  "Accelerations of the coordinates; 0 where not given", false);
  add_list_option(*command, "--wrench", arguments->wrench,
                  "Fx, Fy, Fz, Mx, My, Mz on the platform at its centre of mass; 0 where not given", false);
  add_mode_options(*command, *arguments);
  command->add_flag("--reactions", arguments->reactions, "Also the forces and couples in every joint");
  command->footer(
      "The forces tau of the actuators give the motion asked for: tau = M_q qddot + coriolis + gravity - wrench.\n"
      "Example: pkmopt dynamics 3crr-r-cru --at x=0.2,y=0.17,z=0.22,phi=0.3 --acceleration x=5");
  command->callback([&session, arguments] { session.exit_code = dynamics(session.catalogues, *arguments); });
}

}  // namespace pkm
