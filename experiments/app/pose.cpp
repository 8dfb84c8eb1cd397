// `pkmopt pose`: inverse kinematics, Jacobians and limits at one pose, joints' speeds and accelerations of a motion.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/setup/assignments.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/matrices.hpp"
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

Vector<double, 4> four(const std::vector<double>& v) { return {{v[0], v[1], v[2], v[3]}}; }

double chain_angle(const MechanismInfo& info, const std::string& text, const std::string& option) {
  if (text.empty()) return 0;
  if (info.chain_input.empty())
    throw ConfigError({"", 0, option}, "mechanism " + info.name + " has no auxiliary chain");
  return parse_number(text, option, "rad");
}

Found find(const Target& target, const PoseArguments& arguments) {
  const MechanismInfo& info = target.info();
  const Mechanism& mechanism = *target.mechanism;
  Found f;
  f.mode = known_mode(info, arguments);
  f.at.pose = four(parse_all_assignments(arguments.at, "--at", assignable_coordinates(info)));
  const auto rates = parse_some_assignments(arguments.velocity, "--velocity", assignable_rates(info, "s"));
  const auto changes = parse_some_assignments(arguments.acceleration, "--acceleration", assignable_rates(info, "s^2"));
  if (!info.has_influence && !(arguments.velocity.empty() && arguments.acceleration.empty()))
    throw ConfigError({}, "mechanism " + info.name + " has no influence coefficients, so no speeds of joints");
  f.at.velocity = four(rates);
  f.at.acceleration = four(changes);
  if (!arguments.theta.empty() && !arguments.gamma.empty())
    throw ConfigError({"", 0, "--gamma"}, "the chain's input follows from its output; give --theta or --gamma");
  f.at.input.angle = chain_angle(info, arguments.theta, "--theta");
  f.zeta = chain_angle(info, arguments.zeta, "--zeta");
  const double gamma = chain_angle(info, arguments.gamma, "--gamma");
  f.pose = mechanism.inspect(target.parameters, f.at.as_pose(), f.mode, target.limits);
  if (info.has_influence) f.influence = mechanism.influence(target.parameters, f.at.as_pose(), f.mode);
  if (info.chain_input.empty()) return f;
  if (!arguments.gamma.empty())
    f.at.input.angle = mechanism.chain_input(target.parameters, f.at.as_pose(), gamma, f.zeta).value_or(0);
  f.at.input.speed = rates.back();
  f.at.input.acceleration = changes.back();
  f.chain = mechanism.chain(target.parameters, f.at, f.zeta);
  return f;
}

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

/// The pose's angles and the chain's, with its output.
Json angles_json(const MechanismInfo& info, const Found& f) {
  Json angles = named_json(f.pose.angles);
  if (!f.chain) return angles;
  for (const auto& [name, value] : f.chain->angles) angles[name] = value;
  angles[info.chain_output] = f.chain->turns ? Json(f.chain->output.angle) : Json();
  return angles;
}

Json chain_json(const MechanismInfo& info, const Found& f) {
  const ChainReport& chain = *f.chain;
  const std::string& out = info.chain_output;
  Json json = {{info.chain_input, f.at.input.angle}, {"zeta", f.zeta}};
  json["reason"] = chain.turns ? Json() : Json(chain.reason);
  for (const char* suffix : {"", "_speed", "_acceleration"}) json[out + suffix] = nullptr;
  for (const char* key : {"omega", "alpha", "gradient", "hessian"}) json[key] = nullptr;
  if (!chain.turns) return json;
  json[out] = chain.output.angle;
  json[out + "_speed"] = chain.output.speed;
  json[out + "_acceleration"] = chain.output.acceleration;
  json["omega"] = chain.spin.velocity.m;
  json["alpha"] = chain.spin.acceleration.m;
  json["gradient"] = chain.influence.gradient.m;
  json["hessian"] = Json::array();
  for (std::size_t i = 0; i < 5; ++i) {
    json["hessian"].push_back(Json::array());
    for (std::size_t j = 0; j < 5; ++j) json["hessian"][i].push_back(chain.influence.hessian(i, j));
  }
  return json;
}

Json pose_json(const MechanismInfo& info, const Found& f) {
  const PoseReport& report = f.pose;
  Json pose = Json::object(), joints;
  for (std::size_t i = 0; i < 4; ++i) pose[info.coordinates[i]] = f.at.pose[i];
  if (report.joints)
    for (std::size_t i = 0; i < 4; ++i) joints[info.joints[i]] = (*report.joints)[i];
  Json json = {{"mechanism", info.name},
               {"mode", f.mode},
               {"pose", pose},
               {"feasible", report.feasible},
               {"assembles", report.assembles},
               {"reason", report.reason.empty() ? Json() : Json(report.reason)},
               {"joints", joints},
               {"J", matrix_or_null(report.J)},
               {"Jq", matrix_or_null(report.Jq)},
               {"G", matrix_or_null(report.G)},
               {"det_Jq", json_or_null(report.det_Jq)},
               {"det_G", json_or_null(report.det_G)}};
  if (info.has_influence) {
    for (const char* key : {"H", "joint_speeds", "joint_accelerations"}) json[key] = nullptr;
    if (f.influence) {
      json["H"] = Json::array();
      for (const auto& H : f.influence->H) json["H"].push_back(matrix_json(H));
      json["joint_speeds"] = vector_json(f.influence->G * f.at.velocity);
      json["joint_accelerations"] = vector_json(accelerations(*f.influence, f.at.velocity, f.at.acceleration));
    }
  }
  json["conditioning"] = json_or_null(report.conditioning);
  json["indices"] = named_json(report.indices);
  json["angles"] = angles_json(info, f);
  if (f.chain) json["chain"] = chain_json(info, f);
  json["margins"] = named_json(report.margins);
  return json;
}

void print_if_any(const std::string& title, const std::optional<Eigen::Matrix4d>& matrix) {
  if (matrix)
    print_matrix(std::cout, title, *matrix);
  else
    std::cout << '\n' << title << ": does not exist\n";
}

bool moves(const Vector<double, 4>& x) { return x[0] != 0 || x[1] != 0 || x[2] != 0 || x[3] != 0; }

std::vector<Row> joint_rows(const MechanismInfo& info, const Found& f) {
  std::vector<Row> rows;
  if (!f.pose.joints) return rows;
  for (std::size_t i = 0; i < 4; ++i) rows.push_back({info.joints[i], number((*f.pose.joints)[i], "m")});
  if (!f.influence || !(moves(f.at.velocity) || moves(f.at.acceleration))) return rows;
  const Vector<double, 4> speed = f.influence->G * f.at.velocity,
                          acceleration = accelerations(*f.influence, f.at.velocity, f.at.acceleration);
  for (std::size_t i = 0; i < 4; ++i)
    rows[i].insert(rows[i].end(), {number(speed[i], "m/s"), number(acceleration[i], "m/s^2")});
  return rows;
}

void print_chain(const MechanismInfo& info, const Turning& input, const ChainReport& chain) {
  if (!chain.turns) {
    std::cout << '\n' << info.chain_output << " does not exist: " << chain.reason << '\n';
    return;
  }
  const Turning& out = chain.output;
  print_section(std::cout, "auxiliary chain",
                {{info.chain_input, number(input.angle, "rad")},
                 {info.chain_output, number(out.angle, "rad")},
                 {"speed", number(out.speed, "rad/s")},
                 {"acceleration", number(out.acceleration, "rad/s^2")}});
}

void print_pose(const MechanismInfo& info, const Found& f) {
  const PoseReport& report = f.pose;
  std::string pose;
  for (std::size_t i = 0; i < 4; ++i)
    pose += (i == 0 ? "" : ", ") + info.coordinates[i] + " = " + number(f.at.pose[i], i == 3 ? "rad" : "m");
  std::cout << aligned({{"mechanism", info.name},
                        {"mode", f.mode},
                        {"pose", pose},
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
  if (f.chain) print_chain(info, f.at.input, *f.chain);
  print_section(std::cout, "margins (>= 0 holds)", margins);
}

int pose(const Catalogues& catalogues, const PoseArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Found found = find(target, arguments);
  if (arguments.json)
    print_json(std::cout, pose_json(target.info(), found));
  else
    print_pose(target.info(), found);
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
