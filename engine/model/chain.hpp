// The auxiliary chain that a mechanism may carry: one more input shaft, which turns one more output shaft on the
// platform while the platform moves.
#pragma once

#include <string>

#include "engine/math/small_matrix.hpp"
#include "engine/model/pose.hpp"

namespace pkm {

/// An angle [rad] and its derivatives by time.
struct Turning {
  double angle = 0, speed = 0, acceleration = 0;
};

/// Derivatives of the output angle by the pose's coordinates and, last, the input angle.
struct ChainInfluence {
  AxisVector<double> gradient;
  AxisMatrix<double> hessian;
};

/// Absolute motion of the output shaft in the fixed frame [rad/s, rad/s^2].
struct Spin {
  Vector<double, 3> velocity, acceleration;
};

/// Everything about the chain at one pose and motion.
struct ChainReport {
  bool turns = false;  ///< false: its output, influence and spin are not there
  std::string reason;  ///< why it does not turn
  NamedValues angles;  ///< of its joints [rad] and its lengths [m]; they exist at every pose
  Turning output;
  ChainInfluence influence;
  Spin spin;
};

}  // namespace pkm
