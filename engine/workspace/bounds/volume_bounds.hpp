// Interval branch and bound for the volume of the feasible set: boxes of the outer coordinates whose enclosures are the
// widest are bisected until the relative gap of the bounds is small enough.
#pragma once

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/workspace/bounds/proof_tree.hpp"

namespace pkm::bounds {

using Ranges = std::array<std::array<double, 2>, kMaxOuterAxes + 1>;

/// Bounds of the volume in which all constraints are satisfied. The result is bit-identical for any number of threads.
/// @param ranges  range of each axis of the constraints, the column coordinate last
/// @param tree    receives the proof; null: not requested
VolumeBounds volume_bounds(const Constraints& constraints, const Ranges& ranges, const BoundsOptions& options,
                           ProofTree* tree = nullptr);

}  // namespace pkm::bounds
