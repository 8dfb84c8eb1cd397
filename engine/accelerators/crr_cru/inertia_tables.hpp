// (3CRR/R)&CRU and Quadrupteron: the limbs' inertias over the cells of a voxel grid.
//
// A limb's inertia depends on the two coordinates of its plane (and on phi), so a grid of n^3 cells has n^2 of them.
// Each limb's table lies along the grid's rows, so that a row's indices are computed side by side.
#pragma once

#include <vector>

#include "engine/accelerators/crr_cru/coupling.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::crr_cru {

class InertiaTables {
 public:
  /// Tables for one phi.
  /// @param coordinate  of each axis of the grid: 0 to 2, or 3 for phi, which is not tabulated over
  /// @param along       the axis of rows
  /// @param held        where a position is held: its value
  void fill(const Geometry<double>& g, const Masses<double>& b, const WorkingMode& mode, double phi,
            const VoxelGrid& grid, const std::array<std::size_t, 3>& coordinate, std::size_t along, double held) {
    frame_ = inertia_frame(g, b, phi);
    const auto cells = [&](std::size_t axis) { return axis == kNone ? 1 : grid.cells[axis]; };
    const auto at = [&](std::size_t axis, std::int64_t cell) { return axis == kNone ? held : grid.centre(axis, cell); };
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::size_t, 2> plane = {kLimbs[i].p, kLimbs[i].q}, axis = {kNone, kNone};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < 2; ++k)
          if (coordinate[a] == plane[k]) axis[k] = a;
      if (axis[0] == along) {
        std::swap(axis[0], axis[1]);
        std::swap(plane[0], plane[1]);
      }
      Table& table = table_[i];
      table.stride = {0, 0, 0};
      if (axis[0] != kNone) table.stride[axis[0]] = static_cast<std::size_t>(cells(axis[1]));
      if (axis[1] != kNone) table.stride[axis[1]] = 1;
      table.varies = axis[1] == along;
      const auto size = static_cast<std::size_t>(cells(axis[0]) * cells(axis[1]));
      for (auto* list : {&table.pp, &table.pq, &table.qq}) list->resize(size + kLanes);
      std::size_t place = 0;
      Vector3<double> C{};
      for (std::int64_t m = 0; m < cells(axis[0]); ++m)
        for (std::int64_t n = 0; n < cells(axis[1]); ++n, ++place) {
          C[plane[0]] = at(axis[0], m) + frame_.arm[i][plane[0]];
          C[plane[1]] = at(axis[1], n) + frame_.arm[i][plane[1]];
          const auto share = plane_inertia(g, b, i, limb_at(g, i, C, mode[i]));
          table.pp[place] = share.pp;
          table.pq[place] = share.pq;
          table.qq[place] = share.qq;
        }
    }
  }

  /// M_q of a feasible cell [kg].
  Matrix<double, 4, 4> at(const std::array<std::int64_t, 3>& cell) const {
    const auto share = [&](std::size_t i) -> PlaneInertia<double> {
      const Table& t = table_[i];
      const std::size_t place = t.place(cell);
      return {t.pp[place], t.pq[place], t.qq[place]};
    };
    return matrix_of(joint_inertia(frame_, share(0), share(1), share(2), share(3)));
  }

  /// The coupling indices of cells [first, end) of a row, by their number.
  /// @param row    a cell of it, the first
  /// @param index  grows where it is too short
  void coupling(const std::array<std::int64_t, 3>& row, std::size_t first, std::size_t end,
                std::array<std::vector<double>, 4>& index) const {
    std::array<ShareRow, 4> shares;
    std::array<double*, 4> to;
    for (std::size_t i = 0; i < 4; ++i) {
      const Table& t = table_[i];
      const std::size_t place = t.place(row);
      shares[i] = {t.pp.data() + place, t.pq.data() + place, t.qq.data() + place, t.varies};
      if (index[i].size() < end + kLanes) index[i].resize(end + kLanes);
      to[i] = index[i].data();
    }
    const SlideFrame<double>& frame = frame_;
    with_instruction_set([&]<InstructionSet set>() { coupling_along<set>(frame, shares, first, end, to); });
  }

 private:
  static constexpr std::size_t kNone = 3;  ///< no axis: what is held
  struct Table {
    std::vector<double> pp, pq, qq;  ///< lanes may read beyond the cells
    std::array<std::size_t, 3> stride;
    bool varies;  ///< along rows
    std::size_t place(const std::array<std::int64_t, 3>& cell) const {
      return static_cast<std::size_t>(cell[0]) * stride[0] + static_cast<std::size_t>(cell[1]) * stride[1] +
             static_cast<std::size_t>(cell[2]) * stride[2];
    }
  };
  InertiaFrame<double> frame_;
  std::array<Table, 4> table_;
};

}  // namespace pkm::crr_cru
