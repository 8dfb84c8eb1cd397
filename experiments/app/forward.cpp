// `pkmopt forward`: every pose that given joint values allow, and its motion for that of the joints.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/setup/assignments.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct ForwardArguments : DesignArguments {
  std::vector<std::string> joints, speeds, accelerations;
  bool all = false;
};

std::array<double, 4> coordinates(const Pose<double>& pose) { return {pose.x, pose.y, pose.z, pose.angle}; }

/// Motion of the platform in one assembly mode.
struct PlatformMotion {
  Vector<double, 4> velocity, acceleration;
};

/// An assembly mode and its motion, where one is asked for and it is not singular.
struct Solution {
  AssemblyMode assembly;
  std::optional<PlatformMotion> motion;
};

/// What the joints do beside where they are.
struct JointMotion {
  bool given = false;
  Vector<double, 4> speeds, accelerations;
};

JointMotion joint_motion(const MechanismInfo& info, const ForwardArguments& arguments) {
  const auto four = [](const std::vector<double>& v) { return Vector<double, 4>{{v[0], v[1], v[2], v[3]}}; };
  JointMotion motion;
  motion.given = !(arguments.speeds.empty() && arguments.accelerations.empty());
  if (motion.given && !info.has_influence)
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so no speeds of the platform");
  motion.speeds = four(parse_some_assignments(arguments.speeds, "--speeds", assignable_joint_rates(info, "s")));
  motion.accelerations =
      four(parse_some_assignments(arguments.accelerations, "--accelerations", assignable_joint_rates(info, "s^2")));
  return motion;
}

std::optional<PlatformMotion> platform_motion(const Target& target, const AssemblyMode& assembly,
                                              const JointMotion& joints) {
  const auto& modes = target.info().modes;
  if (!joints.given) return std::nullopt;
  const std::string mode = assembly.working_mode.empty() ? modes.front() : assembly.working_mode;
  if (std::find(modes.begin(), modes.end(), mode) == modes.end()) return std::nullopt;  // between two, a limb singular
  const auto influence = target.mechanism->influence(target.parameters, assembly.pose, mode);
  if (!influence) return std::nullopt;
  const Influence<double> back = reversed(*influence);
  const PlatformMotion motion{back.G * joints.speeds, accelerations(back, joints.speeds, joints.accelerations)};
  for (const auto* part : {&motion.velocity, &motion.acceleration})
    for (const double value : part->m)
      if (!std::isfinite(value)) return std::nullopt;
  return motion;
}

Json poses_json(const Target& target, const std::vector<double>& joints, const JointMotion& motion,
                const ForwardStatus& status, const std::vector<Solution>& solutions) {
  const MechanismInfo& info = target.info();
  Json poses = Json::array();
  const auto by_name = [&](const Vector<double, 4>& values) {
    Json object = Json::object();
    for (std::size_t i = 0; i < 4; ++i) object[info.coordinates[i]] = values[i];
    return object;
  };
  for (const auto& [assembly, platform] : solutions) {
    Json pose;
    for (std::size_t i = 0; i < 4; ++i) pose[info.coordinates[i]] = coordinates(assembly.pose)[i];
    pose["mode"] = assembly.mode;
    pose["working_mode"] = assembly.working_mode.empty() ? Json() : Json(assembly.working_mode);
    pose["double_roots"] = assembly.double_roots;
    if (motion.given) {
      pose["velocity"] = platform ? by_name(platform->velocity) : Json();
      pose["acceleration"] = platform ? by_name(platform->acceleration) : Json();
    }
    poses.push_back(pose);
  }
  Json values;
  for (std::size_t i = 0; i < 4; ++i) values[info.joints[i]] = joints[i];
  return {{"mechanism", info.name},
          {"joints", values},
          {"status", status.word},
          {"reason", status.reason.empty() ? Json() : Json(status.reason)},
          {"poses", poses}};
}

void print_motions(const MechanismInfo& info, const std::vector<Solution>& solutions) {
  std::vector<Row> rows = {{"mode"}};
  for (const char* of : {" speed", " acceleration"})
    for (const auto& name : info.coordinates) rows[0].push_back(name + of);
  for (const auto& [assembly, platform] : solutions) {
    rows.push_back({assembly.mode});
    if (!platform) {
      rows.back().push_back("singular");
      continue;
    }
    for (const auto* part : {&platform->velocity, &platform->acceleration})
      for (const double value : part->m) rows.back().push_back(number(value));
  }
  print_section(std::cout, "motion of the platform (m/s, rad/s, m/s^2, rad/s^2)", rows);
}

void print_poses(const MechanismInfo& info, const std::vector<double>& joints, const std::vector<Solution>& solutions) {
  std::string values;
  for (std::size_t i = 0; i < 4; ++i) values += (i == 0 ? "" : ", ") + info.joints[i] + " = " + number(joints[i], "m");
  std::cout << aligned({{"mechanism", info.name}, {"joints", values}, {"poses", std::to_string(solutions.size())}});
  if (solutions.empty()) return;
  std::vector<Row> rows = {{}};
  for (std::size_t i = 0; i < 4; ++i) rows[0].push_back(info.coordinates[i] + (i == 3 ? " [rad]" : " [m]"));
  rows[0].push_back("mode");
  for (const auto& [assembly, platform] : solutions) {
    rows.emplace_back();
    for (const double value : coordinates(assembly.pose)) rows.back().push_back(number(value));
    rows.back().push_back(assembly.mode);
    for (const auto& root : assembly.double_roots) rows.back().push_back("double in " + root);
  }
  std::cout << '\n';
  std::cout << aligned(rows);
}

int forward(const Catalogues& catalogues, const ForwardArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const MechanismInfo& info = target.info();
  const auto joints = parse_all_assignments(arguments.joints, "--joints", assignable_joints(info));
  const std::array<double, 4> at = {joints[0], joints[1], joints[2], joints[3]};
  const JointMotion motion = joint_motion(info, arguments);
  const auto modes = target.mechanism->forward(target.parameters, at);
  const std::size_t found = modes.size();
  std::vector<Solution> solutions;
  for (const AssemblyMode& mode : modes)
    if (arguments.all || mode.usual) solutions.push_back({mode, platform_motion(target, mode, motion)});
  const ForwardStatus status = target.mechanism->forward_status(target.parameters, at);
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
