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
  std::vector<std::array<double, 2>> ranges = {};  ///< range of each coordinate; lower = upper fixes a coordinate
  const Motion* motion = nullptr;  ///< motion that is examined instead of `ranges`; null: `ranges` is examined
};

/// Deviations of parameters, which are independent of each other: each is at most a common scale times its size.
struct ToleranceProportions {
  std::vector<std::size_t> parameters;  ///< indices of the parameters that deviate
  std::vector<double> sizes;            ///< maximum deviation of each of these parameters at scale 1 [SI], > 0
};

/// A robot whose parameters deviate from the design and that does not do the task. If the scale is 0, the design itself
/// does not do it.
struct ToleranceViolation {
  double scale = 0;                ///< maximum over the parameters of deviation / ToleranceProportions::sizes
  std::vector<double> parameters;  ///< values of all parameters of the robot [SI]
  std::string constraint;          ///< name of the constraint that the robot violates, or of the singularity
  Pose<double> pose;               ///< pose at which the robot violates the constraint or is singular
  /// Time in the motion at which the robot violates the constraint or is singular [s]; std::nullopt for ranges of
  /// poses.
  std::optional<double> time;
};

struct CertifiedTolerances {
  double scale = 0;  ///< all robots whose deviations have at most this scale are proved to do the task
  std::optional<ToleranceViolation> violation;  ///< the robot of smallest scale that is known not to do the task
  double largest_scale = 0;           ///< scale at which a parameter could become 0; larger ones are not examined
  Unsupported no_singularities = {};  ///< reason why singularities were not examined; empty if they were
  std::size_t boxes = 0;              ///< number of boxes examined
  bool stopped = false;
};

/// Whether a constraint of a pose or a singularity depends on a parameter, for all parameters of a mechanism that
/// evaluation_of() accepts.
std::vector<bool> affects_poses(const Mechanism& mechanism, const LimitSpec& limits);

/// Proportions of approximately minimum cost, if a tolerance t_i costs sizes[i] / t_i. The tolerances at scale 1 are
/// close to the largest ones, but not certified; none exceeds a tenth of its parameter. Cutting planes: the violations
/// that a local search finds give linear constraints of the tolerances.
/// @param costs  the parameters that deviate; costs.sizes[i] is the cost of a tolerance of 1 [SI] of parameters[i]
/// @param stop   returns true to stop with the proportions found so far
ToleranceProportions cheapest_proportions(const Mechanism& mechanism, std::span<const double> parameters,
                                          const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                          const ToleranceProportions& costs, const std::function<bool()>& stop);

/// Finds the largest scale of the deviations up to which all robots are proved to do the task.
/// @param mechanism  one that evaluation_of() accepts
/// @param options    gap: the search ends if 1 - certified scale / scale of the known violation is at most this
/// Throws std::invalid_argument with one sentence if a limit has no formula, or if all parameters that deviate are 0.
CertifiedTolerances certified_tolerances(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode, const PoseSet& poses,
                                         const ToleranceProportions& proportions, const BoundsOptions& options);

}  // namespace pkm::generic
