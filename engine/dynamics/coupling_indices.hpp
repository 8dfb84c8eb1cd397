// Dynamic coupling indices (DCI): measure of the inertia forces in a joint that are caused by the other joints.
//
//   DCI_i = 1 - exp(-delta_i),   delta_i = sum over k != i of |M_q(i,k)| / |M_q(i,i)|
//
// DCI is 0 for a decoupled joint, and tends to 1 for strong coupling. It is dimensionless if all elements of M_q have
// the same unit, kg. Source: the paper cited in pose_dynamics.hpp, eq 42.
#pragma once

#include <array>

#include "engine/math/scalar.hpp"

namespace pkm {

/// The elements of a symmetric 4 x 4 matrix M_q [kg].
template <class S>
struct JointInertia {
  S m00, m11, m22, m33, m01, m02, m03, m12, m13, m23;
};

/// The coupling index 1 - exp(-off / own) of a joint. `off` is the sum of the magnitudes of the off-diagonal elements
/// in its row of M_q, `own` is the diagonal element.
template <class S>
[[gnu::always_inline]] inline S coupling_index(const S& off, const S& own) {
  return S(1.0) - exp(S(off / own * -1.0));
}

/// Computes the coupling indices of four joints. S can be Lanes, for several poses at once (SIMD).
template <class S>
[[gnu::always_inline]] inline std::array<S, 4> coupling_indices(const JointInertia<S>& M) {
  const S m01 = magnitude(M.m01), m02 = magnitude(M.m02), m03 = magnitude(M.m03), m12 = magnitude(M.m12),
          m13 = magnitude(M.m13), m23 = magnitude(M.m23);
  return {coupling_index(S(m01 + m02 + m03), M.m00), coupling_index(S(m01 + m12 + m13), M.m11),
          coupling_index(S(m02 + m12 + m23), M.m22), coupling_index(S(m03 + m13 + m23), M.m33)};
}

}  // namespace pkm
