#include <algorithm>

#include "engine/core/team.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kCells = 16;     // per swept axis, where every rotation needs a survey of its own
constexpr std::size_t kRotations = 13;  // of those

/// The coupling indices of feasible poses at some rotations.
struct Turned {
  std::vector<double> rotations;
  std::vector<Survey<double>> surveys;
};

/// A workspace that sweeps over the rotation has all: its cells, layer by layer.
Turned by_layers(const WorkspaceFields& workspace, std::size_t axis, std::size_t limbs) {
  Turned turned;
  const VoxelGrid grid = workspace.grid();
  turned.surveys.resize(static_cast<std::size_t>(grid.cells[axis]));
  for (std::int64_t k = 0; k < grid.cells[axis]; ++k) turned.rotations.push_back(grid.centre(axis, k));
  std::int64_t stride = 1;
  for (std::size_t i = axis + 1; i < 3; ++i) stride *= grid.cells[i];
  for (const std::size_t cell : workspace.feasible_cells()) {
    auto& survey =
        turned.surveys[static_cast<std::size_t>(static_cast<std::int64_t>(cell) / stride % grid.cells[axis])];
    survey.weight.push_back(1);
    for (std::size_t limb = 0; limb < limbs; ++limb)
      survey.fields[&kCouplingIndex][limb].push_back(workspace.field("dci_" + std::to_string(limb + 1)).values[cell]);
  }
  return turned;
}

/// One that holds it is surveyed at several, on coarse voxels.
Turned by_surveys(const Views& views, const View& view, std::size_t held) {
  Turned turned;
  const int coordinate = view.workspace->held[held].coordinate;
  const auto [lower, upper] = view.held_range[held];
  turned.surveys.resize(kRotations);
  for (std::size_t k = 0; k < kRotations; ++k)
    turned.rotations.push_back(lower + (upper - lower) * static_cast<double>(k) / (kRotations - 1));
  const Demand demand{.fields = {&kCouplingIndex}, .mode = views.mode};
  share_pieces(kRotations, [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) {
      SurveyPlan plan = views.plan;
      for (std::size_t axis = 0; axis < view.workspace->axes.size(); ++axis)
        std::get<VoxelOptions>(plan.method).cells[axis] = kCells;
      std::erase_if(plan.held, [&](const HeldCoordinate& other) { return other.coordinate == coordinate; });
      plan.held.push_back({coordinate, HeldCoordinate::Kind::value, turned.rotations[k]});
      survey_once<double>(*prepare_survey(views.mechanism, plan, demand), view.parameters, turned.surveys[k]);
    }
  });
  return turned;
}

Turned turned(const Views& views, const View& view, int rotation) {
  const WorkspaceFields& workspace = *view.workspace;
  const auto place_in = [&](const std::vector<WorkspaceAxis>& axes) {
    return static_cast<std::size_t>(std::ranges::find(axes, rotation, &WorkspaceAxis::coordinate) - axes.begin());
  };
  const std::size_t axis = place_in(workspace.axes);
  return axis < workspace.axes.size() ? by_layers(workspace, axis, views.mechanism.info().joints.size())
                                      : by_surveys(views, view, place_in(workspace.held));
}

/// Mean, 95 % quantile and maximum of one index at every rotation that has feasible poses.
Json against_rotation(const Turned& turned, const std::string& limb) {
  Scratch scratch;
  Json json;
  for (const char* const statistic : {"mean", "p95", "max"})
    for (const Survey<double>& survey : turned.surveys)
      json[statistic].push_back(
          survey.weight.empty() ? std::nan("") : PoseStatistic{kCouplingIndex, statistic, limb}(survey, scratch));
  return json;
}

}  // namespace

Json coupling_data(const Views& views) {
  const MechanismInfo& info = views.mechanism.info();
  if (!views.coupling || no_joint_forces(views.mechanism)) return {};
  const auto rotation = std::ranges::find_if(info.coordinates, &AxisInfo::turns);
  const bool turns = rotation != info.coordinates.end();
  std::vector<std::string> joints, limbs;
  for (const AxisInfo& joint : info.joints) {
    joints.push_back(joint.name);
    limbs.push_back(std::to_string(joints.size()));
  }
  limbs.emplace_back("worst");
  Json designs = Json::array();
  for (const View& view : views.designs) {
    if (!view.workspace) continue;
    Json json = {{"name", view.name}};
    if (turns) {
      const Turned found = turned(views, view, static_cast<int>(rotation - info.coordinates.begin()));
      json["rotations"] = found.rotations;
      for (const std::string& limb : limbs) json["indices"].push_back(against_rotation(found, limb));
    }
    designs.push_back(std::move(json));
  }
  if (designs.empty()) return {};
  return {{"rotation", turns ? Json(rotation->name) : Json()},
          {"joints", joints},
          {"masses", views.mechanism.dynamics()->mass_model()},
          {"designs", designs}};
}

}  // namespace pkm
