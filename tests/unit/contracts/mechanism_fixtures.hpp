// Test fixtures for arbitrary mechanisms: nominal designs, analysis plans, reference poses and limits, derived from the
// description of each mechanism.
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

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/motion/motion_factories.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/voxel_grid.hpp"
#include "tests/own_mechanisms/all.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::test {

/// The mechanisms that the contract suites test: those of the catalogue and of tests/own_mechanisms.
inline const MechanismList& mechanisms() {
  static const MechanismList list = [] {
    MechanismList all = all_mechanisms();
    for (auto& own : own_mechanisms()) all.push_back(std::move(own));
    return all;
  }();
  return list;
}

/// The mechanism files that the contract suites test. With sanitizers only one of each kind of limb: there every test
/// reads the files again, in 0.2 s each.
inline std::vector<std::string> contract_files() {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  return {"linear-delta", "gough"};
#endif
#endif
  return mechanism_files();
}

/// Names of all mechanisms and files under test. Does not read the files: every test process needs all names.
inline std::vector<std::string> mechanisms_and_files() {
  std::vector<std::string> names;
  for (const auto& mechanism : mechanisms()) names.push_back(mechanism.name());
  for (const std::string& file : contract_files()) names.push_back("file-" + file);
  return names;
}

/// The same and the files in the folders of experiments/mechanisms, for suites that take little time.
inline std::vector<std::string> mechanisms_and_all_files() {
  std::vector<std::string> names = mechanisms_and_files();
  if (contract_files() == mechanism_files())
    for (const std::string& file : mechanism_files_in_folders()) names.push_back("file-" + file);
  return names;
}

/// The mechanism with a name of mechanisms_and_all_files(). Files are read once.
inline const std::shared_ptr<const Mechanism>& test_mechanism(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const Mechanism>> known = [] {
    std::map<std::string, std::shared_ptr<const Mechanism>> all;
    for (const auto& mechanism : mechanisms()) all[mechanism->info().name] = mechanism;
    return all;
  }();
  auto& mechanism = known[name];
  if (!mechanism) {
    const std::string file = name.substr(name.find('-') + 1);
    std::string text = text_of_mechanism(file), prefix = "file-" + file.substr(0, file.find('/') + 1);
    std::ranges::replace(prefix, '/', '-');
    // some files have the name of a mechanism in tests/own_mechanisms, or of one in another folder
    text.insert(text.find('"', text.find("[mechanism]")) + 1, prefix);
    mechanism = read_mechanism_toml(text, file + ".toml");
  }
  return mechanism;
}

inline bool is_from_file(const MechanismInfo& info) { return info.name.starts_with("file-"); }

/// The name of a quantity of the mechanism that needs no dynamics; "" if there is none.
inline std::string some_quantity(const MechanismInfo& info) {
  for (const PoseQuantity* const quantity : pose_quantities(info))
    if (quantity->formula || (quantity->needs_report() && !why_no_conditioning(info))) return quantity->name;
  return "";
}

inline std::vector<double> nominal(const MechanismInfo& info) {
  std::vector<double> values;
  for (const Parameter& p : info.parameters) values.push_back(p.nominal);
  return values;
}

/// Plan of a voxel analysis of one sweep without limits; fixed coordinates have their default values.
inline WorkspacePlan voxels(const MechanismInfo& info, const Sweep& sweep, std::int64_t cells) {
  VoxelOptions options;
  std::fill_n(options.cells.begin(), sweep.swept.size(), cells);
  WorkspacePlan plan{.method = options, .swept = sweep.swept, .fixed = {}, .limits = no_limits(info)};
  for (const int coordinate : sweep.fixed) plan.fixed.push_back({.coordinate = coordinate});
  return plan;
}
inline WorkspacePlan columns(const MechanismInfo& info, const Sweep& sweep, const ColumnOptions& options = {}) {
  WorkspacePlan plan = voxels(info, sweep, 1);
  plan.method = options;
  return plan;
}

/// The same for the default sweep, the mechanism's first.
inline WorkspacePlan voxels(const MechanismInfo& info, std::int64_t cells) {
  return voxels(info, info.sweeps.front(), cells);
}
inline WorkspacePlan columns(const MechanismInfo& info, const ColumnOptions& options = {}) {
  return columns(info, info.sweeps.front(), options);
}

/// The sweeps of the catalogue's mechanisms that have accelerators; of other mechanisms none.
inline std::span<const Sweep> accelerated_sweeps(const MechanismInfo& info) {
  static const std::map<std::string, std::size_t> count = {
      {"4ppa-2par", 1}, {"3crr-r-cru", 4}, {"quadrupteron", 4}, {"2t1r-p-hybrid", 1}};
  const auto known = count.find(info.name);
  return std::span(info.sweeps).first(known == count.end() ? 0 : known->second);
}
/// Whether the generic engine evaluates the mechanism.
inline bool is_generic(const MechanismInfo& info) { return is_from_file(info) || !accelerated_sweeps(info).empty(); }

/// Whether columns are tested for a sweep. By the generic engine only for the default sweep: preparing them is
/// expensive, and BoundedColumns tests some of the other sweeps.
inline bool has_columns(const Mechanism& mechanism, const Sweep& sweep) {
  const MechanismInfo& info = mechanism.info();
  const auto is_sweep = [&](const Sweep& other) { return other.swept == sweep.swept; };
  return mechanism.columns() && (!is_generic(info) || is_sweep(info.sweeps.front()) ||
                                 std::ranges::any_of(accelerated_sweeps(info), is_sweep));
}

/// Plan by voxels, followed by a plan by columns if the mechanism supports them.
inline std::vector<WorkspacePlan> plans(const Mechanism& mechanism, const Sweep& sweep, std::int64_t cells) {
  std::vector<WorkspacePlan> all = {voxels(mechanism.info(), sweep, cells)};
  if (has_columns(mechanism, sweep)) all.push_back(columns(mechanism.info(), sweep));
  return all;
}
/// The most accurate of these plans.
inline WorkspacePlan best_plan(const Mechanism& mechanism, const Sweep& sweep, std::int64_t cells = 10) {
  return plans(mechanism, sweep, cells).back();
}
inline WorkspacePlan best_plan(const Mechanism& mechanism, std::int64_t cells = 10) {
  return best_plan(mechanism, mechanism.info().sweeps.front(), cells);
}

/// Sweeps to test: all, if the mechanism has its own voxel evaluator. Otherwise the generic cell-by-cell evaluator is
/// used, and one sweep of each unit suffices; for files the first that is not empty, since the default values of their
/// fixed coordinates may be infeasible.
inline std::vector<Sweep> sweeps(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  if (mechanism.voxels() && !is_generic(info)) return info.sweeps;
  const auto has_cells = [&](const Sweep& sweep) {
    const VoxelMap map = voxel_map(mechanism, nominal(info), voxels(info, sweep, 10));
    return std::ranges::count(map.feasible, 1) > 0;
  };
  const auto accelerated = accelerated_sweeps(info);
  std::vector<Sweep> some(accelerated.begin(), accelerated.end());
  std::set<std::string> units;
  for (const Sweep& sweep : some) units.insert(unit_of_product(info, sweep.swept));
  for (const Sweep& sweep : info.sweeps) {
    const std::string unit = unit_of_product(info, sweep.swept);
    if (units.contains(unit) || (is_generic(info) && !has_cells(sweep))) continue;
    units.insert(unit);
    some.push_back(sweep);
  }
  return some;
}
/// For failure traces: "sweep of x y".
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

inline WorkspaceResult<double> survey(const Mechanism& mechanism, const std::vector<double>& parameters,
                                      const WorkspacePlan& plan, const FieldRequest& request = {}) {
  WorkspaceResult<double> result;
  evaluate_once<double>(*prepare_workspace(mechanism, plan, request), parameters, result);
  return result;
}

/// Whether workspace analyses of the mechanism can compute a quantity.
inline bool is_available(const Mechanism& mechanism, const PoseQuantity& quantity) {
  return quantity.needs_inertia() ? mechanism.dynamics() != nullptr : !mechanism.info().characteristic_length.empty();
}

/// Requests all fields that the workspace analyses of the mechanism can compute.
inline FieldRequest request_of_all_fields(const Mechanism& mechanism) {
  FieldRequest request;
  for (const PoseQuantity* const quantity : pose_quantities())
    if (is_available(mechanism, *quantity)) request.add(*quantity);
  return request;
}
/// The same without the fields that need the joint-space inertia.
inline FieldRequest request_without_inertia(const Mechanism& mechanism) {
  FieldRequest request = request_of_all_fields(mechanism);
  std::erase_if(request.fields, [](const PoseQuantity* quantity) { return quantity->needs_inertia(); });
  return request;
}

/// The centres of the cells of a map, in the order of the cells.
/// @param at  contains the values of the fixed coordinates
inline std::vector<Pose<double>> centres(const Sweep& sweep, const VoxelMap& map, Pose<double> at) {
  const VoxelGrid grid(map);
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

/// Cells of the default sweep of the nominal design. The fixed coordinates differ slightly from their default values,
/// so that no symmetry hides errors.
struct Cells {
  std::vector<Pose<double>> poses;
  std::vector<std::uint8_t> feasible;
};
inline Cells sample_cells(const Mechanism& mechanism, std::int64_t cells) {
  const MechanismInfo& info = mechanism.info();
  WorkspacePlan plan = voxels(info, cells);
  Pose<double> at(info.coordinates.size());
  for (FixedCoordinate& fixed : plan.fixed) {
    fixed.kind = FixedCoordinate::Kind::value;
    fixed.value = *mechanism.default_value(nominal(info), fixed.coordinate) + 0.01;
    at[static_cast<std::size_t>(fixed.coordinate)] = fixed.value;
  }
  const VoxelMap map = voxel_map(mechanism, nominal(info), plan);
  return {centres(info.sweeps.front(), map, at), map.feasible};
}

/// Reference pose inside the workspace of the nominal design: the best conditioned cell centre whose neighbourhood in
/// all coordinates is feasible, too.
inline Pose<double> reference_pose(const Mechanism& mechanism) {
  static std::map<std::string, Pose<double>> found;
  const MechanismInfo& info = mechanism.info();
  if (found.contains(info.name)) return found[info.name];
  const std::vector<double> p = nominal(info);
  const auto inspect = [&](const Pose<double>& pose) {
    return mechanism.inspect(p, pose, info.modes.front(), no_limits(info));
  };
  const auto is_interior = [&](Pose<double> pose) {
    constexpr double kDistance = 0.03;  // [m, rad]
    for (double& coordinate : pose)
      for (const double by : {-kDistance, 2 * kDistance, -kDistance}) {
        coordinate += by;
        if (!inspect(pose).feasible) return false;
      }
    return true;
  };
  const Cells cells = sample_cells(mechanism, 12);
  double best = -1;
  for (std::size_t i = 0; i < cells.poses.size(); ++i) {
    if (!cells.feasible[i]) continue;
    const double value = inspect(cells.poses[i]).conditioning.value_or(0);
    if (!(value > best) || !is_interior(cells.poses[i])) continue;
    best = value;
    found[info.name] = cells.poses[i];
  }
  if (best < 0) throw std::logic_error("mechanism " + info.name + " has no pose with a feasible neighbourhood");
  return found[info.name];
}

/// A pose that no design reaches.
inline Pose<double> unreachable_pose(const MechanismInfo& info) {
  Pose<double> pose(info.coordinates.size());
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = info.coordinates[i].turns() ? 0 : 50;
  return pose;
}

/// A motion named "swing" that the nominal design can follow.
inline std::vector<DesignMotion> motions(const Mechanism& mechanism) {
  return {{{"swing", oscillation(space_axes(mechanism.info().coordinates), reference_pose(mechanism), 0.01, 1, 1)}}};
}

/// A region, named "task": a small box of the default sweep around a pose. Around the reference pose it is feasible for
/// the nominal design.
inline Region task(const MechanismInfo& info, const Pose<double>& centre) {
  const Sweep& sweep = info.sweeps.front();
  Region region{"task", voxels(info, sweep, 4), {}};
  for (FixedCoordinate& fixed : region.plan.fixed) {
    fixed.kind = FixedCoordinate::Kind::value;
    fixed.value = centre[static_cast<std::size_t>(fixed.coordinate)];
  }
  Box& box = std::get<VoxelOptions>(region.plan.method).box.emplace();
  box.fill({0, 1});
  for (std::size_t k = 0; k < sweep.swept.size(); ++k) {
    const double at = centre[static_cast<std::size_t>(sweep.swept[k])];
    box[k] = {at - 0.01, at + 0.01};
  }
  return region;
}
inline Region task(const Mechanism& mechanism) { return task(mechanism.info(), reference_pose(mechanism)); }

/// Every limit at the end of its range that is farther from its inactive value: no pose is feasible.
inline LimitSpec infeasible_limits(const MechanismInfo& info) {
  LimitSpec spec = no_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& l = info.limits[i];
    spec.given[i] = std::fabs(l.upper - l.inactive) > std::fabs(l.inactive - l.lower) ? l.upper : l.lower;
  }
  return spec;
}

/// The same for a plan; limits of a clearance stay inactive if the method (columns) does not support them.
inline LimitSpec infeasible_limits(const Mechanism& mechanism, const WorkspacePlan& plan) {
  const MechanismInfo& info = mechanism.info();
  WorkspacePlan limited = plan;
  limited.limits = infeasible_limits(info);
  try {
    prepare_workspace(mechanism, limited, {});
  } catch (const std::invalid_argument&) {
    for (std::size_t i = 0; i < info.limits.size(); ++i)
      if (info.limits[i].group == "clearance") limited.limits.given[i].reset();
  }
  return limited.limits;
}

/// A valid GoogleTest parameter name.
inline std::string test_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace pkm::test
