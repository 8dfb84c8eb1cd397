#include "engine/results/task_workspace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/team.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

/// The value of a coordinate that the comparison does not sweep: its value in the first region of the task or, if there
/// is none, in the first motion, otherwise the default value of the design. Throws std::invalid_argument if there is
/// none.
double value_outside_axes(const TaskEvaluation& evaluation, const ComparedRobot& robot, int coordinate) {
  const ProblemParts& parts = evaluation.study.problem->parts();
  for (const Region& region : parts.regions)
    if (std::ranges::find(region.plan.fixed, coordinate, &FixedCoordinate::coordinate) != region.plan.fixed.end())
      return fixed_value(*robot.mechanism, robot.parameters, region.plan, coordinate);
  if (!evaluation.study.motions.empty())
    return evaluation.study.motions.front().at(robot.parameters)->at(0).pose[static_cast<std::size_t>(coordinate)];
  return fixed_value(*robot.mechanism, robot.parameters, parts.plan, coordinate);
}

}  // namespace

int coordinate_index(const MechanismInfo& info, const std::string& name) {
  const AxisInfo* const found = find_named(info.coordinates, name);
  return found ? static_cast<int>(found - info.coordinates.data()) : -1;
}

// The workspace is analysed twice: the cells of the first analysis find its extent, and those of the second analysis
// divide this extent.
std::optional<WorkspaceFields> workspace_over(const std::vector<AxisInfo>& axes, const TaskEvaluation& evaluation,
                                              const ComparedRobot& robot, std::int64_t cells) {
  const MechanismInfo& info = robot.mechanism->info();
  WorkspacePlan plan;
  VoxelOptions voxels;
  for (const AxisInfo& axis : axes)
    if (const int coordinate = coordinate_index(info, axis.name); coordinate >= 0) plan.swept.push_back(coordinate);
  if (plan.swept.empty()) throw std::invalid_argument("the robot has none of the coordinates " + join(names_of(axes)));
  for (int i = 0; i < std::ssize(info.coordinates); ++i)
    if (!contains(plan.swept, i))
      plan.fixed.push_back({i, FixedCoordinate::Kind::value, value_outside_axes(evaluation, robot, i)});
  plan.limits = robot.limits;
  std::fill_n(voxels.cells.begin(), plan.swept.size(), cells);
  plan.method = voxels;
  const Sweep& sweep = sweep_of(info, plan);
  VoxelMap map;
  for (const int pass : {1, 2}) {
    map = voxel_map(*robot.mechanism, robot.parameters, plan);
    const VoxelGrid grid(map);
    std::array<std::array<std::int64_t, 2>, 3> extent;
    extent.fill({std::numeric_limits<std::int64_t>::max(), -1});
    Cell cell;
    for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
      for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
        for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2])
          for (std::size_t i = 0; map.feasible[grid.index(cell)] && i < 3; ++i)
            extent[i] = {std::min(extent[i][0], cell[i]), std::max(extent[i][1], cell[i])};
    if (extent[0][1] < 0) return {};
    if (pass == 2) break;
    Box box;
    for (std::size_t i = 0; i < 3; ++i)
      box[i] = {std::fmax(grid.lower[i], grid.centre(i, extent[i][0]) - 1.5 * grid.step[i]),
                std::fmin(grid.upper[i], grid.centre(i, extent[i][1]) + 1.5 * grid.step[i])};
    voxels.box = box;
    plan.method = voxels;
  }

  WorkspaceFields found;
  found.mechanism = info.name;
  const auto axis_at = [&](int coordinate, double lower, double upper, std::int64_t count) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    return WorkspaceAxis{coordinate, axis.name, axis.unit, lower, upper, count};
  };
  for (std::size_t i = 0; i < sweep.swept.size(); ++i)
    found.axes.push_back(axis_at(sweep.swept[i], map.lower[i], map.upper[i], map.cells[i]));
  for (const FixedCoordinate& fixed : plan.fixed) {
    found.fixed.push_back(axis_at(fixed.coordinate, fixed.value, fixed.value, 0));
    found.fixed_note.emplace_back("of the task");
  }
  const VoxelGrid grid = found.grid();
  found.fields.push_back({"feasible", "1", "", {map.feasible.begin(), map.feasible.end()}});
  found.fields.push_back({"margin", "mixed", "", std::vector<double>(map.feasible.size())});
  found.volume = static_cast<double>(std::ranges::count(map.feasible, 1)) * grid.cell_volume();
  found.volume_unit = volume_unit(info, plan);
  const PoseMargin margin_at(*robot.mechanism, robot.parameters, robot.limits);
  std::vector<double>& margin = found.fields.back().values;
  std::vector<Scratch> scratch(workers());
  parallel_for(margin.size(), [&](std::size_t cell, std::size_t end, std::size_t worker) {
    for (; cell < end; ++cell) {
      const double value = margin_at(found.pose(cell), scratch[worker]), magnitude = std::fabs(value);
      margin[cell] = (map.feasible[cell] ? 1 : -1) * (std::isfinite(value) ? std::fmax(magnitude, 1e-12) : 1);
    }
  });
  return found;
}

std::vector<TaskValue> workspace_values(const std::vector<AxisInfo>& axes,
                                        const std::set<std::size_t, std::greater<>>& counts,
                                        const ComparedRobot& robot) {
  const auto& workspace = robot.workspace;
  const std::size_t swept = workspace ? workspace->axes.size() : 0;
  std::vector<TaskValue> lines;
  const auto add = [&](const std::string& name) -> TaskValue& {
    return lines.emplace_back(TaskValue{.group = "", .name = "workspace: " + name, .reason = robot.why_no_workspace});
  };
  const char* const measures[] = {"length", "area", "volume"};
  for (const std::size_t count : counts) {  // volumes are listed before areas
    TaskValue& line = add(measures[count - 1]);
    if (swept == count) {
      line.value = workspace->volume;
      line.unit = workspace->volume_unit;
    } else if (workspace) {
      line.reason = "the workspace extends over " + join(names_of(workspace->axes));
    }
  }
  const auto extents = workspace ? feasible_extents(*workspace) : std::nullopt;
  for (const AxisInfo& axis : axes) {
    TaskValue& line = add("size along " + axis.name);
    line.unit = axis.unit;
    if (!workspace) continue;
    line.reason = "the robot has no coordinate " + axis.name;
    for (std::size_t k = 0; k < swept; ++k)
      if (workspace->axes[k].name == axis.name) {
        line.value = (*extents)[k][1] - (*extents)[k][0];
        line.reason.clear();
      }
  }
  return lines;
}

std::string limiting_margin(const ComparedRobot& robot, const std::vector<Pose<double>>& poses) {
  double least = std::numeric_limits<double>::infinity();
  std::string name;
  for (const Pose<double>& pose : poses) {
    const PoseReport report =
        robot.mechanism->inspect(robot.parameters, pose, robot.mechanism->info().modes.front(), robot.limits);
    if (!report.assembles) return "cannot be assembled";
    for (const auto& [margin, value] : report.margins)
      if (value < least) {
        least = value;
        name = margin;
      }
  }
  return name;
}

// The scale factor of the box is increased in steps until a pose becomes infeasible, and then bisected.
TaskValue largest_scale(const Region& region, const ComparedRobot& robot, const std::vector<Pose<double>>& poses) {
  constexpr double kFirst = 0.05, kStep = 1.1, kLargest = 50;
  TaskValue line{.group = region.name, .name = region.name + ": scale", .unit = "1"};
  const PoseMargin margin(*robot.mechanism, robot.parameters, robot.limits);
  const std::vector<int>& swept = sweep_of(robot.mechanism->info(), region.plan).swept;
  Scratch scratch;
  const auto is_feasible = [&](double scale) {
    return std::ranges::all_of(poses, [&](Pose<double> pose) {
      for (std::size_t i = 0; i < swept.size(); ++i) {
        const auto& [lower, upper] = (*region.plan.box())[i];
        double& value = pose[static_cast<std::size_t>(swept[i])];
        value = (lower + upper) / 2 + scale * (value - (lower + upper) / 2);
      }
      return margin(pose, scratch) >= 0;
    });
  };
  if (!is_feasible(0)) {
    line.value = 0;
    return line;
  }
  double feasible = 0, tried = kFirst;
  for (; is_feasible(tried); tried *= kStep) {
    feasible = tried;
    if (tried > kLargest) {
      line.reason = "the robot has no limits that bound the box";
      return line;
    }
  }
  for (int bisections = 0; bisections < 30; ++bisections) {
    const double between = (feasible + tried) / 2;
    (is_feasible(between) ? feasible : tried) = between;
  }
  line.value = feasible;
  return line;
}

}  // namespace pkm
