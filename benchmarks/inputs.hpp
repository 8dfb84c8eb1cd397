// What the benchmarks measure on: the paper's two designs, random designs from a fixed seed, the limits and the studies
// of the experiments. Nothing here depends on the clock, so two runs measure the same work.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mechanisms/four_ppa_two_par/model.hpp"
#include "engine/setup/study.hpp"

namespace pkm::benchmarks {

const Mechanism& mechanism_named(std::string_view name);
const Mechanism& four_ppa();

/// All parameters of 4PPa-2PaR for the four lengths that the paper varies [m]; d = 0.15, L0 = 2.5, nominal elsewhere.
std::vector<double> design(double a, double b, double l_u, double l_d);
/// The paper's original design and its optimum's corner.
std::vector<double> original_design();
std::vector<double> optimal_design();

LimitSpec without_limits();
/// Thresholds of experiments/4ppa-2par/wide-bounds.toml.
LimitSpec with_limits();

/// Random designs of the wide bounds (table 5) whose workspace is not empty and smaller with the limits than without.
std::vector<std::vector<double>> designs_with_active_limits(std::size_t count);

/// The paper's grid of 32 x 34 x 60 cells.
inline constexpr VoxelOptions kPaperGrid{.cells = {32, 34, 60}};

inline HeldCoordinate held_at(int coordinate, double value) {
  return {.coordinate = coordinate, .kind = HeldCoordinate::Kind::value, .value = value};
}
SurveyPlan voxel_plan(const LimitSpec& limits);
SurveyPlan column_plan(const LimitSpec& limits, const std::vector<HeldCoordinate>& held = {}, double tolerance = 1e-8);

/// experiments/4ppa-2par/paper-problem.toml: the paper's problem on its voxels, 20 designs and 100 generations.
Study paper_study();
/// experiments/4ppa-2par/wide-bounds.toml: exact columns with limits, 100 designs and 200 generations.
Study wide_study();

/// Fills `values` with design number `row` of the random designs of a seed.
void random_design(const DesignSpace& space, std::uint64_t seed, std::uint32_t row, std::span<double> values);

}  // namespace pkm::benchmarks
