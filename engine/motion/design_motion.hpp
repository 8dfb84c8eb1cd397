// Motions that depend on the design: their times and coordinates are formulas of the mechanism's parameters.
#pragma once

#include "engine/core/unsupported.hpp"
#include "engine/math/dual.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// A motion of a study. NamedMotion::motion is that of the study's own parameters.
struct DesignMotion : NamedMotion {
  /// Indices of the mechanism's parameters on which the motion depends.
  std::vector<std::size_t> parameters = {};
  /// The motion for all parameters of the mechanism; empty if it depends on none. Throws DesignError if there is none.
  std::function<std::shared_ptr<const Motion>(std::span<const double>)> of_design = nullptr;
  /// Reason why the motion has no derivatives with respect to these parameters; empty: it has derivatives.
  Unsupported why_no_derivatives = {};

  /// The motion of a design, given by all parameters of the mechanism. Throws DesignError if it has none.
  std::shared_ptr<const Motion> at(std::span<const double> design) const {
    return of_design ? of_design(design) : motion;
  }
};

/// A sample of a motion with its derivatives by the design. Velocity and acceleration are those at a fixed fraction of
/// the motion's duration, not at a fixed time.
struct DualMotionSample {
  Dual4 time;                                ///< time of the sample [s]
  Pose<Dual4> pose;                          ///< coordinates of the pose [m, rad]
  AxisVector<Dual4> velocity, acceleration;  ///< first and second time derivative of the pose
};

/// Samples of the motion of a design, as sample() takes them. The derivatives are central differences of fourth order;
/// their relative error is about 1e-11.
/// @param design  all parameters of the mechanism
std::vector<DualMotionSample> sample_with_derivatives(const DesignMotion& motion, std::span<const Dual4> design,
                                                      std::size_t count);

}  // namespace pkm
