#include "engine/workspace/solid_margins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/eigen_solvers.hpp"

namespace pkm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double norm_of(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

/// Whether a pose is infeasible: at least one of its margins is negative or does not exist (NaN).
bool is_infeasible(std::span<const double> margins) {
  return !std::ranges::all_of(margins, [](double margin) { return margin >= 0; });
}

}  // namespace

SolidMargins::SolidMargins(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                           std::vector<int> swept, std::vector<Pose<double>> orientations, const SolidShape& shape,
                           std::vector<ReportMargin> reported)
    : mechanism_(mechanism),
      ordered_(*find_ordered_margins(mechanism)),
      parameters_(parameters.begin(), parameters.end()),
      limits_(limits),
      swept_(std::move(swept)),
      orientations_(std::move(orientations)),
      shape_(shape),
      reported_(std::move(reported)),
      count_(ordered_.margin_names(limits).size() + reported_.size()),
      dual_parameters_(parameters.begin(), parameters.end()) {}

std::vector<std::string> SolidMargins::names() const {
  std::vector<std::string> names = ordered_.margin_names(limits_);
  for (const ReportMargin& margin : reported_) names.push_back(margin.name);
  return names;
}

Pose<double> SolidMargins::pose(const std::array<double, 3>& point, std::size_t orientation) const {
  Pose<double> pose = orientations_[orientation];
  for (std::size_t axis = 0; axis < swept_.size(); ++axis) pose[static_cast<std::size_t>(swept_[axis])] = point[axis];
  return pose;
}

PoseReport SolidMargins::report(const Pose<double>& pose) const {
  return mechanism_.inspect(parameters_, pose, mechanism_.info().modes.front(), limits_);
}

void SolidMargins::append(std::span<const double> parameters, std::span<const Pose<double>> poses,
                          std::vector<double>& margins) {
  if (reported_.empty()) return ordered_.append_ordered(parameters, "", limits_, poses, scratch_, margins);
  for (const Pose<double>& pose : poses) {
    ordered_.append_ordered(parameters, "", limits_, {&pose, 1}, scratch_, margins);
    const PoseReport report = mechanism_.inspect(parameters, pose, mechanism_.info().modes.front(), limits_);
    for (const ReportMargin& margin : reported_) margins.push_back(report.assembles ? margin.value(report) : kNaN);
  }
}

double SolidMargins::value(std::span<const double> parameters, std::size_t margin, const Pose<double>& pose) {
  std::vector<double>& margins = values_;
  margins.clear();
  append(parameters, {&pose, 1}, margins);
  return margins[margin];
}

bool SolidMargins::is_feasible(const std::array<double, 3>& point) {
  for (std::size_t k = 0; k < orientations_.size(); ++k) {
    const Pose<double> at = pose(point, k);
    values_.clear();
    append(parameters_, {&at, 1}, values_);
    if (is_infeasible(values_)) return false;
  }
  return true;
}

SolidMargins::Gradient SolidMargins::gradient(std::size_t margin, const Pose<double>& pose) {
  // The values are cached, because consecutive calls often need other margins of the same pose.
  if (!dual_pose_ || !(*dual_pose_ == pose)) {
    Pose<Dual4> seeded(pose.size());
    for (std::size_t i = 0; i < pose.size(); ++i) seeded[i] = Dual4(pose[i]);
    for (std::size_t axis = 0; axis < swept_.size(); ++axis)
      seeded[static_cast<std::size_t>(swept_[axis])].v[static_cast<int>(axis)] = 1;
    duals_.clear();
    ordered_.append_ordered(std::span<const Dual4>(dual_parameters_), "", limits_, {&seeded, 1}, scratch_, duals_);
    dual_pose_ = pose;
  }
  Gradient found;
  if (margin < duals_.size() && std::isfinite(duals_[margin].a)) {
    found.value = duals_[margin].a;
    for (std::size_t axis = 0; axis < swept_.size(); ++axis)
      found.by_axis[axis] = duals_[margin].v[static_cast<int>(axis)];
    return found;
  }
  // The margin has no derivatives: use central differences of order 4.
  found.value = value(parameters_, margin, pose);
  double size = 0;
  for (const int coordinate : swept_) size = std::max(size, std::fabs(pose[static_cast<std::size_t>(coordinate)]));
  const double step = 1e-4 * std::max(size, 1e-3);
  for (std::size_t axis = 0; axis < swept_.size(); ++axis) {
    const auto at = [&](double steps) {
      Pose<double> moved = pose;
      moved[static_cast<std::size_t>(swept_[axis])] += steps * step;
      return value(parameters_, margin, moved);
    };
    found.by_axis[axis] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
  }
  return found;
}

Dual4 SolidMargins::by_parameters(std::span<const Dual4> parameters, std::size_t margin, const Pose<double>& pose) {
  Pose<Dual4> fixed(pose.size());
  for (std::size_t i = 0; i < pose.size(); ++i) fixed[i] = Dual4(pose[i]);
  duals_.clear();
  dual_pose_.reset();
  ordered_.append_ordered(parameters, "", limits_, {&fixed, 1}, scratch_, duals_);
  if (margin < duals_.size() && std::isfinite(duals_[margin].a)) return duals_[margin];
  Dual4 found(value(parameters_, margin, pose));
  double size = 0;
  for (const Dual4& parameter : parameters) size = std::max(size, std::fabs(parameter.a));
  const double step = 1e-4 * size;
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](double steps) {
      std::vector<double> moved = parameters_;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += steps * step * parameters[i].v[k];
      return value(moved, margin, pose);
    };
    found.v[k] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
  }
  return found;
}

CriticalPoint SolidMargins::plane_across_ray(const Solid& solid, std::size_t margin, std::size_t orientation,
                                             const UnitPoint& unit) {
  const std::array<double, 3> end = solid.at(shape_, unit);
  const auto at = [&](double t) {
    std::array<double, 3> point{};
    for (std::size_t i = 0; i < 3; ++i) point[i] = std::lerp(solid.centre[i], end[i], t);
    return point;
  };
  double inside = 0, outside = 1;
  constexpr int kBisections = 50;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (inside + outside) / 2;
    (is_feasible(at(middle)) ? inside : outside) = middle;
  }
  CriticalPoint found{margin, orientation, unit};
  std::array<double, 3> ray{};
  for (std::size_t i = 0; i < shape_.axes(); ++i) ray[i] = end[i] - solid.centre[i];
  const double length = norm_of(ray);
  for (std::size_t i = 0; i < 3; ++i) found.normal[i] = -ray[i] / length;
  found.distance = (inside - 1) * length;
  return found;
}

CriticalPoint SolidMargins::minimise(const Solid& solid, std::size_t margin, std::size_t orientation,
                                     const UnitPoint& start) {
  // Newton's method on the product of unit balls: the free directions are all directions in a ball's interior, and the
  // tangents on its boundary. On a unit sphere, the Hessian is the Hessian of the margin minus the outward derivative.
  constexpr int kMaxIterations = 30;
  constexpr double kOnBoundary = 1 - 1e-12, kMaxStep = 0.5, kDifference = 1e-4;
  const std::size_t axes = shape_.axes();
  const auto scaled_gradient = [&](const UnitPoint& at) {
    Gradient g = gradient(margin, pose(solid.at(shape_, at), orientation));
    for (std::size_t i = 0; i < axes; ++i) g.by_axis[i] *= solid.dimensions[shape_.ball_of(i)] / 2;
    return g;
  };
  UnitPoint unit = start;
  Gradient at_unit = scaled_gradient(unit);
  for (int iteration = 0; iteration < kMaxIterations && std::isfinite(norm_of(at_unit.by_axis)); ++iteration) {
    std::vector<UnitPoint> directions;
    // curvatures[k]: 0 if directions[k] lies in the interior of a ball; the outward derivative of the margin if
    // directions[k] is tangent to a sphere
    std::vector<double> curvatures;
    std::array<bool, 3> stays_on_boundary{};  // for each ball, whether the point stays on its boundary
    for (std::size_t ball = 0; ball < shape_.balls(); ++ball) {
      double radius = 0, outward = 0;
      for (const std::size_t i : shape_.axes_of(ball)) {
        radius = std::hypot(radius, unit[i]);
        outward += unit[i] * at_unit.by_axis[i];
      }
      stays_on_boundary[ball] = radius >= kOnBoundary && outward <= 0;
      std::vector<UnitPoint> basis;
      for (const std::size_t i : shape_.axes_of(ball)) {
        UnitPoint direction{};
        direction[i] = 1;
        // Gram-Schmidt method: make the direction orthogonal to the radius and to the previous tangents.
        if (stays_on_boundary[ball])
          for (std::size_t k = 0; k <= basis.size(); ++k) {
            UnitPoint other{};
            if (k < basis.size())
              other = basis[k];
            else
              for (const std::size_t j : shape_.axes_of(ball)) other[j] = unit[j];
            double product = 0;
            for (std::size_t j = 0; j < 3; ++j) product += direction[j] * other[j];
            for (std::size_t j = 0; j < 3; ++j) direction[j] -= product * other[j];
          }
        const double length = norm_of(direction);
        if (stays_on_boundary[ball] && (length < 0.3 || basis.size() + 1 == shape_.axes_of(ball).size())) continue;
        for (double& component : direction) component /= length;
        basis.push_back(direction);
      }
      for (const UnitPoint& direction : basis) {
        directions.push_back(direction);
        curvatures.push_back(stays_on_boundary[ball] ? outward : 0);
      }
    }
    const auto n = static_cast<Eigen::Index>(directions.size());
    Eigen::VectorXd reduced(n);
    const auto along = [&](const std::array<double, 3>& g, Eigen::Index k) {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += g[i] * directions[static_cast<std::size_t>(k)][i];
      return sum;
    };
    for (Eigen::Index k = 0; k < n; ++k) reduced[k] = along(at_unit.by_axis, k);
    const double size = norm_of(at_unit.by_axis);
    if (n == 0 || reduced.norm() <= 1e-13 * size) break;
    Eigen::MatrixXd hessian(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      std::array<Gradient, 2> ends;
      for (std::size_t end = 0; end < 2; ++end) {
        UnitPoint moved = unit;
        for (std::size_t i = 0; i < 3; ++i)
          moved[i] += (end == 0 ? -kDifference : kDifference) * directions[static_cast<std::size_t>(k)][i];
        ends[end] = scaled_gradient(moved);
      }
      for (Eigen::Index l = 0; l < n; ++l)
        hessian(l, k) = (along(ends[1].by_axis, l) - along(ends[0].by_axis, l)) / (2 * kDifference);
      hessian(k, k) -= curvatures[static_cast<std::size_t>(k)];
    }
    if (!hessian.allFinite()) hessian = Eigen::MatrixXd::Identity(n, n) * size;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd((hessian + hessian.transpose()) / 2));
    const Eigen::VectorXd curvature = eigen.eigenvalues().cwiseAbs().cwiseMax(1e-6 * size);
    Eigen::VectorXd step =
        -eigen.eigenvectors() * (eigen.eigenvectors().transpose() * reduced).cwiseQuotient(curvature);
    step *= std::min(1.0, kMaxStep / step.norm());
    bool has_moved = false;
    for (int halvings = 0; halvings < 10 && !has_moved; ++halvings, step /= 4) {
      UnitPoint moved = unit;
      for (Eigen::Index k = 0; k < n; ++k)
        for (std::size_t i = 0; i < 3; ++i) moved[i] += step[k] * directions[static_cast<std::size_t>(k)][i];
      for (std::size_t ball = 0; ball < shape_.balls(); ++ball) {
        double radius = 0;
        for (const std::size_t i : shape_.axes_of(ball)) radius = std::hypot(radius, moved[i]);
        if (radius > 1 || stays_on_boundary[ball])
          for (const std::size_t i : shape_.axes_of(ball)) moved[i] /= radius;
      }
      const Gradient there = scaled_gradient(moved);
      if (!(there.value <= at_unit.value + 1e-15 * size)) continue;
      has_moved = std::fabs(there.value - at_unit.value) > 1e-15 * size || step.norm() > 1e-9;
      unit = moved;
      at_unit = there;
      if (!has_moved) break;
    }
    if (!has_moved) break;
  }
  return linearised(solid, margin, orientation, unit);
}

CriticalPoint SolidMargins::linearised(const Solid& solid, std::size_t margin, std::size_t orientation,
                                       const UnitPoint& unit) {
  CriticalPoint found{margin, orientation, unit};
  const Gradient g = gradient(margin, pose(solid.at(shape_, unit), orientation));
  found.norm = norm_of(g.by_axis);
  if (!(found.norm > 0) || !std::isfinite(found.norm) || !std::isfinite(g.value)) {
    if (is_feasible(solid.at(shape_, unit))) {
      found.norm = 0;
      found.distance = std::numeric_limits<double>::infinity();
      return found;
    }
    return plane_across_ray(solid, margin, orientation, unit);
  }
  found.distance = g.value / found.norm;
  for (std::size_t i = 0; i < 3; ++i) found.normal[i] = g.by_axis[i] / found.norm;
  return found;
}

std::vector<CriticalPoint> SolidMargins::critical_points(const Solid& solid, double range, const SolidSamples& all) {
  std::vector<CriticalPoint> found;
  std::vector<Pose<double>> poses(all.points.size());
  std::vector<double> margins;
  // For each margin, the difference up to which two values count as equal because of rounding errors.
  std::vector<double> equal(count_);
  for (std::size_t orientation = 0; orientation < orientations_.size(); ++orientation) {
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose(solid.at(shape_, all.points[i]), orientation);
    margins.clear();
    append(parameters_, poses, margins);
    const auto margin_at = [&](std::size_t sample, std::size_t margin) { return margins[sample * count_ + margin]; };
    std::ranges::fill(equal, 0.0);
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (std::size_t margin = 0; margin < count_; ++margin)
        if (const double size = 1e-11 * std::fabs(margin_at(i, margin)); size > equal[margin] && std::isfinite(size))
          equal[margin] = size;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto of_pose = std::span(margins).subspan(i * count_, count_);
      if (is_infeasible(of_pose) && std::ranges::none_of(of_pose, [](double margin) { return margin < 0; }))
        found.push_back(plane_across_ray(
            solid,
            static_cast<std::size_t>(std::ranges::find_if_not(of_pose, [](double x) { return x >= 0; }) -
                                     of_pose.begin()),
            orientation, all.points[i]));
      for (std::size_t margin = 0; margin < count_; ++margin) {
        const double value = of_pose[margin];
        if (!std::isfinite(value)) continue;
        // Among neighbouring samples with equal margins, for example along an edge, only the first one counts as a
        // minimum.
        const auto is_larger = [&](std::size_t k) {
          const double excess = margin_at(k, margin) - value;
          return !(excess < -equal[margin]) && (!(excess <= equal[margin]) || k > i);
        };
        if (!std::ranges::all_of(all.neighbours[i], is_larger)) continue;
        // If the first-order distance from the zero of the margin far exceeds the range, no point of the solid comes
        // near it.
        const Gradient first = gradient(margin, poses[i]);
        if (value > 4 * range * norm_of(first.by_axis)) continue;
        const CriticalPoint point = minimise(solid, margin, orientation, all.points[i]);
        if (point.distance > range) continue;
        const auto is_same = [&](const CriticalPoint& other) {
          if (other.margin != margin || other.orientation != orientation) return false;
          std::array<double, 3> apart{};
          for (std::size_t axis = 0; axis < 3; ++axis) apart[axis] = other.unit[axis] - point.unit[axis];
          return norm_of(apart) < 1e-6;
        };
        if (std::ranges::none_of(found, is_same)) found.push_back(point);
      }
    }
  }
  return found;
}

}  // namespace pkm
