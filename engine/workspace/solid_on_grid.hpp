// The largest solid in a voxel map, judged by cell centres.
#pragma once

#include <optional>
#include <vector>

#include "engine/workspace/solid.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// Kind of a solid, and requirements on its proportions and its position.
struct SolidSpec {
  SolidShape shape;
  /// Required ratio of the dimensions, one number per ball; empty if the proportions are free.
  std::vector<double> ratio;
  /// Required coordinates of the centre, by axis; std::nullopt if a coordinate is free.
  std::array<std::optional<double>, 3> centre = {};
};

/// The largest solid that is centred at a cell's centre and contains the centres of good cells only. Among several of
/// this size, it is the one closest to the mean of their positions. If the proportions are free, those in which
/// dimensions differ by powers of 2 are tried.
/// @param good  for each cell, by VoxelGrid::index(): nonzero if the cell may be in the solid
/// @return std::nullopt if no cell is good
std::optional<Solid> largest_solid_on_grid(const VoxelGrid& grid, const std::vector<std::uint8_t>& good,
                                           const SolidSpec& spec);

}  // namespace pkm
