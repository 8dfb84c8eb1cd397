// Abilities that need masses: equations of motion and joint reactions.
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
  virtual const std::vector<std::string>& mass_models() const = 0;  ///< names of all mass models, the default first
  virtual const std::string& mass_model() const = 0;                ///< name of the selected mass model
  /// Returns the same mechanism with another mass model; null if it has no mass model of this name.
  virtual std::shared_ptr<const Mechanism> with_masses(const std::string& model) const = 0;

  /// Computes the equations of motion of one design at several states. PoseDynamics::assembles is false for a pose that
  /// cannot be assembled. Throws DesignError if a mass is not positive.
  /// @param mode  one of MechanismInfo::modes
  virtual void equations(std::span<const double> parameters, const std::string& mode,
                         std::span<const MotionState<double>> states, std::span<PoseDynamics<double>> found) const = 0;
  virtual void equations(std::span<const Dual4> parameters, const std::string& mode,
                         std::span<const MotionState<Dual4>> states, std::span<PoseDynamics<Dual4>> found) const = 0;
};

/// Computes the reaction forces and couples in every joint by the Newton-Euler equations.
class JointReactions {
 public:
  virtual ~JointReactions() = default;
  /// @param acceleration  acceleration of the platform coordinates
  /// @param wrench        external load on the platform [N, N m]
  virtual Reactions find(std::span<const double> parameters, const std::string& mode, const MotionState<double>& state,
                         const AxisVector<double>& acceleration, const Wrench<double>& wrench) const = 0;
};

}  // namespace pkm
