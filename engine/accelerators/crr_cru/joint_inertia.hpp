// (3CRR/R)&CRU and Quadrupteron: M_q from the limbs' shares, and coupling indices along a row of voxels, kLanes at a
// time. Derivation: README.md.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/instruction_set.hpp"
#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::crr_cru {

/// Inertia of a limb's rods as felt at C_i in the limb's plane: elements of M_d [kg].
template <class S>
struct PlaneInertia {
  S pp, pq, qq;
};

/// What M_q takes of one phi.
template <class S>
struct SlideFrame {
  std::array<std::array<S, 2>, 4> per_slide;  ///< s_i in the limb's plane, along the lower and the higher world axis
  // platforms, and what slides along the rails
  S xx, yy, zz, vx, vy, vz, k;
  std::array<double, 4> rotors{};  ///< what drive trains add
};

/// M_q from the limbs' shares [kg]. S may be lanes, of which all have one frame.
template <class S, class T>
[[gnu::always_inline]] inline JointInertia<S> joint_inertia(const SlideFrame<T>& f, const PlaneInertia<S>& l1,
                                                            const PlaneInertia<S>& l2, const PlaneInertia<S>& l3,
                                                            const PlaneInertia<S>& l4) {
  const auto along = [&f](std::size_t i, const PlaneInertia<S>& l) {  // A_i s_i
    const auto& s = f.per_slide[i];
    return std::array<S, 2>{l.pp * s[0] + l.pq * s[1], l.pq * s[0] + l.qq * s[1]};
  };
  const std::array<S, 2> v1 = along(0, l1), v2 = along(1, l2), v3 = along(2, l3), v4 = along(3, l4);
  const S vx = f.vx + (v2[0] + v3[0] + v4[0]), vy = f.vy + (v1[0] + v3[1]), vz = f.vz + (v1[1] + v2[1] + v4[1]);
  const auto twice = [&f](std::size_t i, const std::array<S, 2>& v) {
    return S(f.per_slide[i][0] * v[0] + f.per_slide[i][1] * v[1]);
  };
  const S k = f.k + ((twice(0, v1) + twice(1, v2)) + (twice(2, v3) + twice(3, v4)));
  JointInertia<S> M;
  M.m00 = f.xx + (l2.pp + l3.pp + l4.pp) + f.rotors[0];
  M.m11 = f.yy + (l1.pp + l3.qq) - vy * 2.0 + k + f.rotors[1];
  M.m22 = f.zz + (l1.qq + l2.qq + l4.qq) + f.rotors[2];
  M.m33 = k + f.rotors[3];
  M.m01 = l3.pq - vx;
  M.m02 = l2.pq + l4.pq;
  M.m03 = vx;
  M.m12 = l1.pq - vz;
  M.m13 = vy - k;
  M.m23 = vz;
  return M;
}

/// A limb's shares along a row of voxels: an element for each, or one for all.
struct ShareRow {
  const double *pp, *pq, *qq;
  bool varies;
};

/// Coupling indices of voxels [first, end) of a row, and up to whole lanes of some beyond; numbers without meaning for
/// voxels that do not assemble.
template <InstructionSet set>
void coupling_along(const SlideFrame<double>& frame, const std::array<ShareRow, 4>& shares, std::size_t first,
                    std::size_t end, const std::array<double*, 4>& index);

}  // namespace pkm::crr_cru
