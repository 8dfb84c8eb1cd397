#include "engine/workspace/solid_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/quadratic_program.hpp"

namespace pkm {

SolidRefinement::Iterate SolidRefinement::run(const SolidSamples& samples, const Iterate* last) {
  samples_ = &samples;
  constexpr double kMissed = 1e-6;  // violation, in units of the size, at which `last` is discarded
  Iterate now = evaluate(last ? last->x : variables_.values(like_), nullptr, 1);
  if (last && now.violation > kMissed) {
    last = nullptr;
    now = evaluate(variables_.values(like_), nullptr, 1);
  }
  Eigen::MatrixXd curvature = last ? last->curvature : initial_curvature(now);
  double radius = 0.3;
  int final_steps = 0;
  for (int iteration = 0;; ++iteration) {
    const auto [step, multipliers, predicted] = solve_step(now, curvature, radius);
    now.multipliers = multipliers;
    const double length = step.lpNorm<Eigen::Infinity>();
    residual_ = length + now.violation;
    // Smaller differences of the merit function are due to rounding errors of violations, multiplied by the penalty.
    constexpr double kRounding = 1e-10;
    const bool is_final = predicted < kRounding;
    if (residual_ < kTolerance || iteration == kMaxIterations || final_steps == kMaxFinalSteps || radius < kTolerance) {
      // Compute the multipliers with the initial curvature, because an almost singular update may have made the
      // curvature very large.
      now.multipliers = solve_step(now, initial_curvature(now), kNearby).multipliers;
      now.curvature = curvature;
      return now;
    }
    final_steps += is_final ? 1 : 0;
    if (final_steps == kMaxFinalSteps / 2) curvature = initial_curvature(now);
    const Iterate trial = corrected(evaluate(now.x + step, &now, length), radius);
    const double actual = merit(now) - merit(trial);
    if (!(is_final ? actual > -kRounding : actual >= 0.05 * predicted)) {
      if (!add_points(trial, now)) radius = std::min(radius, length) / 4;
      continue;
    }
    if (actual > 0.7 * predicted && length > 0.9 * radius) radius = std::min(2 * radius, 0.5);
    update(curvature, now, trial);
    now = trial;
  }
}

Solid SolidRefinement::finish(Iterate& last, const SolidSamples& dense) {
  Solid found = solid(last.x);
  constexpr int kMaxRounds = 60;
  for (int round = 0; round < kMaxRounds; ++round) {
    double violation = 0;
    for (const CriticalPoint& point : critical_points(found, dense)) violation = std::max(violation, -point.distance);
    if (violation <= 1e-14 * variables_.unit()) return found;
    const double smallest = *std::ranges::min_element(found.dimensions);
    const double factor = std::max(0.5, 1 - 2.1 * violation / smallest);
    for (double& dimension : found.dimensions) dimension *= factor;
  }
  found.dimensions.assign(found.dimensions.size(), 0.0);
  return found;
}

Eigen::MatrixXd SolidRefinement::initial_curvature(const Iterate& at) const {
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Identity(variables_.count(), variables_.count()) * 1e-3;
  curvature.diagonal() -= at.hessian;
  return curvature;
}

std::vector<CriticalPoint> SolidRefinement::critical_points(const Solid& solid, const SolidSamples& samples) {
  const double range = *std::ranges::max_element(solid.dimensions);
  std::vector<CriticalPoint> points = margins_.critical_points(solid, range, samples);
  add_faces(solid, points);
  return points;
}

void SolidRefinement::add_faces(const Solid& solid, std::vector<CriticalPoint>& points) const {
  for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis)
    for (std::size_t end = 0; end < 2; ++end) {
      const double sign = end == 0 ? 1 : -1;
      CriticalPoint face{kBoxFace, 0};
      face.unit[axis] = -sign;
      face.normal[axis] = sign;
      face.norm = 1;
      face.distance = sign * (solid.at(spec_.shape, face.unit)[axis] - faces_[axis][end]);
      points.push_back(face);
    }
}

SolidRefinement::Iterate SolidRefinement::evaluate(const Eigen::VectorXd& x, const Iterate* before, double length) {
  constexpr double kSmallStep = 0.02;
  Iterate made{.x = x};
  const Solid here = solid(x);
  if (!before || length > kSmallStep) {
    made.points = critical_points(here, *samples_);
  } else {
    for (const CriticalPoint& old : before->points) {
      if (old.margin == kBoxFace) continue;
      const CriticalPoint point = margins_.minimise(here, old.margin, old.orientation, old.unit);
      if (std::isfinite(point.distance) && !nearest(made.points, point, 1e-6)) made.points.push_back(point);
    }
    add_faces(here, made.points);
  }
  // Keep the points whose constraints were active in the last step, even if they are not local minima any more.
  // Otherwise a margin with many equal minima (a sphere in a cylinder) would be represented by different minima in each
  // iteration.
  for (Eigen::Index k = 0; before && k < before->multipliers.size(); ++k) {
    const CriticalPoint& old = before->points[static_cast<std::size_t>(k)];
    if (old.margin == kBoxFace || old.norm == 0 || before->multipliers[k] < 1e-6 || nearest(made.points, old, 0.05))
      continue;
    const CriticalPoint kept = margins_.linearised(here, old.margin, old.orientation, old.unit);
    if (std::isfinite(kept.distance)) made.points.push_back(kept);
  }
  made.log_volume = variables_.log_volume(x, made.gradient, made.hessian);
  for (const CriticalPoint& point : made.points)
    made.violation = std::max(made.violation, -point.distance / variables_.unit());
  return made;
}

bool SolidRefinement::add_points(const Iterate& trial, Iterate& now) {
  constexpr double kNew = 0.05, kNear = 0.1;
  const Solid here = solid(now.x);
  const std::size_t before = now.points.size();
  for (const CriticalPoint& point : trial.points) {
    if (point.margin == kBoxFace || point.norm == 0 || point.distance > kNear * variables_.unit() ||
        nearest(now.points, point, kNew))
      continue;
    const CriticalPoint added = margins_.linearised(here, point.margin, point.orientation, point.unit);
    if (std::isfinite(added.distance)) now.points.push_back(added);
  }
  return now.points.size() > before;
}

const CriticalPoint* SolidRefinement::nearest(const std::vector<CriticalPoint>& points, const CriticalPoint& to,
                                              double reach) {
  const CriticalPoint* best = nullptr;
  for (const CriticalPoint& point : points) {
    if (point.margin != to.margin || point.orientation != to.orientation) continue;
    const double apart = std::hypot(point.unit[0] - to.unit[0], point.unit[1] - to.unit[1], point.unit[2] - to.unit[2]);
    if (apart > reach) continue;
    reach = apart;
    best = &point;
  }
  return best;
}

SolidRefinement::Step SolidRefinement::solve_program(const Iterate& at, const Eigen::MatrixXd& B,
                                                     const Eigen::VectorXd& c, double radius) const {
  std::vector<std::size_t> near;  // indices of the points whose constraints the step can reach
  for (std::size_t k = 0; k < at.points.size(); ++k)
    if (at.points[k].distance <= variables_.gradient(at.points[k]).lpNorm<1>() * radius * variables_.unit())
      near.push_back(k);
  const Eigen::Index n = variables_.count(), m = static_cast<Eigen::Index>(near.size());
  QuadraticProgram program;
  program.B = Eigen::MatrixXd::Identity(n + 1, n + 1) * 1e-8;
  program.B.topLeftCorner(n, n) += B;
  program.c = Eigen::VectorXd(n + 1);
  program.c << c, kPenalty;
  program.A = Eigen::MatrixXd::Zero(m + 1 + 2 * n, n + 1);
  program.b = Eigen::VectorXd::Zero(m + 1 + 2 * n);
  for (Eigen::Index k = 0; k < m; ++k) {
    const CriticalPoint& point = at.points[near[static_cast<std::size_t>(k)]];
    program.A.row(k).head(n) = variables_.gradient(point).transpose();
    program.A(k, n) = 1;
    program.b[k] = -point.distance / variables_.unit();
  }
  program.A(m, n) = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double shrinkage = i < variables_.first_size() ? radius : std::min(radius, 0.9 * at.x[i]);
    program.A(m + 1 + 2 * i, i) = 1;
    program.b[m + 1 + 2 * i] = -shrinkage;
    program.A(m + 2 + 2 * i, i) = -1;
    program.b[m + 2 + 2 * i] = -radius;
  }
  const QuadraticSolution solution = solve(program);
  Step found{solution.x.head(n), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(at.points.size()))};
  for (std::size_t k = 0; k < near.size(); ++k)
    found.multipliers[static_cast<Eigen::Index>(near[k])] = solution.multipliers[static_cast<Eigen::Index>(k)];
  found.predicted = -c.dot(found.step) - 0.5 * found.step.dot(B * found.step) +
                    kPenalty * (at.violation - std::max(0.0, solution.x[n]));
  return found;
}

SolidRefinement::Step SolidRefinement::solve_step(const Iterate& now, const Eigen::MatrixXd& curvature,
                                                  double radius) const {
  return solve_program(now, curvature, -now.gradient, radius);
}

SolidRefinement::Iterate SolidRefinement::corrected(Iterate trial, double radius) {
  if (trial.violation < kTolerance / 10) return trial;
  const Eigen::Index n = variables_.count();
  const Step step = solve_program(trial, Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n), radius);
  Iterate better = evaluate(trial.x + step.step, &trial, step.step.lpNorm<Eigen::Infinity>());
  return merit(better) < merit(trial) ? better : trial;
}

void SolidRefinement::update(Eigen::MatrixXd& B, const Iterate& from, const Iterate& to) const {
  const Eigen::VectorXd s = to.x - from.x;
  if (s.norm() < 1e-9) return;  // the differences of gradients would be rounding errors
  Eigen::VectorXd y = from.gradient - to.gradient;
  for (Eigen::Index k = 0; k < from.multipliers.size(); ++k) {
    if (from.multipliers[k] < 1e-6) continue;
    const CriticalPoint& old = from.points[static_cast<std::size_t>(k)];
    if (old.margin == kBoxFace) continue;
    const CriticalPoint* const same = nearest(to.points, old, 0.5);
    if (!same) return;
    y -= from.multipliers[k] * (variables_.gradient(*same) - variables_.gradient(old));
  }
  const Eigen::VectorXd Bs = B * s;
  const double sBs = s.dot(Bs), sy = s.dot(y);
  const double theta = sy >= 0.2 * sBs ? 1 : 0.8 * sBs / (sBs - sy);
  const Eigen::VectorXd r = theta * y + (1 - theta) * Bs;
  B += r * r.transpose() / s.dot(r) - Bs * Bs.transpose() / sBs;
}

}  // namespace pkm
