// Degenerate triples: three boundary curves that pass through one point for all tau, for example A = 0, Q = 0 and
// Q = A^2, to which a constraint A + sqrt(Q) >= 0 is reduced.
//
// They are resolved by an infinitesimal perturbation of the curves (simulation of simplicity, Edelsbrunner and Mucke
// 1990), which does not change the volume: two curves that touch each other are moved apart; if no two curves touch,
// the curve with the highest index is moved outward. The third curve then has a constant sign at the crossing of the
// other two.
#pragma once

#include "engine/generic/corner_curves/decomposition.hpp"

namespace pkm::generic::corner_curves {

/// A function counts as zero if its magnitude is at most this many times its rounding error.
inline constexpr double kZero = 64;

/// Resolves a triple of curves that pass through one point for all tau. Appends the constant signs of the third curve
/// to each pair (`constants`) and, for a branch of a pair's crossings that the third curve does not contain, the values
/// of tau at which it passes through (`events`).
/// @param triple  indices of the three curves, in ascending order
/// @param pairs   the pairs (0, 1), (0, 2) and (1, 2) of the triple; null: the two curves touch for all tau
/// @param roots   scratch memory
/// @return false if the degeneracy is not supported
bool resolve_coincidence(const std::vector<BoundaryCurve>& curves, const std::array<std::size_t, 3>& triple,
                         const std::array<DecompositionScratch::Pair*, 3>& pairs, std::vector<Root>& roots);

}  // namespace pkm::generic::corner_curves
