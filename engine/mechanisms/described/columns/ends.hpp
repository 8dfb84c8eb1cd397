// Ends of columns, and what tells whether two sections or columns are bounded by the same.
#pragma once

#include <utility>
#include <vector>

#include "engine/mechanisms/described/columns/formula.hpp"

namespace pkm::described {

/// An end of a column: twice the surface, and which of its roots.
using EndLabel = std::uint32_t;

inline constexpr double kTie = 1e-13;  ///< places that are nearer than this are one

inline Signs bit(std::size_t surface) { return Signs{1} << surface; }

using Ends = std::vector<std::pair<double, EndLabel>>;

/// What a section is bounded by: the corners at which arcs end. Where an arc turns back is none, but for a conic that
/// is there as a whole. Of a column, its ends. As long as they are the same, the measure is a smooth function.
struct Structure {
  std::uint64_t hash = 0;  ///< in whatever order they are; 0: nothing is feasible
  std::vector<std::uint32_t>
      corners;  ///< labels: of a crossing by both arcs, of an upright side by its lower and upper
};

}  // namespace pkm::described
