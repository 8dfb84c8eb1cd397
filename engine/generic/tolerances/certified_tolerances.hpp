// Certified tolerances of a design: the largest deviations of its parameters within which every robot does a task, by
// interval branch and bound. The constraints of the mechanism file, and the determinants of its Jacobians, are written
// as functions of the pose and of the deviations.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm::generic {

/// The task of a robot: all poses of a box, or all instants of a motion.
struct PoseSet {
  std::vector<std::array<double, 2>> ranges = {};  ///< of each coordinate; lower = upper fixes the coordinate
  const Motion* motion = nullptr;                  ///< instead of the ranges
};

/// Deviations of parameters, which are independent of each other, in proportion to a common scale.
struct ToleranceProportions {
  std::vector<std::size_t> parameters;  ///< indices of the parameters that deviate
  std::vector<double> sizes;            ///< maximum deviation of each at scale 1 [SI], > 0
};

/// A robot that does not do the task.
struct ToleranceViolation {
  double scale = 0;                ///< maximum deviation, relative to the sizes
  std::vector<double> parameters;  ///< all parameters of the robot [SI]
  std::string constraint;          ///< that it violates, or the singularity that it reaches
  Pose<double> pose;               ///< where
  std::optional<double> time;      ///< when [s], in a motion
};

struct CertifiedTolerances {
  double scale = 0;                             ///< all robots up to this scale are proved to do the task
  std::optional<ToleranceViolation> violation;  ///< the one with the smallest scale that is known
  double largest_scale = 0;                     ///< at which a parameter could become 0; larger ones are not examined
  Unsupported no_singularities = {};            ///< why singularities were not examined; empty if they were
  std::size_t boxes = 0;                        ///< number of boxes examined
  bool stopped = false;
};

/// Whether a constraint of a pose or a singularity depends on a parameter, for all parameters of a mechanism that
/// evaluation_of() accepts.
std::vector<bool> affects_poses(const Mechanism& mechanism, const LimitSpec& limits);

/// Proportions of approximately minimum cost, if a tolerance t_i costs sizes[i] / t_i. The tolerances at scale 1 are
/// close to the largest ones, but not certified; none exceeds a tenth of its parameter. Cutting planes: the violations
/// that a local search finds give linear constraints of the tolerances.
/// @param costs  the parameters that deviate, and the costs as sizes
/// @param stop   returns true to stop with the proportions found so far
ToleranceProportions cheapest_proportions(const Mechanism& mechanism, std::span<const double> parameters,
                                          const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                          const ToleranceProportions& costs, const std::function<bool()>& stop);

/// @param mechanism  as for affects_poses()
/// @param options    gap: target of 1 - certified scale / scale of the violation
/// Throws std::invalid_argument with one sentence if a limit has no formula, or if all parameters that deviate are 0.
CertifiedTolerances certified_tolerances(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                         const ToleranceProportions& proportions, const BoundsOptions& options);

}  // namespace pkm::generic
