#include "experiments/app/grid.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {

void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t usual) {
  add_option(command, "--box NAME=FROM:TO", arguments.box,
             "Ranges of swept coordinates; default: the study's, else all that the design reaches")
      ->allow_extra_args(false);
  add_cells_option(command, arguments.cells,
                   "Cells along each of them; default: the study's, else " + std::to_string(usual));
}

VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells) {
  VoxelOptions voxels;
  std::fill_n(voxels.cells.begin(), sweep.swept.size(), cells);
  return voxels;
}

Box reached_box(const SurveyPlan& plan, const Target& target) {
  SurveyPlan anywhere = plan;
  anywhere.method = VoxelOptions{};
  Box box;
  box.fill({0, 1});
  try {
    const VoxelMap map = voxel_map(*target.mechanism, target.parameters, anywhere);
    for (std::size_t i = 0; i < sweep_of(target.info(), plan).swept.size(); ++i) box[i] = {map.lower[i], map.upper[i]};
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
  return box;
}

std::array<bool, 3> set_grid(SurveyPlan& plan, const Target& target, const GridArguments& arguments, std::int64_t usual,
                             double most) {
  const MechanismInfo& info = target.info();
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Assignable> swept;
  for (const int coordinate : sweep.swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    swept.push_back({axis.name, axis.unit});
  }
  VoxelOptions voxels = equal_cells(sweep, usual);
  voxels.box = plan.box();
  if (plan.voxels()) voxels = *plan.voxels();
  std::array<bool, 3> given;
  given.fill(voxels.box.has_value());
  if (!arguments.box.empty()) {
    const auto ranges = parse_some_ranges(arguments.box, "--box", swept);
    if (!voxels.box) voxels.box = reached_box(plan, target);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (ranges[i]) (*voxels.box)[i] = *ranges[i];
      given[i] = given[i] || ranges[i];
    }
  }
  if (!arguments.cells.empty()) {
    const auto cells = parse_cells(arguments.cells, names_of(swept));
    std::ranges::copy(cells, voxels.cells.begin());
  }
  double all = 1;
  for (const std::int64_t cells : voxels.cells) all *= static_cast<double>(cells);
  if (all > most) throw ConfigError({"", 0, "--cells"}, shortest(all) + " cells", "at most " + shortest(most));
  plan.method = voxels;
  return given;
}

}  // namespace pkm
