// Simbody system of a multibody model: the spanning tree as mobilized bodies, the closures as constraints.
//
// This header includes no header of the engine but that of the model, because Simbody's headers do not compile as
// C++20.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/mechanism/multibody_model.hpp"

namespace pkm::simbody {

/// Position of the platform frame, and the components of its twist (0 to 2: angular velocity, 3 to 5: velocity of the
/// origin) with values of them and of their time derivatives.
struct PlatformState {
  Eigen::Vector3d origin;
  Eigen::Matrix3d rotation;
  std::vector<int> rows;
  Eigen::VectorXd velocity, acceleration;
};

struct MultibodySolution {
  std::vector<double> positions, forces;  ///< of the drives, by joint of the mechanism
  double closure_error = 0, force_error = 0;
};

class MultibodySystem {
 public:
  explicit MultibodySystem(const MultibodyModel& model);
  ~MultibodySystem();
  /// Moves the platform from its position in the last call, initially the reference pose, with closed loops.
  /// @param with_orientation  false: the orientation of the platform is not prescribed
  /// @return the residual
  double assemble(const PlatformState& platform, bool with_orientation);
  void reset();  ///< to the reference pose
  /// Inverse dynamics at the position of the last call.
  /// @param point   where the wrench (force, moment) acts, in the base frame
  MultibodySolution solve(const PlatformState& platform, const Eigen::Vector3d& point,
                          const std::array<double, 6>& wrench);

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace pkm::simbody
