// Computes the data of the panel "Coupling": statistics of the coupling indices over the rotation of the platform.
#include <algorithm>

#include "engine/core/team.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

// If the study fixes the rotation of the platform, the workspace is analysed at several values of this rotation, with
// the following numbers of voxels and values.
constexpr std::int64_t kCellsPerAxis = 16;   // number of voxels along each swept axis
constexpr std::size_t kFixedRotations = 13;  // number of values of the rotation

/// The coupling indices of the feasible poses at each of several values of a rotation.
struct CouplingByRotation {
  std::vector<double> rotations;
  std::vector<WorkspaceResult<double>> surveys;
};

/// If the study sweeps the rotation of the platform: groups the cells of the workspace by the value of the rotation.
CouplingByRotation group_by_rotation(const WorkspaceFields& workspace, std::size_t axis, std::size_t limbs) {
  CouplingByRotation result;
  const VoxelGrid grid = workspace.grid();
  result.surveys.resize(static_cast<std::size_t>(grid.cells[axis]));
  for (std::int64_t k = 0; k < grid.cells[axis]; ++k) result.rotations.push_back(grid.centre(axis, k));
  std::int64_t stride = 1;
  for (std::size_t i = axis + 1; i < 3; ++i) stride *= grid.cells[i];
  for (const std::size_t cell : workspace.feasible_cells()) {
    auto& survey =
        result.surveys[static_cast<std::size_t>(static_cast<std::int64_t>(cell) / stride % grid.cells[axis])];
    survey.weight.push_back(1);
    for (std::size_t limb = 0; limb < limbs; ++limb)
      survey.fields[&kCouplingIndex][limb].push_back(workspace.field("dci_" + std::to_string(limb + 1)).values[cell]);
  }
  return result;
}

/// If the study fixes the rotation of the platform: analyses the workspace on coarse voxels at several values of the
/// rotation, within that range of the rotation in which poses are feasible.
/// @param fixed  index of the rotation in WorkspaceFields::fixed
CouplingByRotation analyse_at_rotations(const ShownDesigns& shown, const ShownDesign& design, std::size_t fixed) {
  CouplingByRotation result;
  const int coordinate = design.workspace->fixed[fixed].coordinate;
  const auto [lower, upper] = design.fixed_range[fixed];
  result.surveys.resize(kFixedRotations);
  for (std::size_t k = 0; k < kFixedRotations; ++k)
    result.rotations.push_back(lower + (upper - lower) * static_cast<double>(k) / (kFixedRotations - 1));
  const FieldRequest request{.fields = {&kCouplingIndex}, .mode = shown.mode};
  parallel_for(kFixedRotations, [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) {
      WorkspacePlan plan = shown.plan;
      for (std::size_t axis = 0; axis < design.workspace->axes.size(); ++axis)
        std::get<VoxelOptions>(plan.method).cells[axis] = kCellsPerAxis;
      std::erase_if(plan.fixed, [&](const FixedCoordinate& other) { return other.coordinate == coordinate; });
      plan.fixed.push_back({coordinate, FixedCoordinate::Kind::value, result.rotations[k]});
      evaluate_once<double>(*prepare_workspace(shown.mechanism, plan, request), design.parameters, result.surveys[k]);
    }
  });
  return result;
}

/// Coupling indices over a rotation of the platform, which the study either sweeps or fixes.
/// @param rotation  index of the rotation in MechanismInfo::coordinates
CouplingByRotation coupling_by_rotation(const ShownDesigns& shown, const ShownDesign& design, int rotation) {
  const WorkspaceFields& workspace = *design.workspace;
  const auto find_in = [&](const std::vector<WorkspaceAxis>& axes) {
    return static_cast<std::size_t>(std::ranges::find(axes, rotation, &WorkspaceAxis::coordinate) - axes.begin());
  };
  const std::size_t axis = find_in(workspace.axes);
  return axis < workspace.axes.size() ? group_by_rotation(workspace, axis, shown.mechanism.info().joints.size())
                                      : analyse_at_rotations(shown, design, find_in(workspace.fixed));
}

/// Mean, 95 % quantile and maximum of a coupling index at each value of the rotation; NaN if no pose is feasible there.
/// @param limb  number of the limb, "1", "2", ..; "worst": the largest index of all limbs
Json statistics_by_rotation(const CouplingByRotation& coupling, const std::string& limb) {
  Scratch scratch;
  Json json;
  for (const char* const statistic : {"mean", "p95", "max"})
    for (const WorkspaceResult<double>& survey : coupling.surveys)
      json[statistic].push_back(
          survey.weight.empty() ? std::nan("") : PoseStatistic{kCouplingIndex, statistic, limb}(survey, scratch));
  return json;
}

}  // namespace

Json coupling_data(const ShownDesigns& shown) {
  const MechanismInfo& info = shown.mechanism.info();
  if (!shown.coupling || why_no_joint_forces(shown.mechanism)) return {};
  const auto rotation = std::ranges::find_if(info.coordinates, &AxisInfo::turns);
  const bool has_rotation = rotation != info.coordinates.end();
  std::vector<std::string> joints, limbs;
  for (const AxisInfo& joint : info.joints) {
    joints.push_back(joint.name);
    limbs.push_back(std::to_string(joints.size()));
  }
  limbs.emplace_back("worst");
  Json designs = Json::array();
  for (const ShownDesign& design : shown.designs) {
    if (!design.workspace) continue;
    Json json = {{"name", design.name}};
    if (has_rotation) {
      const auto found = coupling_by_rotation(shown, design, static_cast<int>(rotation - info.coordinates.begin()));
      json["rotations"] = found.rotations;
      for (const std::string& limb : limbs) json["indices"].push_back(statistics_by_rotation(found, limb));
    }
    designs.push_back(std::move(json));
  }
  if (designs.empty()) return {};
  return {{"rotation", has_rotation ? Json(rotation->name) : Json()},
          {"joints", joints},
          {"masses", shown.mechanism.dynamics()->mass_model()},
          {"designs", designs}};
}

}  // namespace pkm
