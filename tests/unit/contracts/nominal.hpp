// What the contract suites need of any mechanism, found without knowing it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/mechanisms/all.hpp"
#include "engine/motion/motions.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/survey/survey_set.hpp"
#include "engine/survey/voxel_grid.hpp"
#include "tests/own_mechanisms/all.hpp"
#include "tests/unit/mechanisms/described/files.hpp"

namespace pkm::test {

/// Those that the suites hold to their laws: the catalogue's and a user's.
inline const MechanismList& mechanisms() {
  static const MechanismList list = [] {
    MechanismList all = all_mechanisms();
    for (auto& own : own_mechanisms()) all.push_back(std::move(own));
    return all;
  }();
  return list;
}

/// The files that the suites take: with sanitizers, where every test reads them anew in 0.2 s, one of each kind of
/// limb.
inline std::vector<std::string> files_of_contracts() {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  return {"linear-delta", "gough", "3crr-r-cru"};
#endif
#endif
  return mechanism_files();
}

/// Names of those and of files. Every test's process asks for all of them, so files are not read for it.
inline std::vector<std::string> mechanisms_and_files() {
  std::vector<std::string> names;
  for (const auto& mechanism : mechanisms()) names.push_back(mechanism->info().name);
  for (const std::string& file : files_of_contracts()) names.push_back("file-" + file);
  return names;
}

/// The mechanism of such a name; a file is read once.
inline const std::shared_ptr<const Mechanism>& mechanism_called(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const Mechanism>> known = [] {
    std::map<std::string, std::shared_ptr<const Mechanism>> all;
    for (const auto& mechanism : mechanisms()) all[mechanism->info().name] = mechanism;
    return all;
  }();
  auto& mechanism = known[name];
  if (!mechanism) {
    const std::string file = name.substr(name.find('-') + 1);
    std::string text = text_of_mechanism(file);
    text.insert(text.find('"') + 1, "file-");  // some have the name of a user's
    mechanism = read_mechanism_toml(text, file + ".toml");
  }
  return mechanism;
}

inline bool is_of_file(const MechanismInfo& info) { return info.name.starts_with("file-"); }

inline std::vector<double> nominal(const MechanismInfo& info) {
  std::vector<double> values;
  for (const Parameter& p : info.parameters) values.push_back(p.nominal);
  return values;
}

/// A survey of one of the mechanism's sweeps without limits, what is not swept held in the design's middle.
inline SurveyPlan voxels(const MechanismInfo& info, const Sweep& sweep, std::int64_t cells) {
  VoxelOptions options;
  std::fill_n(options.cells.begin(), sweep.swept.size(), cells);
  SurveyPlan plan{.method = options, .swept = sweep.swept, .held = {}, .limits = no_limits(info)};
  for (const int coordinate : sweep.held) plan.held.push_back({.coordinate = coordinate});
  return plan;
}
inline SurveyPlan columns(const MechanismInfo& info, const Sweep& sweep, const ColumnOptions& options = {}) {
  SurveyPlan plan = voxels(info, sweep, 1);
  plan.method = options;
  return plan;
}

/// The same of the usual sweep.
inline SurveyPlan voxels(const MechanismInfo& info, std::int64_t cells) {
  return voxels(info, info.sweeps.front(), cells);
}
inline SurveyPlan columns(const MechanismInfo& info, const ColumnOptions& options = {}) {
  return columns(info, info.sweeps.front(), options);
}

/// Whether columns are looked at: those of files are prepared by trials, and of their other sweeps BoundedColumns takes
/// some.
inline bool has_columns(const Mechanism& mechanism, const Sweep& sweep) {
  return mechanism.columns() && (!is_of_file(mechanism.info()) || sweep.swept == mechanism.info().sweeps.front().swept);
}

/// By voxels, and by columns where the mechanism has them.
inline std::vector<SurveyPlan> plans(const Mechanism& mechanism, const Sweep& sweep, std::int64_t cells) {
  std::vector<SurveyPlan> all = {voxels(mechanism.info(), sweep, cells)};
  if (has_columns(mechanism, sweep)) all.push_back(columns(mechanism.info(), sweep));
  return all;
}
/// The more exact one of them.
inline SurveyPlan best_plan(const Mechanism& mechanism, const Sweep& sweep, std::int64_t cells = 10) {
  return plans(mechanism, sweep, cells).back();
}
inline SurveyPlan best_plan(const Mechanism& mechanism, std::int64_t cells = 10) {
  return best_plan(mechanism, mechanism.info().sweeps.front(), cells);
}

/// Sweeps to look at: all; where every cell of any sweep is tested alike, the first of each unit. Of files, whose boxes
/// have any middle, the first that is not empty.
inline std::vector<Sweep> sweeps(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  if (mechanism.voxels() && !is_of_file(info)) return info.sweeps;
  const auto has_cells = [&](const Sweep& sweep) {
    const VoxelMap map = voxel_map(mechanism, nominal(info), voxels(info, sweep, 10));
    return std::ranges::count(map.feasible, 1) > 0;
  };
  std::vector<Sweep> some;
  std::set<std::string> units;
  for (const Sweep& sweep : info.sweeps) {
    const std::string unit = unit_of_product(info, sweep.swept);
    if (units.contains(unit) || (is_of_file(info) && !has_cells(sweep))) continue;
    units.insert(unit);
    some.push_back(sweep);
  }
  return some;
}
/// For traces of failures: "sweep of x y".
inline std::string words(const MechanismInfo& info, const Sweep& sweep) {
  std::string text = "sweep of";
  for (const int coordinate : sweep.swept) text += " " + info.coordinates[static_cast<std::size_t>(coordinate)].name;
  return text;
}
inline std::string words(const MechanismInfo& info, const Pose<double>& pose) {
  std::string text = "pose";
  for (std::size_t i = 0; i < pose.size(); ++i) text += " " + info.coordinates[i].name + "=" + std::to_string(pose[i]);
  return text;
}

inline Survey<double> survey(const Mechanism& mechanism, const std::vector<double>& parameters, const SurveyPlan& plan,
                             const Demand& demand = {}) {
  Survey<double> result;
  survey_once<double>(*prepare_survey(mechanism, plan, demand), parameters, result);
  return result;
}

/// All that its surveys can give.
inline Demand all_fields(const Mechanism& mechanism) {
  Demand demand;
  for (const PoseQuantity* const quantity : pose_quantities())
    if (gives(mechanism, *quantity)) demand.add(*quantity);
  return demand;
}
inline Demand no_inertia(const Mechanism& mechanism) {
  Demand demand = all_fields(mechanism);
  std::erase_if(demand.fields, [](const PoseQuantity* quantity) { return quantity->needs_inertia(); });
  return demand;
}

/// The centres of a map's cells, in their order.
/// @param at  has the values of the coordinates that the sweep holds
inline std::vector<Pose<double>> centres(const Sweep& sweep, const VoxelMap& map, Pose<double> at) {
  Box box;
  for (std::size_t i = 0; i < 3; ++i) box[i] = {map.lower[i], map.upper[i]};
  const VoxelGrid grid({map.cells[0], map.cells[1], map.cells[2]}, box);
  std::vector<Pose<double>> poses;
  for (std::int64_t i = 0; i < grid.cells[0]; ++i)
    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
      for (std::int64_t k = 0; k < grid.cells[2]; ++k) {
        const std::int64_t cell[3] = {i, j, k};
        for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
          at[static_cast<std::size_t>(sweep.swept[axis])] = grid.centre(axis, cell[axis]);
        poses.push_back(at);
      }
  return poses;
}

/// Cells of the nominal design's usual sweep, a little beside the middle of what is held: where nothing is symmetric.
struct Cells {
  std::vector<Pose<double>> poses;
  std::vector<std::uint8_t> feasible;
};
inline Cells some_cells(const Mechanism& mechanism, std::int64_t cells) {
  const MechanismInfo& info = mechanism.info();
  SurveyPlan plan = voxels(info, cells);
  Pose<double> at(info.coordinates.size());
  for (HeldCoordinate& held : plan.held) {
    held.kind = HeldCoordinate::Kind::value;
    held.value = *mechanism.middle(nominal(info), held.coordinate) + 0.01;
    at[static_cast<std::size_t>(held.coordinate)] = held.value;
  }
  const VoxelMap map = voxel_map(mechanism, nominal(info), plan);
  return {centres(info.sweeps.front(), map, at), map.feasible};
}

/// A pose inside the nominal design's workspace: of the cells with room on all sides, the one that is conditioned best.
inline Pose<double> usual_pose(const Mechanism& mechanism) {
  static std::map<std::string, Pose<double>> found;
  const MechanismInfo& info = mechanism.info();
  if (found.contains(info.name)) return found[info.name];
  const std::vector<double> p = nominal(info);
  const auto inspect = [&](const Pose<double>& pose) {
    return mechanism.inspect(p, pose, info.modes.front(), no_limits(info));
  };
  const auto has_room = [&](Pose<double> pose) {
    constexpr double kRoom = 0.03;  // [m, rad]
    for (double& coordinate : pose)
      for (const double by : {-kRoom, 2 * kRoom, -kRoom}) {
        coordinate += by;
        if (!inspect(pose).feasible) return false;
      }
    return true;
  };
  const Cells cells = some_cells(mechanism, 12);
  double best = -1;
  for (std::size_t i = 0; i < cells.poses.size(); ++i) {
    if (!cells.feasible[i]) continue;
    const double value = inspect(cells.poses[i]).conditioning.value_or(0);
    if (!(value > best) || !has_room(cells.poses[i])) continue;
    best = value;
    found[info.name] = cells.poses[i];
  }
  if (best < 0) throw std::logic_error("mechanism " + info.name + " has no pose with room around it");
  return found[info.name];
}

/// One that no design reaches.
inline Pose<double> far_pose(const MechanismInfo& info) {
  Pose<double> pose(info.coordinates.size());
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = info.coordinates[i].turns() ? 0 : 50;
  return pose;
}

/// Motions called "swing" that the nominal design can follow.
inline std::vector<NamedMotion> motions(const Mechanism& mechanism) {
  return {{"swing", oscillation(space_axes(mechanism.info().coordinates), usual_pose(mechanism), 0.01, 1, 1)}};
}

/// A small box of poses around one, as the usual sweep sees it: around the usual one it is feasible for the nominal
/// design.
inline Region task(const MechanismInfo& info, const Pose<double>& centre) {
  const Sweep& sweep = info.sweeps.front();
  Region region{"task", voxels(info, sweep, 4), {}};
  for (HeldCoordinate& held : region.plan.held) {
    held.kind = HeldCoordinate::Kind::value;
    held.value = centre[static_cast<std::size_t>(held.coordinate)];
  }
  Box& box = std::get<VoxelOptions>(region.plan.method).box.emplace();
  box.fill({0, 1});
  for (std::size_t k = 0; k < sweep.swept.size(); ++k) {
    const double at = centre[static_cast<std::size_t>(sweep.swept[k])];
    box[k] = {at - 0.01, at + 0.01};
  }
  return region;
}
inline Region task(const Mechanism& mechanism) { return task(mechanism.info(), usual_pose(mechanism)); }

/// Every limit at the end of its range that is farther from inactive: nothing passes.
inline LimitSpec absurd_limits(const MechanismInfo& info) {
  LimitSpec spec = no_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& l = info.limits[i];
    spec.given[i] = std::fabs(l.upper - l.inactive) > std::fabs(l.inactive - l.lower) ? l.upper : l.lower;
  }
  return spec;
}

/// The same for surveys by a method: limits of a clearance, which columns may refuse, are left inactive there.
inline LimitSpec absurd_limits(const Mechanism& mechanism, const SurveyPlan& plan) {
  const MechanismInfo& info = mechanism.info();
  SurveyPlan limited = plan;
  limited.limits = absurd_limits(info);
  try {
    prepare_survey(mechanism, limited, {});
  } catch (const std::invalid_argument&) {
    for (std::size_t i = 0; i < info.limits.size(); ++i)
      if (info.limits[i].group == "clearance") limited.limits.given[i].reset();
  }
  return limited.limits;
}

/// A name that googletest takes.
inline std::string test_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace pkm::test
