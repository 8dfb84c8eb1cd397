// `pkmopt dynamics`: inverse dynamics, coupling indices and joint reactions at one pose with its velocity and
// acceleration.

#include "engine/config/assignments.hpp"
#include "engine/dynamics/coupling.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/joint_forces.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct DynamicsArguments : DesignArguments, MotionArguments, ReactionArguments {
  std::vector<std::string> wrench;
};

/// Text that states the units of the elements of the joint-space inertia matrix.
std::string inertia_units(const Axes& joints) {
  const std::string units = units_of(joints);
  return units == "m" ? "kg" : units == "rad" ? "kg m^2" : "kg, kg m, kg m^2";
}

/// Adds the joint-space dynamics to the output: positions, speeds, drive forces, powers and coupling indices.
/// @return the reason why there are no drive forces if J is singular; otherwise ""
std::string report_drive_forces(const MechanismInfo& info, const PoseDynamics<double>& d, const MotionSample& at,
                                const Wrench<double>& wrench, Printout& out) {
  const AxisVector<double> q_rate = d.J * at.velocity;
  out.json["joints"] = axes_json(info.joints, d.q);
  out.json["J"] = matrix_json(d.J);

  std::vector<Row> rows = {{"", "position"}};
  for (std::size_t i = 0; i < info.joints.size(); ++i)
    rows.push_back({info.joints[i].name, position(d.q[i], info.joints[i].unit)});
  const auto add = [&](const char* key, const char* title, const AxisVector<double>& values, const auto& unit) {
    out.json[key] = vector_json(values);
    rows[0].push_back(title);
    for (std::size_t i = 0; i < values.size(); ++i) rows[i + 1].push_back(number(values[i], unit(i)));
  };
  const auto force = [drives = assignable_forces(info)](std::size_t i) { return drives[i].unit; };
  add("joint_speeds", "speed", q_rate, [&info](std::size_t i) { return info.joints[i].unit + "/s"; });
  const std::string jacobian = matrix_text("J, where qdot = J Xdot", d.J);
  if (is_singular(d.J)) {
    out.add_table("joints", rows);
    out.text += jacobian;
    return "the Jacobian of the pose is singular to working precision, so the drives have no forces";
  }
  const JointSpace<double> at_joints = joint_space(d);
  const AxisVector<double> tau = drive_forces(d, at.acceleration, wrench);
  AxisVector<double> power = tau;
  for (std::size_t i = 0; i < power.size(); ++i) power[i] *= q_rate[i];
  out.json["Mq"] = matrix_json(at_joints.M_q);
  add("tau", "force tau", tau, force);
  add("coriolis", "Coriolis", at_joints.c_q, force);
  add("gravity", "gravity", at_joints.G_q, force);
  add("power", "power", power, [](std::size_t) { return "W"; });
  add("dci", "coupling index", coupling_indices(at_joints.M_q), [](std::size_t) { return "1"; });
  out.add_table("joints", rows);
  out.text += matrix_text("joint-space inertia M_q (" + inertia_units(info.joints) + ")", at_joints.M_q) + jacobian;
  return "";
}

std::string dynamics(const Target& target, const DynamicsArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const Mechanism& mechanism = *target.mechanism;
  const Dynamics* const equations = mechanism.dynamics();
  if (const Unsupported reason = why_no_joint_forces(mechanism))
    throw ConfigError({"", 0, "dynamics"}, *reason + ", so its dynamics are undefined");
  expect_reactions(mechanism, arguments);
  const std::string mode = parse_mode(info, arguments);
  const MotionSample at = parse_motion(mechanism, arguments);
  const Wrench<double> wrench = parse_wrench(arguments.wrench);
  const PoseReport report = mechanism.inspect(target.parameters, at.pose, mode, target.limits);
  out.add("mechanism", info.name);
  out.add("mode", mode);
  out.add("masses", equations->mass_model());
  report_pose(info, at.pose, report, out);
  for (const char* key : {"joints", "J", "Mq", "dci", "tau", "coriolis", "gravity", "joint_speeds", "power"})
    out.json[key] = nullptr;
  std::string no_forces;
  if (report.assembles) {
    const MotionState<double> state{at.pose, at.velocity};
    PoseDynamics<double> d;
    equations->equations(std::span<const double>(target.parameters), mode, {&state, 1}, {&d, 1});
    no_forces = report_drive_forces(info, d, at, wrench, out);
    if (arguments.any()) {
      Reactions found = mechanism.reactions()->find(target.parameters, mode, state, at.acceleration, wrench);
      select_joints(arguments, found);
      report_reactions(found, out);
      if (arguments.reactions) report_rods(target, mode, at.pose, found, out);
    }
  }
  return report.assembles ? no_forces : assembly_error(mode, report);
}

}  // namespace

void add_dynamics(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<DynamicsArguments>(
      app, session, "dynamics", "Compute inertia, coupling indices, drive forces and joint forces at one pose.",
      "The drive forces tau produce the given motion: tau = M_q qddot + coriolis + gravity - wrench.\n"
      "Example: pkmopt dynamics 3crr-r-cru --at x=0.2,y=0.17,z=0.22,phi=0.3 --acceleration x=5",
      dynamics);
  add_list_option(command, "--at", arguments.at, "Pose: a value for every coordinate")->required();
  add_list_option(command, "--velocity", arguments.velocity, "Velocities of the coordinates (default 0)");
  add_list_option(command, "--acceleration", arguments.acceleration, "Accelerations of the coordinates (default 0)");
  add_list_option(command, "--wrench", arguments.wrench,
                  "Fx, Fy, Fz, Mx, My, Mz on the platform at its centre of mass (default 0)");
  add_mode_options(command, arguments);
  add_reaction_options(command, arguments);
}

}  // namespace pkm
