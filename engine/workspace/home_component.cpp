#include "engine/workspace/home_component.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/workspace/components.hpp"

namespace pkm {
namespace {

/// Removes from a vector all elements whose index is not in `kept`, a list of indices in ascending order.
template <class T>
void keep(const std::vector<std::size_t>& kept, std::vector<T>& values) {
  if (values.empty()) return;
  for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
  values.resize(kept.size());
}

class HomeComponent final : public VoxelEvaluator {
 public:
  HomeComponent(const Mechanism& mechanism, const WorkspacePlan& plan, const FieldRequest& request,
                std::unique_ptr<const VoxelEvaluator> map, std::unique_ptr<const VoxelEvaluator> samples)
      : finder_(mechanism, plan, request.mode),
        sweep_(sweep_of(mechanism.info(), plan)),
        home_(*plan.home),
        poses_(request.poses),
        map_(std::move(map)),
        samples_(std::move(samples)) {}

  VoxelMap map(std::span<const double> parameters) const override {
    Scratch scratch;
    return component(parameters, scratch);
  }

  void evaluate(std::span<const double> parameters, Scratch& scratch, WorkspaceResult<double>& result) const override {
    const VoxelMap cells = component(parameters, scratch);
    const VoxelGrid grid(cells);
    WorkspaceResult<double> counts;
    summarise(grid, cells, counts, sweep_.swept.size());
    if (samples_)
      samples_->evaluate(parameters, scratch, result);
    else
      result.clear();
    result.volume = counts.volume;
    result.cells = counts.cells;
    result.feasible_cells = counts.feasible_cells;
    result.cell_volume = counts.cell_volume;
    result.touches_box = counts.touches_box;
    if (!samples_) return;
    std::vector<std::size_t> kept;
    PKM_EXPECTS(result.pose.size() == result.weight.size());
    for (std::size_t i = 0; i < result.pose.size(); ++i)
      if (cells.feasible[cell_of(result.pose[i], grid)] != 0) kept.push_back(i);
    keep(kept, result.weight);
    keep(kept, result.pose);
    for (auto& [quantity, field] : result.fields)
      for (auto& values : field) keep(kept, values);
    if (!poses_) result.pose.clear();
  }

 private:
  /// Voxel map of a design in which only the cells of the component that contains the home pose are feasible.
  VoxelMap component(std::span<const double> parameters, Scratch& scratch) const {
    VoxelMap map = map_->map(parameters);
    const ConnectedComponents components = finder_.find(parameters, map, scratch);
    const std::uint32_t home = finder_.holding(parameters, map, components, home_, "the home pose", scratch);
    for (std::size_t cell = 0; cell < map.feasible.size(); ++cell) map.feasible[cell] = components.label[cell] == home;
    return map;
  }
  std::size_t cell_of(const Pose<double>& centre, const VoxelGrid& grid) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      cell[axis] = static_cast<std::int64_t>(
          std::floor((centre[static_cast<std::size_t>(sweep_.swept[axis])] - grid.lower[axis]) / grid.step[axis]));
    return grid.index(cell);
  }

  ComponentFinder finder_;
  const Sweep& sweep_;
  std::array<double, 3> home_;
  bool poses_;  ///< true: the poses of the samples are requested
  std::unique_ptr<const VoxelEvaluator> map_, samples_;
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> prepare_home_component(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                             const FieldRequest& request,
                                                             std::unique_ptr<const VoxelEvaluator> map,
                                                             std::unique_ptr<const VoxelEvaluator> samples) {
  return std::make_unique<HomeComponent>(mechanism, plan, request, std::move(map), std::move(samples));
}

}  // namespace pkm
