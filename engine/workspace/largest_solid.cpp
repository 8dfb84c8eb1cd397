#include "engine/workspace/largest_solid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/pose_product.hpp"
#include "engine/math/quadratic_program.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/solid_margins.hpp"
#include "engine/workspace/visualisation_plan.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kCellsOfSearch = 40;  // cells per axis of the initial search, for plans of columns
// sample intervals along a radius: first run, second run, final test
constexpr int kCoarseDensity = 2, kSampleDensity = 4, kFinalDensity = 6;
// value of CriticalPoint::margin that stands for a face of the search box
constexpr std::size_t kBoxFace = std::size_t(-1);

/// Determinant of the Jacobian G of a pose; NaN if it is undefined.
double determinant_of(const PoseReport& report) {
  return report.det_G.value_or(std::numeric_limits<double>::quiet_NaN());
}

using Faces = std::array<std::array<double, 2>, 3>;

/// Variables of the optimisation: free coordinates of the solid's centre, then its sizes, divided by a length, unit().
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
  /// Gradient of CriticalPoint::distance with respect to the variables; the distance, too, is divided by unit().
  Eigen::VectorXd gradient(const CriticalPoint& point) const {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(count());
    for (std::size_t i = 0; i < free_.size(); ++i) g[static_cast<Eigen::Index>(i)] = point.normal[free_[i]];
    for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis) {
      const std::size_t ball = spec_.shape.ball_of(axis);
      g[variable_of(ball)] += point.normal[axis] * point.unit[axis] / 2 * ratio(ball);
    }
    return g;
  }
  /// Logarithm of the solid's volume (without a constant), its gradient and the diagonal of its Hessian, which is
  /// diagonal.
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
  SolidRefinement(const SolidSpec& spec, const Faces& faces, SolidMargins& margins, const Solid& start)
      : spec_(spec), faces_(faces), margins_(margins), variables_(spec, start), like_(start) {}

  /// A point x of the iteration, with the constraints linearised there.
  struct Iterate {
    Eigen::VectorXd x;
    std::vector<CriticalPoint> points;
    Eigen::VectorXd multipliers = {};  ///< Lagrange multiplier of each critical point
    double log_volume = 0;
    Eigen::VectorXd gradient, hessian;
    double violation = 0;            ///< largest constraint violation, in units of SolidVariables::unit()
    Eigen::MatrixXd curvature = {};  ///< approximate Hessian of the Lagrangian at the end of a run
  };

  /// Iterates until convergence.
  /// @param last  result of an earlier run with fewer samples, from which this run continues. If a constraint is
  ///              violated there, the earlier run has missed a minimum of its margin, and this run starts anew
  Iterate run(const SolidSamples& samples, const Iterate* last = nullptr) {
    samples_ = &samples;
    constexpr double kMissed = 1e-6;  // violation in units of the size
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
      // Predicted decreases of the merit function below this value are dominated by rounding errors times the penalty.
      constexpr double kRounding = 1e-10;
      const bool is_final = predicted < kRounding;
      if (residual_ < kTolerance || iteration == kMaxIterations || final_steps == kMaxFinalSteps ||
          radius < kTolerance) {
        // Compute the final multipliers with the initial curvature: an almost singular update may have made the current
        // one very large.
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

  /// Shrinks the solid of the last iterate until no constraint is violated at `dense`, a set of more samples.
  /// @return the solid; all its dimensions are 0 if this fails
  Solid finish(Iterate& last, const SolidSamples& dense) {
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

  double residual() const { return residual_; }
  Solid solid(const Eigen::VectorXd& x) const { return variables_.solid(x, like_); }
  double unit() const { return variables_.unit(); }

 private:
  static constexpr int kMaxIterations = 80, kMaxFinalSteps = 25;
  static constexpr double kTolerance = 1e-12, kPenalty = 1e3, kNearby = 1e-2;

  /// Hessian of -log(volume), made positive definite.
  Eigen::MatrixXd initial_curvature(const Iterate& at) const {
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Identity(variables_.count(), variables_.count()) * 1e-3;
    curvature.diagonal() -= at.hessian;
    return curvature;
  }

  std::vector<CriticalPoint> critical_points(const Solid& solid, const SolidSamples& samples) {
    const double range = *std::ranges::max_element(solid.dimensions);
    std::vector<CriticalPoint> points = margins_.critical_points(solid, range, samples);
    add_faces(solid, points);
    return points;
  }

  /// Appends, for each face of the search box, the point of the solid nearest to it.
  void add_faces(const Solid& solid, std::vector<CriticalPoint>& points) const {
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

  /// Evaluates the objective and all constraints at x.
  /// @param before  the iterate from which `x` was reached; null: none
  /// @param length  length of the step from `before`; after a small step, the critical points of `before` are only
  ///                updated
  Iterate evaluate(const Eigen::VectorXd& x, const Iterate* before, double length) {
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
    // Keep points that were active in the last step, but are no local minima any more: a margin with many equal minima
    // (a sphere in a cylinder) would otherwise be represented by different points in each iteration.
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

  /// Adds the critical points of a rejected trial to the linear model, as a bundle method does: where a margin has many
  /// minima, those on the other side of the solid stop the next step. @return false if there is no new point
  bool add_points(const Iterate& trial, Iterate& now) {
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

  /// The critical point of the same constraint that is nearest to `to` in the unit solid; null if none is within
  /// `reach`.
  static const CriticalPoint* nearest(const std::vector<CriticalPoint>& points, const CriticalPoint& to, double reach) {
    const CriticalPoint* best = nullptr;
    for (const CriticalPoint& point : points) {
      if (point.margin != to.margin || point.orientation != to.orientation) continue;
      const double apart =
          std::hypot(point.unit[0] - to.unit[0], point.unit[1] - to.unit[1], point.unit[2] - to.unit[2]);
      if (apart > reach) continue;
      reach = apart;
      best = &point;
    }
    return best;
  }

  static double merit(const Iterate& at) { return -at.log_volume + kPenalty * at.violation; }

  struct Step {
    Eigen::VectorXd step, multipliers;
    double predicted = 0;  ///< predicted decrease of the merit function
  };

  /// Computes a step d: minimises c'd + d'Bd/2 + penalty * t for |d| <= radius, where t >= 0 relaxes the linearised
  /// constraints. Constraints that are satisfied for all these d are omitted.
  Step solve_program(const Iterate& at, const Eigen::MatrixXd& B, const Eigen::VectorXd& c, double radius) const {
    std::vector<std::size_t> near;  // indices of the critical points that are not omitted
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
  Step solve_step(const Iterate& now, const Eigen::MatrixXd& curvature, double radius) const {
    return solve_program(now, curvature, -now.gradient, radius);
  }

  /// Second-order correction of a trial step: moves to the nearest point that satisfies the constraints, linearised at
  /// the trial point. @return the corrected iterate, or `trial` if that has the lower merit function
  Iterate corrected(Iterate trial, double radius) {
    if (trial.violation < kTolerance / 10) return trial;
    const Eigen::Index n = variables_.count();
    const Step step = solve_program(trial, Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n), radius);
    Iterate better = evaluate(trial.x + step.step, &trial, step.step.lpNorm<Eigen::Infinity>());
    return merit(better) < merit(trial) ? better : trial;
  }

  /// Damped BFGS update of the Hessian of the Lagrangian (Nocedal and Wright, procedure 18.2).
  void update(Eigen::MatrixXd& B, const Iterate& from, const Iterate& to) const {
    const Eigen::VectorXd s = to.x - from.x;
    if (s.norm() < 1e-9) return;  // differences of gradients would be rounding errors
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

  const SolidSpec& spec_;
  const Faces& faces_;
  SolidMargins& margins_;
  const SolidSamples* samples_ = nullptr;  ///< samples of the current run
  SolidVariables variables_;
  Solid like_;
  double residual_ = 0;
};

}  // namespace

LargestSolidFinder::LargestSolidFinder(const Mechanism& mechanism, const WorkspacePlan& plan, SolidSpec spec,
                                       bool is_regular, std::vector<ReportMargin> reported)
    : mechanism_(mechanism),
      plan_(plan),
      spec_(std::move(spec)),
      is_regular_(is_regular),
      reported_(std::move(reported)),
      sweep_(sweep_of(mechanism.info(), plan)),
      coarse_samples_(spec_.shape.samples(kCoarseDensity)),
      samples_(spec_.shape.samples(kSampleDensity)),
      dense_samples_(spec_.shape.samples(kFinalDensity)) {
  const MechanismInfo& info = mechanism.info();
  if (!find_ordered_margins(mechanism))
    throw std::invalid_argument("mechanism " + info.name + " has no formulas of the margins of poses");
  for (const FixedCoordinate& fixed : plan.fixed)
    if (fixed.kind == FixedCoordinate::Kind::integrated)
      throw std::invalid_argument("the workspace integrates over " +
                                  info.coordinates[static_cast<std::size_t>(fixed.coordinate)].name +
                                  "; expected one value, or a list of values, in all of which the " +
                                  spec_.shape.name() + " has to be reachable");
  plan_.limits = workspace_limits(info, plan.limits);
  voxels_ =
      prepare_voxel_map(mechanism, visualisation_plan(info, plan_, {kCellsOfSearch, kCellsOfSearch, kCellsOfSearch}));
  if (mechanism.voxels() && info.joints.size() == info.coordinates.size())
    sides_ = mechanism.voxels()->prepare_sides(plan_, "");
}

std::vector<std::string> LargestSolidFinder::dimension_names() const {
  std::vector<std::string> axes;
  for (const int coordinate : sweep_.swept)
    axes.push_back(mechanism_.info().coordinates[static_cast<std::size_t>(coordinate)].name);
  return spec_.shape.dimension_names(axes);
}

std::vector<Pose<double>> LargestSolidFinder::orientations(std::span<const double> parameters) const {
  std::vector<Pose<double>> poses = {Pose<double>(mechanism_.info().coordinates.size())};
  for (const int coordinate : sweep_.fixed) {
    const FixedCoordinate how = how_fixed(plan_, coordinate);
    const std::vector<double> values = how.kind == FixedCoordinate::Kind::listed
                                           ? how.values
                                           : std::vector{fixed_value(mechanism_, parameters, plan_, coordinate)};
    poses = with_each(poses, coordinate, values);
  }
  return poses;
}

std::vector<PoseSolid> LargestSolidFinder::pose_solids(std::span<const double> parameters, const Solid& solid) const {
  std::vector<PoseSolid> all;
  for (const Pose<double>& fixed : orientations(parameters)) {
    PoseSolid made;
    for (const double value : fixed) made.ranges.push_back({value, value});
    for (std::size_t ball = 0; ball < spec_.shape.balls(); ++ball) {
      std::vector<std::size_t> coordinates;
      for (const std::size_t axis : spec_.shape.axes_of(ball)) {
        coordinates.push_back(static_cast<std::size_t>(sweep_.swept[axis]));
        const double half = solid.dimensions[ball] / 2;
        made.ranges[coordinates.back()] = {solid.centre[axis] - half, solid.centre[axis] + half};
      }
      if (coordinates.size() > 1) made.balls.push_back(coordinates);
    }
    all.push_back(std::move(made));
  }
  return all;
}

std::vector<std::int8_t> LargestSolidFinder::determinant_signs(std::span<const double> parameters,
                                                               std::span<const Pose<double>> poses,
                                                               const SolidMargins& margins) const {
  const auto sign_at = [&](const Pose<double>& pose) {
    const double determinant = determinant_of(margins.report(pose));
    return static_cast<std::int8_t>(determinant > 0 ? 1 : determinant < 0 ? -1 : 0);
  };
  std::vector<std::int8_t> signs(poses.size());
  if (!sides_) {
    std::ranges::transform(poses, signs.begin(), sign_at);
    return signs;
  }
  Scratch scratch;
  sides_->start(parameters, scratch);
  sides_->find(poses, true, scratch, signs);
  std::ranges::replace(signs, PoseSides::kSingular, std::int8_t{0});
  // det J is det G / det Jq up to its sign, and det Jq has one sign in a working mode.
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::int8_t sign = signs[i] == 0 ? std::int8_t{0} : sign_at(poses[i]);
    if (sign == 0) continue;
    if (sign != signs[i])
      for (std::int8_t& each : signs) each = static_cast<std::int8_t>(-each);
    break;
  }
  return signs;
}

SolidMargins LargestSolidFinder::margins(std::span<const double> parameters, double determinant) const {
  std::vector<ReportMargin> reported = reported_;
  if (determinant != 0)
    reported.push_back({"det G = 0, a parallel singularity",
                        [determinant](const PoseReport& report) { return determinant * determinant_of(report); }});
  return {mechanism_, parameters, plan_.limits, sweep_.swept, orientations(parameters), spec_.shape, reported};
}

LargestSolid LargestSolidFinder::find(std::span<const double> parameters) const {
  const VoxelMap map = voxels_->map(parameters);
  LargestSolid found = find(parameters, map, false);
  if (!is_regular_ || found.is_regular) return found;
  return find(parameters, map, true);
}

LargestSolid LargestSolidFinder::find(std::span<const double> parameters, const VoxelMap& map, bool is_regular) const {
  Faces faces;
  for (std::size_t axis = 0; axis < 3; ++axis) faces[axis] = {map.lower[axis], map.upper[axis]};
  const VoxelGrid grid(map);
  SolidMargins tests = margins(parameters, 0);
  const std::size_t count = tests.orientations().size();
  LargestSolid none;
  none.solid.dimensions.assign(spec_.shape.balls(), 0.0);

  // First search on the voxel grid: use cells that are feasible in all orientations and, if required, whose
  // determinants have one sign.
  std::vector<std::uint8_t> good = map.feasible;
  std::vector<std::size_t> cells;
  std::vector<Pose<double>> poses;  // poses at the centres of these cells
  Cell cell;
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        const std::size_t at = grid.index(cell);
        std::array<double, 3> point{};
        for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = grid.centre(axis, cell[axis]);
        if (good[at] && (count > 1 || !reported_.empty())) good[at] = tests.is_feasible(point);
        if (!good[at] || !is_regular) continue;
        cells.push_back(at);
        poses.push_back(tests.pose(point, 0));
      }
  const std::vector<std::int8_t> determinants = determinant_signs(parameters, poses, tests);
  std::optional<Solid> start;
  double sign = 0;
  for (const double side : is_regular ? std::vector{1.0, -1.0} : std::vector{0.0}) {
    std::vector<std::uint8_t> on_side = good;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!(side * determinants[i] > 0)) on_side[cells[i]] = 0;
    const auto solid = largest_solid_on_grid(grid, on_side, spec_);
    if (!solid || (start && spec_.shape.volume(solid->dimensions) <= spec_.shape.volume(start->dimensions))) continue;
    start = solid;
    sign = side;
  }
  if (!start) return none;
  if (is_regular) {
    const double size = std::fabs(determinant_of(tests.report(tests.pose(start->centre, 0))));
    if (size > 0) sign /= size;
  }

  // Then refine with the constraints themselves, first with few samples.
  SolidMargins constraints = margins(parameters, sign);
  SolidRefinement refinement(spec_, faces, constraints, *start);
  const SolidRefinement::Iterate coarse = refinement.run(coarse_samples_);
  SolidRefinement::Iterate last = refinement.run(samples_, &coarse);
  LargestSolid found;
  found.solid = refinement.finish(last, dense_samples_);
  found.volume = spec_.shape.volume(found.solid.dimensions);
  if (!(found.volume > 0)) return none;
  found.residual = refinement.residual();
  found.determinant = sign;
  found.samples = dense_samples_.points.size() * count;
  const std::vector<std::string> names = constraints.names();
  for (std::size_t k = 0; k < last.points.size(); ++k) {
    const CriticalPoint& point = last.points[k];
    const double multiplier = last.multipliers[static_cast<Eigen::Index>(k)];
    // maximum distance of a contact, in units of the size; minimum multiplier of an active constraint
    constexpr double kTouches = 1e-9, kActive = 1e-6;
    if (point.norm == 0 || (std::fabs(point.distance) > kTouches * refinement.unit() && multiplier < kActive)) continue;
    Contact contact{.pose = constraints.pose(refinement.solid(last.x).at(spec_.shape, point.unit), point.orientation),
                    .multiplier = multiplier < kActive ? 0 : multiplier / (refinement.unit() * point.norm),
                    .margin = point.margin,
                    .unit = point.unit};
    if (point.margin != kBoxFace) {
      contact.constraint = names[point.margin];
    } else {
      const auto axis = static_cast<std::size_t>(std::ranges::find_if(point.unit, [](double u) { return u != 0; }) -
                                                 point.unit.begin());
      contact.constraint = "box, " + mechanism_.info().coordinates[static_cast<std::size_t>(sweep_.swept[axis])].name +
                           (point.unit[axis] > 0 ? " max" : " min");
    }
    found.contacts.push_back(std::move(contact));
  }
  if (sign == 0) {
    for (std::size_t k = 0; k < count; ++k) {
      poses.clear();
      for (const UnitPoint& unit : samples_.points) poses.push_back(tests.pose(found.solid.at(spec_.shape, unit), k));
      const std::vector<std::int8_t> signs = determinant_signs(parameters, poses, tests);
      if (std::ranges::count(signs, 1) > 0 && std::ranges::count(signs, -1) > 0) found.is_regular = false;
    }
  }
  return found;
}

Dual4 LargestSolidFinder::volume(std::span<const Dual4> parameters, const LargestSolid& found) const {
  Dual4 result(found.volume);
  std::vector<double> values;
  for (const Dual4& parameter : parameters) values.push_back(parameter.a);
  SolidMargins constraints = margins(values, found.determinant);
  for (const Contact& contact : found.contacts) {
    if (contact.multiplier == 0) continue;
    const double factor = found.volume * contact.multiplier;
    if (contact.margin != kBoxFace) {
      const Dual4 margin = constraints.by_parameters(parameters, contact.margin, contact.pose);
      for (int k = 0; k < 4; ++k) result.v[k] += factor * margin.v[k];
      continue;
    }
    // The face of a search box that is computed for each design.
    const std::optional<Box>& fixed = plan_.box();
    if (fixed) continue;
    const auto axis = static_cast<std::size_t>(std::ranges::find_if(contact.unit, [](double u) { return u != 0; }) -
                                               contact.unit.begin());
    double size = 0;
    for (const double value : values) size = std::max(size, std::fabs(value));
    const double step = 1e-6 * size;
    for (int k = 0; k < 4; ++k) {
      const auto face = [&](double steps) {
        std::vector<double> moved = values;
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += steps * step * parameters[i].v[k];
        const VoxelMap map = voxels_->map(moved);
        return contact.unit[axis] > 0 ? map.upper[axis] : -map.lower[axis];
      };
      result.v[k] += factor * (face(1) - face(-1)) / (2 * step);
    }
  }
  return result;
}

}  // namespace pkm
