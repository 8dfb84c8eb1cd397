#include "experiments/app/slices.hpp"

#include "engine/core/catalogue.hpp"
#include "engine/setup/assignments.hpp"
#include "experiments/app/grid.hpp"

namespace pkm {
namespace {

constexpr double kHalfSlice = 0x1p-10;  // [m or rad] on either side of the value

}  // namespace

Slices set_held(SurveyPlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists) {
  const SourcePlace place{"", 0, "--held"};
  const auto values = parse_assignments(lists, place.key, assignable_axes(info.coordinates));
  std::vector<int> known;
  bool several = false;
  for (const Sweep& sweep : info.sweeps) {
    several = several || sweep.held.size() > 1;
    for (const int held : sweep.held)
      if (std::ranges::find(known, held) == known.end()) known.push_back(held);
  }
  std::vector<HeldCoordinate> given;
  Slices slices;
  for (int i = 0; i < std::ssize(values); ++i) {
    const auto& value = values[static_cast<std::size_t>(i)];
    if (!value) continue;
    if (std::ranges::find(known, i) == known.end())
      slices[i] = *value;
    else
      given.push_back({i, HeldCoordinate::Kind::value, *value});
  }
  const auto serves = [&given](const Sweep& sweep) {
    return std::ranges::all_of(
        given, [&](const auto& held) { return std::ranges::find(sweep.held, held.coordinate) != sweep.held.end(); });
  };
  if (std::ranges::none_of(info.sweeps, serves))
    throw ConfigError(
        place, join(lists),
        several ? "coordinates that one survey can hold, with their values" : "one coordinate with its value");
  if (!serves(sweep_of(info, plan))) {
    plan.held.clear();
    plan.swept.clear();
    plan.method = ColumnOptions();
  }
  for (const HeldCoordinate& held : plan.held)
    if (std::ranges::find(given, held.coordinate, &HeldCoordinate::coordinate) == given.end()) given.push_back(held);
  plan.held = given;
  return slices;
}

void add_cuts(Slices& slices, const SurveyPlan& plan, const MechanismInfo& info,
              const std::vector<std::string>& lists) {
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  const Axes axes = swept_axes(plan, info, {});
  for (const std::string& name : assigned_names(lists))
    if (find_named(info.coordinates, name) && !find_named(axes, name))
      throw ConfigError({"", 0, "--cut"}, "the coordinate '" + name + "', which is held",
                        "one that is swept, " + join(names_of(axes)), "--held " + name + "=..");
  const auto values = parse_assignments(lists, "--cut", assignable_axes(axes));
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (values[i]) slices[swept[i]] = *values[i];
}

Axes swept_axes(const SurveyPlan& plan, const MechanismInfo& info, const Slices& slices) {
  Axes axes;
  for (const int coordinate : sweep_of(info, plan).swept)
    if (!slices.contains(coordinate)) axes.push_back(info.coordinates[static_cast<std::size_t>(coordinate)]);
  return axes;
}

void cut(SurveyPlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given) {
  if (slices.empty()) return;
  VoxelOptions voxels = *plan.voxels();
  if (!voxels.box) voxels.box = reached_box(plan, target);
  const std::vector<int>& swept = sweep_of(target.info(), plan).swept;
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (const auto slice = slices.find(swept[i]); slice != slices.end()) {
      voxels.cells[i] = 1;
      (*voxels.box)[i] = {slice->second - kHalfSlice, slice->second + kHalfSlice};
      ranges_given[i] = false;
    }
  plan.method = voxels;
}

void flatten(WorkspaceFields& workspace, const MechanismInfo& info, const Slices& slices) {
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
    workspace.held.push_back(*axis);
    workspace.held_note.push_back("as given, a slice");
    workspace.volume /= 2 * kHalfSlice;
    axis = workspace.axes.erase(axis);
  }
  workspace.volume_unit = unit_of_product(info, swept);
}

}  // namespace pkm
