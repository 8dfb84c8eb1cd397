// (3CRR/R)&CRU and Quadrupteron: tables of the inertia of the limbs over the cells of a voxel grid.
//
// The inertia of a limb depends on the two coordinates of its plane (and on phi), so it takes only n^2 different values
// on a grid of n^3 cells. The values are stored along the rows of the grid, so that coupling indices can be computed in
// SIMD batches.
#pragma once

#include <vector>

#include "engine/accelerators/crr_cru/coupling.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::crr_cru {

class InertiaTables {
 public:
  /// Fills the tables for one yaw angle phi.
  /// @param coordinate  for each axis of the grid, its coordinate: 0 to 2 for x, y, z; 3 for phi, on which the tables
  /// do not depend
  /// @param along       axis of the grid along which rows run
  /// @param fixed       value of the fixed coordinate; used only if that coordinate is a position
  void fill(const Geometry<double>& g, const Masses<double>& b, const WorkingMode& mode, double phi,
            const VoxelGrid& grid, const std::array<std::size_t, 3>& coordinate, std::size_t along, double fixed) {
    inertia_ = yaw_inertia(g, b, phi);
    const auto cells = [&](std::size_t axis) { return axis == kFixed ? 1 : grid.cells[axis]; };
    const auto at = [&](std::size_t axis, std::int64_t cell) {
      return axis == kFixed ? fixed : grid.centre(axis, cell);
    };
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::size_t, 2> plane = {kLimbs[i].p, kLimbs[i].q}, axis = {kFixed, kFixed};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < 2; ++k)
          if (coordinate[a] == plane[k]) axis[k] = a;
      if (axis[0] == along) {
        std::swap(axis[0], axis[1]);
        std::swap(plane[0], plane[1]);
      }
      Table& table = table_[i];
      table.stride = {0, 0, 0};
      if (axis[0] != kFixed) table.stride[axis[0]] = static_cast<std::size_t>(cells(axis[1]));
      if (axis[1] != kFixed) table.stride[axis[1]] = 1;
      table.varies = axis[1] == along;
      const auto size = static_cast<std::size_t>(cells(axis[0]) * cells(axis[1]));
      for (auto* list : {&table.pp, &table.pq, &table.qq}) list->resize(size + kLanes);
      std::size_t n = 0;
      Vector3<double> C{};
      for (std::int64_t row = 0; row < cells(axis[0]); ++row)
        for (std::int64_t cell = 0; cell < cells(axis[1]); ++cell, ++n) {
          C[plane[0]] = at(axis[0], row) + inertia_.arm[i][plane[0]];
          C[plane[1]] = at(axis[1], cell) + inertia_.arm[i][plane[1]];
          const auto [pp, pq, qq] = plane_inertia(g, b, i, limb_at(g, i, C, mode[i]));
          table.pp[n] = pp;
          table.pq[n] = pq;
          table.qq[n] = qq;
        }
    }
  }

  /// Joint-space inertia M_q at a feasible cell [kg].
  Matrix<double, 4, 4> at(const Cell& cell) const {
    std::array<PlaneInertia<double>, 4> limbs;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = table_[i].index(cell);
      limbs[i] = {table_[i].pp[n], table_[i].pq[n], table_[i].qq[n]};
    }
    return matrix_of(joint_inertia(inertia_, limbs));
  }

  /// Computes the coupling indices of the cells [first, end) of a row.
  /// @param row    first cell of the row
  /// @param index  receives one vector for each joint, whose element k is the index of cell k; extended if necessary
  void coupling(const Cell& row, std::size_t first, std::size_t end, std::array<std::vector<double>, 4>& index) const {
    std::array<InertiaRow, 4> limbs;
    std::array<double*, 4> to;
    for (std::size_t i = 0; i < 4; ++i) {
      const Table& t = table_[i];
      const std::size_t n = t.index(row);
      limbs[i] = {t.pp.data() + n, t.pq.data() + n, t.qq.data() + n, t.varies};
      if (index[i].size() < end + kLanes) index[i].resize(end + kLanes);
      to[i] = index[i].data();
    }
    with_instruction_set([&]<InstructionSet set>() { coupling_of_row<set>(inertia_, limbs, first, end, to); });
  }

 private:
  static constexpr std::size_t kFixed = 3;  ///< number used in place of a grid axis for the fixed coordinate
  struct Table {
    /// Inertia of each cell, followed by kLanes unused elements, which kernels may read.
    std::vector<double> pp, pq, qq;
    std::array<std::size_t, 3> stride;
    bool varies;  ///< true: the inertia varies along the rows of the grid; false: it is the same in all cells of a row
    std::size_t index(const Cell& cell) const {
      return static_cast<std::size_t>(cell[0]) * stride[0] + static_cast<std::size_t>(cell[1]) * stride[1] +
             static_cast<std::size_t>(cell[2]) * stride[2];
    }
  };
  YawInertia<double> inertia_;
  std::array<Table, 4> table_;
};

}  // namespace pkm::crr_cru
