// The multibody model of a mechanism file: bodies, spanning tree and loop closures at one design.
#pragma once

#include <span>
#include <string>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/multibody_model.hpp"

namespace pkm::generic {

/// Reason why a mechanism has no multibody model; "" if it has one.
std::string why_no_multibody_model(const Mechanism& mechanism);

/// The multibody model of a mechanism at a reference pose. Its masses are those of the equations of motion. A rod with
/// ball joints at both ends gets a universal joint at one end, which prevents its spin without a reaction. Throws
/// std::invalid_argument with a sentence if the mechanism has no multibody model, if the pose does not assemble, or if
/// the joints of the file allow other motions at this pose than the coordinates; throws DesignError if a mass is not
/// positive.
/// @param pose  the reference pose
/// @param mode  working mode, one of MechanismInfo::modes
MultibodyModel multibody_model(const Mechanism& mechanism, std::span<const double> parameters, const Pose<double>& pose,
                               const std::string& mode);

}  // namespace pkm::generic
