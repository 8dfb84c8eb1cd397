#include "experiments/app/component_list.hpp"

#include <limits>
#include <stdexcept>

#include "engine/workspace/components.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

constexpr double kMinShare = 1e-3;  ///< minimum share of the feasible cells for a component to be listed in the text

/// Number of components that are large enough to be listed in the text.
std::size_t large_ones(const ConnectedComponents& components, double feasible) {
  return static_cast<std::size_t>(std::ranges::count_if(components.all, [&](const WorkspaceComponent& component) {
    return static_cast<double>(component.cells) >= kMinShare * feasible;
  }));
}

using Extents = std::vector<std::array<double, 2>>;

/// For each component, the range of its cells along each axis.
std::vector<Extents> extents_of(const ConnectedComponents& components, const VoxelGrid& grid, std::size_t axes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Extents> all(components.all.size(), Extents(axes, {kInfinity, -kInfinity}));
  Cell cell{};
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        const std::uint32_t label = components.label[grid.index(cell)];
        if (label == 0) continue;
        for (std::size_t axis = 0; axis < axes; ++axis) {
          auto& [lower, upper] = all[label - 1][axis];
          lower = std::min(lower, grid.lower[axis] + static_cast<double>(cell[axis]) * grid.step[axis]);
          upper = std::max(upper, grid.lower[axis] + static_cast<double>(cell[axis] + 1) * grid.step[axis]);
        }
      }
  return all;
}

}  // namespace

void report_components(const Target& target, const WorkspacePlan& plan, Printout& out) {
  const MechanismInfo& info = target.info();
  WorkspacePlan all = visualisation_plan(info, plan, {1, 1, 1});
  all.home.reset();
  out.json["components"] = nullptr;
  // If there are fewer joints than coordinates, every pose is singular, so that there are no components.
  if (info.joints.size() < info.coordinates.size()) return;
  Axes axes;
  for (const int coordinate : sweep_of(info, all).swept)
    axes.push_back(info.coordinates[static_cast<std::size_t>(coordinate)]);
  const VoxelMap map = voxel_map(*target.mechanism, target.parameters, all);
  const VoxelGrid grid(map);
  Scratch scratch;
  const ComponentFinder finder(*target.mechanism, all, "");
  const ConnectedComponents found = finder.find(target.parameters, map, scratch);
  const std::uint32_t home =
      plan.home ? finder.holding(target.parameters, map, found, *plan.home, "the home pose", scratch) : 0;
  const auto feasible = static_cast<double>(std::ranges::count(map.feasible, 1));
  const std::string unit = volume_unit(info, all);
  const std::vector<Extents> extents = extents_of(found, grid, axes.size());

  std::vector<Row> rows;
  double others = 0;
  out.json["components"] = Json::array();
  for (std::size_t k = 0; k < found.all.size(); ++k) {
    const WorkspaceComponent& component = found.all[k];
    const double share = static_cast<double>(component.cells) / feasible,
                 volume = static_cast<double>(component.cells) * grid.cell_volume();
    const bool holds_home = k + 1 == home;
    Json json = {{"cells", component.cells}, {"share", share},     {"volume", volume},
                 {"sign", component.side},   {"home", holds_home}, {"extents", Json::object()}};
    Row row = {std::to_string(k + 1), digits(100 * share) + " %",
               number(volume, unit, known_digits_of_voxels(component.cells, axes.size()))};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const auto& [lower, upper] = extents[k][axis];
      json["extents"][axes[axis].name] = extents[k][axis];
      row.push_back(axes[axis].name + " = " + range_text(lower, upper, axes[axis].unit));
    }
    if (holds_home) row.push_back("holds the home pose");
    out.json["components"].push_back(std::move(json));
    if (share >= kMinShare || holds_home)
      rows.push_back(std::move(row));
    else
      others += share;
  }
  const std::size_t large = large_ones(found, feasible);
  if (large < 2 && !plan.home) return;
  const ConnectedComponents across =
      ComponentFinder(*target.mechanism, all, "", Crossing::allowed).find(target.parameters, map, scratch);
  out.json["components_across_singularities"] = across.all.size();
  out.head.push_back({"components", std::to_string(large) + " without crossing a singularity, " +
                                        std::to_string(large_ones(across, feasible)) +
                                        " if singularities could be crossed"});
  if (rows.size() < found.all.size())
    rows.push_back({"others", digits(100 * others) + " %",
                    "in " + std::to_string(found.all.size() - rows.size()) + " components of less than 0.1 % each"});
  out.add_table("components of the workspace (share, size, extent)", rows);
}

}  // namespace pkm
