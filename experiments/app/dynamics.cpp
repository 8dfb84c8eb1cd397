// `pkmopt dynamics`: inverse dynamics, coupling indices and joint reactions at one pose with its velocity and
// acceleration.

#include "engine/config/assignments.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/mechanism/redundant_drives.hpp"
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

/// Adds the tensions of the cables to the output.
void report_tensions(const Target& target, const AxisVector<double>& tau, Printout& out) {
  const LimitedDrives* const drives = find_limited_drives(*target.mechanism);
  if (!drives || drives->cables().empty()) return;
  const DriveLimits limits = drives->drive_limits(target.parameters);
  std::vector<Row> rows = {{"", "tension", "minimum", "maximum"}};
  Json& json = out.json["tensions"] = Json::object();
  for (const std::size_t i : drives->cables()) {
    const std::string& name = target.info().joints[i].name;
    json[name] = -tau[i];
    rows.push_back({name, number(-tau[i], "N"), number(-limits.upper[i], "N"), number(-limits.lower[i], "N")});
  }
  out.add_table("tensions of the cables", rows);
}

/// Adds the joint-space dynamics to the output: positions, speeds, drive forces, powers and coupling indices. If there
/// are more drives than coordinates, M_q is undefined: M_X and the internal forces are added instead.
/// @return the reason why there are no drive forces; otherwise ""
std::string report_drive_forces(const Target& target, const PoseDynamics<double>& d, const MotionSample& at,
                                const Wrench<double>& wrench, Printout& out) {
  const MechanismInfo& info = target.info();
  const AxisVector<double> q_rate = d.J * at.velocity;
  out.json["joints"] = axes_json(info.joints, d.q);
  out.json["J"] = matrix_json(d.J);

  std::vector<Row> rows = {{"", "position"}};
  for (std::size_t i = 0; i < info.joints.size(); ++i)
    rows.push_back({info.joints[i].name, number(d.q[i], info.joints[i].unit)});
  const auto add = [&](const char* key, const char* title, const AxisVector<double>& values, const auto& unit) {
    out.json[key] = vector_json(values);
    rows[0].push_back(title);
    for (std::size_t i = 0; i < values.size(); ++i) rows[i + 1].push_back(number(values[i], unit(i)));
  };
  const auto force = [drives = assignable_forces(info)](std::size_t i) { return drives[i].unit; };
  add("joint_speeds", "speed", q_rate, [&info](std::size_t i) { return info.joints[i].unit + "/s"; });
  const std::string jacobian = matrix_text("J, where qdot = J Xdot", d.J);
  const bool redundant = d.J.rows() > d.J.cols();
  const std::string inertia =
      redundant ? matrix_text("inertia M_X at the platform (" + inertia_units(info.coordinates) + ")", d.M_X) : "";
  if (redundant) out.json["MX"] = matrix_json(d.M_X);
  const auto [forces, reason] =
      distributed_forces(d, at.acceleration, wrench, drive_limits(*target.mechanism, target.parameters));
  if (!forces) {
    out.add_table("joints", rows);
    out.text += inertia + jacobian;
    return is_rank_deficient(d.J) ? "the Jacobian of the pose is singular to working precision, so the drives have no "
                                    "forces"
                                  : reason;
  }
  const AxisVector<double>& tau = *forces;
  AxisVector<double> power = tau;
  for (std::size_t i = 0; i < power.size(); ++i) power[i] *= q_rate[i];
  add("tau", "force tau", tau, force);
  if (redundant) {
    add("power", "power", power, [](std::size_t) { return "W"; });
    out.add_table("joints", rows);
    report_tensions(target, tau, out);
    const AxisMatrix<double> internal = internal_forces(d.J);
    out.json["internal_forces"] = matrix_json(internal);
    out.text += matrix_text("internal forces, an orthonormal basis (rows: joints)", internal) + inertia + jacobian;
    return "";
  }
  const JointSpace<double> at_joints = joint_space(d);
  out.json["Mq"] = matrix_json(at_joints.M_q);
  add("coriolis", "Coriolis", at_joints.c_q, force);
  add("gravity", "gravity", at_joints.G_q, force);
  add("power", "power", power, [](std::size_t) { return "W"; });
  add("dci", "coupling index", coupling_indices(at_joints.M_q), [](std::size_t) { return "1"; });
  out.add_table("joints", rows);
  report_tensions(target, tau, out);
  out.text += matrix_text("joint-space inertia M_q (" + inertia_units(info.joints) + ")", at_joints.M_q) + jacobian;
  return "";
}

std::string dynamics(const Target& target, const DynamicsArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const Mechanism& mechanism = *target.mechanism;
  const Dynamics* const equations = mechanism.dynamics();
  if (const Unsupported reason = why_no_drive_forces(mechanism))
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
    no_forces = report_drive_forces(target, d, at, wrench, out);
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
