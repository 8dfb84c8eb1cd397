#include "experiments/app/joint_forces.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "experiments/app/motion_samples.hpp"

namespace pkm {
namespace {

/// A vector whose undetermined components are null.
Json components_json(const std::array<std::optional<double>, 3>& components) {
  return list_json(components, json_or_null<double>);
}

/// Adds the magnitude of a force or couple along a motion: three cells to the joint's row, four keys to its JSON.
void add_load(const std::string& key, const LoadSummary& load, const Trajectory& trajectory, Row& row, Json& json) {
  std::vector<std::string> undetermined;  // components
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
  command.add_flag("--reactions", arguments.reactions, "Also compute the forces and couples in all joints");
  add_option(command, "--joint NAME", arguments.joint,
             "Only the forces in this joint, named as by --reactions (repeatable)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void expect_reactions(const Mechanism& mechanism, const ReactionArguments& arguments) {
  if (!arguments.any() || mechanism.reactions()) return;
  const std::string why = mechanism.why_no_reactions();
  throw ConfigError({"", 0, arguments.reactions ? "--reactions" : "--joint"},
                    "mechanism " + mechanism.info().name + " has no model of the forces in its joints" +
                        (why.empty() ? "" : ": " + why));
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
    out.add_table("forces (N) and couples (N m) in the joints: " + std::to_string(reactions.equations) +
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
      out.text +=
          "\nno forces in the joints: they do not exist" + sample_location(trajectory, point) + ": " + reason + '\n';
      return;
    }
  std::vector<Row> rows = {{"", "on", "peak force", "at", "RMS force", "peak couple", "at", "RMS couple"}};
  for (const ReactionLoads& joint : reaction_loads(trajectory)) {
    Row& row = rows.emplace_back(Row{joint.name, joint.on});
    Json& loads = json[joint.name] = {{"on", joint.on}};
    add_load("force", joint.force, trajectory, row, loads);
    add_load("couple", joint.couple, trajectory, row, loads);
  }
  out.add_table("magnitudes of the forces (N) and couples (N m) in the joints", rows);
}

}  // namespace pkm
