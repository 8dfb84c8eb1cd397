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
  double scale = 0;  ///< maximum of |d_i|
  std::size_t constraint = 0;
  std::vector<double> point;     ///< coordinates, deviations
  std::vector<double> gradient;  ///< of the constraint by the axes, close to the point; empty if the scale is 0
};

class ViolationSearch {
 public:
  /// @param ranges  of the coordinates; the remaining axes are deviations
  ViolationSearch(const ParametricConstraints& constraints, std::span<const std::array<double, 2>> ranges)
      : constraints_(constraints), ranges_(ranges) {}

  /// The violation with the smallest scale that the local search finds.
  /// @param limit  only scales up to this value are searched
  /// @param stop   returns true to stop with what has been found
  std::optional<Violation> search(double limit, const std::function<bool()>& stop) const;

  /// A violation of constraint k at a pose in the corners given by its gradients; std::nullopt if none is found below
  /// `limit`.
  std::optional<Violation> at_pose(std::size_t k, std::span<const double> pose, double limit,
                                   ParametricConstraints::Scratch& scratch) const;

  /// The first violation of constraint k at a pose along the ray d = t s; std::nullopt if none is found up to `limit`.
  /// @param s      not longer than 1 along each axis, with the length 1 along one of them
  /// @param scale  initial estimate of t
  std::optional<Violation> along(std::size_t k, std::span<const double> pose, std::span<const double> s, double scale,
                                 double limit, ParametricConstraints::Scratch& scratch) const;

 private:
  /// The scale of (1): 0 if the constraint is violated for d = 0, infinity if it does not depend on d.
  /// @param gradient  receives the derivatives at the pose
  double first_order(std::size_t k, std::span<const double> point, std::vector<double>& gradient,
                     ParametricConstraints::Scratch& scratch) const;
  std::vector<double> minimise(std::size_t k, std::vector<double> point, ParametricConstraints::Scratch& scratch) const;

  const ParametricConstraints& constraints_;
  std::span<const std::array<double, 2>> ranges_;
};

}  // namespace pkm::bounds
