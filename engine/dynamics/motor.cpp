#include "engine/dynamics/motor.hpp"

#include <cmath>
#include <limits>

namespace pkm {

MotorFit fit(const Motor& motor, DriveTrain train, std::span<const JointLoad> loads) {
  train.rotor = motor.rotor;
  MotorFit found;
  double squares = 0;
  for (const JointLoad& load : loads) {
    const double torque = train.torque(load.force, load.speed, load.acceleration);
    found.peak_torque = std::fmax(found.peak_torque, std::fabs(torque));
    found.speed = std::fmax(found.speed, std::fabs(load.speed * train.ratio));
    squares += torque * torque;
  }
  found.rms_torque = std::sqrt(squares / static_cast<double>(loads.size()));
  found.reserve = std::numeric_limits<double>::infinity();
  const auto compare = [&found](const char* name, double rating, double demand) {
    if (!(rating / demand < found.reserve)) return;
    found.reserve = rating / demand;
    found.bounded_by = name;
  };
  compare("peak torque", motor.peak_torque, found.peak_torque);
  compare("continuous torque", motor.continuous_torque, found.rms_torque);
  compare("speed", motor.speed, found.speed);
  return found;
}

}  // namespace pkm
