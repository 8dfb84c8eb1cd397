// Golden data of 4PPa-2PaR, and the designs, limits and plans of its tests.
#pragma once

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/generic/files.hpp"
#include "tests/unit/math/uniform.hpp"

namespace pkm::testing {

inline const Mechanism& four_ppa() { return *all_mechanisms().front(); }
/// The same mechanism file without accelerators.
inline const Mechanism& generic_four_ppa() { return *test::described("4ppa-2par"); }
inline const std::string kModes[] = {"lower,lower", "lower,upper", "upper,lower", "upper,upper"};

inline const nlohmann::json& golden() {
  static const nlohmann::json data = nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/4ppa-2par.json"));
  return data;
}

/// A value of a pose report.
inline double named(const NamedValues& values, const std::string& name) {
  const auto found = std::ranges::find(values, name, &NamedValues::value_type::first);
  if (found == values.end()) throw std::logic_error("the report has no " + name);
  return found->second;
}

inline std::vector<double> nominal() {
  std::vector<double> p;
  for (const auto& parameter : four_ppa().info().parameters) p.push_back(parameter.nominal);
  return p;
}

/// All parameters of a golden case.
inline std::vector<double> design_of(const nlohmann::json& entry) {
  std::vector<double> p = nominal();
  const char* const keys[6] = {"a", "b", "lu", "ld", "d", "L0"};
  for (std::size_t i = 0; i < 6; ++i) p[i] = entry["design"][keys[i]];
  return p;
}

inline LimitSpec limits_of(const nlohmann::json& entry) {
  LimitSpec spec = no_limits(four_ppa().info());
  const auto& limits = four_ppa().info().limits;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (entry["limits"].contains(limits[i].name)) spec.given[i] = entry["limits"][limits[i].name].get<double>();
  return spec;
}

// How y is fixed: in the middle, at a value, or integrated over (voxels: with a number of cells).
inline FixedCoordinate in_the_middle() { return {.coordinate = 1}; }
inline FixedCoordinate at_y(double y) { return {.coordinate = 1, .kind = FixedCoordinate::Kind::value, .value = y}; }
inline FixedCoordinate over_y(std::int64_t cells = 0) {
  return {.coordinate = 1, .kind = FixedCoordinate::Kind::integrated, .cells = cells};
}

inline WorkspacePlan columns(const LimitSpec& limits, const FixedCoordinate& fixed_y = in_the_middle(),
                             double tolerance = 1e-10) {
  return {.method = ColumnOptions{.tolerance = tolerance}, .fixed = {fixed_y}, .limits = limits};
}

inline WorkspacePlan voxels(const LimitSpec& limits, std::array<std::int64_t, 3> cells,
                            const FixedCoordinate& fixed_y = in_the_middle()) {
  return {.method = VoxelOptions{.cells = cells}, .fixed = {fixed_y}, .limits = limits};
}

inline ColumnOptions& column_options(WorkspacePlan& plan) { return std::get<ColumnOptions>(plan.method); }
inline VoxelOptions& voxel_options(WorkspacePlan& plan) { return std::get<VoxelOptions>(plan.method); }

inline WorkspaceResult<double> survey(const std::vector<double>& p, const WorkspacePlan& plan,
                                      const FieldRequest& request = {}) {
  WorkspaceResult<double> result;
  evaluate_once<double>(*prepare_workspace(four_ppa(), plan, request), p, result);
  return result;
}

}  // namespace pkm::testing
