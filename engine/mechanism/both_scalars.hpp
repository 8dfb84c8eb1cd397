// Abilities written once for numbers and for derivatives: a mechanism has templates, these bases call them.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Self has `template <class S> void find_dynamics(std::span<const S> parameters, const std::string& mode,
/// std::span<const MotionState<S>>, std::span<PoseDynamics<S>>) const`.
template <class Self>
class DynamicsOf : public Dynamics {
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

/// Self has `template <class S> void find_margins(std::span<const S> parameters, const std::string& mode,
/// const LimitSpec&, std::span<const Pose<double>>, Scratch&, std::vector<S>&) const`, and `std::string
/// common_margin_unit() const`.
template <class Self>
class PoseMarginsOf : public PoseMargins {
 public:
  std::string margin_unit() const final { return static_cast<const Self&>(*this).common_margin_unit(); }
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
