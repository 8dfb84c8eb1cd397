// Decorator that adds drive trains and joint limits to a mechanism. The reflected inertia of the rotors enters the
// equations of motion; all other calls are forwarded to the mechanism.
#pragma once

#include <memory>

#include "engine/dynamics/drive_train.hpp"
#include "engine/dynamics/joint_limits.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Wraps a mechanism.
/// @param trains  drive train of each joint; empty: only the limits are added
/// @param limits  limits of each joint; empty: none
std::shared_ptr<const Mechanism> with_drive_trains(std::shared_ptr<const Mechanism> mechanism, DriveTrains trains,
                                                   std::vector<JointLimits> limits = {});

/// The limits that were passed to with_drive_trains(); empty if there are none.
std::vector<JointLimits> joint_limits(const Mechanism& mechanism);

/// Returns the mechanism that was passed to with_drive_trains(), or the argument itself if it was not wrapped.
const Mechanism& without_drive_trains(const Mechanism& mechanism);

}  // namespace pkm
