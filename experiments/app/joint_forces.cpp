#include "experiments/app/joint_forces.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/generic/rod_loads.hpp"
#include "experiments/app/motion_samples.hpp"

namespace pkm {
namespace {

/// JSON array of the components of a force or couple; a component that is not determined is null.
Json components_json(const std::array<std::optional<double>, 3>& components) {
  return list_json(components, json_or_null<double>);
}

/// Adds the magnitude of a force or couple along a motion to the output: three cells of the joint's table row, and four
/// keys of the joint's JSON object.
void add_load(const std::string& key, const LoadSummary& load, const Trajectory& trajectory, Row& row, Json& json) {
  std::vector<std::string> undetermined;  // names of the components that are not determined
  for (std::size_t k = 0; k < 3; ++k)
    if (!load.determined[k]) undetermined.emplace_back(1, "xyz"[k]);
  const bool known = undetermined.size()<3, acts = load.peak> 0;
  const double time = trajectory.points[load.at].motion.time;
  row.push_back(known ? number(load.peak) + (undetermined.empty() ? "" : " (" + join(undetermined) + " undetermined)")
                      : "undetermined");
  row.push_back(acts ? number(time, "s") : "");
  row.push_back(known ? number(load.rms) : "");
  json["peak_" + key] = known ? Json(load.peak) : Json();
  json["peak_" + key + "_time"] = acts ? Json(time) : Json();
  json["rms_" + key] = known ? Json(load.rms) : Json();
  json["undetermined_" + key] = undetermined;
}

}  // namespace

void add_reaction_options(CLI::App& command, ReactionArguments& arguments) {
  command.add_flag("--reactions", arguments.reactions, "Also compute the forces and moments in all joints");
  add_option(command, "--joint NAME", arguments.joint,
             "Show the forces in this joint only, by its name in the output of --reactions (repeatable)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void expect_reactions(const Mechanism& mechanism, const ReactionArguments& arguments) {
  if (!arguments.any()) return;
  const char* const option = arguments.reactions ? "--reactions" : "--joint";
  if (const Unsupported reason = why_no_joint_forces(mechanism); reason && mechanism.dynamics())
    throw ConfigError({"", 0, option}, *reason + ", so forces in its joints cannot be computed");
  if (mechanism.reactions()) return;
  const std::string why = mechanism.why_no_reactions();
  throw ConfigError({"", 0, option}, "mechanism " + mechanism.info().name +
                                         " has no model of the forces in its joints" + (why.empty() ? "" : ": " + why));
}

void select_joints(const ReactionArguments& arguments, Reactions& reactions) {
  if (arguments.joint.empty() || reactions.joints.empty()) return;
  const std::vector<std::string> names = names_of(reactions.joints);
  for (const std::string& name : arguments.joint)
    if (!contains(names, name))
      throw ConfigError({"", 0, "--joint"}, "the unknown name '" + name + "'", "one of " + join(names),
                        nearest_name(name, names));
  std::erase_if(reactions.joints, [&](const JointReaction& joint) { return !contains(arguments.joint, joint.name); });
}

Json reactions_json(const Reactions& reactions) {
  Json joints = Json::object();
  for (const JointReaction& joint : reactions.joints)
    joints[joint.name] = {
        {"on", joint.on}, {"force", components_json(joint.force)}, {"couple", components_json(joint.couple)}};
  return joints;
}

void report_reactions(const Reactions& reactions, Printout& out) {
  std::vector<Row> rows = {{"", "on", "Fx", "Fy", "Fz", "Mx", "My", "Mz"}};
  for (const JointReaction& joint : reactions.joints) {
    Row& row = rows.emplace_back(Row{joint.name, joint.on});
    for (const auto* const components : {&joint.force, &joint.couple})
      for (const auto& component : *components) row.push_back(component ? number(*component) : "undetermined");
  }
  out.json["reactions"] = {{"joints", reactions_json(reactions)},
                           {"reason", text_or_null(reactions.reason)},
                           {"equations", reactions.equations},
                           {"unknowns", reactions.unknowns},
                           {"rank", reactions.rank}};
  if (reactions.reason.empty())
    out.add_table("forces (N) and moments (N m) in the joints: " + std::to_string(reactions.equations) +
                      " equations, " + std::to_string(reactions.unknowns) + " unknowns, rank " +
                      std::to_string(reactions.rank),
                  rows);
  else
    out.text += "\nno forces in the joints: " + reactions.reason + '\n';
}

void report_reactions(const Trajectory& trajectory, Printout& out) {
  Json& json = out.json["summary"]["reactions"];
  for (const TrajectoryPoint& point : trajectory.points)
    if (const std::string& reason = point.reactions->reason; !reason.empty()) {
      out.text += "\nforces in the joints are undefined" + sample_location(trajectory, point) + ": " + reason + '\n';
      return;
    }
  std::vector<Row> rows = {{"", "on", "peak force", "at", "RMS force", "peak moment", "at", "RMS moment"}};
  for (const ReactionLoads& joint : reaction_loads(trajectory)) {
    Row& row = rows.emplace_back(Row{joint.name, joint.on});
    Json& loads = json[joint.name] = {{"on", joint.on}};
    add_load("force", joint.force, trajectory, row, loads);
    add_load("couple", joint.couple, trajectory, row, loads);
  }
  out.add_table("magnitudes of the forces (N) and moments (N m) in the joints", rows);
}

void report_rods(const Target& target, const std::string& mode, const Pose<double>& pose, const Reactions& reactions,
                 Printout& out) {
  const std::vector<generic::RodLoad> rods =
      generic::rod_loads(*target.mechanism, target.parameters, mode, pose, reactions);
  if (rods.empty()) return;
  std::vector<Row> rows = {{"", "axial force", "stress", "buckling force", "reserve"}};
  Json& json = out.json["rods"] = Json::object();
  for (const generic::RodLoad& rod : rods) {
    const std::optional<double> axial = rod.ends ? std::optional(rod.axial()) : std::nullopt;
    const std::optional<double> stress = axial ? std::optional(*axial / rod.area) : std::nullopt,
                                reserve = rod.reserve();
    rows.push_back({rod.name, axial ? number(*axial, "N") : "undetermined", stress ? number(*stress, "Pa") : "",
                    number(rod.buckling_force, "N"), reserve ? number(*reserve) : ""});
    json[rod.name] = {{"axial_force", json_or_null(axial)},
                      {"stress", json_or_null(stress)},
                      {"buckling_force", rod.buckling_force},
                      {"buckling_reserve", json_or_null(reserve)}};
  }
  out.add_table("rods: axial force (> 0: tension), stress, and reserve against buckling with pinned ends", rows);
}

void report_rods(const Target& target, const std::string& mode, const Trajectory& trajectory, Printout& out) {
  if (std::ranges::any_of(trajectory.points, [](const auto& point) { return !point.reactions->reason.empty(); }))
    return;
  const std::vector<generic::PeakRodLoad> rods =
      generic::peak_rod_loads(*target.mechanism, target.parameters, mode, trajectory);
  if (rods.empty()) return;
  std::vector<Row> rows = {
      {"", "peak tension", "peak compression", "peak stress", "buckling force", "min. reserve", "at"}};
  Json& json = out.json["summary"]["rods"] = Json::object();
  for (const generic::PeakRodLoad& rod : rods) {
    const auto known = [&rod](double value) { return rod.is_determined ? Json(value) : Json(); };
    const std::optional<double> reserve = rod.is_determined ? rod.reserve : std::nullopt;
    const std::optional<double> time =
        reserve ? std::optional(trajectory.points[rod.critical].motion.time) : std::nullopt;
    json[rod.name] = {{"peak_tension", known(rod.tension)},
                      {"peak_compression", known(rod.compression)},
                      {"peak_stress", known(rod.stress)},
                      {"buckling_force", rod.buckling_force},
                      {"least_buckling_reserve", json_or_null(reserve)},
                      {"least_buckling_reserve_time", json_or_null(time)}};
    Row& row = rows.emplace_back(Row{rod.name});
    for (const double force : {rod.tension, rod.compression})
      row.push_back(rod.is_determined ? number(force, "N") : "undetermined");
    row.push_back(rod.is_determined ? number(rod.stress, "Pa") : "");
    row.push_back(number(rod.buckling_force, "N"));
    row.push_back(reserve ? number(*reserve) : "");
    row.push_back(time ? number(*time, "s") : "");
  }
  out.add_table("rods: axial forces, stress, and reserve against buckling with pinned ends", rows);
}

}  // namespace pkm
