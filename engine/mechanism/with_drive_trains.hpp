// Decorator that adds drive trains and limits of the joints to a mechanism: the reflected inertia of the rotors enters
// the equations of motion, everything else is forwarded.
#pragma once

#include <memory>

#include "engine/dynamics/drive_train.hpp"
#include "engine/dynamics/joint_limits.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// @param trains  one for each joint, or none: then the mechanism has limits of its joints only
/// @param limits  one for each joint, or none
std::shared_ptr<const Mechanism> with_drive_trains(std::shared_ptr<const Mechanism> mechanism, DriveTrains trains,
                                                   std::vector<JointLimits> limits = {});

/// The limits that were passed to with_drive_trains(); empty if there are none.
std::vector<JointLimits> joint_limits(const Mechanism& mechanism);

/// The mechanism that was passed to with_drive_trains(); the argument itself if it is not such a decorator.
const Mechanism& without_drive_trains(const Mechanism& mechanism);

}  // namespace pkm
