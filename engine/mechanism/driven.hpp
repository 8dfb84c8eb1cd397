// A mechanism with drive trains: everything that it was, and in its equations of motion what turns with its motors.
#pragma once

#include <memory>

#include "engine/dynamics/drive_train.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// @param trains  as many as the mechanism has joints
std::shared_ptr<const Mechanism> with_drive_trains(std::shared_ptr<const Mechanism> mechanism, DriveTrains trains);

}  // namespace pkm
