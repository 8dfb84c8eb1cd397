// Bounds of the volume where conditions hold: boxes of the outer coordinates are split where most is unknown.
#pragma once

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/workspace/bounds/proof_tree.hpp"

namespace pkm::bounds {

using Ranges = std::array<std::array<double, 2>, kMostOuter + 1>;

/// The same bits for any number of threads.
/// @param ranges  by axis of the conditions, the innermost last
/// @param tree  of the proof; null: nobody asks
VolumeBounds volume_bounds(const Conditions& conditions, const Ranges& ranges, const BoundsOptions& options,
                           ProofTree* tree = nullptr);

}  // namespace pkm::bounds
