#include "experiments/app/joint_forces.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "experiments/app/motion_samples.hpp"

namespace pkm {
namespace {

Json components_json(const std::array<std::optional<double>, 3>& components) {
  return list_json(components, json_or_null<double>);
}

/// One load of a joint along a motion: three cells of its row, four keys of its JSON.
void tell_load(const std::string& key, const CarriedLoad& load, const Trajectory& trajectory, Row& row, Json& json) {
  std::vector<std::string> without;
  for (std::size_t k = 0; k < 3; ++k)
    if (!load.determined[k]) without.emplace_back(1, "xyz"[k]);
  const bool known = without.size()<3, acts = load.peak> 0;
  const double time = trajectory.points[load.at].motion.time;
  row.push_back(known ? number(load.peak) + (without.empty() ? "" : " without " + join(without)) : "undetermined");
  row.push_back(acts ? number(time, "s") : "");
  row.push_back(known ? number(load.rms) : "");
  json["peak_" + key] = known ? Json(load.peak) : Json();
  json["peak_" + key + "_time"] = acts ? Json(time) : Json();
  json["rms_" + key] = known ? Json(load.rms) : Json();
  json["undetermined_" + key] = without;
}

}  // namespace

void add_reaction_options(CLI::App& command, ReactionArguments& arguments) {
  command.add_flag("--reactions", arguments.reactions, "Also the forces and couples in every joint");
  add_option(command, "--joint NAME", arguments.joint,
             "Those of this joint alone, as --reactions calls it; separated by commas or repeated")
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

void keep_joints(const ReactionArguments& arguments, Reactions& reactions) {
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

void tell_reactions(const Reactions& reactions, Printout& out) {
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
    out.section("forces (N) and couples (N m) in the joints: " + std::to_string(reactions.equations) + " equations, " +
                    std::to_string(reactions.unknowns) + " unknowns, rank " + std::to_string(reactions.rank),
                rows);
  else
    out.text += "\nno forces in the joints: " + reactions.reason + '\n';
}

void tell_reactions(const Trajectory& trajectory, Printout& out) {
  Json& json = out.json["summary"]["reactions"];
  for (const TrajectoryPoint& point : trajectory.points)
    if (const std::string& reason = point.reactions->reason; !reason.empty()) {
      out.text += "\nno forces in the joints: the motion has none" + place_of(trajectory, point) + ": " + reason + '\n';
      return;
    }
  std::vector<Row> rows = {{"", "on", "peak force", "at", "RMS force", "peak couple", "at", "RMS couple"}};
  for (const CarryingJoint& joint : carried_along(trajectory)) {
    Row& row = rows.emplace_back(Row{joint.name, joint.on});
    Json& told = json[joint.name] = {{"on", joint.on}};
    tell_load("force", joint.force, trajectory, row, told);
    tell_load("couple", joint.couple, trajectory, row, told);
  }
  out.section("sizes of the forces (N) and couples (N m) in the joints", rows);
}

}  // namespace pkm
