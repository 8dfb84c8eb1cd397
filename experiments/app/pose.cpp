// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/setup/assignments.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/matrices.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct PoseArguments : DesignArguments {
  std::vector<std::string> at;
  std::string mode;
};

template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json matrix_or_null(const std::optional<Eigen::Matrix4d>& matrix) { return matrix ? matrix_json(*matrix) : Json(); }

Json named_json(const NamedValues& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

Json pose_json(const MechanismInfo& info, const std::string& mode, const std::vector<double>& at,
               const PoseReport& report) {
  Json pose = Json::object(), joints;
  for (std::size_t i = 0; i < 4; ++i) pose[info.coordinates[i]] = at[i];
  if (report.joints)
    for (std::size_t i = 0; i < 4; ++i) joints[info.joints[i]] = (*report.joints)[i];
  return {{"mechanism", info.name},
          {"mode", mode},
          {"pose", pose},
          {"feasible", report.feasible},
          {"assembles", report.assembles},
          {"reason", report.reason.empty() ? Json() : Json(report.reason)},
          {"joints", joints},
          {"J", matrix_or_null(report.J)},
          {"Jq", matrix_or_null(report.Jq)},
          {"G", matrix_or_null(report.G)},
          {"det_Jq", json_or_null(report.det_Jq)},
          {"det_G", json_or_null(report.det_G)},
          {"conditioning", json_or_null(report.conditioning)},
          {"indices", named_json(report.indices)},
          {"angles", named_json(report.angles)},
          {"margins", named_json(report.margins)}};
}

void print_if_any(const std::string& title, const std::optional<Eigen::Matrix4d>& matrix) {
  if (matrix)
    print_matrix(std::cout, title, *matrix);
  else
    std::cout << '\n' << title << ": does not exist\n";
}

void print_pose(const MechanismInfo& info, const std::string& mode, const std::vector<double>& at,
                const PoseReport& report) {
  std::string pose;
  for (std::size_t i = 0; i < 4; ++i)
    pose += (i == 0 ? "" : ", ") + info.coordinates[i] + " = " + number(at[i], i == 3 ? "rad" : "m");
  std::cout << aligned({{"mechanism", info.name},
                        {"mode", mode},
                        {"pose", pose},
                        {"assembles", report.assembles ? "yes" : "no: " + report.reason},
                        {"feasible", report.feasible                              ? "yes"
                                     : report.assembles && !report.reason.empty() ? "no: " + report.reason
                                                                                  : "no"}});
  std::vector<Row> joints, angles, margins, indices;
  if (report.joints)
    for (std::size_t i = 0; i < 4; ++i) joints.push_back({info.joints[i], number((*report.joints)[i], "m")});
  for (const auto& [name, value] : report.angles) angles.push_back({name, number(value)});
  for (const auto& [name, value] : report.margins)
    margins.push_back({name, number(value), value >= 0 ? "holds" : "broken"});
  if (report.det_Jq) indices.push_back({"det_Jq", number(*report.det_Jq)});
  if (report.det_G) indices.push_back({"det_G", number(*report.det_G)});
  for (const auto& [name, value] : report.indices) indices.push_back({name, number(value)});
  if (report.conditioning) indices.push_back({"conditioning", number(*report.conditioning)});
  print_section(std::cout, "joints", joints);
  if (report.assembles && report.G) {
    print_if_any("Jq, where Jq qdot = G V", report.Jq);
    print_if_any("G", report.G);
    print_if_any("J = Jq^-1 G, where qdot = J V", report.J);
  } else if (report.assembles) {
    print_if_any("J, where qdot = J V", report.J);
  }
  print_section(std::cout, "indices", indices);
  print_section(std::cout, "angles and lengths (rad, m)", angles);
  print_section(std::cout, "margins (>= 0 holds)", margins);
}

int pose(const Catalogues& catalogues, const PoseArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const MechanismInfo& info = target.info();
  const std::string mode = known_mode(info, arguments.mode);
  const auto at = parse_all_assignments(arguments.at, "--at", assignable_coordinates(info));
  const PoseReport report =
      target.mechanism->inspect(target.parameters, {at[0], at[1], at[2], at[3]}, mode, target.limits);
  if (arguments.json)
    print_json(std::cout, pose_json(info, mode, at, report));
  else
    print_pose(info, mode, at, report);
  if (!report.assembles) throw std::runtime_error("the pose does not assemble in mode " + mode + ": " + report.reason);
  return kDone;
}

}  // namespace

void add_pose(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<PoseArguments>();
  CLI::App* command = app.add_subcommand("pose", "One pose: joints, Jacobians, singularity indices, limits.");
  add_design_arguments(*command, *arguments);
  add_list_option(*command, "--at", arguments->at, "The pose: every coordinate", true);
  add_mode_option(*command, arguments->mode);
  command->footer(
      "The limits are those of the study; a bare mechanism has none. A pose that breaks a limit is computed all the\n"
      "same (exit code 0); one that does not assemble gives its reason and exit code 1.\n"
      "Example: pkmopt pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg");
  command->callback([&session, arguments] { session.exit_code = pose(session.catalogues, *arguments); });
}

}  // namespace pkm
