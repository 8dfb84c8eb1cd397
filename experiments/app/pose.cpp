// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose, joints' speeds and accelerations of a motion.

#include <algorithm>
#include <cmath>

#include "engine/model/singular.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/cad.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct PoseArguments : DesignArguments, MotionArguments {
  std::string theta, gamma, zeta;
  std::vector<std::string> joint_error;
  std::string stl, dxf;
  bool force = false;
};

double chain_angle(const Mechanism& mechanism, const std::string& text, const std::string& option) {
  if (text.empty()) return 0;
  if (!mechanism.chain())
    throw ConfigError({"", 0, option}, "mechanism " + mechanism.info().name + " has no auxiliary chain");
  return parse_number(text, option, "rad");
}

/// The auxiliary chain at a pose with the motion of its input.
struct ChainAt {
  Turning input;
  double zeta;
  ChainReport report;
};

std::optional<ChainAt> chain_at(const Target& target, const PoseArguments& arguments, MotionSample at) {
  if (!arguments.theta.empty() && !arguments.gamma.empty())
    throw ConfigError({"", 0, "--gamma"}, "the chain's input follows from its output; give --theta or --gamma");
  at.input.angle = chain_angle(*target.mechanism, arguments.theta, "--theta");
  const double zeta = chain_angle(*target.mechanism, arguments.zeta, "--zeta");
  const double gamma = chain_angle(*target.mechanism, arguments.gamma, "--gamma");
  const AuxiliaryChain* const chain = target.mechanism->chain();
  if (!chain) return {};
  if (!arguments.gamma.empty()) at.input.angle = chain->input_for(target.parameters, at.pose, gamma, zeta).value_or(0);
  return ChainAt{at.input, zeta, chain->report(target.parameters, at, zeta)};
}

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

/// Writes the files of the links that are asked for.
void write_links(const Target& target, const std::string& mode, const Pose<double>& pose,
                 const PoseArguments& arguments, Printout& out) {
  const Existing existing = if_forced(arguments.force);
  check_outputs({arguments.stl, arguments.dxf}, target.files, existing);
  if (arguments.stl.empty() && arguments.dxf.empty()) return;
  const MechanismInfo& info = target.info();
  const std::vector<PlacedLink> links =
      needed(target.mechanism->links(), "a file of links", "links", info).place(target.parameters, pose, mode);
  if (links.empty()) return;  // the pose does not assemble, which is told
  const std::string title = "links of " + info.name + ", " + target.words;
  const auto write = [&](const std::string& file, const std::string& bytes) {
    write_file(file, bytes, existing);
    out.json["files"].push_back(file);
    out.text += "\nwrote " + file + '\n';
  };
  if (!arguments.stl.empty()) write(arguments.stl, links_stl(links, target.limits.obstacles, title));
  if (!arguments.dxf.empty()) write(arguments.dxf, links_dxf(links, target.limits.obstacles));
}

/// Errors of the joints that --joint-error gives: one for all, or by name.
std::vector<double> joint_errors(const MechanismInfo& info, const std::vector<std::string>& lists) {
  const std::string option = "--joint-error";
  std::vector<double> errors;
  if (lists.size() == 1 && lists[0].find('=') == std::string::npos)
    for (const AxisInfo& joint : info.joints) errors.push_back(parse_number(lists[0], option, joint.unit));
  else
    errors = parse_some_assignments(lists, option, assignable_axes(info.joints));
  for (const double error : errors)
    if (error < 0) throw ConfigError({"", 0, option}, shortest(error), "an error >= 0");
  return errors;
}

/// What errors of the joints within +- theirs do to the platform, to first order: the worst that each coordinate can
/// have, and the longest translation, which is at a corner of the box of errors.
void tell_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                     const std::vector<std::string>& lists, Printout& out) {
  const MechanismInfo& info = target.info();
  const Velocities& velocities =
      needed(target.mechanism->velocities(), "--joint-error", "influence coefficients", info);
  if (info.joints.size() != info.coordinates.size())
    throw ConfigError({"", 0, "--joint-error"}, "mechanism " + info.name + " has not as many joints as coordinates");
  const std::vector<double> errors = joint_errors(info, lists);
  out.json["joint_error"] = values_by_name(info.joints, errors);
  out.json["tool_error"] = nullptr;
  const auto influence = velocities.influence(target.parameters, at.pose, mode);
  if (!influence || is_singular(influence->G)) {
    out.text += "\nerror of the tool: does not exist, the pose is singular\n";
    return;
  }
  const AxisMatrix<double> of_joints = reversed(*influence).G;
  const auto with_micrometres = [](double error) {
    return number(error, "m") + " (" + formatted("%.6g", 1e6 * error) + " um)";
  };
  std::vector<Row> rows;
  std::vector<double> worst(errors.size(), 0);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    for (std::size_t j = 0; j < errors.size(); ++j) worst[i] += std::fabs(of_joints(i, j)) * errors[j];
    const AxisInfo& axis = info.coordinates[i];
    rows.push_back({axis.name, axis.turns() ? position(worst[i], axis.unit) : with_micrometres(worst[i])});
  }
  double longest = 0;
  for (unsigned corner = 0; corner < 1U << errors.size(); ++corner) {
    double square = 0;
    for (std::size_t i = 0; i < worst.size(); ++i) {
      double move = 0;
      for (std::size_t j = 0; j < errors.size(); ++j) move += (corner >> j & 1 ? 1 : -1) * of_joints(i, j) * errors[j];
      if (!info.coordinates[i].turns()) square += move * move;
    }
    longest = std::max(longest, std::sqrt(square));
  }
  rows.push_back({"translation", with_micrometres(longest)});
  out.json["tool_error"] = {{"coordinates", values_by_name(info.coordinates, worst)}, {"translation", longest}};
  out.section("greatest error of the tool, for errors of the joints up to " + axes_text(info.joints, errors), rows);
}

/// Matrices that the pose has, where it has them.
void print_jacobians(const PoseReport& report, Printout& out) {
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
}

void tell_chain(const AuxiliaryChain& names, const ChainAt& at, Printout& out) {
  const ChainReport& chain = at.report;
  const Turning& turning = chain.output;
  const std::string in = names.input(), name = names.output();
  const auto found = [&chain](const Json& value) { return chain.turns ? value : Json(); };
  out.json["angles"][name] = found(turning.angle);
  out.json["chain"] = {{in, at.input.angle},
                       {"zeta", at.zeta},
                       {"reason", chain.turns ? Json() : Json(chain.reason)},
                       {name, found(turning.angle)},
                       {name + "_speed", found(turning.speed)},
                       {name + "_acceleration", found(turning.acceleration)},
                       {"omega", found(chain.spin.velocity.m)},
                       {"alpha", found(chain.spin.acceleration.m)},
                       {"gradient", found(vector_json(chain.influence.gradient))},
                       {"hessian", found(matrix_json(chain.influence.hessian))}};
  if (chain.turns)
    out.section("auxiliary chain", {{in, position(at.input.angle, "rad")},
                                    {name, position(turning.angle, "rad")},
                                    {"speed", number(turning.speed, "rad/s")},
                                    {"acceleration", number(turning.acceleration, "rad/s^2")}});
  else
    out.text += '\n' + name + " does not exist: " + chain.reason + '\n';
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
  json.update({{"joints", axes_json(info.joints, report.joints)},
               {"J", matrix_json(report.J)},
               {"Jq", matrix_json(report.Jq)},
               {"G", matrix_json(report.G)},
               {"det_Jq", json_or_null(report.det_Jq)},
               {"det_G", json_or_null(report.det_G)}});
  tell_joints(target, mode, at, report, out);
  if (!arguments.joint_error.empty()) tell_tool_error(target, mode, at, arguments.joint_error, out);
  if (report.assembles) print_jacobians(report, out);

  std::vector<Row> indices, margins;
  const auto add_index = [&indices](const std::string& name, std::optional<double> value) {
    if (value) indices.push_back({name, number(*value)});
  };
  add_index("det_Jq", report.det_Jq);
  add_index("det_G", report.det_G);
  for (const auto& [name, value] : report.indices) add_index(name, value);
  add_index("conditioning", report.conditioning);
  out.section("indices", indices);
  json["conditioning"] = json_or_null(report.conditioning);
  json["indices"] = values_by_name(report.indices);

  NamedValues angles = report.angles;
  if (chain) angles.insert(angles.end(), chain->report.angles.begin(), chain->report.angles.end());
  json["angles"] = values_by_name(angles);
  out.section("angles and lengths (rad, m)", rows_of(angles));
  if (chain) tell_chain(*mechanism.chain(), *chain, out);
  for (const auto& [name, value] : report.margins)
    margins.push_back({name, number(value), std::isnan(value) ? "" : value >= 0 ? "holds" : "broken"});
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
  add_option(command, "--stl FILE", arguments.stl, "Write the links' surfaces to this file, as binary STL in m");
  add_option(command, "--dxf FILE", arguments.dxf, "Write the links' axes to this file, as DXF in m");
  add_output_by_ending(command, {{".dxf", &arguments.dxf}, {".stl", &arguments.stl}});
  command.add_flag("--force", arguments.force, "Overwrite files that exist");
  add_option(command, "--theta ANGLE", arguments.theta, "Input angle of an auxiliary chain; default 0");
  add_option(command, "--gamma ANGLE", arguments.gamma, "Its output angle instead: the input follows");
  add_option(command, "--zeta ANGLE", arguments.zeta, "Phase of its forks; default 0");
}

}  // namespace pkm
