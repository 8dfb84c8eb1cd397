// Motions of a platform: pose, velocity and acceleration as functions of time.
//
// A motion is independent of the mechanism: it is a curve in named coordinates. engine/mechanism/trajectory.hpp
// evaluates a mechanism with these coordinates along it.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/pose.hpp"
#include "engine/motion/time_graph.hpp"

namespace pkm {

/// An input of a mechanism in addition to the pose, such as the angle of an additional shaft, and its time derivatives.
struct InputSample {
  double value = 0, rate = 0, acceleration = 0;
};

/// A motion at one time.
struct MotionSample {
  double time = 0;                            ///< time since the start of the motion [s]
  Pose<double> pose;                          ///< coordinates of the pose [m, rad]
  AxisVector<double> velocity, acceleration;  ///< first and second time derivative of the pose
  /// Values of MechanismInfo::inputs, in their order; empty: constant default values.
  std::vector<InputSample> inputs = {};
};

/// A motion, given by a function of time and by an equivalent expression graph. Immutable and thread-safe.
class Motion {
 public:
  using At = std::function<MotionSample(double)>;
  using Write = std::function<std::vector<expression::Node>(TimeGraph&)>;

  Motion(double duration, At at, Write write) : duration_(duration), at_(std::move(at)), write_(std::move(write)) {}
  /// Duration [s], > 0; the motion begins at time 0.
  double duration() const { return duration_; }
  /// Pose, velocity and acceleration at a time. @param time  in [0, duration()]
  MotionSample at(double time) const { return at_(time); }
  /// Adds the coordinates of the pose to a graph, as expressions of the time in [0, duration()].
  std::vector<expression::Node> write(TimeGraph& to) const;

 private:
  double duration_;
  At at_;
  Write write_;
};

/// A motion and its name in a study.
struct NamedMotion {
  std::string name;
  std::shared_ptr<const Motion> motion;
};

/// `count` >= 2 samples at equidistant times, including the start and the end.
std::vector<MotionSample> sample(const Motion& motion, std::size_t count);

/// True if the motion can be repeated without a discontinuity: pose, velocity and acceleration at the end equal those
/// at the start, within 1e-9 in SI units. Angles may differ by full turns.
bool is_periodic(const Motion& motion, std::span<const AxisInfo> coordinates);

}  // namespace pkm
