#include "experiments/app/tool_error.hpp"

#include <algorithm>

#include "engine/config/assignments.hpp"
#include "engine/geometry/pose_error.hpp"
#include "engine/geometry/singular.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// Parses --joint-error: one bound for all joints, or bounds by name.
/// @return bounds of all joints [SI], >= 0
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

}  // namespace

void report_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                       const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists,
                       Printout& out) {
  const MechanismInfo& info = target.info();
  const Velocities& velocities =
      require_capability(target.mechanism->velocities(), "--joint-error", "influence coefficients", info);
  if (info.joints.size() != info.coordinates.size())
    throw ConfigError({"", 0, "--joint-error"},
                      "mechanism " + info.name + " does not have as many joints as coordinates");
  const std::vector<double> errors = joint_errors(info, lists);
  out.json["joint_error"] = values_by_name(info.joints, errors);
  out.json["tool_error"] = nullptr;
  const auto influence = velocities.influence(target.parameters, at.pose, mode);
  if (!influence || is_singular(influence->G)) {
    out.text += "\ntool error: undefined, because the pose is singular\n";
    return;
  }
  const AxisMatrix<double> inverse = reversed(*influence).G;  // maps joint errors to coordinate errors
  const auto with_micrometres = [](double error) {
    return number(error, "m") + " (" + formatted("%.6g", 1e6 * error) + " um)";
  };
  std::vector<Row> rows;
  const std::vector<double> worst = max_components(inverse, errors);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const AxisInfo& axis = info.coordinates[i];
    rows.push_back({axis.name, axis.turns() ? position(worst[i], axis.unit) : with_micrometres(worst[i])});
  }
  const auto [translation, rotation] = max_twist((T ? *T : translation_map(info.coordinates)) * inverse, errors);
  rows.push_back({"translation", with_micrometres(translation)});
  Json json = {{"coordinates", values_by_name(info.coordinates, worst)}, {"translation", translation}};
  if (T && std::ranges::any_of(info.coordinates, &AxisInfo::turns)) {
    json["rotation"] = rotation;
    rows.push_back({"rotation", position(rotation, "rad")});
  }
  out.json["tool_error"] = json;
  out.add_table("maximum tool error, for joint errors up to " + axes_text(info.joints, errors), rows);
}

}  // namespace pkm
