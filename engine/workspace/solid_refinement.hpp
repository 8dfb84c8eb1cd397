// Refinement of a solid in the workspace: exchange of critical points with sequential quadratic programming
// (largest_solid.hpp).
#pragma once

#include <Eigen/Core>

#include "engine/workspace/solid_margins.hpp"
#include "engine/workspace/solid_on_grid.hpp"

namespace pkm {

/// Variables of the optimisation: the sizes of the solid and the free coordinates of its centre, both divided by
/// unit(), the largest dimension of the initial solid.
class SolidVariables {
 public:
  SolidVariables(const SolidSpec& spec, const Solid& start) : spec_(spec) {
    for (std::size_t axis = 0; axis < spec.shape.axes(); ++axis)
      if (!spec.centre[axis]) free_.push_back(axis);
    unit_ = *std::ranges::max_element(start.dimensions);
  }

  double unit() const { return unit_; }
  Eigen::Index sizes() const { return spec_.ratio.empty() ? static_cast<Eigen::Index>(spec_.shape.balls()) : 1; }
  Eigen::Index count() const { return first_size() + sizes(); }
  Eigen::Index first_size() const { return static_cast<Eigen::Index>(free_.size()); }

  Eigen::VectorXd values(const Solid& solid) const {
    Eigen::VectorXd x(count());
    for (std::size_t i = 0; i < free_.size(); ++i) x[static_cast<Eigen::Index>(i)] = solid.centre[free_[i]] / unit_;
    for (Eigen::Index i = 0; i < sizes(); ++i)
      x[first_size() + i] = solid.dimensions[static_cast<std::size_t>(i)] / ratio(static_cast<std::size_t>(i)) / unit_;
    return x;
  }
  Solid solid(const Eigen::VectorXd& x, const Solid& like) const {
    Solid made = like;
    for (std::size_t i = 0; i < free_.size(); ++i) made.centre[free_[i]] = x[static_cast<Eigen::Index>(i)] * unit_;
    for (std::size_t ball = 0; ball < spec_.shape.balls(); ++ball)
      made.dimensions[ball] = x[variable_of(ball)] * ratio(ball) * unit_;
    return made;
  }
  /// Derivatives of CriticalPoint::distance / unit() with respect to the variables.
  Eigen::VectorXd gradient(const CriticalPoint& point) const {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(count());
    for (std::size_t i = 0; i < free_.size(); ++i) g[static_cast<Eigen::Index>(i)] = point.normal[free_[i]];
    for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis) {
      const std::size_t ball = spec_.shape.ball_of(axis);
      g[variable_of(ball)] += point.normal[axis] * point.unit[axis] / 2 * ratio(ball);
    }
    return g;
  }
  /// log(volume) up to a constant, its gradient, and the diagonal of its Hessian, which is a diagonal matrix.
  double log_volume(const Eigen::VectorXd& x, Eigen::VectorXd& gradient, Eigen::VectorXd& hessian) const {
    double sum = 0;
    gradient = hessian = Eigen::VectorXd::Zero(count());
    for (std::size_t ball = 0; ball < spec_.shape.balls(); ++ball) {
      const double power = static_cast<double>(spec_.shape.axes_of(ball).size());
      const Eigen::Index i = variable_of(ball);
      sum += power * std::log(x[i]);
      gradient[i] += power / x[i];
      hessian[i] -= power / (x[i] * x[i]);
    }
    return sum;
  }

 private:
  double ratio(std::size_t ball) const { return spec_.ratio.empty() ? 1 : spec_.ratio[ball]; }
  Eigen::Index variable_of(std::size_t ball) const {
    return first_size() + (spec_.ratio.empty() ? static_cast<Eigen::Index>(ball) : 0);
  }

  const SolidSpec& spec_;
  std::vector<std::size_t> free_;
  double unit_ = 1;
};

/// Sequential quadratic programming with a trust region and the L-infinity merit function
/// -log(volume) + penalty * (largest violation); every step is followed by a second-order correction.
class SolidRefinement {
 public:
  using Faces = std::array<std::array<double, 2>, 3>;       ///< lower and upper bound of the search box, by axis
  static constexpr std::size_t kBoxFace = std::size_t(-1);  ///< value of CriticalPoint::margin for points that belong
                                                            ///< to a face of the search box

  SolidRefinement(const SolidSpec& spec, const Faces& faces, SolidMargins& margins, const Solid& start)
      : spec_(spec), faces_(faces), margins_(margins), variables_(spec, start), like_(start) {}

  /// An iterate of sequential quadratic programming: a solid, its critical points and the local model.
  struct Iterate {
    Eigen::VectorXd x;
    std::vector<CriticalPoint> points;
    Eigen::VectorXd multipliers = {};  ///< Lagrange multipliers, one for each of `points`
    double log_volume = 0;
    Eigen::VectorXd gradient, hessian;
    double violation = 0;            ///< largest violation of a constraint, in units of SolidVariables::unit()
    Eigen::MatrixXd curvature = {};  ///< approximate Hessian of the Lagrangian at the end of a run
  };

  /// Iterates until convergence.
  /// @param last  final iterate of an earlier run with fewer samples. The run continues from it, unless a constraint is
  ///   violated there, because the earlier samples missed a minimum of its margin
  Iterate run(const SolidSamples& samples, const Iterate* last = nullptr);

  /// The solid of an iterate, shrunk until no constraint is violated.
  /// @param dense  other samples of the solid, from which the critical points are found
  Solid finish(Iterate& last, const SolidSamples& dense);

  double residual() const { return residual_; }
  Solid solid(const Eigen::VectorXd& x) const { return variables_.solid(x, like_); }
  double unit() const { return variables_.unit(); }

 private:
  static constexpr int kMaxIterations = 80, kMaxFinalSteps = 25;
  static constexpr double kTolerance = 1e-12, kPenalty = 1e3, kNearby = 1e-2;

  /// Hessian of -log(volume), made positive definite.
  Eigen::MatrixXd initial_curvature(const Iterate& at) const;

  std::vector<CriticalPoint> critical_points(const Solid& solid, const SolidSamples& samples);

  /// Adds the points of the solid nearest to the faces of the search box.
  void add_faces(const Solid& solid, std::vector<CriticalPoint>& points) const;

  /// Evaluates the solid with the variables `x`: its volume, its critical points and the violation of the constraints.
  /// @param before  the iterate from which `x` was reached; null: none
  /// @param length  length of the step from `before` to `x`; after small steps only the critical points of `before` are
  ///   followed
  Iterate evaluate(const Eigen::VectorXd& x, const Iterate* before, double length);

  /// Adds the critical points of a rejected trial to the linear model, as a bundle method does: where a margin has many
  /// minima, those on the other side of the solid stop the next step. @return false if there is no new point
  bool add_points(const Iterate& trial, Iterate& now);

  /// Among the critical points of the same constraint, the one that is nearest to a given critical point; null if none
  /// is within the distance `reach` in the unit solid.
  static const CriticalPoint* nearest(const std::vector<CriticalPoint>& points, const CriticalPoint& to, double reach);

  static double merit(const Iterate& at) { return -at.log_volume + kPenalty * at.violation; }

  struct Step {
    Eigen::VectorXd step, multipliers;
    double predicted = 0;  ///< decrease of the merit function that the quadratic model predicts
  };

  /// Minimises c'd + d'Bd/2 + penalty * t subject to the linearised constraints, which t >= 0 relaxes, and |d| <=
  /// radius. Constraints that hold for all these d are omitted.
  Step solve_program(const Iterate& at, const Eigen::MatrixXd& B, const Eigen::VectorXd& c, double radius) const;
  Step solve_step(const Iterate& now, const Eigen::MatrixXd& curvature, double radius) const;

  /// Second-order correction: the nearest point that satisfies the constraints, linearised at the trial point.
  Iterate corrected(Iterate trial, double radius);

  /// Damped BFGS update of the Hessian of the Lagrangian (Nocedal and Wright, procedure 18.2).
  void update(Eigen::MatrixXd& B, const Iterate& from, const Iterate& to) const;

  const SolidSpec& spec_;
  const Faces& faces_;
  SolidMargins& margins_;
  const SolidSamples* samples_ = nullptr;  ///< samples of the solid in the current run
  SolidVariables variables_;
  Solid like_;
  double residual_ = 0;
};

}  // namespace pkm
