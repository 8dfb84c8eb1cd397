#include "experiments/app/grid.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {

void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t default_cells) {
  add_option(command, "--box NAME=FROM:TO", arguments.box,
             "Ranges of swept coordinates (default: the study's, else all reachable poses)")
      ->allow_extra_args(false);
  add_cells_option(command, arguments.cells,
                   "Cells along each axis (default: the study's, else " + std::to_string(default_cells) + ")");
}

VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells) {
  VoxelOptions voxels;
  std::fill_n(voxels.cells.begin(), sweep.swept.size(), cells);
  return voxels;
}

Box reachable_box(const WorkspacePlan& plan, const Target& target) {
  WorkspacePlan unbounded = plan;
  unbounded.method = VoxelOptions{};
  unbounded.home.reset();
  Box box;
  box.fill({0, 1});
  try {
    const VoxelMap map = voxel_map(*target.mechanism, target.parameters, unbounded);
    for (std::size_t i = 0; i < sweep_of(target.info(), plan).swept.size(); ++i) box[i] = {map.lower[i], map.upper[i]};
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
  return box;
}

std::vector<Assignable> assignable_coordinates(const MechanismInfo& info, const Sweep& sweep) {
  std::vector<Assignable> swept;
  for (const int coordinate : sweep.swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    swept.push_back({axis.name, axis.unit});
  }
  return swept;
}

std::array<double, 3> parse_home(const std::vector<std::string>& lists, const MechanismInfo& info, const Sweep& sweep) {
  std::array<double, 3> home{};
  std::ranges::copy(parse_all_assignments(lists, "--home", assignable_coordinates(info, sweep)), home.begin());
  return home;
}

std::array<bool, 3> set_grid(WorkspacePlan& plan, const Target& target, const GridArguments& arguments,
                             std::int64_t default_cells, double max_cells, const Slices& sliced) {
  const MechanismInfo& info = target.info();
  const Sweep& sweep = sweep_of(info, plan);
  const std::vector<Assignable> swept = assignable_coordinates(info, sweep);
  VoxelOptions voxels = equal_cells(sweep, default_cells);
  voxels.box = plan.box();
  if (plan.voxels()) voxels = *plan.voxels();
  std::array<bool, 3> given;
  given.fill(voxels.box.has_value());
  if (!arguments.box.empty()) {
    const auto ranges = parse_some_ranges(arguments.box, "--box", swept);
    if (!voxels.box) voxels.box = reachable_box(plan, target);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (ranges[i]) (*voxels.box)[i] = *ranges[i];
      given[i] = given[i] || ranges[i];
    }
  }
  std::vector<std::size_t> axes;  // indices of the axes that are not sliced
  std::vector<std::string> names;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    voxels.cells[i] = sliced.contains(sweep.swept[i]) ? 1 : voxels.cells[i];
    if (sliced.contains(sweep.swept[i])) continue;
    axes.push_back(i);
    names.push_back(swept[i].name);
  }
  if (!arguments.cells.empty()) {
    for (const auto& [coordinate, value] : sliced)
      if (const std::string& name = info.coordinates[static_cast<std::size_t>(coordinate)].name;
          contains(assigned_names(arguments.cells), name))
        throw ConfigError({"", 0, "--cells"}, "cells of " + name + ", at which the workspace is cut",
                          "cells of " + join(names));
    const auto cells = parse_cells(arguments.cells, names);
    for (std::size_t k = 0; k < axes.size(); ++k) voxels.cells[axes[k]] = cells[k];
  }
  double total = 1;
  for (const std::int64_t cells : voxels.cells) total *= static_cast<double>(cells);
  if (total > max_cells)
    throw ConfigError({"", 0, "--cells"}, shortest(total) + " cells", "at most " + shortest(max_cells));
  plan.method = voxels;
  return given;
}

std::vector<std::array<double, 2>> parse_pose_box(const Target& target, const WorkspacePlan& plan,
                                                  const std::vector<std::string>& box) {
  const MechanismInfo& info = target.info();
  const Sweep& sweep = sweep_of(info, plan);
  const std::vector<Assignable> swept = assignable_coordinates(info, sweep);
  const auto given = parse_ranges(box, "--box", swept);
  std::vector<std::array<double, 2>> ranges(info.coordinates.size());
  for (std::size_t i = 0; i < swept.size(); ++i) ranges[static_cast<std::size_t>(sweep.swept[i])] = given[i];
  for (const int coordinate : sweep.fixed)
    ranges[static_cast<std::size_t>(coordinate)].fill(
        fixed_value(*target.mechanism, target.parameters, plan, coordinate));
  return ranges;
}

}  // namespace pkm
