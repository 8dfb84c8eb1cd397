// Inputs of the benchmarks: the paper's two designs, random designs of a fixed seed, and limits and studies of the
// experiments. They do not depend on the clock, so that all runs measure the same work.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "engine/config/study.hpp"

namespace pkm::benchmarks {

const Mechanism& mechanism_named(std::string_view name);
const Mechanism& four_ppa();
/// The default values of the parameters.
std::vector<double> nominal(const Mechanism& mechanism);

/// All parameters of 4PPa-2PaR for the four lengths that the paper varies [m]; d = 0.15, L0 = 2.5, nominal elsewhere.
std::vector<double> design(double a, double b, double l_u, double l_d);
/// The paper's original design and its optimal design, a corner of the design space.
std::vector<double> original_design();
std::vector<double> optimal_design();

LimitSpec without_limits();
/// Thresholds of experiments/4ppa-2par/wide-bounds.toml.
LimitSpec with_limits();

/// Random designs within the wide bounds (table 5 of the paper) whose workspace is not empty and is reduced by the
/// limits.
std::vector<std::vector<double>> designs_with_active_limits(std::size_t count);

/// The paper's grid of 32 x 34 x 60 voxels.
inline constexpr VoxelOptions kPaperGrid{.cells = {32, 34, 60}};

inline FixedCoordinate fixed_at(int coordinate, double value) {
  return {.coordinate = coordinate, .kind = FixedCoordinate::Kind::value, .value = value};
}
WorkspacePlan voxel_plan(const LimitSpec& limits);
WorkspacePlan column_plan(const LimitSpec& limits, const std::vector<FixedCoordinate>& fixed_coordinates = {},
                          double tolerance = 1e-8);

/// experiments/4ppa-2par/paper-problem.toml: the paper's problem on its voxel grid, 20 designs and 100 generations.
Study paper_study();
/// experiments/4ppa-2par/wide-bounds.toml: exact volumes with limits, 100 designs and 200 generations.
Study wide_study();

/// Fills `values` with random design number `row` of a seed.
void random_design(const DesignSpace& space, std::uint64_t seed, std::uint32_t row, std::span<double> values);

}  // namespace pkm::benchmarks
