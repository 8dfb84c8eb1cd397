// Scalar dispatch: CRTP base classes whose overloads for double and Dual4 both call one member template of the
// mechanism.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Implements both overloads of Dynamics::equations(). Self defines `template <class S> void
/// find_dynamics(std::span<const S> parameters, const std::string& mode, std::span<const MotionState<S>>,
/// std::span<PoseDynamics<S>>) const`.
template <class Self>
class DynamicsDispatch : public Dynamics {
 public:
  void equations(std::span<const double> p, const std::string& mode, std::span<const MotionState<double>> states,
                 std::span<PoseDynamics<double>> found) const final {
    static_cast<const Self&>(*this).find_dynamics(p, mode, states, found);
  }
  void equations(std::span<const Dual4> p, const std::string& mode, std::span<const MotionState<Dual4>> states,
                 std::span<PoseDynamics<Dual4>> found) const final {
    static_cast<const Self&>(*this).find_dynamics(p, mode, states, found);
  }
};

/// Implements both overloads of PoseMargins::append(). Self defines `template <class S> void
/// find_margins(std::span<const S> parameters, const std::string& mode, const LimitSpec&, std::span<const
/// Pose<double>>, Scratch&, std::vector<S>&) const`.
template <class Self>
class PoseMarginsDispatch : public PoseMargins {
 public:
  void append(std::span<const double> p, const std::string& mode, const LimitSpec& limits,
              std::span<const Pose<double>> poses, Scratch& scratch, std::vector<double>& margins) const final {
    static_cast<const Self&>(*this).find_margins(p, mode, limits, poses, scratch, margins);
  }
  void append(std::span<const Dual4> p, const std::string& mode, const LimitSpec& limits,
              std::span<const Pose<double>> poses, Scratch& scratch, std::vector<Dual4>& margins) const final {
    static_cast<const Self&>(*this).find_margins(p, mode, limits, poses, scratch, margins);
  }
};

}  // namespace pkm
