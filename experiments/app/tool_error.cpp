#include "experiments/app/tool_error.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/study_additions.hpp"
#include "engine/geometry/pose_error.hpp"
#include "engine/geometry/singular.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// The matrix (J^T J)^-1 J^T, which maps errors of the joints to those of the coordinates by least squares if there are
/// more joints than coordinates.
AxisMatrix<double> pseudo_inverse(const AxisMatrix<double>& J) { return solve(transpose(J) * J, transpose(J)); }

/// The pose with these joint coordinates, by Newton's method, or, if there are more joints than coordinates, the pose
/// that fits them best, by the Gauss-Newton method; std::nullopt if it does not converge.
std::optional<Pose<double>> pose_of_joints(const Target& target, const std::string& mode, const Pose<double>& near,
                                           const AxisVector<double>& joints) {
  return refine_pose(near, [&](const Pose<double>& pose) -> std::optional<AxisVector<double>> {
    const PoseReport report = target.mechanism->inspect(target.parameters, pose, mode, target.limits);
    if (!report.assembles || !report.J || is_rank_deficient(*report.J)) return {};
    const AxisVector<double> rest = joints - *report.joints;
    if (report.J->rows() == report.J->cols()) return solve(*report.J, rest);
    return pseudo_inverse(*report.J) * rest;
  });
}

/// The largest errors of each coordinate and of the position over all vertices of the box of joint errors; std::nullopt
/// if the pose of a vertex was not found.
std::optional<std::vector<double>> worst_corner(const Target& target, const std::string& mode, const Pose<double>& pose,
                                                const AxisMatrix<double>& inverse, const std::vector<double>& errors) {
  const MechanismInfo& info = target.info();
  const PoseReport at = target.mechanism->inspect(target.parameters, pose, mode, target.limits);
  std::vector<double> worst(info.coordinates.size() + 1, 0.0);
  const bool is_complete = visit_vertices(errors, [&](const AxisVector<double>& change) {
    const auto found = pose_of_joints(target, mode, pose + inverse * change, *at.joints + change);
    if (!found) return false;
    double square = 0;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const double error = (*found)[i] - pose[i];
      worst[i] = std::max(worst[i], std::fabs(error));
      if (!info.coordinates[i].turns()) square += error * error;
    }
    worst.back() = std::max(worst.back(), std::sqrt(square));
    return true;
  });
  return is_complete ? std::optional(worst) : std::nullopt;
}

}  // namespace

void report_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                       const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists, bool exact,
                       Printout& out) {
  const MechanismInfo& info = target.info();
  const Velocities& velocities =
      require_capability(target.mechanism->velocities(), "--joint-error", "influence coefficients", info);
  if (info.joints.size() < info.coordinates.size())
    throw ConfigError({"", 0, "--joint-error"},
                      "mechanism " + info.name + " has fewer joints than coordinates, which do not determine its pose");
  const std::vector<double> errors = parse_joint_errors(info, lists);
  out.json["joint_error"] = values_by_name(info.joints, errors);
  out.json["tool_error"] = nullptr;
  const auto influence = velocities.influence(target.parameters, at.pose, mode);
  if (!influence || is_rank_deficient(influence->G)) {
    out.text += "\ntool error: undefined, because the pose is singular\n";
    return;
  }
  const bool redundant = info.joints.size() > info.coordinates.size();
  const AxisMatrix<double> inverse = redundant ? pseudo_inverse(influence->G) : reversed(*influence).G;
  std::vector<Row> rows;
  const std::vector<double> worst = max_components(inverse, errors);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const AxisInfo& axis = info.coordinates[i];
    rows.push_back({axis.name, number(worst[i], axis.unit)});
  }
  const auto [translation, rotation] = max_twist((T ? *T : translation_map(info.coordinates)) * inverse, errors);
  rows.push_back({"translation", number(translation, "m")});
  Json json = {{"coordinates", values_by_name(info.coordinates, worst)}, {"translation", translation}};
  if (T && std::ranges::any_of(info.coordinates, &AxisInfo::turns)) {
    json["rotation"] = rotation;
    rows.push_back({"rotation", number(rotation, "rad")});
  }
  if (exact) {
    const auto corner = worst_corner(target, mode, at.pose, inverse, errors);
    json["worst_corner"] = nullptr;
    if (corner) {
      const std::vector<double> of_coordinates(corner->begin(), corner->end() - 1);
      json["worst_corner"] = {{"coordinates", values_by_name(info.coordinates, of_coordinates)},
                              {"translation", corner->back()}};
      rows.push_back({"translation, exact", number(corner->back(), "m")});
    } else {
      rows.push_back(
          {"translation, exact", "unknown: for one combination of the extreme joint errors no pose was found"});
    }
  }
  out.json["tool_error"] = json;
  out.add_table("maximum first-order tool error, for joint errors up to " + axes_text(info.joints, errors), rows);
}

}  // namespace pkm
