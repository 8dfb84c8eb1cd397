// (3CRR/R)&CRU and Quadrupteron: geometry and inverse kinematics of one pose. Frames: README.md.
//
// Source: Transactions of the Chinese Society for Agricultural Machinery 54 (9), 2023, 448-458, with its errata.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/geometry/pose.hpp"
#include "engine/math/scalar.hpp"
#include "engine/math/small_matrix.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm::crr_cru {

template <class S>
using Pose = SchoenfliesPose<S>;

/// Which platform carries the joints C_1 to C_3: a separate middle platform, which is jointed to the moving platform at
/// D, or the moving platform itself.
enum class Platform { jointed, rigid };  // the first is (3CRR/R)&CRU, the second Quadrupteron

/// Indices of the parameters of a design.
enum ParameterIndex {
  kL11,
  kL12,
  kL21,
  kL22,
  kL31,
  kL32,
  kL41,
  kL42,
  kR,
  kH,
  kL,
  kRails,
  kBeta1,
  kBeta2,
  kBeta3,
  kRhoMin,
  kRhoMax,
  kParameters
};

/// Indices of the limits on poses in a LimitSpec.
enum LimitIndex { kSMin, kCMin, kClearanceMin, kLimits };

template <class S>
using Vector3 = std::array<S, 3>;

/// Lengths [m]; names as in README.md.
template <class S>
struct Geometry {
  Platform platform;
  std::array<S, 4> l_1, l_2;  ///< for each limb, length of the rod at the slide and of the rod at the platform
  S r, h, l, L;
  std::array<S, 3> cos_beta, sin_beta;
  S rho_min, rho_max;
};

template <class S>
Geometry<S> geometry(Platform platform, std::span<const S> p) {
  Geometry<S> g{.platform = platform,
                .l_1 = {p[kL11], p[kL21], p[kL31], p[kL41]},
                .l_2 = {p[kL12], p[kL22], p[kL32], p[kL42]},
                .r = p[kR],
                .h = p[kH],
                .l = p[kL],
                .L = p[kRails],
                .cos_beta = {},
                .sin_beta = {},
                .rho_min = p[kRhoMin],
                .rho_max = p[kRhoMax]};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [s, c] = sincos(p[kBeta1 + i]);
    g.cos_beta[i] = c;
    g.sin_beta[i] = s;
  }
  return g;
}

/// Thresholds of the constraints on poses: a pose is feasible if |sin theta_i2| >= s_min in all limbs and kappa_p >=
/// c_min, where theta_i2 is the angle between the rods of limb i, and kappa_p is 0 at a parallel singularity.
struct Limits {
  double s_min = 0, c_min = 0;
};

inline Limits limits(const LimitSpec& spec) { return {spec.given[kSMin].value_or(0), spec.given[kCMin].value_or(0)}; }

/// The frame of a limb: indices of the world axes along its directions e (rail), p and q, and the signs of p and q.
struct LimbAxes {
  std::size_t e, p, q;
  double p_sign, q_sign;
  double sense;          ///< sign s = e . (p x q), +1 or -1
  Vector3<double> rail;  ///< position of the rail divided by the length L
};
inline constexpr std::array<LimbAxes, 4> kLimbs = {{
    {.e = 0, .p = 1, .q = 2, .p_sign = -1, .q_sign = 1, .sense = -1, .rail = {0, 1, 0}},
    {.e = 1, .p = 0, .q = 2, .p_sign = 1, .q_sign = -1, .sense = 1, .rail = {0, 0, 1}},
    {.e = 2, .p = 0, .q = 1, .p_sign = 1, .q_sign = 1, .sense = 1, .rail = {0, 0, 0}},
    {.e = 1, .p = 0, .q = 2, .p_sign = -1, .q_sign = -1, .sense = -1, .rail = {1, 0, 1}},
}};

/// Components of a vector in the plane of a limb, along its directions p and q.
template <class S>
Vector<S, 2> in_plane(const LimbAxes& f, const Vector3<S>& v) {
  return {{v[f.p] * f.p_sign, v[f.q] * f.q_sign}};
}

/// The vector from D to the platform joint C_i of a limb, and whether it rotates with phi.
template <class S>
struct Arm {
  Vector3<S> to_joint;
  bool rotates;
};

/// Velocity of C_i divided by the rate of phi: z x (C_i - D) if the arm rotates, otherwise 0.
template <class S>
Vector<S, 3> yaw_velocity(const Arm<S>& arm) {
  if (!arm.rotates) return {};
  return {{arm.to_joint[1] * -1.0, arm.to_joint[0], S(0.0)}};
}

template <class S>
std::array<Arm<S>, 4> arms(const Geometry<S>& g, const S& sin_phi, const S& cos_phi) {
  std::array<Arm<S>, 4> arm;
  const bool rotates = g.platform == Platform::rigid;
  for (std::size_t i = 0; i < 3; ++i) {
    const S c = rotates ? S(g.cos_beta[i] * cos_phi - g.sin_beta[i] * sin_phi) : g.cos_beta[i];
    const S s = rotates ? S(g.sin_beta[i] * cos_phi + g.cos_beta[i] * sin_phi) : g.sin_beta[i];
    arm[i] = {{g.r * c, g.r * s, -g.h}, rotates};
  }
  arm[3] = {{g.l * cos_phi, g.l * sin_phi, S(0.0)}, true};
  return arm;
}

/// Elbow sign sigma_i = sign(sin theta_i2) of each limb, +1 or -1.
using WorkingMode = std::array<int, 4>;

/// State of one limb at a pose. If the limb does not reach the pose, only rho, A, C and d are set.
template <class S>
struct Limb {
  S rho;               ///< slide position [m]
  Vector3<S> A, B, C;  ///< positions of the limb's joints: at the slide, between the rods, at the platform [m]
  Vector<S, 2> d;      ///< vector from A to C in the plane of the limb, components along p and q [m]
  /// Unit vectors along the rod at the slide and the rod at the platform, components along p and q.
  Vector<S, 2> u1, u2;
  S sin_2, cos_2;        ///< sine and cosine of the angle theta_i2 between the two rods
  bool reaches = false;  ///< true if |d| is in [|l_i1 - l_i2|, l_i1 + l_i2]
};

/// Computes the state of limb i if its platform joint is at C.
/// @param elbow  sign of sin theta_i2
template <class S>
Limb<S> limb_at(const Geometry<S>& g, std::size_t i, const Vector3<S>& C, int elbow) {
  const LimbAxes& f = kLimbs[i];
  const S &l1 = g.l_1[i], &l2 = g.l_2[i];
  Limb<S> limb;
  limb.C = C;
  limb.rho = C[f.e];
  for (std::size_t k = 0; k < 3; ++k) limb.A[k] = g.L * f.rail[k];
  limb.A[f.e] += limb.rho;
  limb.d = in_plane(f, C) - in_plane(f, limb.A);
  const S d2 = dot(limb.d, limb.d);
  const double length = std::sqrt(value_of(d2)), sum = value_of(l1 + l2), difference = value_of(l1 - l2);
  limb.reaches = length <= sum && length >= std::fabs(difference);
  if (!limb.reaches) return limb;
  // Formulas for 1 - cos theta_2 and 1 + cos theta_2 that do not cancel at the limits of the reach.
  const S twice = l1 * l2 * 2.0, one_minus_cos = ((l1 + l2) * (l1 + l2) - d2) / twice,
          one_plus_cos = (d2 - (l1 - l2) * (l1 - l2)) / twice;
  limb.cos_2 = value_of(one_minus_cos) < 1 ? S(1.0 - one_minus_cos) : S(one_plus_cos - 1.0);
  limb.sin_2 = sqrt_or_zero(S(one_minus_cos * one_plus_cos)) * static_cast<double>(elbow);
  if (!(value_of(d2) > 0)) {  // the rods coincide, and their direction is arbitrary
    limb.u1 = {{S(1.0), S(0.0)}};
    limb.u2 = {{S(-1.0), S(0.0)}};
  } else {
    const S k = l1 + l2 * limb.cos_2, w = l2 * limb.sin_2;  // components of d along u1 and normal to u1
    limb.u1 = {{(k * limb.d[0] + w * limb.d[1]) / d2, (k * limb.d[1] - w * limb.d[0]) / d2}};
    limb.u2 = {{(limb.d[0] - l1 * limb.u1[0]) / l2, (limb.d[1] - l1 * limb.u1[1]) / l2}};
  }
  limb.B = limb.A;
  limb.B[f.p] += l1 * limb.u1[0] * f.p_sign;
  limb.B[f.q] += l1 * limb.u1[1] * f.q_sign;
  return limb;
}

}  // namespace pkm::crr_cru
