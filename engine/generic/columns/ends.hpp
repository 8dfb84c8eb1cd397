// Ends of columns, and what tells whether two sections or columns are bounded by the same.
#pragma once

#include <utility>
#include <vector>

#include "engine/generic/columns/formula.hpp"

namespace pkm::generic {

/// An end of a column: twice the surface, and which of its roots.
using EndLabel = std::uint32_t;

inline constexpr double kTie = 1e-13;  ///< places that are nearer than this are one

inline Signs bit(std::size_t surface) { return Signs{1} << surface; }

using Ends = std::vector<std::pair<double, EndLabel>>;

/// Of what bounds a section: the corners at which arcs end, in whatever order. Where an arc turns back is none, but for
/// a conic that is there as a whole. Of a column, its ends. As long as they are the same, the measure is a smooth
/// function. 0: nothing is feasible.
using Structure = std::uint64_t;

}  // namespace pkm::generic
