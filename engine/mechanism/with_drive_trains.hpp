// Decorator that adds drive trains to a mechanism: the equations of motion include the reflected inertia of their
// rotors; everything else is forwarded.
#pragma once

#include <memory>

#include "engine/dynamics/drive_train.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// @param trains  one for each joint
std::shared_ptr<const Mechanism> with_drive_trains(std::shared_ptr<const Mechanism> mechanism, DriveTrains trains);

/// The mechanism that was passed to with_drive_trains(); the argument itself if it is not such a decorator.
const Mechanism& without_drive_trains(const Mechanism& mechanism);

}  // namespace pkm
