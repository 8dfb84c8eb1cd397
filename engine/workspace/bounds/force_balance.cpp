#include "engine/workspace/bounds/force_balance.hpp"

#include <algorithm>
#include <cmath>

#include "engine/dynamics/force_distribution.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/math/non_negative_least_squares.hpp"

namespace pkm::bounds {

using expression::Graph, expression::Groups, expression::Node;

namespace {

Interval dot(std::span<const Interval> x, std::span<const double> y) {
  Interval sum(0.0);
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * Interval(y[i]);
  return sum;
}

bool is_bounded(const Interval& x) { return x.is_continuous() && std::isfinite(x.width()); }

/// Enclosures of the matrices and vectors of the balance, or of their derivatives by an axis.
struct Terms {
  std::vector<std::vector<Interval>> J;  ///< rows of J, by joint
  std::vector<Interval> lower, upper;    ///< limits of the forces, by joint
  std::vector<Interval> load;            ///< a vertex of a set of loads
};

/// Values of the formulas for one set of loads, of which a vertex is selected.
/// @param vertex  bit k: sign of half axis k
Terms terms_of(const BalanceFormulas& formulas, const std::vector<Interval>& values, std::size_t set,
               std::size_t vertex) {
  Terms terms;
  const std::size_t n = formulas.coordinates;
  auto next = values.begin();
  const auto take = [&](std::size_t count) {
    std::vector<Interval> taken(next, next + static_cast<std::ptrdiff_t>(count));
    next += static_cast<std::ptrdiff_t>(count);
    return taken;
  };
  for (std::size_t j = 0; j < formulas.joints; ++j) terms.J.push_back(take(n));
  for (std::size_t j = 0; j < formulas.joints; ++j) {
    const std::vector<Interval> tension =
        formulas.is_limited[j] ? take(2) : std::vector<Interval>(2, Interval::empty());
    terms.lower.push_back(-tension[1]);
    terms.upper.push_back(-tension[0]);
  }
  if (formulas.is_closure) {
    terms.load.assign(n, Interval(0.0));
    return terms;
  }
  for (std::size_t k = 0; k < set; ++k) take(n * (1 + formulas.half_axes[k]));
  terms.load = take(n);
  for (std::size_t k = 0; k < formulas.half_axes[set]; ++k) {
    const std::vector<Interval> axis = take(n);
    for (std::size_t i = 0; i < n; ++i)
      terms.load[i] = (vertex >> k & 1U) != 0 ? terms.load[i] - axis[i] : terms.load[i] + axis[i];
  }
  return terms;
}

/// The balance at the midpoint of a box, over the box, and its derivatives over the box.
struct Enclosures {
  const BalanceFormulas& formulas;
  Terms at_middle, on_box;
  std::vector<Terms> by_axis;
  std::vector<Interval> offsets;  ///< X_i - m_i, by axis

  std::size_t n() const { return formulas.coordinates; }
  std::size_t joints() const { return formulas.joints; }
};

/// The balance at the midpoint, in double precision.
struct MidpointBalance {
  AxisMatrix<double> J;
  AxisVector<double> load;
  DriveLimits limits;
};

MidpointBalance midpoint_of(const Enclosures& e) {
  MidpointBalance at{AxisMatrix<double>(e.joints(), e.n()), AxisVector<double>(e.n()), no_drive_limits(e.joints())};
  at.limits.sharing = ForceSharing::centre;
  for (std::size_t j = 0; j < e.joints(); ++j) {
    for (std::size_t i = 0; i < e.n(); ++i) at.J(j, i) = e.at_middle.J[j][i].middle();
    if (!e.formulas.is_limited[j]) continue;
    at.limits.lower[j] = e.formulas.is_closure ? -1 : e.on_box.lower[j].upper;
    at.limits.upper[j] = e.formulas.is_closure ? 0 : e.on_box.upper[j].lower;
  }
  for (std::size_t i = 0; i < e.n(); ++i) at.load[i] = e.at_middle.load[i].middle();
  return at;
}

/// The weighted right inverse P = W J (J^T W J)^-1 of J^T, where 1/W are the second derivatives of the logarithmic
/// barrier of the limits; joints x coordinates.
Eigen::MatrixXd right_inverse(const MidpointBalance& at, const AxisVector<double>& forces) {
  const auto joints = static_cast<Eigen::Index>(at.J.rows()), n = static_cast<Eigen::Index>(at.J.cols());
  Eigen::MatrixXd J(joints, n);
  Eigen::VectorXd weights(joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const auto joint = static_cast<std::size_t>(j);
    for (Eigen::Index i = 0; i < n; ++i) J(j, i) = at.J(joint, static_cast<std::size_t>(i));
    const double below = forces[joint] - at.limits.lower[joint], above = at.limits.upper[joint] - forces[joint];
    weights(j) = 1 / (1 / (below * below) + 1 / (above * above));
  }
  // Drives without limits have an infinite weight: take one that is large, but leaves the matrix well-conditioned.
  double largest = 0;
  for (const double weight : weights)
    if (std::isfinite(weight)) largest = std::max(largest, weight);
  for (double& weight : weights)
    if (!std::isfinite(weight)) weight = 100 * largest;
  const Eigen::MatrixXd weighted = weights.asDiagonal() * J;
  return weighted * (J.transpose() * weighted).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
}

/// Encloses the solutions y of M y = r for all M = I - E and all r in the intervals by Krawczyk's operator.
/// @return empty if M is not proven to be regular
std::vector<Interval> solutions(const std::vector<std::vector<Interval>>& E, const std::vector<Interval>& r) {
  const std::size_t n = r.size();
  Eigen::MatrixXd comparison = Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  Eigen::VectorXd bound(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    bound(static_cast<Eigen::Index>(i)) = magnitude(r[i]).upper;
    for (std::size_t k = 0; k < n; ++k)
      comparison(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) -= magnitude(E[i][k]).upper;
  }
  // The enlargement makes the operator map Y into its interior; the absolute part counts if r is 0.
  const double enlargement = 1e-12 * (1 + bound.maxCoeff());
  bound = comparison.partialPivLu().solve(Eigen::VectorXd((1.000001 * bound.array() + enlargement).matrix()));
  std::vector<Interval> Y;
  for (const double half : bound) {
    if (!(half > 0) || !std::isfinite(half)) return {};
    Y.emplace_back(-half, half);
  }
  std::vector<Interval> mapped = r;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) mapped[i] += E[i][k] * Y[k];
    if (!(Y[i].lower < mapped[i].lower && mapped[i].upper < Y[i].upper)) return {};
  }
  return mapped;
}

/// @param forces  forces that balance the load at the midpoint, within the limits
/// @return true if the load is balanced at every pose of the box
bool is_balanced(const Enclosures& e, const MidpointBalance& at, const AxisVector<double>& forces) {
  const std::size_t n = e.n(), joints = e.joints();
  const Eigen::MatrixXd P = right_inverse(at, forces);
  const std::span<const double> tau(forces.begin(), joints);
  const auto column_of = [&](const Terms& terms, std::size_t i) {
    std::vector<Interval> column;
    for (std::size_t j = 0; j < joints; ++j) column.push_back(terms.J[j][i]);
    return column;
  };
  std::vector<std::vector<Interval>> E(n);  // I - M
  std::vector<Interval> residual;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<Interval> column = column_of(e.on_box, i);
    for (std::size_t k = 0; k < n; ++k) {
      const std::span<const double> of_P(P.col(static_cast<Eigen::Index>(k)).data(), joints);
      E[i].push_back(Interval(i == k ? 1.0 : 0.0) - dot(column, of_P));
    }
    residual.push_back(e.at_middle.load[i] - dot(column_of(e.at_middle, i), tau));
  }
  std::vector<Interval> range(tau.begin(), tau.end());  // enclosure of the drive forces over the box
  const auto add_range = [&](const std::vector<Interval>& z) {
    for (std::size_t j = 0; j < joints; ++j)
      for (std::size_t k = 0; k < n; ++k)
        range[j] += Interval(P(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k))) * z[k];
  };
  for (std::size_t axis = 0; axis < e.by_axis.size(); ++axis) {
    std::vector<Interval> derivative;
    std::vector<double> B;
    for (std::size_t i = 0; i < n; ++i) {
      derivative.push_back(e.by_axis[axis].load[i] - dot(column_of(e.by_axis[axis], i), tau));
      B.push_back(derivative.back().middle());
    }
    for (std::size_t i = 0; i < n; ++i)
      residual[i] += (derivative[i] - Interval(B[i]) + dot(E[i], B)) * e.offsets[axis];
    // The forces vary linearly along the axis: sum the products before the multiplication by the offset.
    for (std::size_t j = 0; j < joints; ++j) {
      Interval slope(0.0);
      for (std::size_t k = 0; k < n; ++k)
        slope += Interval(P(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k))) * Interval(B[k]);
      range[j] += slope * e.offsets[axis];
    }
  }
  const std::vector<Interval> y = solutions(E, residual);
  if (y.empty()) return false;
  add_range(y);
  for (std::size_t j = 0; j < joints; ++j)
    if (!(at.limits.lower[j] < range[j].lower && range[j].upper < at.limits.upper[j])) return false;
  return true;
}

/// @return a vector c for which J c > 0 for all cables, if there is one; no weighted sum of the cables' rows of J
/// vanishes then
std::optional<AxisVector<double>> common_side(const MidpointBalance& at) {
  const std::size_t n = at.J.cols();
  std::vector<std::vector<double>> columns;
  for (std::size_t j = 0; j < at.J.rows(); ++j) {
    std::vector<double> column(n + 1, 1.0);
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) square += at.J(j, i) * at.J(j, i);
    for (std::size_t i = 0; i < n; ++i) column[i] = at.J(j, i) / std::sqrt(square);
    columns.push_back(std::move(column));
  }
  // The residual of the least squares is a vector (-c, r) with -c^T J_j + r <= 0 for all j, and r > 0 unless the rows
  // of J balance each other.
  std::vector<double> residual(n + 1, 0.0);
  residual[n] = 1;
  const std::vector<double> u = non_negative_least_squares(columns, residual, 1e-9);
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i <= n; ++i) residual[i] -= u[j] * columns[j][i];
  if (!(residual[n] > 1e-9)) return {};
  AxisVector<double> c(n);
  for (std::size_t i = 0; i < n; ++i) c[i] = -residual[i];
  return c;
}

/// @return true if c separates the load from all forces of the drives at every pose of the box
bool is_separated(const Enclosures& e, const AxisVector<double>& separating) {
  const std::span<const double> c(separating.begin(), e.n());
  // The mean value form of max c^T J^T tau - c^T f; its derivatives are summed before they are multiplied by offsets.
  Interval value = -dot(e.at_middle.load, c);
  std::vector<Interval> derivatives;
  for (const Terms& terms : e.by_axis) derivatives.push_back(-dot(terms.load, c));
  for (std::size_t j = 0; j < e.joints(); ++j) {
    Interval along = dot(e.at_middle.J[j], c);  // c^T J_j over the box
    for (std::size_t axis = 0; axis < e.by_axis.size(); ++axis) along += dot(e.by_axis[axis].J[j], c) * e.offsets[axis];
    const bool is_positive = along.lower > 0, is_negative = along.upper < 0;
    if (!e.formulas.is_limited[j] || (e.formulas.is_closure && !is_positive)) return false;
    if (e.formulas.is_closure) continue;
    if (!is_positive && !is_negative) {
      value += Interval(std::max((along * e.on_box.lower[j]).upper, (along * e.on_box.upper[j]).upper));
      continue;
    }
    const Interval& force = is_positive ? e.on_box.upper[j] : e.on_box.lower[j];
    value += force * dot(e.at_middle.J[j], c);
    for (std::size_t axis = 0; axis < e.by_axis.size(); ++axis)
      derivatives[axis] += force * dot(e.by_axis[axis].J[j], c);
  }
  if (e.formulas.is_closure) return true;
  for (std::size_t axis = 0; axis < e.by_axis.size(); ++axis) value += derivatives[axis] * e.offsets[axis];
  return value.upper < 0;
}

}  // namespace

ForceBalance::ForceBalance(Graph graph, BalanceFormulas formulas, std::vector<std::size_t> axes,
                           std::vector<Interval> inputs)
    : formulas_(std::move(formulas)), axes_(std::move(axes)), inputs_(std::move(inputs)) {
  // Numbers become inputs, so that derivatives contain no numbers that were computed with rounding errors.
  std::vector<double> numbers;
  graph = expression::without_numbers(
      graph, inputs_.size(), [](std::size_t) { return Groups{1}; }, numbers, formulas_.all);
  inputs_.insert(inputs_.end(), numbers.begin(), numbers.end());
  std::vector<Node> outputs = formulas_.all;
  for (const std::size_t axis : axes_)
    for (const Node node : formulas_.all) outputs.push_back(expression::derivative(graph, node, graph.input(axis)));
  program_ = expression::Program(graph, outputs);
}

struct ForceBalance::Values {
  std::vector<Interval> all;
  std::vector<std::vector<Interval>> by_axis;
};

ForceBalance::Values ForceBalance::values_on(const IntervalBox& box) const {
  std::vector<Interval> inputs = inputs_, registers;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) inputs[axes_[axis]] = box[axis];
  program_.run_all<Interval>(inputs, registers);
  auto output = program_.outputs().begin();
  const auto next = [&] {
    std::vector<Interval> values;
    while (values.size() < formulas_.all.size()) values.push_back(registers[*output++]);
    return values;
  };
  Values values{next(), {}};
  while (values.by_axis.size() < axes_.size()) values.by_axis.push_back(next());
  return values;
}

ForceBalance::Result ForceBalance::examine(const IntervalBox& box) const {
  IntervalBox middle{};
  std::vector<Interval> offsets;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    middle[axis] = Interval(box[axis].middle());
    offsets.push_back(box[axis] - middle[axis]);
  }
  const Values on_box = values_on(box), at_middle = values_on(middle);
  const auto are_bounded = [](const std::vector<Interval>& values) { return std::ranges::all_of(values, is_bounded); };
  const auto is_known = [](const Interval& x) { return x.is_defined() && std::isfinite(x.width()); };
  if (!are_bounded(on_box.all) || !are_bounded(at_middle.all)) return Result::undecided;
  for (const auto& derivatives : on_box.by_axis)
    if (!std::ranges::all_of(derivatives, is_known)) return Result::undecided;
  bool are_balanced = true;  // all loads that were examined
  for (std::size_t set = 0; set < formulas_.half_axes.size(); ++set)
    for (std::size_t vertex = 0; vertex < std::size_t{1} << formulas_.half_axes[set]; ++vertex) {
      Enclosures e{formulas_,
                   terms_of(formulas_, at_middle.all, set, vertex),
                   terms_of(formulas_, on_box.all, set, vertex),
                   {},
                   offsets};
      for (const auto& derivatives : on_box.by_axis) e.by_axis.push_back(terms_of(formulas_, derivatives, set, vertex));
      const MidpointBalance at = midpoint_of(e);
      const auto forces = distribute_forces(at.J, at.load, at.limits);
      if (forces && are_balanced && is_balanced(e, at, *forces)) continue;
      are_balanced = false;
      const auto c = formulas_.is_closure ? common_side(at)
                     : forces             ? std::nullopt
                                          : separating_vector(at.J, at.load, at.limits);
      if (c && is_separated(e, *c)) return Result::not_balanced;
    }
  return are_balanced ? Result::balanced : Result::undecided;
}

}  // namespace pkm::bounds
