// Motions of a platform: the pose, its velocity and acceleration at every time.
//
// A motion belongs to no mechanism: it is a curve in named coordinates. engine/mechanism/trajectory.hpp follows it with
// a mechanism that has these.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/model/chain.hpp"
#include "engine/motion/time_formulas.hpp"

namespace pkm {

/// A motion at one time.
struct MotionSample {
  double time = 0;                            ///< [s]
  Pose<double> pose;                          ///< in SI units
  AxisVector<double> velocity, acceleration;  ///< its derivatives by time
  Turning input;                              ///< of the auxiliary chain, where there is one
};

/// Immutable, shared by threads.
class Motion {
 public:
  using At = std::function<MotionSample(double)>;
  using Write = std::function<std::vector<graph::Node>(TimeGraph&)>;

  Motion(double duration, At at, Write write) : duration_(duration), at_(std::move(at)), write_(std::move(write)) {}
  /// [s], > 0; it begins at 0.
  double duration() const { return duration_; }
  /// @param time  in [0, duration()]
  MotionSample at(double time) const { return at_(time); }
  /// The coordinates of the pose as formulas of the time in [0, duration()].
  std::vector<graph::Node> write(TimeGraph& to) const;

 private:
  double duration_;
  At at_;
  Write write_;
};

/// A motion with the name that a study gives it.
struct NamedMotion {
  std::string name;
  std::shared_ptr<const Motion> motion;
};

/// `count` samples at equal distances in time, both ends included; count >= 2.
std::vector<MotionSample> sample(const Motion& motion, std::size_t count);

/// Whether it ends as it begins (within 1e-9 of a metre, a radian and their rates), so that it can be repeated without
/// a jump of pose, velocity or acceleration. A full turn counts as none.
bool is_periodic(const Motion& motion, std::span<const AxisInfo> coordinates);

}  // namespace pkm
