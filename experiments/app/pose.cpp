// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose, and the speeds and accelerations of the joints
// for given rates of the coordinates; or joints, limits and quantities at all poses of a table.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/generic/pose_margins.hpp"
#include "engine/math/satisfied.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/link_files.hpp"
#include "experiments/app/motion_inputs.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/stiffness.hpp"
#include "experiments/app/table_input.hpp"
#include "experiments/app/tool_error.hpp"

namespace pkm {
namespace {

struct PoseArguments : DesignArguments, MotionArguments, InputArguments, LinkFiles {
  std::vector<std::string> joint_error, wrench;
  bool stiffness = false, exact_error = false;
  TableJob poses;
  int threads = 0;
};

/// Reports the joint positions and, if rates are given, the speeds and accelerations of the joints; also the
/// second-order influence coefficients H, in JSON only.
void report_joints(const Target& target, const std::string& mode, const MotionSample& at, const PoseReport& report,
                   Printout& out) {
  const MechanismInfo& info = target.info();
  std::vector<Row> rows;
  for (std::size_t i = 0; report.joints && i < info.joints.size(); ++i)
    rows.push_back({info.joints[i].name, number((*report.joints)[i], info.joints[i].unit)});
  if (const Velocities* const velocities = target.mechanism->velocities()) {
    for (const char* key : {"H", "joint_speeds", "joint_accelerations"}) out.json[key] = nullptr;
    if (const auto influence = velocities->influence(target.parameters, at.pose, mode)) {
      const AxisVector<double> speed = influence->G * at.velocity,
                               acceleration = accelerations(*influence, at.velocity, at.acceleration);
      for (std::size_t i = 0; i < info.joints.size(); ++i) out.json["H"].push_back(matrix_json(influence->H[i]));
      out.json["joint_speeds"] = vector_json(speed);
      out.json["joint_accelerations"] = vector_json(acceleration);
      const auto moves = [](double rate) { return rate != 0; };
      const bool rates_given = std::ranges::any_of(at.velocity, moves) || std::ranges::any_of(at.acceleration, moves);
      for (std::size_t i = 0; rates_given && i < rows.size(); ++i) {
        const std::string& unit = info.joints[i].unit;
        rows[i].insert(rows[i].end(), {number(speed[i], unit + "/s"), number(acceleration[i], unit + "/s^2")});
      }
    }
  }
  out.add_table("joints", rows);
}

const std::vector<std::string> kTwistComponents = {"vx", "vy", "vz", "wx", "wy", "wz"};

/// Adds the Jacobian matrices to the JSON output, with the names of their rows and columns.
void add_jacobians(const MechanismInfo& info, const PoseReport& report,
                   const std::optional<AxisMatrix<double>>& J_twist, Json& json) {
  json.update({{"J", matrix_json(report.J)},
               {"J_rows", names_of(info.joints)},
               {"J_columns", names_of(info.coordinates)},
               {"J_columns_are", "coordinate rates"},
               {"J_twist", matrix_json(J_twist)},
               {"J_twist_rows", names_of(info.joints)},
               {"J_twist_columns", kTwistComponents},
               {"J_twist_columns_are", "twist"},
               {"T", matrix_json(report.T)},
               {"T_rows", kTwistComponents},
               {"T_columns", names_of(info.coordinates)},
               {"Jq", matrix_json(report.Jq)},
               {"G", matrix_json(report.G)},
               {"det_Jq", json_or_null(report.det_Jq)},
               {"det_G", json_or_null(report.det_G)}});
}

/// Returns true if each rate of a coordinate is a component of the twist, so that T contains only zeros and ones.
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

/// Prints those Jacobian matrices that are defined for the mechanism.
void print_jacobians(const PoseReport& report, const std::optional<AxisMatrix<double>>& J_twist, Printout& out) {
  const auto print = [&out](const std::string& title, const std::optional<AxisMatrix<double>>& matrix) {
    out.text += matrix ? matrix_text(title, *matrix) : '\n' + title + ": undefined at this pose\n";
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

/// Computes joints, conditioning, quantities and margins at all poses of a table.
void pose_table(const Target& target, const TableJob& job, int threads, const std::string& mode,
                const std::string& program, Printout& out) {
  const MechanismInfo& info = target.info();
  const CsvColumns given = read_table(job, assignable_axes(info.coordinates), true, program);
  const auto pose_of = [&](std::size_t row) {
    Pose<double> at(info.coordinates.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = (*given.values[i])[row];
    return at;
  };
  const auto reports = computed_rows<PoseReport>(given.rows, threads, [&](std::size_t row) {
    return target.mechanism->inspect(target.parameters, pose_of(row), mode, target.limits);
  });

  std::vector<std::size_t> quantities;  // indices of those quantities that depend on the pose
  std::vector<std::string> columns, margins;
  for (const AxisInfo& coordinate : info.coordinates)
    columns.push_back(column_header(coordinate.name, coordinate.unit));
  columns.insert(columns.end(), {"assembles", "feasible"});
  for (const AxisInfo& joint : info.joints) columns.push_back(column_header(joint.name, joint.unit));
  columns.emplace_back("conditioning");
  for (std::size_t i = 0; i < info.quantities.size(); ++i) {
    const QuantityInfo& quantity = info.quantities[i];
    if (quantity.of_design || quantity.of_motion) continue;
    quantities.push_back(i);
    columns.push_back(column_header(quantity.name, quantity.unit));
  }
  // At a pose that cannot be assembled, some margins are missing, so the names are collected from all poses.
  for (const PoseReport& report : reports)
    for (const auto& [name, value] : report.margins)
      if (!contains(margins, name)) margins.push_back(name);
  for (const std::string& margin : margins) columns.push_back("margin " + margin);
  columns.emplace_back("reason");

  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CsvTable table(columns);
  std::vector<Json> objects;
  std::size_t feasible = 0;
  for (std::size_t row = 0; row < given.rows; ++row) {
    const PoseReport& report = reports[row];
    const Pose<double> at = pose_of(row);
    table.row(std::span<const double>(at), int{report.assembles}, int{report.feasible});
    for (std::size_t i = 0; i < info.joints.size(); ++i) table.add(report.joints ? (*report.joints)[i] : nan);
    table.add(report.conditioning.value_or(nan));
    Json object = {{"pose", values_by_name(info.coordinates, at)},
                   {"assembles", report.assembles},
                   {"feasible", report.feasible},
                   {"joints", axes_json(info.joints, report.joints)},
                   {"conditioning", json_or_null(report.conditioning)}};
    for (const std::size_t i : quantities) {
      const double value = report.assembles && i < report.quantities.size() ? report.quantities[i] : nan;
      table.add(value);
      object["quantities"][info.quantities[i].name] = value;
    }
    for (const std::string& margin : margins) {
      const auto found = std::ranges::find(report.margins, margin, &NamedValues::value_type::first);
      table.add(found == report.margins.end() ? nan : found->second);
    }
    object["margins"] = values_by_name(report.margins);
    object["reason"] = text_or_null(report.reason);
    table.add(report.reason);
    objects.push_back(std::move(object));
    feasible += report.feasible;
  }
  report_table(job, table, std::move(objects),
               std::to_string(feasible) + " of " + std::to_string(given.rows) + " poses are feasible", out);
}

std::string pose(const Target& target, const PoseArguments& arguments, const std::string& program, Printout& out) {
  const Mechanism& mechanism = *target.mechanism;
  const MechanismInfo& info = mechanism.info();
  const std::string mode = parse_mode(info, arguments);
  expect_table(arguments.poses, "--poses");
  if (!arguments.poses.input.empty()) {
    TableJob job = arguments.poses;
    job.force = arguments.force;
    pose_table(target, job, arguments.threads, mode, program, out);
    return "";
  }
  if (arguments.at.empty()) throw ConfigError({"", 0, "--at"}, "nothing", "the pose, or --poses with a table of poses");
  MotionSample at = parse_motion(mechanism, arguments);
  set_inputs(mechanism, arguments, at);
  if (!mechanism.velocities() && !(arguments.velocity.empty() && arguments.acceleration.empty()))
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so joint speeds are unknown");
  const PoseReport report = mechanism.inspect(target.parameters, at.pose, mode, target.limits);

  out.add("mechanism", info.name);
  out.add("mode", mode);
  report_pose(info, at.pose, report, out);
  if (report.assembles && !report.feasible && !report.reason.empty()) out.head.back()[1] += ": " + report.reason;
  Json& json = out.json;
  json["joints"] = axes_json(info.joints, report.joints);
  const auto J_twist =
      report.J && report.T ? twist_jacobian(*report.J, *report.T) : std::optional<AxisMatrix<double>>();
  add_jacobians(info, report, J_twist, json);
  report_joints(target, mode, at, report, out);
  if (!arguments.joint_error.empty())
    report_tool_error(target, mode, at, report.T, arguments.joint_error, arguments.exact_error, out);
  if (arguments.stiffness) report_stiffness(target, mode, at.pose, report, arguments.wrench, out);
  if (report.assembles) print_jacobians(report, J_twist, out);

  std::vector<Row> indices, margins;
  const auto add_index = [&indices](const std::string& name, std::optional<double> value, const std::string& meaning) {
    if (value) indices.push_back({name, number(*value), meaning});
  };
  add_index("det_Jq", report.det_Jq, "determinant of Jq, 0 at serial singularities");
  add_index("det_G", report.det_G, "determinant of G, 0 at parallel singularities");
  for (const auto& [name, value] : report.indices) {
    const QuantityInfo* const quantity = find_named(info.quantities, name);
    indices.push_back({name, number(value, quantity ? quantity->unit : "1"), quantity ? quantity->meaning : ""});
  }
  add_index("conditioning", report.conditioning, kConditioning.meaning);
  std::string undefined = why_no_conditioning(info).value_or("");
  if (undefined.empty() && report.J && !report.conditioning)
    undefined = "the Jacobian is infinite, or a characteristic length of this design is not positive";
  if (!undefined.empty()) indices.push_back({"conditioning", "none: " + undefined});
  out.add_table("indices", indices);
  json["conditioning"] = json_or_null(report.conditioning);
  if (!undefined.empty()) json["why_no_conditioning"] = undefined;
  json["indices"] = values_by_name(report.indices);

  json["angles"] = values_by_name(report.angles);
  std::vector<Row> angles;
  for (const auto& [name, value] : report.angles) {
    // A value whose name is not that of a quantity of the mechanism is the clearance or the value of a passive joint.
    const QuantityInfo* const quantity = find_named(info.quantities, name);
    const std::string unit = quantity              ? quantity->unit
                             : name == "clearance" ? "m"
                                                   : generic::unit_of_passive_joint(mechanism, name);
    angles.push_back({name, number(value, unit)});
  }
  out.add_table("angles and lengths", angles);
  report_quantities(info, at, mechanism.quantities(target.parameters, mode, target.limits, at), out);
  for (const auto& [name, value] : report.margins)
    margins.push_back({name, number(value, generic::unit_of_margin(mechanism, name)),
                       std::isnan(value)     ? ""
                       : is_satisfied(value) ? "satisfied"
                                             : "violated"});
  json["margins"] = values_by_name(report.margins);
  out.add_table("margins (satisfied if >= 0)", margins);
  write_links(target, mode, at.pose, arguments, out);
  return assembly_error(mode, report);
}

}  // namespace

void add_pose(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<PoseArguments>(
      app, session, "pose", "Compute joints, Jacobians, singularity indices and limits at one pose.",
      "Limits are those of the study; without a study, only those that follow from the design, such as joint ranges.\n"
      "A pose that violates a limit is still evaluated (exit code 0). If the pose cannot be assembled, the reason is\n"
      "printed and the exit code is 1.\n"
      "Example: pkmopt pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg",
      [&session](const Target& target, const PoseArguments& given, Printout& out) {
        return pose(target, given, session.program, out);
      });
  add_list_option(command, "--at", arguments.at, "The pose: every coordinate");
  add_mode_options(command, arguments);
  add_list_option(command, "--velocity", arguments.velocity, "Rates of the coordinates and of the inputs; default: 0");
  add_list_option(command, "--acceleration", arguments.acceleration,
                  "Accelerations of the same coordinates; default: 0");
  auto* const table = add_option(
      command, "--poses FILE", arguments.poses.input,
      "Compute joints, limits and quantities at every row of this table (CSV), whose columns are the coordinates");
  add_threads(command, arguments.threads);
  auto* const joint_error =
      add_option(command, "--joint-error ERROR|NAME=ERROR", arguments.joint_error,
                 "Print the first-order error of the tool for these errors of the joints, 10um for all or by name");
  joint_error->allow_extra_args(false);
  command
      .add_flag("--exact-error", arguments.exact_error,
                "With --joint-error: find the poses of all extreme joint errors, and print the exact error, too")
      ->needs(joint_error);
  auto* const stiffness = command.add_flag("--stiffness", arguments.stiffness,
                                           "Print compliance, stiffness and natural frequencies of the platform");
  add_list_option(command, "--wrench", arguments.wrench,
                  "Force and moment at the origin of the platform, Fx=100,Mz=1: print the deflection")
      ->needs(stiffness);
  add_link_files(command, arguments, {{".csv", &arguments.poses.csv}});
  add_input_option(command, arguments);
  for (const char* const of_single_poses : {"--at", "--velocity", "--acceleration", "--input", "--joint-error",
                                            "--stiffness", "--stl", "--dxf", "--vtk", "--urdf", "--sdf", "--mjcf"})
    table->excludes(command.get_option(of_single_poses));
}

}  // namespace pkm
