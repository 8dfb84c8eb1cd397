#include "engine/workspace/bounds/pose_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/core/team.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/math/roots.hpp"

namespace pkm::bounds {

using expression::Node, expression::Program;

Matrices::Matrices(const expression::Graph& graph, const std::vector<NamedMatrix>& matrices,
                   std::vector<std::size_t> axes, const std::vector<Interval>& inputs)
    : matrices_(matrices), axes_(std::move(axes)) {
  std::vector<Node> entries;
  for (const NamedMatrix& matrix : matrices_)
    entries.insert(entries.end(), matrix.entries.begin(), matrix.entries.end());
  program_ = Program(graph, entries);
  initial_ = inputs;
  initial_.resize(inputs.size() + program_.registers());
}

void Matrices::evaluate(const IntervalBox& box, Scratch& scratch) const {
  const std::size_t inputs = scratch.size() - program_.registers();
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) scratch[axes_[axis]] = box[axis];
  program_.run_all<Interval>(std::span(scratch).first(inputs), std::span(scratch).subspan(inputs));
}

std::vector<Interval> Matrices::entries(std::size_t k, const Scratch& scratch) const {
  const std::size_t inputs = scratch.size() - program_.registers();
  std::size_t output = 0;
  for (std::size_t i = 0; i < k; ++i) output += matrices_[i].entries.size();
  std::vector<Interval> entries;
  while (entries.size() < matrices_[k].entries.size())
    entries.push_back(scratch[inputs + program_.outputs()[output++]]);
  return entries;
}

namespace {

/// Matrix of the midpoints of interval entries; std::nullopt if one entry is undefined or unbounded.
std::optional<AxisMatrix<double>> midpoint_matrix(std::span<const Interval> entries, std::size_t rows,
                                                  std::size_t columns) {
  AxisMatrix<double> midpoint(rows, columns);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (!entries[k].is_defined() || !std::isfinite(entries[k].width())) return {};
    midpoint[k] = entries[k].middle();
  }
  return midpoint;
}

}  // namespace

bool has_full_rank(std::span<const Interval> entries, std::size_t rows, std::size_t columns) {
  const auto midpoint = midpoint_matrix(entries, rows, columns);
  if (!midpoint || is_rank_deficient(*midpoint)) return false;
  // An approximate left inverse of a matrix A is sufficient: if its product with A has full rank, then A has full
  // column rank.
  const AxisMatrix<double> inverse = rows == columns ? solve(*midpoint, AxisMatrix<double>::identity(rows))
                                                     : solve(transpose(*midpoint) * *midpoint, transpose(*midpoint));
  // Comparison matrix of the product: minimum of the diagonal elements, minus the maximum magnitude of the others.
  AxisMatrix<double> comparison(columns, columns);
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      Interval product(0.0);
      for (std::size_t k = 0; k < rows; ++k) product += Interval(inverse(i, k)) * entries[k * columns + j];
      if (product.is_empty()) return false;
      comparison(i, j) = i == j ? product.lower : -magnitude(product).upper;
    }
  AxisVector<double> ones(columns);
  for (double& one : ones) one = 1;
  const AxisVector<double> weights = solve(comparison, ones);
  for (std::size_t i = 0; i < columns; ++i) {
    if (!(weights[i] > 0) || !std::isfinite(weights[i])) return false;
    Interval sum(0.0);
    for (std::size_t j = 0; j < columns; ++j) sum += Interval(comparison(i, j)) * Interval(weights[j]);
    if (!(sum.lower > 0)) return false;
  }
  return true;
}

namespace {

/// Sign of the determinant by interval Gaussian elimination with partial pivoting; 0 if a pivot may be 0.
/// @param a  n x n, row by row
int determinant_sign_of(std::vector<Interval> a, std::size_t n) {
  int sign = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot_row = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(a[i * n + k].middle()) > std::fabs(a[pivot_row * n + k].middle())) pivot_row = i;
    const Interval pivot = a[pivot_row * n + k];
    if (!pivot.is_defined() || !(pivot.lower > 0 || pivot.upper < 0)) return 0;
    if (pivot.upper < 0) sign = -sign;
    if (pivot_row != k) {
      sign = -sign;
      for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot_row * n + j]);
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const Interval factor = a[i * n + k] / pivot;
      for (std::size_t j = k + 1; j < n; ++j) a[i * n + j] = a[i * n + j] - factor * a[k * n + j];
    }
  }
  return sign;
}

}  // namespace

std::optional<std::size_t> Matrices::first_undecided(const IntervalBox& box, Scratch& scratch) const {
  evaluate(box, scratch);
  for (std::size_t k = 0; k < size(); ++k)
    if (!has_full_rank(entries(k, scratch), matrices_[k].rows, matrices_[k].columns)) return k;
  return {};
}

int Matrices::determinant_sign(std::size_t k, const IntervalBox& pose, Scratch& scratch) const {
  if (matrices_[k].rows != matrices_[k].columns) return 0;
  evaluate(pose, scratch);
  return determinant_sign_of(entries(k, scratch), matrices_[k].rows);
}

bool Matrices::is_singular_at(std::size_t k, const IntervalBox& pose, Scratch& scratch) const {
  evaluate(pose, scratch);
  const std::size_t rows = matrices_[k].rows, columns = matrices_[k].columns;
  const std::vector<Interval> A = entries(k, scratch);
  const auto midpoint = midpoint_matrix(A, rows, columns);
  if (!midpoint) return false;
  Eigen::MatrixXd matrix(rows, columns);
  double norm = 0;  // maximum over the rows of the sum of magnitudes
  for (std::size_t i = 0; i < rows; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (*midpoint)(i, j);
      sum += std::fabs((*midpoint)(i, j));
    }
    norm = std::fmax(norm, sum);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(matrix, Eigen::ComputeFullV);
  const Eigen::VectorXd v = decomposition.matrixV().rightCols(1);
  for (std::size_t i = 0; i < rows; ++i) {
    Interval product(0.0);
    for (std::size_t j = 0; j < columns; ++j) product += A[i * columns + j] * Interval(v[static_cast<Eigen::Index>(j)]);
    if (!(magnitude(product).upper <= kSingularRcond * norm * v.cwiseAbs().maxCoeff())) return false;
  }
  return true;
}

bool Matrices::is_continuous(std::size_t k, const IntervalBox& box, Scratch& scratch) const {
  evaluate(box, scratch);
  return std::ranges::all_of(entries(k, scratch),
                             [](const Interval& x) { return x.is_continuous() && std::isfinite(x.width()); });
}

namespace {

struct Box {
  IntervalBox sides;
  std::vector<std::size_t> open;  ///< indices of the undecided constraints
  bool is_regular = false;        ///< true if all matrices are proved to have full rank
  // Results of examine():
  bool is_outside = false;  ///< no pose of the box is in the solid
  /// A pose of the box: its midpoint, or, if that is not in the solid, the pose of the box nearest to the solid's
  /// centre.
  IntervalBox sample;
  /// Index of a constraint that is violated at the sample; the sample is then proven to be in the solid.
  std::optional<std::size_t> violated;
  std::optional<std::size_t> undecided;  ///< index of the first matrix that is not proven to have full rank on the box
  int determinant_sign = 0;              ///< sign of the determinant of matrix `undecided` at the sample; 0: unknown
  bool is_singular_at_sample = false;    ///< matrix `undecided` is singular at the sample, to working precision
  std::size_t axis = 0;                  ///< axis of the next bisection
};

/// Name of a rank-deficient matrix, and the pose (or a small box of poses) at which it is singular.
struct Singularity {
  std::string detail;
  IntervalBox pose;
};

class PoseBranchAndBound {
 public:
  PoseBranchAndBound(const Constraints& constraints, const Matrices* matrices, const PoseSolid& poses,
                     const BoundsOptions& options)
      : constraints_(constraints), matrices_(matrices), ranges_(poses.ranges), balls_(poses.balls), options_(options) {
    for (std::size_t i = 0; i < workers(); ++i)
      scratch_.push_back({constraints.make_scratch(), constraints.make_scratch(), constraints.make_scratch(),
                          matrices ? matrices->initial_scratch() : Matrices::Scratch()});
    if (matrices) brackets_.resize(matrices->size());
  }

  PoseCertificate run() {
    Box all;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) all.sides[axis] = {ranges_[axis][0], ranges_[axis][1]};
    for (std::size_t k = 0; k < constraints_.size(); ++k) all.open.push_back(k);
    all.is_regular = !matrices_;
    PoseCertificate found;
    if (!matrices_) found.regular.kind = PropertyResult::Kind::not_examined;
    std::vector<Box> boxes = {all};
    while (!boxes.empty()) {
      parallel_for(boxes.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        // The stop request is tested for each box as well, because examining all boxes may take long.
        for (std::size_t i = begin; i < end && !stopped(); ++i) examine(boxes[i], scratch_[worker]);
      });
      found.boxes += boxes.size();
      found.stopped = stopped();
      const bool last = found.stopped || found.boxes >= options_.max_boxes;
      std::vector<Box> next;
      for (const Box& box : boxes) {
        if (box.is_outside) continue;
        if (box.violated && found.feasible.kind != PropertyResult::Kind::fails)
          found.feasible = {PropertyResult::Kind::fails, constraints_.name(*box.violated), pose(box.sample)};
        if (box.violated) continue;
        if (!singularity_ && !box.is_regular) singularity_ = find_singularity(box);
        if (box.open.empty() && (box.is_regular || singularity_)) continue;
        if (!last && bisect(box, next)) continue;
        if (!box.open.empty() && found.feasible.kind == PropertyResult::Kind::holds)
          found.feasible = {PropertyResult::Kind::undecided, constraints_.name(box.open.front()), pose(box.sample)};
        if (box.undecided && !singularity_ && found.regular.kind == PropertyResult::Kind::holds)
          found.regular = {PropertyResult::Kind::undecided, matrices_->name(*box.undecided), pose(box.sample)};
      }
      boxes = std::move(next);
      if (found.feasible.kind == PropertyResult::Kind::fails) {
        found.regular = {PropertyResult::Kind::not_examined, "not every pose is feasible"};
        return found;
      }
    }
    if (singularity_) found.regular = {PropertyResult::Kind::fails, singularity_->detail, pose(singularity_->pose)};
    return found;
  }

 private:
  struct Scratch {
    Constraints::Scratch box, sample, vertex;
    Matrices::Scratch matrices;
  };

  bool stopped() const { return options_.stop && options_.stop(); }

  Pose<double> pose(const IntervalBox& box) const {
    Pose<double> pose(ranges_.size());
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) pose[axis] = box[axis].middle();
    return pose;
  }

  /// The solid is a product of balls: sets of poses at which a sum of squares is at most 1. Encloses the maximum of
  /// these sums over the balls, for the poses of a box.
  Interval sum_of_squares(const IntervalBox& box) const {
    Interval largest(0.0);
    for (const std::vector<std::size_t>& ball : balls_) {
      Interval sum(0.0);
      for (const std::size_t axis : ball) {
        const Interval lower(ranges_[axis][0]), upper(ranges_[axis][1]);
        sum += square((Interval(2.0) * box[axis] - lower - upper) / (upper - lower));
      }
      largest = max(largest, sum);
    }
    return largest;
  }
  bool is_certified_inside(const IntervalBox& box) const { return sum_of_squares(box).upper <= 1; }

  /// The midpoint of a box or, if it is not in the solid, the pose of the box nearest to the centres of the balls.
  IntervalBox sample_of(const IntervalBox& box) const {
    IntervalBox sample = box;
    for (Interval& side : sample) side = Interval(side.middle());
    if (is_certified_inside(sample)) return sample;
    for (const std::vector<std::size_t>& ball : balls_)
      for (const std::size_t axis : ball)
        sample[axis] =
            Interval(std::clamp(std::midpoint(ranges_[axis][0], ranges_[axis][1]), box[axis].lower, box[axis].upper));
    return sample;
  }

  /// A singularity of the undecided matrix: at the sample of this box, or on the line to the sample of an earlier box
  /// with a determinant of opposite sign, which is in the solid because solids are convex.
  std::optional<Singularity> find_singularity(const Box& box) {
    const std::string& name = matrices_->name(*box.undecided);
    if (box.is_singular_at_sample) return Singularity{name + ", to working precision", box.sample};
    if (box.determinant_sign == 0) return {};
    Bracket& bracket = brackets_[*box.undecided];
    (box.determinant_sign > 0 ? bracket.positive : bracket.negative) = box.sample;
    if (!bracket.positive || !bracket.negative || bracket.searches == kMaxSearches) return {};
    ++bracket.searches;
    const auto root = bracket_root(*box.undecided, *bracket.negative, *bracket.positive);
    if (root) return Singularity{name + ", where the determinant changes its sign", *root};
    bracket.negative.reset();
    bracket.positive.reset();
    return {};
  }

  /// A small box that contains a root of the determinant of a matrix, by bisection of the line between a pose with a
  /// negative and one with a positive determinant; std::nullopt if the elements of the matrix are not continuous in it.
  std::optional<IntervalBox> bracket_root(std::size_t matrix, const IntervalBox& negative,
                                          const IntervalBox& positive) {
    Scratch& scratch = scratch_.front();
    const auto point = [&](double t) {
      IntervalBox box = negative;
      for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
        box[axis] = Interval(std::lerp(negative[axis].lower, positive[axis].lower, t));
      return box;
    };
    const auto is_positive = [&](double t) -> std::optional<bool> {
      const int sign = matrices_->determinant_sign(matrix, point(t), scratch.matrices);
      return sign == 0 ? std::nullopt : std::optional(sign > 0);
    };
    const auto [with, without] = pkm::bisect(is_positive, {.with = 1, .without = 0}, 0x1p-60);
    IntervalBox box = point(without);
    const IntervalBox other = point(with);
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
      box[axis] = {std::min(box[axis].lower, other[axis].lower), std::max(box[axis].upper, other[axis].upper)};
    if (!matrices_->is_continuous(matrix, box, scratch.matrices)) return {};
    return box;
  }

  /// Decides constraints and matrices on a box, and tests whether its sample is a counterexample.
  void examine(Box& box, Scratch& scratch) const {
    // For each axis, the sum over the undecided constraints of upper bounds of their variation along the axis.
    std::array<double, kMaxAxes> variation{};
    std::vector<std::size_t> open;
    const Interval sums = sum_of_squares(box.sides);
    box.is_outside = sums.lower > 1;
    if (box.is_outside) return;
    box.sample = sample_of(box.sides);
    const bool is_inside = is_certified_inside(box.sample);
    const std::size_t last = ranges_.size() - 1;
    constraints_.set_box(box.sides, scratch.box);
    constraints_.set_box(box.sample, scratch.sample);
    for (const std::size_t k : box.open) {
      const Interval value = constraints_.value(k, box.sides[last], scratch.box);
      if (value.is_certified_satisfied()) continue;
      const Interval at_sample = constraints_.value(k, box.sample[last], scratch.sample);
      if (is_inside && (value.is_certified_violated() || at_sample.is_certified_violated())) {
        box.violated = k;
        return;
      }
      const Derivatives derivatives = constraints_.derivatives(k, box.sides[last], scratch.box);
      if (derivatives.is_known &&
          (mean_value_form(at_sample, box.sample, box.sides, derivatives).is_certified_satisfied() ||
           minimum_by_monotonicity(k, box.sides, derivatives, scratch).is_certified_satisfied() ||
           (sums.upper > 1 &&
            mean_value_form_in_balls(at_sample, box.sample, box.sides, derivatives).is_certified_satisfied())))
        continue;
      open.push_back(k);
      for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
        variation[axis] +=
            derivatives.is_known ? magnitude(derivatives.by_axis[axis]).upper * box.sides[axis].width() : 0;
    }
    box.open = open;
    if (!box.is_regular && !singularity_) {
      box.undecided = matrices_->first_undecided(box.sides, scratch.matrices);
      box.is_regular = !box.undecided;
    }
    if (box.undecided && is_inside) {
      box.determinant_sign = matrices_->determinant_sign(*box.undecided, box.sample, scratch.matrices);
      box.is_singular_at_sample =
          box.determinant_sign == 0 && matrices_->is_singular_at(*box.undecided, box.sample, scratch.matrices);
    }
    box.axis = bisection_axis(box, variation);
  }

  /// Enclosure of a constraint over a box by the mean value form.
  /// @param value  value of the constraint at `sample`, a pose of the box
  Interval mean_value_form(Interval value, const IntervalBox& sample, const IntervalBox& sides,
                           const Derivatives& derivatives) const {
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
      value += derivatives.by_axis[axis] * (sides[axis] - sample[axis]);
    return value;
  }

  /// The mean value form for the part of a box that is in the solid. There, the sum of squares q of each ball is at
  /// most 1, so that the constraint is not less than its mean value form plus m (q - 1) for any m >= 0 (Lagrangian
  /// relaxation). This sum is separable. With the multiplier m of a linear constraint, its error is of second order in
  /// the size of the box, like that of the mean value form on boxes that do not extend beyond the solid.
  /// @return a lower bound
  Interval mean_value_form_in_balls(Interval value, const IntervalBox& sample, const IntervalBox& sides,
                                    const Derivatives& derivatives) const {
    std::array<bool, kMaxAxes> is_added{};
    for (const std::vector<std::size_t>& ball : balls_) {
      double norm = 0;
      for (const std::size_t axis : ball)
        norm = std::hypot(norm, derivatives.by_axis[axis].middle() * (ranges_[axis][1] - ranges_[axis][0]) / 2);
      const Interval multiplier(norm / 2);
      if (!(norm > 0) || !std::isfinite(norm)) continue;
      for (const std::size_t axis : ball) {
        is_added[axis] = true;
        const Interval lower(ranges_[axis][0]), upper(ranges_[axis][1]), two(2.0);
        const Interval b = multiplier / square((upper - lower) / two), offset = sample[axis] - (lower + upper) / two;
        const Interval change = sides[axis] - sample[axis];
        double least = std::numeric_limits<double>::infinity();
        const auto add_part = [&](double from, double to, double derivative) {
          if (!(from <= to)) return;
          // Encloses a t + b (t + offset)^2 for t in [from, to], by completing the square.
          const Interval a(derivative), t(from, to), vertex = a / (two * b);
          const double bound = (b * square(t + offset + vertex) - a * offset - a * vertex / two).lower;
          // If the bound is NaN, `least` becomes NaN.
          least = bound > -std::numeric_limits<double>::infinity() ? std::min(least, bound) : bound;
        };
        add_part(change.lower, std::fmin(change.upper, 0), derivatives.by_axis[axis].upper);
        add_part(std::fmax(change.lower, 0), change.upper, derivatives.by_axis[axis].lower);
        value += Interval(least);
      }
      value = value - multiplier;
    }
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
      if (!is_added[axis]) value += derivatives.by_axis[axis] * (sides[axis] - sample[axis]);
    return value;
  }

  /// Encloses the minimum of a constraint: each axis along which it is monotonic is restricted to the end at which the
  /// constraint is smaller.
  Interval minimum_by_monotonicity(std::size_t k, const IntervalBox& sides, const Derivatives& derivatives,
                                   Scratch& scratch) const {
    IntervalBox vertex = sides;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) {
      if (derivatives.by_axis[axis].lower >= 0) vertex[axis] = Interval(sides[axis].lower);
      if (derivatives.by_axis[axis].upper <= 0) vertex[axis] = Interval(sides[axis].upper);
    }
    constraints_.set_box(vertex, scratch.vertex);
    return constraints_.value(k, vertex[ranges_.size() - 1], scratch.vertex);
  }

  /// The axis along which the undecided constraints vary most; if none is undecided, that of the longest side relative
  /// to the range of the axis.
  std::size_t bisection_axis(const Box& box, const std::array<double, kMaxAxes>& variation) const {
    const auto share = [&](std::size_t axis) {
      const double whole = ranges_[axis][1] - ranges_[axis][0];
      return whole > 0 ? box.sides[axis].width() / whole : 0;
    };
    double maximum = 0, longest = 0;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) longest = std::max(longest, share(axis));
    std::size_t best = 0;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) {
      if (8 * share(axis) < longest)
        // Skip axes along which the box is short, so that its aspect ratio is bounded.
        continue;
      const double priority =
          std::isfinite(variation[axis]) && !box.open.empty() ? variation[axis] + 1e-300 * share(axis) : share(axis);
      if (priority <= maximum) continue;
      maximum = priority;
      best = axis;
    }
    return best;
  }

  /// Bisects a box along box.axis and appends both halves.
  /// @return false if its side has no midpoint in double precision
  static bool bisect(const Box& box, std::vector<Box>& to) {
    const Interval& side = box.sides[box.axis];
    const double middle = side.middle();
    if (!(side.lower < middle && middle < side.upper)) return false;
    for (const Interval& half : {Interval(side.lower, middle), Interval(middle, side.upper)}) {
      to.push_back(box);
      to.back().sides[box.axis] = half;
      to.back().undecided.reset();
      to.back().determinant_sign = 0;
      to.back().is_singular_at_sample = false;
    }
    return true;
  }

  const Constraints& constraints_;
  const Matrices* matrices_;
  std::span<const std::array<double, 2>> ranges_;
  const std::vector<std::vector<std::size_t>>& balls_;
  const BoundsOptions& options_;
  std::vector<Scratch> scratch_;  ///< scratch memory of each worker thread

  /// Two poses at which the determinant of a matrix has opposite signs.
  struct Bracket {
    std::optional<IntervalBox> negative, positive;
    int searches = 0;  ///< number of bracket_root() calls
  };
  static constexpr int kMaxSearches = 100;  // limited, because a determinant also changes its sign at poles
  std::vector<Bracket> brackets_;           ///< one element for each matrix whose determinant is examined
  std::optional<Singularity> singularity_;
};

}  // namespace

PoseCertificate certify(const Constraints& constraints, const Matrices* matrices, const PoseSolid& poses,
                        const BoundsOptions& options) {
  return PoseBranchAndBound(constraints, matrices, poses, options).run();
}

}  // namespace pkm::bounds
