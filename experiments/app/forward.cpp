// `pkmopt forward`: forward kinematics. Finds the poses for given joint values and, for given joint rates, the velocity
// and acceleration of the platform.

#include <algorithm>
#include <cmath>

#include "engine/config/assignments.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/mechanism/abilities/nearest_assembly.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct ForwardArguments : DesignArguments {
  std::vector<std::string> joints, near, speeds, accelerations;
  bool all = false;

  bool moves() const { return !(speeds.empty() && accelerations.empty()); }
};

/// First and second time derivatives of the joint positions or of the platform coordinates.
using Rates = std::array<AxisVector<double>, 2>;

/// Parses --speeds and --accelerations. Throws ConfigError if the mechanism cannot convert them to platform rates.
Rates joint_rates(const Mechanism& mechanism, const ForwardArguments& arguments) {
  const MechanismInfo& info = mechanism.info();
  if (arguments.moves() && !mechanism.velocities())
    throw ConfigError(
        {}, "mechanism " + info.name + " has no influence coefficients, so platform speeds cannot be computed");
  if (arguments.moves() && info.joints.size() != info.coordinates.size())
    throw ConfigError({}, "mechanism " + info.name +
                              " has different numbers of joints and coordinates, so joint speeds do "
                              "not determine platform speeds");
  const auto rates = [&](const std::vector<std::string>& lists, const char* option, const char* per) {
    return axis_vector(parse_some_assignments(lists, option, assignable_axes(info.joints, per)));
  };
  return {rates(arguments.speeds, "--speeds", "s"), rates(arguments.accelerations, "--accelerations", "s^2")};
}

/// Velocity and acceleration of the platform coordinates in an assembly mode; std::nullopt if the pose is singular.
std::optional<Rates> platform_rates(const Target& target, const AssemblyMode& assembly, const Rates& joints) {
  const auto& modes = target.info().modes;
  const std::string mode = assembly.working_mode.empty() ? modes.front() : assembly.working_mode;
  if (std::ranges::find(modes, mode) == modes.end())
    return std::nullopt;  // a limb is singular, so that the pose belongs to two working modes
  const auto influence = target.mechanism->velocities()->influence(target.parameters, assembly.pose, mode);
  if (!influence || is_singular(influence->G)) return std::nullopt;
  const Influence<double> back = reversed(*influence);
  const Rates rates{back.G * joints[0], accelerations(back, joints[0], joints[1])};
  for (const auto& part : rates)
    for (const double value : part)
      if (!std::isfinite(value)) return std::nullopt;
  return rates;
}

/// The assembly mode that is closest to the pose of --near, as a list of one element; empty if there is none.
std::vector<AssemblyMode> nearest_mode(const Target& target, const AxisVector<double>& joints,
                                       const std::vector<std::string>& near) {
  const auto from = axis_vector(parse_all_assignments(near, "--near", assignable_axes(target.info().coordinates)));
  auto found = nearest_assembly(*target.mechanism, target.parameters, joints, from);
  if (!found) return {};
  found->usual = true;  // the user has requested this mode, so it is always listed
  return {*found};
}

/// States whether the list of poses is complete, and by which method it was found.
/// @param hidden  number of poses that are listed only with --all
ForwardGuarantee guarantee_of(const ForwardKinematics& kinematics, const ForwardArguments& arguments,
                              std::size_t hidden) {
  ForwardGuarantee list = kinematics.guarantee();
  if (!arguments.near.empty())
    return {false, list.is_complete ? "the nearest of all isolated poses"
                                    : "found by Newton's method from the pose of --near alone; there may be others"};
  if (hidden == 0) return list;
  return {false, list.method + "; --all lists " + std::to_string(hidden) + " more"};
}

std::string forward(const Target& target, const ForwardArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const Axes& coordinates = info.coordinates;
  const ForwardKinematics& kinematics =
      require_capability(target.mechanism->forward(), "forward", "forward kinematics", info);
  const auto joints = axis_vector(parse_all_assignments(arguments.joints, "--joints", assignable_axes(info.joints)));
  const Rates rates = joint_rates(*target.mechanism, arguments);
  std::vector<AssemblyMode> modes;
  if (arguments.near.empty())
    modes = kinematics.assemblies(target.parameters, joints);
  else
    modes = nearest_mode(target, joints, arguments.near);
  const ForwardStatus status = kinematics.status(target.parameters, joints, modes);

  Json poses = Json::array();
  std::vector<Row> rows = {{}}, motions = {{"mode"}};
  for (const AxisInfo& axis : coordinates) rows[0].push_back(axis.name);
  rows[0].push_back("mode");
  for (const char* rate : {" speed", " acceleration"})
    for (const AxisInfo& axis : coordinates) motions[0].push_back(axis.name + rate);
  for (const AssemblyMode& assembly : modes) {
    if (!arguments.all && !assembly.usual) continue;
    Json pose = values_by_name(coordinates, assembly.pose);
    pose["mode"] = assembly.mode;
    pose["working_mode"] = text_or_null(assembly.working_mode);
    pose["double_roots"] = assembly.double_roots;
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < coordinates.size(); ++i) row.push_back(number(assembly.pose[i], coordinates[i].unit));
    row.push_back(assembly.mode);
    for (const auto& root : assembly.double_roots) row.push_back("double in " + root);
    if (arguments.moves()) {
      Row& motion = motions.emplace_back(Row{assembly.mode});
      const auto platform = platform_rates(target, assembly, rates);
      pose["velocity"] = platform ? values_by_name(coordinates, (*platform)[0]) : Json();
      pose["acceleration"] = platform ? values_by_name(coordinates, (*platform)[1]) : Json();
      if (!platform) motion.push_back("singular");
      for (std::size_t k = 0; platform && k < platform->size(); ++k)
        for (const double value : (*platform)[k]) motion.push_back(number(value));
    }
    poses.push_back(pose);
  }
  out.add("mechanism", info.name);
  out.add("joints", values_by_name(info.joints, joints), axes_text(info.joints, joints));
  out.json["status"] = status.word;
  out.json["reason"] = text_or_null(status.reason);
  out.add("poses", poses, std::to_string(poses.size()));
  const ForwardGuarantee guarantee = guarantee_of(kinematics, arguments, modes.size() - poses.size());
  out.add("complete", guarantee.is_complete, (guarantee.is_complete ? "yes, " : "no, ") + guarantee.method);
  out.json["guarantee"] = guarantee.method;
  if (!poses.empty()) out.text += '\n' + aligned(rows);
  if (!poses.empty() && arguments.moves())
    out.add_table("motion of the platform (" + units_of(coordinates, "/s") + ", " + units_of(coordinates, "/s^2") + ")",
                  motions);
  return modes.empty()   ? status.reason
         : poses.empty() ? "only unusual assembly modes exist for these joint values; --all lists all " +
                               std::to_string(modes.size())
                         : "";
}

}  // namespace

void add_forward(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<ForwardArguments>(
      app, session, "forward", "Solve the forward kinematics: find all poses for given joint values.",
      "Limits are ignored. Exit code 1 if no assembly mode exists. Each rigid-body pose is listed once; the line\n"
      "'complete' shows whether the list contains every pose.\n"
      "Example: pkmopt forward 4ppa-2par --joints q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846",
      forward);
  add_list_option(command, "--joints", arguments.joints, "Values of all joints")->required();
  add_list_option(command, "--near", arguments.near, "Find only the assembly mode closest to this pose");
  add_list_option(command, "--speeds", arguments.speeds,
                  "Joint speeds, from which the speed of the platform is computed");
  add_list_option(command, "--accelerations", arguments.accelerations,
                  "Joint accelerations, from which the acceleration of the platform is computed");
  command.add_flag("--all", arguments.all, "Also list assembly modes that are unusual in practice")->excludes("--near");
}

}  // namespace pkm
