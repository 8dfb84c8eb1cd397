#include "experiments/app/tool_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/config/assignments.hpp"
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

/// Map from coordinate rates to the twist for a mechanism that does not provide it: the coordinates that are lengths
/// are taken as the components of the position; the rotation is unknown and set to 0.
AxisMatrix<double> translation_map(const MechanismInfo& info) {
  auto T = AxisMatrix<double>::zero(6, info.coordinates.size());
  for (std::size_t j = 0, row = 0; j < info.coordinates.size() && row < 3; ++j)
    if (!info.coordinates[j].turns()) T(row++, j) = 1;
  return T;
}

/// Maximum norms of the translation and of the rotation of the twists E e over the box |e_i| <= errors[i]. A norm is
/// convex, so its maximum is attained at a vertex of the box.
std::array<double, 2> max_twist(const AxisMatrix<double>& E, const std::vector<double>& errors) {
  std::array<double, 2> max{};
  for (unsigned corner = 0; corner < 1U << errors.size(); ++corner) {
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < E.rows(); ++i) {
      double component = 0;
      for (std::size_t j = 0; j < errors.size(); ++j) component += (corner >> j & 1 ? 1 : -1) * E(i, j) * errors[j];
      squares[i / 3] += component * component;
    }
    for (std::size_t part = 0; part < 2; ++part) max[part] = std::max(max[part], std::sqrt(squares[part]));
  }
  return max;
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
  std::vector<double> worst(errors.size(), 0);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    for (std::size_t j = 0; j < errors.size(); ++j) worst[i] += std::fabs(inverse(i, j)) * errors[j];
    const AxisInfo& axis = info.coordinates[i];
    rows.push_back({axis.name, axis.turns() ? position(worst[i], axis.unit) : with_micrometres(worst[i])});
  }
  const auto [translation, rotation] = max_twist((T ? *T : translation_map(info)) * inverse, errors);
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
