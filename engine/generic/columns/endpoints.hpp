// Endpoints of columns, and the type of slices and columns.
#pragma once

#include <utility>
#include <vector>

#include "engine/generic/surface_signs.hpp"

namespace pkm::generic {

/// Label of an endpoint of a column. In planar slices: twice the index of the surface, plus the index (0 or 1) of its
/// root. In slices that are lines: see ColumnScratch.
using EndLabel = std::uint32_t;

inline constexpr double kMergeDistance = 1e-13;  ///< points at a smaller distance, relative to the slice, are merged

inline Signs bit(std::size_t surface) { return Signs{1} << surface; }

using Ends = std::vector<std::pair<double, EndLabel>>;

/// Hash of the combinatorial type of a slice: of a planar slice the set of vertices that bound its arcs (turning points
/// do not count, except for a complete conic), of a column the labels of its endpoints. While the type is constant, the
/// measure is a smooth function of the outer coordinate. 0: empty slice.
using SliceType = std::uint64_t;

}  // namespace pkm::generic
