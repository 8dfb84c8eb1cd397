// (3CRR/R)&CRU and Quadrupteron: the limbs' inertias over the cells of a voxel grid.
//
// A limb's inertia depends on the two coordinates of its plane (and on phi), so a grid of n^3 cells has n^2 of them.
#pragma once

#include <vector>

#include "engine/mechanisms/crr_cru_coupling.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::crr_cru {

class InertiaTables {
 public:
  /// Tables for one phi.
  /// @param coordinate  of each axis of the grid: 0 to 2, or 3 for phi, which is not tabulated over
  /// @param held        where a position is held: its value
  void fill(const Geometry<double>& g, const Masses<double>& b, const WorkingMode& mode, double phi,
            const VoxelGrid& grid, const std::array<int, 3>& coordinate, double held) {
    frame_ = inertia_frame(g, b, phi);
    for (std::size_t i = 0; i < 4; ++i) {
      Table& table = table_[i];
      table.stride = {0, 0, 0};
      std::array<std::int64_t, 2> axis = {-1, -1};  // of the grid, for the limb's lower and higher world axis
      const std::array<std::size_t, 2> plane = {kLimbs[i].p, kLimbs[i].q};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < 2; ++k)
          if (coordinate[a] == static_cast<int>(plane[k])) axis[k] = static_cast<std::int64_t>(a);
      const auto cells = [&](std::size_t k) { return axis[k] < 0 ? 1 : grid.cells[static_cast<std::size_t>(axis[k])]; };
      const auto at = [&](std::size_t k, std::int64_t cell) {
        return axis[k] < 0 ? held : grid.centre(static_cast<std::size_t>(axis[k]), cell);
      };
      if (axis[0] >= 0) table.stride[static_cast<std::size_t>(axis[0])] = static_cast<std::size_t>(cells(1));
      if (axis[1] >= 0) table.stride[static_cast<std::size_t>(axis[1])] = 1;
      table.share.resize(static_cast<std::size_t>(cells(0) * cells(1)));
      auto place = table.share.begin();
      Vector3<double> C{};
      for (std::int64_t m = 0; m < cells(0); ++m)
        for (std::int64_t n = 0; n < cells(1); ++n) {
          C[plane[0]] = at(0, m) + frame_.arm[i][plane[0]];
          C[plane[1]] = at(1, n) + frame_.arm[i][plane[1]];
          const Limb<double> limb = limb_at(g, i, C, mode[i]);
          *place++ = limb.reach >= 0 ? limb_share(g, b, i, limb) : PlaneInertia<double>{};
        }
    }
  }
  /// M_q of a feasible cell [kg].
  Matrix<double, 4, 4> at(const std::array<std::int64_t, 3>& cell) const {
    const auto share = [&](std::size_t i) -> const PlaneInertia<double>& {
      const Table& t = table_[i];
      return t.share[static_cast<std::size_t>(cell[0]) * t.stride[0] + static_cast<std::size_t>(cell[1]) * t.stride[1] +
                     static_cast<std::size_t>(cell[2]) * t.stride[2]];
    };
    return joint_inertia(frame_, share(0), share(1), share(2), share(3));
  }

 private:
  struct Table {
    std::vector<PlaneInertia<double>> share;
    std::array<std::size_t, 3> stride;
  };
  InertiaFrame<double> frame_;
  std::array<Table, 4> table_;
};

}  // namespace pkm::crr_cru
