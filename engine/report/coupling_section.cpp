#include <nlohmann/json.hpp>

#include "engine/core/team.hpp"
#include "engine/math/statistics.hpp"
#include "engine/problem/inertia_options.hpp"
#include "engine/report/json_text.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kCells = 16;     // per axis, where every rotation needs a survey of its own
constexpr std::size_t kRotations = 13;  // of those

/// The coupling indices of feasible poses at some rotations.
struct Turned {
  std::vector<double> rotations;
  std::vector<Survey<double>> surveys;
};

/// A workspace that sweeps over the rotation has all: its cells, layer by layer.
Turned by_layers(const WorkspaceFields& workspace, std::size_t axis) {
  Turned turned;
  const VoxelGrid grid = workspace.grid();
  turned.surveys.resize(static_cast<std::size_t>(grid.cells[axis]));
  for (std::int64_t k = 0; k < grid.cells[axis]; ++k) turned.rotations.push_back(grid.centre(axis, k));
  std::int64_t stride = 1;
  for (std::size_t i = axis + 1; i < 3; ++i) stride *= grid.cells[i];
  const std::vector<double>& feasible = workspace.field("feasible").values;
  for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
    if (!(feasible[cell] > 0)) continue;
    auto& survey =
        turned.surveys[static_cast<std::size_t>(static_cast<std::int64_t>(cell) / stride % grid.cells[axis])];
    survey.weight.push_back(1);
    for (std::size_t limb = 0; limb < 4; ++limb)
      survey.dci[limb].push_back(workspace.field("dci_" + std::to_string(limb + 1)).values[cell]);
  }
  return turned;
}

/// One that holds it is surveyed at several, on coarse voxels.
Turned by_surveys(const Views& views, const View& view) {
  Turned turned;
  const auto [lower, upper] = view.held_range;
  turned.surveys.resize(kRotations);
  for (std::size_t k = 0; k < kRotations; ++k)
    turned.rotations.push_back(lower + (upper - lower) * static_cast<double>(k) / (kRotations - 1));
  Demand demand;
  demand.dci = true;
  demand.mode = views.mode;
  share_pieces(kRotations, [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) {
      SurveyPlan plan = views.plan;
      plan.cells = {kCells, kCells, kCells};
      plan.held.kind = HeldCoordinate::Kind::value;
      plan.held.value = turned.rotations[k];
      views.mechanism.prepare(plan, demand)->survey(view.parameters, turned.surveys[k]);
    }
  });
  return turned;
}

Turned turned(const Views& views, const View& view) {
  const WorkspaceFields& workspace = *view.workspace;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (workspace.axes[axis].coordinate == 3) return by_layers(workspace, axis);
  return by_surveys(views, view);
}

/// Mean, 95 % quantile and maximum of one index at every rotation that has feasible poses.
Json against_rotation(const Turned& turned, const std::string& limb) {
  std::vector<double> mean, p95, most;
  for (const Survey<double>& survey : turned.surveys) {
    const std::vector<double> index = coupling_of(survey, limb);
    const bool none = index.empty();
    mean.push_back(none ? std::nan("") : weighted_mean(survey.weight, index));
    p95.push_back(none ? std::nan("") : weighted_quantile(survey.weight, index, 0.95));
    most.push_back(none ? std::nan("") : greatest(index));
  }
  return {{"mean", mean}, {"p95", p95}, {"max", most}};
}

}  // namespace

std::string coupling_data(const Views& views) {
  const MechanismInfo& info = views.mechanism.info();
  if (!info.has_dynamics) return "";
  Json designs = Json::array();
  for (const View& view : views.designs) {
    if (!view.workspace) continue;
    const Turned found = turned(views, view);
    Json json = {{"name", view.name}, {"rotations", found.rotations}, {"indices", Json::array()}};
    for (const char* const limb : {"1", "2", "3", "4", "worst"})
      json["indices"].push_back(against_rotation(found, limb));
    designs.push_back(std::move(json));
  }
  if (designs.empty()) return "";
  return json_text(Json{
      {"rotation", info.coordinates[3]}, {"joints", info.joints}, {"masses", info.mass_model}, {"designs", designs}});
}

}  // namespace pkm
