#include "engine/dynamics/motor.hpp"

#include <cmath>
#include <limits>

namespace pkm {

MotorFit fit(const Motor& motor, DriveTrain train, std::span<const JointLoad> loads) {
  train.rotor = motor.rotor;
  MotorFit found;
  double squares = 0, torque_reserve = std::numeric_limits<double>::infinity();
  for (const JointLoad& load : loads) {
    const double torque = train.torque(load.force, load.speed, load.acceleration);
    found.peak_torque = std::fmax(found.peak_torque, std::fabs(torque));
    found.speed = std::fmax(found.speed, std::fabs(load.speed * train.ratio));
    squares += torque * torque;
    torque_reserve = std::fmin(torque_reserve, motor.torque_at(load.speed * train.ratio) / std::fabs(torque));
  }
  found.rms_torque = std::sqrt(squares / static_cast<double>(loads.size()));
  found.reserve = std::numeric_limits<double>::infinity();
  const auto compare = [&found](const char* name, double reserve) {
    if (!(reserve < found.reserve)) return;
    found.reserve = reserve;
    found.bounded_by = name;
  };
  compare("peak torque", torque_reserve);
  compare("continuous torque", motor.continuous_torque / found.rms_torque);
  compare("speed", motor.speed / found.speed);
  return found;
}

}  // namespace pkm
