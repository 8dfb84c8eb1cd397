#include "experiments/app/tool_error.hpp"

#include <cmath>

#include "engine/model/singular.hpp"
#include "engine/setup/assignments.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

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

}  // namespace

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

}  // namespace pkm
