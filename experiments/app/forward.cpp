// `pkmopt forward`: every pose that given joint values allow, and its motion for that of the joints.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/setup/assignments.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct ForwardArguments : DesignArguments {
  std::vector<std::string> joints, speeds, accelerations;
  bool all = false;
};

/// Motion of the platform in one assembly mode.
struct PlatformMotion {
  AxisVector<double> velocity, acceleration;
};

/// An assembly mode and its motion, where one is asked for and it is not singular.
struct Solution {
  AssemblyMode assembly;
  std::optional<PlatformMotion> motion;
};

/// What the joints do beside where they are.
struct JointMotion {
  bool given = false;
  AxisVector<double> speeds, accelerations;
};

JointMotion joint_motion(const Mechanism& mechanism, const ForwardArguments& arguments) {
  const MechanismInfo& info = mechanism.info();
  JointMotion motion;
  motion.given = !(arguments.speeds.empty() && arguments.accelerations.empty());
  if (motion.given && !mechanism.velocities())
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so no speeds of the platform");
  if (motion.given && info.joints.size() != info.coordinates.size())
    throw ConfigError({}, "mechanism " + info.name +
                              " has not as many joints as coordinates: their speeds do not give "
                              "those of the platform");
  motion.speeds = axis_vector(parse_some_assignments(arguments.speeds, "--speeds", assignable_joint_rates(info, "s")));
  motion.accelerations = axis_vector(
      parse_some_assignments(arguments.accelerations, "--accelerations", assignable_joint_rates(info, "s^2")));
  return motion;
}

std::optional<PlatformMotion> platform_motion(const Target& target, const AssemblyMode& assembly,
                                              const JointMotion& joints) {
  const auto& modes = target.info().modes;
  if (!joints.given) return std::nullopt;
  const std::string mode = assembly.working_mode.empty() ? modes.front() : assembly.working_mode;
  if (std::find(modes.begin(), modes.end(), mode) == modes.end()) return std::nullopt;  // between two, a limb singular
  const auto influence = target.mechanism->velocities()->influence(target.parameters, assembly.pose, mode);
  if (!influence) return std::nullopt;
  const Influence<double> back = reversed(*influence);
  const PlatformMotion motion{back.G * joints.speeds, accelerations(back, joints.speeds, joints.accelerations)};
  for (const auto* part : {&motion.velocity, &motion.acceleration})
    for (const double value : *part)
      if (!std::isfinite(value)) return std::nullopt;
  return motion;
}

Json poses_json(const Target& target, const AxisVector<double>& joints, const JointMotion& motion,
                const ForwardStatus& status, const std::vector<Solution>& solutions) {
  const MechanismInfo& info = target.info();
  Json poses = Json::array();
  for (const auto& [assembly, platform] : solutions) {
    Json pose = values_by_name(info.coordinates, assembly.pose);
    pose["mode"] = assembly.mode;
    pose["working_mode"] = text_or_null(assembly.working_mode);
    pose["double_roots"] = assembly.double_roots;
    if (motion.given) {
      pose["velocity"] = platform ? values_by_name(info.coordinates, platform->velocity) : Json();
      pose["acceleration"] = platform ? values_by_name(info.coordinates, platform->acceleration) : Json();
    }
    poses.push_back(pose);
  }
  return {{"mechanism", info.name},
          {"joints", values_by_name(info.joints, joints)},
          {"status", status.word},
          {"reason", text_or_null(status.reason)},
          {"poses", poses}};
}

void print_motions(const MechanismInfo& info, const std::vector<Solution>& solutions) {
  std::vector<Row> rows = {{"mode"}};
  for (const char* of : {" speed", " acceleration"})
    for (const AxisInfo& axis : info.coordinates) rows[0].push_back(axis.name + of);
  for (const auto& [assembly, platform] : solutions) {
    rows.push_back({assembly.mode});
    if (!platform) {
      rows.back().push_back("singular");
      continue;
    }
    for (const auto* part : {&platform->velocity, &platform->acceleration})
      for (const double value : *part) rows.back().push_back(number(value));
  }
  print_section(
      std::cout,
      "motion of the platform (" + units_of(info.coordinates, "/s") + ", " + units_of(info.coordinates, "/s^2") + ")",
      rows);
}

void print_poses(const MechanismInfo& info, const AxisVector<double>& joints, const std::vector<Solution>& solutions) {
  std::cout << aligned({{"mechanism", info.name},
                        {"joints", axes_text(info.joints, joints)},
                        {"poses", std::to_string(solutions.size())}});
  if (solutions.empty()) return;
  std::vector<Row> rows = {{}};
  for (const AxisInfo& axis : info.coordinates) rows[0].push_back(axis.name + " [" + axis.unit + "]");
  rows[0].push_back("mode");
  for (const auto& [assembly, platform] : solutions) {
    rows.emplace_back();
    for (const double value : assembly.pose) rows.back().push_back(number(value));
    rows.back().push_back(assembly.mode);
    for (const auto& root : assembly.double_roots) rows.back().push_back("double in " + root);
  }
  std::cout << '\n';
  std::cout << aligned(rows);
}

int forward(const Catalogues& catalogues, const ForwardArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const MechanismInfo& info = target.info();
  const ForwardKinematics& kinematics = needed(target.mechanism->forward(), "forward", "forward kinematics", info);
  const auto joints = axis_vector(parse_all_assignments(arguments.joints, "--joints", assignable_joints(info)));
  const JointMotion motion = joint_motion(*target.mechanism, arguments);
  const auto modes = kinematics.assemblies(target.parameters, joints);
  const std::size_t found = modes.size();
  std::vector<Solution> solutions;
  for (const AssemblyMode& mode : modes)
    if (arguments.all || mode.usual) solutions.push_back({mode, platform_motion(target, mode, motion)});
  const ForwardStatus status = kinematics.status(target.parameters, joints);
  if (arguments.json)
    print_json(std::cout, poses_json(target, joints, motion, status, solutions));
  else
    print_poses(info, joints, solutions);
  if (motion.given && !arguments.json && !solutions.empty()) print_motions(info, solutions);
  if (found == 0) throw std::runtime_error(status.reason);
  if (solutions.empty())
    throw std::runtime_error("no usual pose assembles with these joint values; --all lists " + std::to_string(found) +
                             " others");
  return kDone;
}

}  // namespace

void add_forward(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<ForwardArguments>();
  CLI::App* command = app.add_subcommand("forward", "Given joint values: the pose of every assembly mode.");
  add_design_arguments(*command, *arguments);
  add_list_option(*command, "--joints", arguments->joints, "Every joint's value", true);
  add_list_option(*command, "--speeds", arguments->speeds, "Speeds of the joints: gives the platform's", false);
  add_list_option(*command, "--accelerations", arguments->accelerations,
                  "Accelerations of the joints: gives the platform's", false);
  command->add_flag("--all", arguments->all, "The unusual assembly modes too");
  command->footer(
      "Limits are not looked at. Exit code 1 when no pose assembles.\n"
      "Example: pkmopt forward 4ppa-2par --joints q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846");
  command->callback([&session, arguments] { session.exit_code = forward(session.catalogues, *arguments); });
}

}  // namespace pkm
