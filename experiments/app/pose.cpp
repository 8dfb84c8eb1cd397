// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose, joints' speeds and accelerations of a motion.

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/math/satisfied.hpp"
#include "engine/problem/no_conditioning.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/chain_at.hpp"
#include "experiments/app/link_files.hpp"
#include "experiments/app/tool_error.hpp"

namespace pkm {
namespace {

struct PoseArguments : DesignArguments, MotionArguments, ChainArguments, LinkFiles {
  std::vector<std::string> joint_error;
};

/// The joints with their speeds and accelerations, and the influence coefficients that these come from.
void tell_joints(const Target& target, const std::string& mode, const MotionSample& at, const PoseReport& report,
                 Printout& out) {
  const MechanismInfo& info = target.info();
  std::vector<Row> rows;
  for (std::size_t i = 0; report.joints && i < info.joints.size(); ++i)
    rows.push_back({info.joints[i].name, position((*report.joints)[i], info.joints[i].unit)});
  if (const Velocities* const velocities = target.mechanism->velocities()) {
    for (const char* key : {"H", "joint_speeds", "joint_accelerations"}) out.json[key] = nullptr;
    if (const auto influence = velocities->influence(target.parameters, at.pose, mode)) {
      const AxisVector<double> speed = influence->G * at.velocity,
                               acceleration = accelerations(*influence, at.velocity, at.acceleration);
      for (std::size_t i = 0; i < info.joints.size(); ++i) out.json["H"].push_back(matrix_json(influence->H[i]));
      out.json["joint_speeds"] = vector_json(speed);
      out.json["joint_accelerations"] = vector_json(acceleration);
      const auto moves = [](double rate) { return rate != 0; };
      const bool told = std::ranges::any_of(at.velocity, moves) || std::ranges::any_of(at.acceleration, moves);
      for (std::size_t i = 0; told && i < rows.size(); ++i) {
        const std::string& unit = info.joints[i].unit;
        rows[i].insert(rows[i].end(), {number(speed[i], unit + "/s"), number(acceleration[i], unit + "/s^2")});
      }
    }
  }
  out.section("joints", rows);
}

const std::vector<std::string> kTwist = {"vx", "vy", "vz", "wx", "wy", "wz"};

/// Matrices with the names of their rows and columns.
void add_jacobians(const MechanismInfo& info, const PoseReport& report,
                   const std::optional<AxisMatrix<double>>& J_twist, Json& json) {
  json.update({{"J", matrix_json(report.J)},
               {"J_rows", names_of(info.joints)},
               {"J_columns", names_of(info.coordinates)},
               {"J_columns_are", "coordinate rates"},
               {"J_twist", matrix_json(J_twist)},
               {"J_twist_rows", names_of(info.joints)},
               {"J_twist_columns", kTwist},
               {"J_twist_columns_are", "twist"},
               {"T", matrix_json(report.T)},
               {"T_rows", kTwist},
               {"T_columns", names_of(info.coordinates)},
               {"Jq", matrix_json(report.Jq)},
               {"G", matrix_json(report.G)},
               {"det_Jq", json_or_null(report.det_Jq)},
               {"det_G", json_or_null(report.det_G)}});
}

/// Whether each rate of a coordinate is one component of the twist.
bool is_twist_of_rates(const AxisMatrix<double>& T) {
  for (std::size_t j = 0; j < T.cols(); ++j) {
    std::size_t ones = 0, zeros = 0;
    for (std::size_t i = 0; i < T.rows(); ++i) {
      ones += T(i, j) == 1;
      zeros += T(i, j) == 0;
    }
    if (ones != 1 || ones + zeros != T.rows()) return false;
  }
  return true;
}

/// Matrices that the pose has, where it has them.
void print_jacobians(const PoseReport& report, const std::optional<AxisMatrix<double>>& J_twist, Printout& out) {
  const auto print = [&out](const std::string& title, const std::optional<AxisMatrix<double>>& matrix) {
    out.text += matrix ? matrix_text(title, *matrix) : '\n' + title + ": does not exist\n";
  };
  if (report.G) {
    print("Jq, where Jq qdot = G V", report.Jq);
    print("G", report.G);
    print("J = Jq^-1 G, where qdot = J V", report.J);
  } else {
    print("J, where qdot = J V", report.J);
  }
  if (!report.T || is_twist_of_rates(*report.T)) return;
  print("T, where the twist of the platform [vx vy vz wx wy wz] = T V, V the rates of the coordinates", report.T);
  print("J_twist, where qdot = J_twist [vx vy vz wx wy wz]", J_twist);
}

std::string pose(const Target& target, const PoseArguments& arguments, Printout& out) {
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = mechanism.info();
  const std::string mode = known_mode(info, arguments);
  const MotionSample at = parse_motion(mechanism, arguments);
  if (!mechanism.velocities() && !(arguments.velocity.empty() && arguments.acceleration.empty()))
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so no speeds of joints");
  const auto chain = chain_at(target, arguments, at);
  const PoseReport report = mechanism.inspect(target.parameters, at.pose, mode, target.limits);

  out.say("mechanism", info.name);
  out.say("mode", mode);
  say_pose(info, at.pose, report, out);
  if (report.assembles && !report.feasible && !report.reason.empty()) out.head.back()[1] += ": " + report.reason;
  Json& json = out.json;
  json["joints"] = axes_json(info.joints, report.joints);
  const auto J_twist =
      report.J && report.T ? twist_jacobian(*report.J, *report.T) : std::optional<AxisMatrix<double>>();
  add_jacobians(info, report, J_twist, json);
  tell_joints(target, mode, at, report, out);
  if (!arguments.joint_error.empty()) tell_tool_error(target, mode, at, report.T, arguments.joint_error, out);
  if (report.assembles) print_jacobians(report, J_twist, out);

  std::vector<Row> indices, margins;
  const auto add_index = [&indices](const std::string& name, std::optional<double> value) {
    if (value) indices.push_back({name, number(*value)});
  };
  add_index("det_Jq", report.det_Jq);
  add_index("det_G", report.det_G);
  for (const auto& [name, value] : report.indices) add_index(name, value);
  add_index("conditioning", report.conditioning);
  std::string undefined = no_conditioning(info).value_or("");
  if (undefined.empty() && report.J && !report.conditioning)
    undefined = "the Jacobian is infinite, or a characteristic length of this design is not positive";
  if (!undefined.empty()) indices.push_back({"conditioning", "none: " + undefined});
  out.section("indices", indices);
  json["conditioning"] = json_or_null(report.conditioning);
  if (!undefined.empty()) json["why_no_conditioning"] = undefined;
  json["indices"] = values_by_name(report.indices);

  NamedValues angles = report.angles;
  if (chain) angles.insert(angles.end(), chain->report.angles.begin(), chain->report.angles.end());
  json["angles"] = values_by_name(angles);
  out.section("angles and lengths (rad, m)", rows_of(angles));
  if (chain) tell_chain(*mechanism.chain(), *chain, out);
  for (const auto& [name, value] : report.margins)
    margins.push_back({name, number(value), std::isnan(value) ? "" : is_satisfied(value) ? "holds" : "broken"});
  json["margins"] = values_by_name(report.margins);
  out.section("margins (>= 0 holds)", margins);
  write_links(target, mode, at.pose, arguments, out);
  return no_assembly(mode, report);
}

}  // namespace

void add_pose(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<PoseArguments>(
      app, session, "pose", "One pose: joints, Jacobians, singularity indices, limits.",
      "The limits are those of the study; a bare mechanism has none but its design's. A pose that breaks a limit is\n"
      "computed all the same (exit code 0); one that does not assemble gives its reason and exit code 1.\n"
      "Example: pkmopt pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg",
      pose);
  add_list_option(command, "--at", arguments.at, "The pose: every coordinate")->required();
  add_mode_options(command, arguments);
  add_list_option(command, "--velocity", arguments.velocity,
                  "Rates of the coordinates, and of an auxiliary chain's input; 0 where not given");
  add_list_option(command, "--acceleration", arguments.acceleration, "Accelerations of the same");
  add_option(command, "--joint-error ERROR|NAME=ERROR", arguments.joint_error,
             "Errors of the joints, as 10um of all, or by name: gives the tool's, to first order")
      ->allow_extra_args(false);
  add_link_files(command, arguments);
  add_chain_options(command, arguments);
}

}  // namespace pkm
