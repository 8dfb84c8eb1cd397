#include "experiments/app/grid.hpp"

#include <CLI/CLI.hpp>

#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/setup/assignments.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t usual) {
  command.add_option("--box", arguments.box, "Ranges of the swept coordinates; default: all that the design reaches")
      ->type_name("NAME=FROM:TO")
      ->allow_extra_args(false);
  add_list_option(command, "--cells", arguments.cells,
                  "Cells along each of them; default: the study's, else " + std::to_string(usual), false);
}

void set_grid(SurveyPlan& plan, const MechanismInfo& info, const GridArguments& arguments, std::int64_t usual,
              double most) {
  std::vector<Assignable> swept, numbers;
  for (const int coordinate : sweep_of(info, plan).swept) {
    const auto index = static_cast<std::size_t>(coordinate);
    swept.push_back({info.coordinates[index], coordinate == 3 ? "rad" : "m"});
    numbers.push_back({info.coordinates[index], "1", 1, 1e6});
  }
  if (!arguments.box.empty()) {
    const auto ranges = parse_ranges(arguments.box, "--box", swept);
    plan.box = {{ranges[0], ranges[1], ranges[2]}};
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (plan.cells[k] == 0) plan.cells[k] = usual;
  if (!arguments.cells.empty()) {
    const auto cells = parse_all_assignments(arguments.cells, "--cells", numbers);
    for (std::size_t k = 0; k < 3; ++k) {
      plan.cells[k] = static_cast<std::int64_t>(cells[k]);
      if (static_cast<double>(plan.cells[k]) != cells[k])
        throw ConfigError({"", 0, "--cells"}, numbers[k].name + "=" + shortest(cells[k]), "a whole number of cells");
    }
  }
  const double all =
      static_cast<double>(plan.cells[0]) * static_cast<double>(plan.cells[1]) * static_cast<double>(plan.cells[2]);
  if (all > most) throw ConfigError({"", 0, "--cells"}, shortest(all) + " cells", "at most " + shortest(most));
}

}  // namespace pkm
