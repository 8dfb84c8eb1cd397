// Endpoints of columns, and the type of slices and columns.
#pragma once

#include <utility>
#include <vector>

#include "engine/generic/surface_signs.hpp"

namespace pkm::generic {

/// Label of an endpoint of a feasible interval of z. In planar slices: twice the index of the surface that bounds the
/// interval, plus the index (0 or 1) of its root. In slices that are lines: twice the index of the constraint that has
/// its root there, plus 1 if this constraint decreases along z.
using EndLabel = std::uint32_t;

/// Points at a smaller distance, relative to the size of the slice, are merged.
inline constexpr double kMergeDistance = 1e-13;

inline Signs bit(std::size_t surface) { return Signs{1} << surface; }

using Ends = std::vector<std::pair<double, EndLabel>>;

/// Hash of the combinatorial type of a slice. For a planar slice it depends on the vertices that bound its arcs
/// (turning points do not count, except for a complete conic); for a slice that is a line (column), on the labels of
/// its endpoints. While the type is constant, the area or length of the slice is a smooth function of the outer
/// coordinate. 0: empty slice.
using SliceType = std::uint64_t;

}  // namespace pkm::generic
