// Hybrid robot: inverse condition number of a pose, and of many poses in SIMD batches.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/geometry/conditioning.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::hybrid {

/// A list of poses, each given by z and beta; the conditioning depends on neither x nor y.
struct PoseList {
  std::vector<double> z, sine, cosine;  ///< z [m], sine and cosine of beta, for each pose

  void clear() {
    for (auto* list : {&z, &sine, &cosine}) list->clear();
  }
  std::size_t size() const { return z.size(); }
};

/// The values of a design on which the conditioning depends. A plain struct, so that kernels share no inline code with
/// files that are compiled for another instruction set.
template <class S>
struct ConditioningDesign {
  S L1, L2, L3, d, e;           ///< lengths of the design, named as in README.md [m]
  std::array<double, 3> signs;  ///< signs of n1, n2, n3
  S length;                     ///< characteristic length [m]
};

/// Inverse condition number of the Jacobian at a pose; 0 if the mechanism cannot be assembled there or is serially
/// singular. S is Lanes or the scalar of the design.
template <class S, class T>
[[gnu::always_inline]] inline S conditioning(const ConditioningDesign<T>& g, const S& z, const S& sin_b,
                                             const S& cos_b) {
  auto regular = value_of(z) >= value_of(z);
  const auto root = [&](const S& square, const T& length, std::size_t limb) __attribute__((always_inline)) {
    regular = regular & (value_of(square) > kRoundoff * value_of(length) * value_of(length));
    return S(sqrt_or_zero(square) * g.signs[limb]);
  };
  const Limbs<S> j = limbs(g, z, sin_b, cos_b, root);
  return select(regular, inverse_condition(homogeneous_jacobian(z, j, S(g.length))), S(0.0));
}

/// Computes the conditioning of `count` poses in SIMD batches; `count` is a multiple of kLanes.
template <InstructionSet set>
void conditioning_of_poses(const ConditioningDesign<double>& design, const double* z, const double* sine,
                           const double* cosine, std::size_t count, double* result);

}  // namespace pkm::hybrid
