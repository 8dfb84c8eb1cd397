// What voxel surveys of any mechanism have in common: coordinates that are integrated over, and what a pose's report
// adds to a sample.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

/// Cells of a held coordinate that is integrated over: a place between its values [lower, lower + cells step].
struct FixedCells {
  std::size_t coordinate;
  double lower, step;
  std::int64_t cells;

  double centre(std::int64_t cell) const { return lower + (static_cast<double>(cell) + 0.5) * step; }
};

/// Those of a plan.
/// @param coordinates  that it holds
/// @param range_of     the range of a coordinate that its cells divide
/// @param all          overwritten
template <class RangeOf>
void find_fixed_cells(std::span<const int> coordinates, const WorkspacePlan& plan, const RangeOf& range_of,
                      std::vector<FixedCells>& all) {
  all.clear();
  for (const int coordinate : coordinates) {
    const FixedCoordinate held = how_fixed(plan, coordinate);
    if (held.kind != FixedCoordinate::Kind::integrated) continue;
    const auto [lower, upper] = range_of(coordinate);
    all.push_back(
        {static_cast<std::size_t>(coordinate), lower, (upper - lower) / static_cast<double>(held.cells), held.cells});
  }
}

/// Sets those of a pose, of the combination of their cells with a number.
template <class Coordinates>
void set_fixed(std::span<const FixedCells> held, std::size_t number, const Coordinates& coordinate) {
  for (const FixedCells& each : held) {
    const auto cells = static_cast<std::size_t>(each.cells);
    coordinate(each.coordinate) = each.centre(static_cast<std::int64_t>(number % cells));
    number /= cells;
  }
}

/// Adds a pose's values to the fields that reports give. @param joints  of the mechanism
inline void add_reported(const PoseReport& report, std::size_t joints, Survey<double>& to) {
  for (auto& [quantity, field] : to.fields) {
    if (quantity->needs_inertia()) continue;
    std::array<double, kMaxJoints> values;
    quantity->of_report(report, values.data());
    const std::size_t count = quantity->per_joint ? joints : 1;
    for (std::size_t i = 0; i < count; ++i)
      field[i].push_back(std::isfinite(values[i]) ? values[i] : quantity->without_value);
  }
}

}  // namespace pkm
