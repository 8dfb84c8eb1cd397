// What voxel surveys of any mechanism have in common: coordinates that are integrated over, and what a pose's report
// adds to a sample.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "engine/mechanism/survey.hpp"

namespace pkm {

/// Cells of a held coordinate that is integrated over: a place between its values [lower, lower + cells step].
struct HeldCells {
  std::size_t coordinate;
  double lower, step;
  std::int64_t cells;

  double centre(std::int64_t cell) const { return lower + (static_cast<double>(cell) + 0.5) * step; }
};

/// Adds a pose's values to the fields that reports give. @param joints  of the mechanism
inline void add_reported(const PoseReport& report, std::size_t joints, Survey<double>& to) {
  for (auto& [quantity, field] : to.fields) {
    if (quantity->needs_inertia()) continue;
    std::array<double, kMostJoints> values;
    quantity->of_report(report, values.data());
    const std::size_t count = quantity->per_joint ? joints : 1;
    for (std::size_t i = 0; i < count; ++i)
      field[i].push_back(std::isfinite(values[i]) ? values[i] : quantity->without_value);
  }
}

}  // namespace pkm
