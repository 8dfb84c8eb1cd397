// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose, joints' speeds and accelerations of a motion.

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

struct PoseArguments : DesignArguments, ModeArguments {
  std::vector<std::string> at, velocity, acceleration;
  std::string theta, gamma, zeta;
};

/// What the command line asks for, and what was found.
struct Found {
  std::string mode;
  MotionSample at;
  double zeta = 0;
  PoseReport pose;
  std::optional<Influence<double>> influence;
  std::optional<ChainReport> chain;
};

double chain_angle(const Mechanism& mechanism, const std::string& text, const std::string& option) {
  if (text.empty()) return 0;
  if (!mechanism.chain())
    throw ConfigError({"", 0, option}, "mechanism " + mechanism.info().name + " has no auxiliary chain");
  return parse_number(text, option, "rad");
}

Found find(const Target& target, const PoseArguments& arguments) {
  const MechanismInfo& info = target.info();
  const Mechanism& mechanism = *target.mechanism;
  Found f;
  f.mode = known_mode(info, arguments);
  f.at.pose = axis_vector(parse_all_assignments(arguments.at, "--at", assignable_coordinates(info)));
  const auto rates = parse_some_assignments(arguments.velocity, "--velocity", assignable_rates(mechanism, "s"));
  const auto changes =
      parse_some_assignments(arguments.acceleration, "--acceleration", assignable_rates(mechanism, "s^2"));
  if (!mechanism.velocities() && !(arguments.velocity.empty() && arguments.acceleration.empty()))
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so no speeds of joints");
  f.at.velocity = axis_vector(std::span(rates).first(f.at.pose.size()));  // behind them the chain's input
  f.at.acceleration = axis_vector(std::span(changes).first(f.at.pose.size()));
  if (!arguments.theta.empty() && !arguments.gamma.empty())
    throw ConfigError({"", 0, "--gamma"}, "the chain's input follows from its output; give --theta or --gamma");
  f.at.input.angle = chain_angle(mechanism, arguments.theta, "--theta");
  f.zeta = chain_angle(mechanism, arguments.zeta, "--zeta");
  const double gamma = chain_angle(mechanism, arguments.gamma, "--gamma");
  f.pose = mechanism.inspect(target.parameters, f.at.pose, f.mode, target.limits);
  if (const Velocities* velocities = mechanism.velocities())
    f.influence = velocities->influence(target.parameters, f.at.pose, f.mode);
  const AuxiliaryChain* const chain = mechanism.chain();
  if (!chain) return f;
  if (!arguments.gamma.empty())
    f.at.input.angle = chain->input_for(target.parameters, f.at.pose, gamma, f.zeta).value_or(0);
  f.at.input.speed = rates.back();
  f.at.input.acceleration = changes.back();
  f.chain = chain->report(target.parameters, f.at, f.zeta);
  return f;
}

Json matrix_or_null(const std::optional<AxisMatrix<double>>& matrix) { return matrix ? matrix_json(*matrix) : Json(); }

/// The pose's angles and the chain's, with its output.
Json angles_json(const Mechanism& mechanism, const Found& f) {
  Json angles = values_by_name(f.pose.angles);
  if (!f.chain) return angles;
  for (const auto& [name, value] : f.chain->angles) angles[name] = value;
  angles[mechanism.chain()->output()] = f.chain->turns ? Json(f.chain->output.angle) : Json();
  return angles;
}

Json chain_json(const AuxiliaryChain& names, const Found& f) {
  const ChainReport& chain = *f.chain;
  const std::string out = names.output();
  Json json = {{names.input(), f.at.input.angle}, {"zeta", f.zeta}};
  json["reason"] = chain.turns ? Json() : Json(chain.reason);
  for (const char* suffix : {"", "_speed", "_acceleration"}) json[out + suffix] = nullptr;
  for (const char* key : {"omega", "alpha", "gradient", "hessian"}) json[key] = nullptr;
  if (!chain.turns) return json;
  json[out] = chain.output.angle;
  json[out + "_speed"] = chain.output.speed;
  json[out + "_acceleration"] = chain.output.acceleration;
  json["omega"] = chain.spin.velocity.m;
  json["alpha"] = chain.spin.acceleration.m;
  json["gradient"] = vector_json(chain.influence.gradient);
  json["hessian"] = matrix_json(chain.influence.hessian);
  return json;
}

Json pose_json(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  const PoseReport& report = f.pose;
  Json json = {{"mechanism", info.name},
               {"mode", f.mode},
               {"pose", axes_json(info.coordinates, f.at.pose)},
               {"feasible", report.feasible},
               {"assembles", report.assembles},
               {"reason", text_or_null(report.reason)},
               {"joints", axes_json(info.joints, report.joints)},
               {"J", matrix_or_null(report.J)},
               {"Jq", matrix_or_null(report.Jq)},
               {"G", matrix_or_null(report.G)},
               {"det_Jq", json_or_null(report.det_Jq)},
               {"det_G", json_or_null(report.det_G)}};
  if (mechanism.velocities()) {
    for (const char* key : {"H", "joint_speeds", "joint_accelerations"}) json[key] = nullptr;
    if (f.influence) {
      json["H"] = Json::array();
      for (std::size_t i = 0; i < info.joints.size(); ++i) json["H"].push_back(matrix_json(f.influence->H[i]));
      json["joint_speeds"] = vector_json(f.influence->G * f.at.velocity);
      json["joint_accelerations"] = vector_json(accelerations(*f.influence, f.at.velocity, f.at.acceleration));
    }
  }
  json["conditioning"] = json_or_null(report.conditioning);
  json["indices"] = values_by_name(report.indices);
  json["angles"] = angles_json(mechanism, f);
  if (f.chain) json["chain"] = chain_json(*mechanism.chain(), f);
  json["margins"] = values_by_name(report.margins);
  return json;
}

void print_if_any(const std::string& title, const std::optional<AxisMatrix<double>>& matrix) {
  if (matrix)
    print_matrix(std::cout, title, *matrix);
  else
    std::cout << '\n' << title << ": does not exist\n";
}

bool moves(const AxisVector<double>& x) {
  return std::ranges::any_of(x, [](double rate) { return rate != 0; });
}

std::vector<Row> joint_rows(const MechanismInfo& info, const Found& f) {
  std::vector<Row> rows;
  if (!f.pose.joints) return rows;
  for (std::size_t i = 0; i < info.joints.size(); ++i)
    rows.push_back({info.joints[i].name, number((*f.pose.joints)[i], info.joints[i].unit)});
  if (!f.influence || !(moves(f.at.velocity) || moves(f.at.acceleration))) return rows;
  const AxisVector<double> speed = f.influence->G * f.at.velocity,
                           acceleration = accelerations(*f.influence, f.at.velocity, f.at.acceleration);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& unit = info.joints[i].unit;
    rows[i].insert(rows[i].end(), {number(speed[i], unit + "/s"), number(acceleration[i], unit + "/s^2")});
  }
  return rows;
}

void print_chain(const AuxiliaryChain& names, const Turning& input, const ChainReport& chain) {
  if (!chain.turns) {
    std::cout << '\n' << names.output() << " does not exist: " << chain.reason << '\n';
    return;
  }
  const Turning& out = chain.output;
  print_section(std::cout, "auxiliary chain",
                {{names.input(), number(input.angle, "rad")},
                 {names.output(), number(out.angle, "rad")},
                 {"speed", number(out.speed, "rad/s")},
                 {"acceleration", number(out.acceleration, "rad/s^2")}});
}

void print_pose(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  const PoseReport& report = f.pose;
  std::cout << aligned({{"mechanism", info.name},
                        {"mode", f.mode},
                        {"pose", axes_text(info.coordinates, f.at.pose)},
                        {"assembles", report.assembles ? "yes" : "no: " + report.reason},
                        {"feasible", report.feasible                              ? "yes"
                                     : report.assembles && !report.reason.empty() ? "no: " + report.reason
                                                                                  : "no"}});
  std::vector<Row> angles, margins, indices;
  for (const auto& [name, value] : report.angles) angles.push_back({name, number(value)});
  if (f.chain)
    for (const auto& [name, value] : f.chain->angles) angles.push_back({name, number(value)});
  for (const auto& [name, value] : report.margins)
    margins.push_back({name, number(value), std::isnan(value) ? "" : value >= 0 ? "holds" : "broken"});
  if (report.det_Jq) indices.push_back({"det_Jq", number(*report.det_Jq)});
  if (report.det_G) indices.push_back({"det_G", number(*report.det_G)});
  for (const auto& [name, value] : report.indices) indices.push_back({name, number(value)});
  if (report.conditioning) indices.push_back({"conditioning", number(*report.conditioning)});
  print_section(std::cout, "joints", joint_rows(info, f));
  if (report.assembles && report.G) {
    print_if_any("Jq, where Jq qdot = G V", report.Jq);
    print_if_any("G", report.G);
    print_if_any("J = Jq^-1 G, where qdot = J V", report.J);
  } else if (report.assembles) {
    print_if_any("J, where qdot = J V", report.J);
  }
  print_section(std::cout, "indices", indices);
  print_section(std::cout, "angles and lengths (rad, m)", angles);
  if (f.chain) print_chain(*mechanism.chain(), f.at.input, *f.chain);
  print_section(std::cout, "margins (>= 0 holds)", margins);
}

int pose(const Catalogues& catalogues, const PoseArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Found found = find(target, arguments);
  if (arguments.json)
    print_json(std::cout, pose_json(*target.mechanism, found));
  else
    print_pose(*target.mechanism, found);
  if (!found.pose.assembles)
    throw std::runtime_error("the pose does not assemble in mode " + found.mode + ": " + found.pose.reason);
  return kDone;
}

}  // namespace

void add_pose(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<PoseArguments>();
  CLI::App* command = app.add_subcommand("pose", "One pose: joints, Jacobians, singularity indices, limits.");
  add_design_arguments(*command, *arguments);
  add_list_option(*command, "--at", arguments->at, "The pose: every coordinate", true);
  add_mode_options(*command, *arguments);
  add_list_option(*command, "--velocity", arguments->velocity,
                  "Rates of the coordinates, and of an auxiliary chain's input; 0 where not given", false);
  add_list_option(*command, "--acceleration", arguments->acceleration, "Accelerations of the same", false);
  command->add_option("--theta", arguments->theta, "Input angle of an auxiliary chain; default 0")->type_name("ANGLE");
  command->add_option("--gamma", arguments->gamma, "Its output angle instead: the input follows")->type_name("ANGLE");
  command->add_option("--zeta", arguments->zeta, "Phase of its forks; default 0")->type_name("ANGLE");
  command->footer(
      "The limits are those of the study; a bare mechanism has none but its design's. A pose that breaks a limit is\n"
      "computed all the same (exit code 0); one that does not assemble gives its reason and exit code 1.\n"
      "Example: pkmopt pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg");
  command->callback([&session, arguments] { session.exit_code = pose(session.catalogues, *arguments); });
}

}  // namespace pkm
