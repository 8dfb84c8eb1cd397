// Abilities that need masses.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/dynamics/reactions.hpp"
#include "engine/math/dual.hpp"

namespace pkm {

class Mechanism;

class Dynamics {
 public:
  virtual ~Dynamics() = default;
  virtual const std::vector<std::string>& mass_models() const = 0;  ///< where masses can come from; the first: default
  virtual const std::string& mass_model() const = 0;                ///< the one in force
  /// The same mechanism with masses from another of them; null: it knows no such model.
  virtual std::shared_ptr<const Mechanism> with_masses(const std::string& model) const = 0;

  /// Equations of motion at states of one design, with its masses. Where a state does not assemble,
  /// PoseDynamics::assembles is false. Throws DesignError where a mass is not positive.
  /// @param mode  one of MechanismInfo::modes
  virtual void equations(std::span<const double> parameters, const std::string& mode,
                         std::span<const MotionState<double>> states, std::span<PoseDynamics<double>> found) const = 0;
  virtual void equations(std::span<const Dual4> parameters, const std::string& mode,
                         std::span<const MotionState<Dual4>> states, std::span<PoseDynamics<Dual4>> found) const = 0;
};

/// Forces and couples in every joint, for an acceleration under a wrench on the platform (Newton and Euler).
class JointReactions {
 public:
  virtual ~JointReactions() = default;
  virtual Reactions find(std::span<const double> parameters, const std::string& mode, const MotionState<double>& state,
                         const AxisVector<double>& acceleration, const Wrench<double>& wrench) const = 0;
};

}  // namespace pkm
