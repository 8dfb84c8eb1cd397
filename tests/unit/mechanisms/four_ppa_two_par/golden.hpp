// The golden data of 4PPa-2PaR, read once, and designs and plans made from it.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/mechanisms/all.hpp"
#include "engine/survey/survey_set.hpp"
#include "tests/unit/math/uniform.hpp"

namespace pkm::testing {

inline const Mechanism& four_ppa() { return *all_mechanisms().front(); }
inline const std::string kModes[] = {"lower,lower", "lower,upper", "upper,lower", "upper,upper"};

inline const nlohmann::json& golden() {
  static const nlohmann::json data = nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/4ppa-2par.json"));
  return data;
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

// How y is held: in the middle, at a value, or integrated over (voxels: by so many cells).
inline HeldCoordinate in_the_middle() { return {.coordinate = 1}; }
inline HeldCoordinate at_y(double y) { return {.coordinate = 1, .kind = HeldCoordinate::Kind::value, .value = y}; }
inline HeldCoordinate over_y(std::int64_t cells = 0) {
  return {.coordinate = 1, .kind = HeldCoordinate::Kind::integrated, .cells = cells};
}

inline SurveyPlan columns(const LimitSpec& limits, const HeldCoordinate& held = in_the_middle(),
                          double tolerance = 1e-10) {
  return {.method = ColumnOptions{.tolerance = tolerance}, .held = {held}, .limits = limits};
}

inline SurveyPlan voxels(const LimitSpec& limits, std::array<std::int64_t, 3> cells,
                         const HeldCoordinate& held = in_the_middle()) {
  return {.method = VoxelOptions{.cells = cells}, .held = {held}, .limits = limits};
}

inline ColumnOptions& column_options(SurveyPlan& plan) { return std::get<ColumnOptions>(plan.method); }
inline VoxelOptions& voxel_options(SurveyPlan& plan) { return std::get<VoxelOptions>(plan.method); }

inline Survey<double> survey(const std::vector<double>& p, const SurveyPlan& plan, const Demand& demand = {}) {
  Survey<double> result;
  survey_once<double>(*prepare_survey(four_ppa(), plan, demand), p, result);
  return result;
}

}  // namespace pkm::testing
