// Installation space of a mechanism over several poses: the axis-parallel bounding box of all links, and the total
// length of the moving ones. Links are capsules, so that the box of one pose is exact: the bounding box of the axis of
// each link, extended by its radius.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

struct InstallationSpace {
  Bounds<double> box;        ///< bounding box of all links at all poses [m], links of the frame included
  double moving_length = 0;  ///< sum of the maximum lengths of the axes of all links that are not part of the frame [m]
};

/// The installation space over all given poses. They are evaluated by the threads of the caller's team, and the result
/// does not depend on their number. Poses inside a workspace count as well, because links can extend farthest at any
/// pose, not only on the boundary.
/// @param mechanism  a mechanism that provides its links
/// @return std::nullopt if there are no poses, or one of them cannot be assembled
std::optional<InstallationSpace> installation_space(const Mechanism& mechanism, std::span<const double> parameters,
                                                    const std::string& mode, std::span<const Pose<double>> poses);

}  // namespace pkm
