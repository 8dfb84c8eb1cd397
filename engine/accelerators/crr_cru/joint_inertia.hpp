// (3CRR/R)&CRU and Quadrupteron: joint-space inertia M_q from the inertias of the limbs, and coupling indices along a
// row of voxels in SIMD batches. Derivation: README.md.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/instruction_set.hpp"
#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::crr_cru {

/// Inertia of the rods of a limb as an equivalent mass at its platform joint C_i: the elements of a symmetric 2 x 2
/// matrix [kg] for velocities in the plane of the limb; p is the lower and q the higher of the two world axes in this
/// plane.
template <class S>
struct PlaneInertia {
  S pp, pq, qq;
};

/// The part of the joint-space inertia M_q that depends on phi alone.
template <class S>
struct YawInertia {
  /// For each limb, vector from the point D of the moving platform to the platform joint C_i [m].
  std::array<std::array<S, 3>, 4> arm;
  /// For each limb, the velocity s_i of C_i in the plane of the limb if slide 4 moves with unit velocity: components
  /// along the lower and the higher of the two world axes in this plane.
  std::array<std::array<S, 2>, 4> per_slide;
  /// Terms of M_q due to the platforms and to the masses that move with the slides along the rails [kg].
  S xx, yy, zz, vx, vy, vz, k;
  std::array<double, 4> rotors{};  ///< inertia of the drive train at each joint [kg]
};

/// Computes M_q [kg] from the inertias of the four limbs. S can be Lanes, for several poses of one phi.
template <class S, class T>
[[gnu::always_inline]] inline JointInertia<S> joint_inertia(const YawInertia<T>& f,
                                                            const std::array<PlaneInertia<S>, 4>& l) {
  const auto along = [&](std::size_t i) {  // product of the inertia A_i of limb i and s_i
    const auto& s = f.per_slide[i];
    return std::array<S, 2>{l[i].pp * s[0] + l[i].pq * s[1], l[i].pq * s[0] + l[i].qq * s[1]};
  };
  const std::array<std::array<S, 2>, 4> v = {along(0), along(1), along(2), along(3)};
  const S vx = f.vx + (v[1][0] + v[2][0] + v[3][0]), vy = f.vy + (v[0][0] + v[2][1]),
          vz = f.vz + (v[0][1] + v[1][1] + v[3][1]);
  const auto twice_energy = [&](std::size_t i) {  // s_i^T A_i s_i
    return S(f.per_slide[i][0] * v[i][0] + f.per_slide[i][1] * v[i][1]);
  };
  const S k = f.k + ((twice_energy(0) + twice_energy(1)) + (twice_energy(2) + twice_energy(3)));
  JointInertia<S> M;
  M.m00 = f.xx + (l[1].pp + l[2].pp + l[3].pp) + f.rotors[0];
  M.m11 = f.yy + (l[0].pp + l[2].qq) - vy * 2.0 + k + f.rotors[1];
  M.m22 = f.zz + (l[0].qq + l[1].qq + l[3].qq) + f.rotors[2];
  M.m33 = k + f.rotors[3];
  M.m01 = l[2].pq - vx;
  M.m02 = l[1].pq + l[3].pq;
  M.m03 = vx;
  M.m12 = l[0].pq - vz;
  M.m13 = vy - k;
  M.m23 = vz;
  return M;
}

/// Inertia of a limb at the voxels of a row: one element per voxel, or a single element if it does not vary along the
/// row.
struct InertiaRow {
  const double *pp, *pq, *qq;
  bool varies;
};

/// Computes the coupling indices of the voxels [first, end) of a row. The number of computed voxels is rounded up to a
/// multiple of kLanes. The indices are meaningless at voxels where the mechanism cannot be assembled.
template <InstructionSet set>
void coupling_of_row(const YawInertia<double>& inertia, const std::array<InertiaRow, 4>& limbs, std::size_t first,
                     std::size_t end, const std::array<double*, 4>& index);

}  // namespace pkm::crr_cru
