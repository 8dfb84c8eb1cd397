// Four-degree-of-freedom hybrid robot with an auxiliary rotation: parameters and geometry.
//
// A pose is (x, y, z, beta), the drives are ordered A, E, B, C. Frames, names and equations: README.md.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/scalar.hpp"

namespace pkm::hybrid {

/// Indices of the parameters of a design: geometry, limits of the poses (limits.hpp), radii of the links.
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
  kSMin,              ///< first of the minimum strokes of s1 to s4
  kSMax = kSMin + 4,  ///< first of the maximum strokes of s1 to s4
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
  kRadii,  ///< first of the five radii of the links
  kParameters = kRadii + 5
};

/// Lengths of a design [m], with the names of the source (f' is fp); kAll lists them in the order of the parameters.
template <class S>
struct Geometry {
  S a, b1, b2, c, d, e, L1, L2, L3;
  S f, fp, h1, h2;

  using G = Geometry;
  static constexpr std::array<S G::*, kTheta0> kAll = {&G::a,  &G::b1, &G::b2, &G::c,  &G::d,  &G::e, &G::L1,
                                                       &G::L2, &G::L3, &G::f,  &G::fp, &G::h1, &G::h2};
};

template <class S>
Geometry<S> geometry(std::span<const S> p) {
  Geometry<S> g;
  for (std::size_t i = 0; i < g.kAll.size(); ++i) g.*g.kAll[i] = p[i];
  return g;
}

/// Signs (+1 or -1) of n1, n2, n3: the components of the links of limbs A, B, C along their rails.
using WorkingMode = std::array<int, 3>;

/// Indices of the drives of limbs A, B and C.
inline constexpr std::array<std::size_t, 3> kDriveOfLimb = {0, 2, 3};

}  // namespace pkm::hybrid
