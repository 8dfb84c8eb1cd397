// Local search for the robot with the smallest deviations of its parameters that violates a constraint at some pose.
//
// The axes of the constraints are coordinates, followed by deviations d_i of parameters. At a pose, a constraint g is
// violated first, to first order, in the corner d_i = -t sign(dg/dd_i) of the box |d_i| <= t, with
//
//     t = g / sum_i |dg/dd_i|        (1)
//
// A grid of poses is sampled; from the poses with the smallest t, (1) is minimised by pattern search (Hooke and Jeeves)
// over the poses, and the corner is then followed by Newton's method. Every violation that is returned is certified by
// interval arithmetic. A smaller one may exist.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "engine/workspace/bounds/parametric_constraints.hpp"

namespace pkm::bounds {

struct Violation {
  double scale = 0;  ///< maximum of |d_i| over the deviations d_i of the violation
  std::size_t constraint = 0;
  /// Values of the coordinates, then of the deviations, at which the constraint is violated.
  std::vector<double> point;
  /// Derivatives of the constraint with respect to all axes, close to `point`; empty if the scale is 0.
  std::vector<double> gradient;
};

class ViolationSearch {
 public:
  /// @param ranges  ranges of the coordinates, the first axes; the remaining axes are deviations
  ViolationSearch(const ParametricConstraints& constraints, std::span<const std::array<double, 2>> ranges)
      : constraints_(constraints), ranges_(ranges) {}

  /// The violation with the smallest scale that the local search finds.
  /// @param limit  only scales up to this value are searched
  /// @param stop   returns true to stop with what has been found
  std::optional<Violation> search(double limit, const std::function<bool()>& stop) const;

  /// A violation of constraint k at a pose. The vertices of the box of deviations that the gradients indicate are
  /// tried; std::nullopt if no violation with a scale below `limit` is found.
  std::optional<Violation> at_pose(std::size_t k, std::span<const double> pose, double limit,
                                   ParametricConstraints::Scratch& scratch) const;

  /// The violation of constraint k at a pose with the smallest t along the ray d = t s of the deviations d;
  /// std::nullopt if none is found up to t = `limit`.
  /// @param s      direction with max |s_i| = 1
  /// @param scale  initial estimate of t
  std::optional<Violation> along(std::size_t k, std::span<const double> pose, std::span<const double> s, double scale,
                                 double limit, ParametricConstraints::Scratch& scratch) const;

 private:
  /// First-order estimate g / sum_i |dg/dd_i| of the scale at which constraint k is violated: 0 if it is violated at
  /// `point` itself, infinity if it does not depend on the deviations d_i.
  /// @param gradient  receives the derivatives at the pose
  double first_order(std::size_t k, std::span<const double> point, std::vector<double>& gradient,
                     ParametricConstraints::Scratch& scratch) const;
  std::vector<double> minimise(std::size_t k, std::vector<double> point, ParametricConstraints::Scratch& scratch) const;

  const ParametricConstraints& constraints_;
  std::span<const std::array<double, 2>> ranges_;
};

}  // namespace pkm::bounds
