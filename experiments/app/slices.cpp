#include "experiments/app/slices.hpp"

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/grid.hpp"

namespace pkm {

Slices set_fixed_coordinates(WorkspacePlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists) {
  const SourceLocation place{"", 0, "--fixed"};
  const auto values = parse_assignments(lists, place.key, assignable_axes(info.coordinates));
  std::vector<int> known;
  bool several = false;
  for (const Sweep& sweep : info.sweeps) {
    several = several || sweep.fixed.size() > 1;
    for (const int fixed : sweep.fixed)
      if (std::ranges::find(known, fixed) == known.end()) known.push_back(fixed);
  }
  std::vector<FixedCoordinate> given;
  Slices slices;
  for (int i = 0; i < std::ssize(values); ++i) {
    const auto& value = values[static_cast<std::size_t>(i)];
    if (!value) continue;
    if (std::ranges::find(known, i) == known.end())
      slices[i] = *value;
    else
      given.push_back({i, FixedCoordinate::Kind::value, *value});
  }
  const auto can_fix = [&given](const Sweep& sweep) {
    return std::ranges::all_of(given, [&](const auto& fixed) {
      return std::ranges::find(sweep.fixed, fixed.coordinate) != sweep.fixed.end();
    });
  };
  if (std::ranges::none_of(info.sweeps, can_fix))
    throw ConfigError(
        place, join(lists),
        several ? "coordinates that can be fixed together, with their values" : "one coordinate with its value");
  if (!can_fix(sweep_of(info, plan))) {
    plan.fixed.clear();
    plan.swept.clear();
    plan.method = ColumnOptions();
    plan.home.reset();
  }
  for (const FixedCoordinate& fixed : plan.fixed)
    if (std::ranges::find(given, fixed.coordinate, &FixedCoordinate::coordinate) == given.end()) given.push_back(fixed);
  plan.fixed = given;
  return slices;
}

void add_cuts(Slices& slices, const WorkspacePlan& plan, const MechanismInfo& info,
              const std::vector<std::string>& lists) {
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  const Axes axes = swept_axes(plan, info, {});
  for (const std::string& name : assigned_names(lists))
    if (find_named(info.coordinates, name) && !find_named(axes, name))
      throw ConfigError({"", 0, "--cut"}, "the coordinate '" + name + "', which is fixed",
                        "one that is swept, " + join(names_of(axes)), "--fixed " + name + "=..");
  const auto values = parse_assignments(lists, "--cut", assignable_axes(axes));
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (values[i]) slices[swept[i]] = *values[i];
}

Axes swept_axes(const WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices) {
  Axes axes;
  for (const int coordinate : sweep_of(info, plan).swept)
    if (!slices.contains(coordinate)) axes.push_back(info.coordinates[static_cast<std::size_t>(coordinate)]);
  return axes;
}

void apply_slices(WorkspacePlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given) {
  if (slices.empty()) return;
  VoxelOptions voxels = *plan.voxels();
  if (!voxels.box) voxels.box = reachable_box(plan, target);
  plan.method = voxels;
  set_thin_layers(plan, target.info(), slices);
  const std::vector<int>& swept = sweep_of(target.info(), plan).swept;
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (slices.contains(swept[i])) ranges_given[i] = false;
}

}  // namespace pkm
