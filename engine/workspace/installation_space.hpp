// Installation space: the axis-parallel bounding box of all links of a mechanism over several poses. Links are
// capsules, so that the box of one pose is exact: the bounding box of the axis of each link, extended by its radius.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The box [m], by all threads of the caller's team; it does not depend on their number. Links of the frame are
/// included. Links can extend farthest at any pose, not only on the boundary of a workspace: all poses are evaluated.
/// @param mechanism  has links
/// @return std::nullopt if there are no poses, or one of them cannot be assembled
std::optional<Bounds<double>> installation_box(const Mechanism& mechanism, std::span<const double> parameters,
                                               const std::string& mode, std::span<const Pose<double>> poses);

}  // namespace pkm
