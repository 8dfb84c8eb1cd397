#include "experiments/app/coordinate_ranges.hpp"

#include <numbers>

#include "engine/config/assignments.hpp"
#include "engine/math/roots.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// The home pose from which ranges are measured. Coordinates that --home does not give are 0. Without --home, it is a
/// pose in the middle of the workspace.
Pose<double> home_pose(const std::vector<std::string>& given, const Target& target, const std::string& mode) {
  const MechanismInfo& info = target.info();
  const SourceLocation place{"", 0, "--home"};
  if (given.empty()) {
    const auto pose = central_pose(*target.mechanism, target.parameters, target.limits, mode);
    if (!pose) throw ConfigError({"", 0, "--ranges"}, "no feasible pose was found", "--home with a feasible pose");
    return *pose;
  }
  const Pose<double> pose = axis_vector(parse_some_assignments(given, "--home", assignable_axes(info.coordinates)));
  if (const PoseReport report = target.mechanism->inspect(target.parameters, pose, mode, target.limits);
      !report.feasible)
    throw ConfigError(place, "an infeasible pose: " + report.reason, "a feasible one");
  return pose;
}

/// An end of the feasible range of a coordinate: the last feasible value, and the constraint that is violated beyond
/// it.
struct RangeEnd {
  double value = 0;
  std::string constraint;
};

/// Searches for the end of the feasible range of a coordinate.
/// @param limit  value of the coordinate at which the search ends
RangeEnd end_of_range(const Target& target, const std::string& mode, Pose<double> pose, std::size_t coordinate,
                      double limit) {
  constexpr int kSteps = 512;  // number of steps of the search; shorter infeasible intervals can be missed
  const double home = pose[coordinate];
  const auto inspect = [&](double value) {
    pose[coordinate] = value;
    return target.mechanism->inspect(target.parameters, pose, mode, target.limits);
  };
  double inside = home;
  for (int k = 1; k <= kSteps; ++k) {
    const double value = std::lerp(home, limit, static_cast<double>(k) / kSteps);
    if (inspect(value).feasible) {
      inside = value;
      continue;
    }
    const auto is_feasible = [&](double at) -> std::optional<bool> { return inspect(at).feasible; };
    const Bracket end = bisect(is_feasible, {.with = inside, .without = value}, 0);
    return {end.with, inspect(end.without).reason};
  }
  return {limit, "feasible up to the end of the search"};
}

}  // namespace

void report_ranges(const std::vector<std::string>& home_given, const Target& target, const std::string& mode,
                   Printout& out) {
  const MechanismInfo& info = target.info();
  const Pose<double> home = home_pose(home_given, target, mode);
  const auto searched = target.mechanism->ranges(target.parameters);
  out.json["home"] = axes_json(info.coordinates, home);
  out.json["ranges"] = Json::object();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < info.coordinates.size(); ++i) {
    const AxisInfo& axis = info.coordinates[i];
    std::array<double, 2> limits = {home[i] - std::numbers::pi, home[i] + std::numbers::pi};
    if (!axis.turns()) {
      if (!searched)
        throw ConfigError({"", 0, "--ranges"}, "mechanism " + info.name + " does not define the range to be searched");
      limits = {std::min((*searched)[i][0], home[i]), std::max((*searched)[i][1], home[i])};
    }
    const RangeEnd lower = end_of_range(target, mode, home, i, limits[0]),
                   upper = end_of_range(target, mode, home, i, limits[1]);
    out.json["ranges"][axis.name] = {{"unit", axis.unit},
                                     {"lower", lower.value},
                                     {"upper", upper.value},
                                     {"below", lower.constraint},
                                     {"above", upper.constraint}};
    rows.push_back({axis.name, range_text(lower.value, upper.value, axis.unit), "below: " + lower.constraint,
                    "above: " + upper.constraint});
  }
  out.add_table("range of each coordinate alone, from " + axes_text(info.coordinates, home), rows);
}

}  // namespace pkm
