// Four-degree-of-freedom hybrid robot with an auxiliary rotation: geometry and inverse kinematics of one pose.
//
// A pose is (x, y, z, beta), the drives are ordered A, E, B, C. Frames, names and equations: README.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/scalar.hpp"

namespace pkm::hybrid {

template <class S>
using Pose = SchoenfliesPose<S>;

/// Order of the parameters: geometry, then what bounds the poses (limits.hpp), then the links' radii.
enum ParameterIndex {
  kA,
  kB1,
  kB2,
  kC,
  kD,
  kE,
  kL1,
  kL2,
  kL3,
  kF,
  kFp,
  kH1,
  kH2,
  kTheta0,
  kSMin,              ///< of s1, four in all
  kSMax = kSMin + 4,  ///< the same
  kZClear = kSMax + 4,
  kBetaMin,
  kBetaMax,
  kTauS,
  kTauP,
  kTauC,
  kPsiAMax,
  kPsiCMax,
  kLamMax,
  kMuMax,
  kGap,
  kPhiMax,
  kLwMin,
  kLwMax,
  kRadiusA,
  kRadiusB,
  kRadiusC,
  kRadiusF,
  kRadiusP,
  kParameters
};

/// Lengths [m] and the phase of the fork arms [rad], names as in the source (f' is fp); kAll has them in the order of
/// the parameters.
template <class S>
struct Geometry {
  S a, b1, b2, c, d, e, L1, L2, L3;
  S f, fp, h1, h2, theta0;
  std::array<S, 5> radius;  ///< of links A, B, C, the auxiliary shaft F, the platform's edge P

  using G = Geometry;
  static constexpr std::array<S G::*, kSMin> kAll = {&G::a,  &G::b1, &G::b2, &G::c,  &G::d,  &G::e,  &G::L1,
                                                     &G::L2, &G::L3, &G::f,  &G::fp, &G::h1, &G::h2, &G::theta0};
};

template <class S>
Geometry<S> geometry(std::span<const S> p) {
  Geometry<S> g;
  for (std::size_t i = 0; i < g.kAll.size(); ++i) g.*g.kAll[i] = p[i];
  for (std::size_t i = 0; i < g.radius.size(); ++i) g.radius[i] = p[kRadiusA + i];
  return g;
}

/// Signs of n1, n2, n3, +1 or -1.
using WorkingMode = std::array<int, 3>;

/// The drives that limbs A, B and C have.
inline constexpr std::array<std::size_t, 3> kDriveOfLimb = {0, 2, 3};

/// Relative roundoff within which a radicand counts as 0, a limb as stretched across its rail.
inline constexpr double kRoundoff = 1e-12;

/// The limbs at a pose. Masks: bit 0 is limb A, bit 1 B, bit 2 C. Of a limb out of reach n is 0 and s where it would
/// be then: finite, of no meaning.
template <class S>
struct Joints : Limbs<S> {
  std::array<S, 4> s;      ///< drives s1, s2, s3, s4 [m]
  unsigned unreached = 0;  ///< limbs out of reach
  unsigned serial = 0;     ///< limbs across their rail, n = 0: serially singular
  bool assembles() const { return unreached == 0; }
};

template <class S>
Joints<S> inverse(const Geometry<S>& g, const Pose<S>& pose, const WorkingMode& mode) {
  const auto [sin_b, cos_b] = sincos(pose.angle);
  Joints<S> j;
  const auto root = [&](const S& square, const S& L, std::size_t limb) {
    const double tolerance = kRoundoff * value_of(L) * value_of(L);
    const unsigned bit = 1u << limb;
    if (value_of(square) < -tolerance) j.unreached |= bit;
    if (std::fabs(value_of(square)) <= tolerance) j.serial |= bit;
    return value_of(square) > tolerance ? S(sqrt(square) * static_cast<double>(mode[limb])) : S(0.0);
  };
  static_cast<Limbs<S>&>(j) = limbs(g, pose.z, sin_b, cos_b, root);
  const S& x = pose.x;
  j.s = {x - g.a + g.b1 - j.n1, pose.y, x + g.a - g.b2 - j.n2, x - g.c - j.n3};
  return j;
}

}  // namespace pkm::hybrid
