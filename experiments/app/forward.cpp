// `pkmopt forward`: every pose that given joint values allow.

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
  std::vector<std::string> joints;
  bool all = false;
};

std::array<double, 4> coordinates(const Pose<double>& pose) { return {pose.x, pose.y, pose.z, pose.angle}; }

Json poses_json(const MechanismInfo& info, const std::vector<double>& joints, const std::vector<AssemblyMode>& modes) {
  Json poses = Json::array();
  for (const auto& mode : modes) {
    Json pose;
    for (std::size_t i = 0; i < 4; ++i) pose[info.coordinates[i]] = coordinates(mode.pose)[i];
    pose["mode"] = mode.mode;
    poses.push_back(pose);
  }
  Json values;
  for (std::size_t i = 0; i < 4; ++i) values[info.joints[i]] = joints[i];
  return {{"mechanism", info.name}, {"joints", values}, {"poses", poses}};
}

void print_poses(const MechanismInfo& info, const std::vector<double>& joints, const std::vector<AssemblyMode>& modes) {
  std::string values;
  for (std::size_t i = 0; i < 4; ++i) values += (i == 0 ? "" : ", ") + info.joints[i] + " = " + number(joints[i], "m");
  std::cout << aligned({{"mechanism", info.name}, {"joints", values}, {"poses", std::to_string(modes.size())}});
  if (modes.empty()) return;
  std::vector<Row> rows = {{}};
  for (std::size_t i = 0; i < 4; ++i) rows[0].push_back(info.coordinates[i] + (i == 3 ? " [rad]" : " [m]"));
  rows[0].push_back("mode");
  for (const auto& mode : modes) {
    rows.emplace_back();
    for (const double value : coordinates(mode.pose)) rows.back().push_back(number(value));
    rows.back().push_back(mode.mode);
  }
  std::cout << '\n';
  std::cout << aligned(rows);
}

int forward(const Catalogues& catalogues, const ForwardArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const MechanismInfo& info = target.info();
  const auto joints = parse_all_assignments(arguments.joints, "--joints", assignable_joints(info));
  auto modes = target.mechanism->forward(target.parameters, {joints[0], joints[1], joints[2], joints[3]});
  const std::size_t found = modes.size();
  if (!arguments.all) std::erase_if(modes, [](const AssemblyMode& mode) { return !mode.usual; });
  if (arguments.json)
    print_json(std::cout, poses_json(info, joints, modes));
  else
    print_poses(info, joints, modes);
  if (found == 0) throw std::runtime_error("no pose assembles with these joint values");
  if (modes.empty())
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
  command->add_flag("--all", arguments->all, "The unusual assembly modes too");
  command->footer(
      "Limits are not looked at. Exit code 1 when no pose assembles.\n"
      "Example: pkmopt forward 4ppa-2par --joints q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846");
  command->callback([&session, arguments] { session.exit_code = forward(session.catalogues, *arguments); });
}

}  // namespace pkm
