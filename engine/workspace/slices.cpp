#include "engine/workspace/slices.hpp"

namespace pkm {
namespace {

// Half the thickness of the layer of cells around the value of a sliced coordinate [m or rad].
constexpr double kHalfThickness = 0x1p-10;

}  // namespace

void set_thin_layers(WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices) {
  VoxelOptions voxels = *plan.voxels();
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (const auto slice = slices.find(swept[i]); slice != slices.end()) {
      voxels.cells[i] = 1;
      (*voxels.box)[i] = {slice->second - kHalfThickness, slice->second + kHalfThickness};
    }
  plan.method = voxels;
}

void remove_sliced_axes(WorkspaceFields& workspace, const MechanismInfo& info, const Slices& slices) {
  if (slices.empty()) return;
  std::vector<int> swept;
  for (auto axis = workspace.axes.begin(); axis != workspace.axes.end();) {
    const auto slice = slices.find(axis->coordinate);
    if (slice == slices.end()) {
      swept.push_back((axis++)->coordinate);
      continue;
    }
    axis->lower = axis->upper = slice->second;
    axis->cells = 0;
    workspace.fixed.push_back(*axis);
    workspace.fixed_note.push_back("as given (slice)");
    workspace.volume /= 2 * kHalfThickness;
    axis = workspace.axes.erase(axis);
  }
  workspace.volume_unit = unit_of_product(info, swept);
}

}  // namespace pkm
