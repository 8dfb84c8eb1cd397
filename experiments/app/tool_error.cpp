#include "experiments/app/tool_error.hpp"

#include <algorithm>
#include <array>
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

/// The twist of a mechanism that does not state it: its lengths are the translation, the rotation is unknown.
AxisMatrix<double> translation_of(const MechanismInfo& info) {
  auto T = AxisMatrix<double>::zero(6, info.coordinates.size());
  for (std::size_t j = 0, row = 0; j < info.coordinates.size() && row < 3; ++j)
    if (!info.coordinates[j].turns()) T(row++, j) = 1;
  return T;
}

/// The longest translation and rotation of the twists E e over a box of errors e. Norms are convex, so that their
/// maxima are at corners of the box.
std::array<double, 2> longest_of_twist(const AxisMatrix<double>& E, const std::vector<double>& errors) {
  std::array<double, 2> longest{};
  for (unsigned corner = 0; corner < 1U << errors.size(); ++corner) {
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < E.rows(); ++i) {
      double component = 0;
      for (std::size_t j = 0; j < errors.size(); ++j) component += (corner >> j & 1 ? 1 : -1) * E(i, j) * errors[j];
      squares[i / 3] += component * component;
    }
    for (std::size_t part = 0; part < 2; ++part) longest[part] = std::max(longest[part], std::sqrt(squares[part]));
  }
  return longest;
}

}  // namespace

void tell_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                     const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists, Printout& out) {
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
  const auto [translation, rotation] = longest_of_twist((T ? *T : translation_of(info)) * of_joints, errors);
  rows.push_back({"translation", with_micrometres(translation)});
  Json told = {{"coordinates", values_by_name(info.coordinates, worst)}, {"translation", translation}};
  if (T && std::ranges::any_of(info.coordinates, &AxisInfo::turns)) {
    told["rotation"] = rotation;
    rows.push_back({"rotation", position(rotation, "rad")});
  }
  out.json["tool_error"] = told;
  out.section("greatest error of the tool, for errors of the joints up to " + axes_text(info.joints, errors), rows);
}

}  // namespace pkm
