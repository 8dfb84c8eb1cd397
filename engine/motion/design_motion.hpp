// Motions that depend on the design: their times and coordinates are formulas of the mechanism's parameters.
#pragma once

#include "engine/core/unsupported.hpp"
#include "engine/math/dual.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// A motion of a study. NamedMotion::motion is the motion for the parameters that the study itself defines.
struct DesignMotion : NamedMotion {
  /// Indices of the mechanism's parameters on which the motion depends.
  std::vector<std::size_t> parameters = {};
  /// Returns the motion for given values of all parameters of the mechanism; empty if the motion does not depend on
  /// parameters. Throws DesignError if there is no motion for these values.
  std::function<std::shared_ptr<const Motion>(std::span<const double>)> of_design = nullptr;
  /// Reason why the motion has no derivatives with respect to `parameters`; empty: it has derivatives.
  Unsupported why_no_derivatives = {};

  /// The motion of a design, given by all parameters of the mechanism. Throws DesignError if the design has no motion.
  std::shared_ptr<const Motion> at(std::span<const double> design) const {
    return of_design ? of_design(design) : motion;
  }
};

/// A sample of a motion with its derivatives with respect to the design. Velocity and acceleration are those at a fixed
/// fraction of the motion's duration, not at a fixed time.
struct DualMotionSample {
  Dual4 time;                                ///< time of the sample [s]
  Pose<Dual4> pose;                          ///< coordinates of the pose [m, rad]
  AxisVector<Dual4> velocity, acceleration;  ///< first and second time derivative of the pose
};

/// `count` samples of the motion of a design at equidistant times, including the start and the end. The derivatives are
/// central differences of fourth order; their relative error is about 1e-11.
/// @param design  all parameters of the mechanism
std::vector<DualMotionSample> sample_with_derivatives(const DesignMotion& motion, std::span<const Dual4> design,
                                                      std::size_t count);

}  // namespace pkm
