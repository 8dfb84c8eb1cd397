// Proof that no path leads from one pose to another, by interval branch and prune over the box that contains the
// workspace.
//
// The box is bisected. A part is removed if a constraint is violated everywhere on it, or if a square matrix has full
// rank on it and a determinant of the other sign than at the first pose. A path that starts at the first pose, stays
// feasible and crosses no singularity cannot enter a removed part, because determinants are continuous along it. Parts
// that do not touch the first pose, through other parts, are removed, too. If the second pose is in none of the
// remaining parts, there is no path.
#pragma once

#include <array>
#include <span>

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/workspace/bounds/pose_box.hpp"

namespace pkm::bounds {

struct SeparationAxis {
  std::array<double, 2> range;
  double from, to;   ///< values of the coordinate at the first and at the second pose
  bool is_periodic;  ///< true: the range is a full revolution, so that its two ends are the same pose
};

/// Tries to prove that no path leads from the pose `from` of the axes to the pose `to`.
/// @param matrices  square matrices whose determinants may not vanish along a path; null: none
Separation separate(const Constraints& constraints, const Matrices* matrices, std::span<const SeparationAxis> axes,
                    const BoundsOptions& options);

}  // namespace pkm::bounds
