// Finds the length parameters of a mechanism that can be dimensioned in its drawing.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A parameter whose value equals the distance between two ends of links, which can be drawn as its dimension.
struct Dimension {
  std::size_t parameter;  ///< index in MechanismInfo::parameters
  std::size_t from, to;   ///< numbers of two link ends: end 2 k is the start of link k, end 2 k + 1 its other end
};

/// The dimensions of a design at a pose, in the order of the parameters, at most one per parameter. A distance
/// represents a parameter if it equals the parameter, its derivative with respect to this parameter is 1, and its
/// derivatives with respect to all other parameters are 0. Parameters with equal values are thus distinguished. The
/// derivatives are forward differences. If several distances qualify, one along a single link is preferred, then one
/// between two links of the same part. The result is empty if the pose does not assemble.
/// @param mode  working mode, one of MechanismInfo::modes
std::vector<Dimension> dimensions_of(const Mechanism& mechanism, std::span<const double> parameters,
                                     const Pose<double>& pose, const std::string& mode);

}  // namespace pkm
