#include "experiments/app/grid.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/setup/assignments.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t usual) {
  add_option(command, "--box NAME=FROM:TO", arguments.box,
             "Ranges of the swept coordinates; default: all that the design reaches")
      ->allow_extra_args(false);
  add_cells_option(command, arguments.cells,
                   "Cells along each of them; default: the study's, else " + std::to_string(usual));
}

VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells) {
  VoxelOptions voxels;
  std::fill_n(voxels.cells.begin(), sweep.swept.size(), cells);
  return voxels;
}

void set_grid(SurveyPlan& plan, const MechanismInfo& info, const GridArguments& arguments, std::int64_t usual,
              double most) {
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Assignable> swept;
  for (const int coordinate : sweep.swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    swept.push_back({axis.name, axis.unit});
  }
  VoxelOptions voxels = equal_cells(sweep, usual);
  voxels.box = plan.box();
  if (plan.voxels()) voxels = *plan.voxels();
  if (!arguments.box.empty()) {
    const auto ranges = parse_ranges(arguments.box, "--box", swept);
    voxels.box.emplace().fill({0, 1});
    std::ranges::copy(ranges, voxels.box->begin());
  }
  if (!arguments.cells.empty()) {
    const auto cells = parse_cells(arguments.cells, names_of(swept));
    std::ranges::copy(cells, voxels.cells.begin());
  }
  double all = 1;
  for (const std::int64_t cells : voxels.cells) all *= static_cast<double>(cells);
  if (all > most) throw ConfigError({"", 0, "--cells"}, shortest(all) + " cells", "at most " + shortest(most));
  plan.method = voxels;
}

}  // namespace pkm
