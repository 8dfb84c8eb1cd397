#include "engine/workspace/bounds/pose_box.hpp"

#include <algorithm>

#include <Eigen/SVD>

#include "engine/core/team.hpp"
#include "engine/geometry/singular.hpp"

namespace pkm::bounds {

using expression::Node, expression::Program;

Matrices::Matrices(const expression::Graph& graph, const std::vector<NamedMatrix>& matrices,
                   std::vector<std::size_t> axes, const std::vector<Interval>& inputs)
    : matrices_(matrices), axes_(std::move(axes)) {
  std::vector<Node> entries;
  for (const NamedMatrix& matrix : matrices_)
    entries.insert(entries.end(), matrix.entries.begin(), matrix.entries.end());
  program_ = Program(graph, entries);
  start_ = inputs;
  start_.resize(inputs.size() + program_.registers());
}

void Matrices::enter(const Place& place, Room& room) const {
  const std::size_t inputs = room.size() - program_.registers();
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) room[axes_[axis]] = place[axis];
  program_.run_all<Interval>(std::span(room).first(inputs), std::span(room).subspan(inputs));
}

std::vector<Interval> Matrices::entries(std::size_t k, const Room& room) const {
  const std::size_t inputs = room.size() - program_.registers();
  std::size_t output = 0;
  for (std::size_t before = 0; before < k; ++before) output += matrices_[before].entries.size();
  std::vector<Interval> entries;
  while (entries.size() < matrices_[k].entries.size()) entries.push_back(room[inputs + program_.outputs()[output++]]);
  return entries;
}

namespace {

/// None where an entry is not defined or not bounded.
std::optional<AxisMatrix<double>> middle_of(std::span<const Interval> entries, std::size_t rows, std::size_t columns) {
  AxisMatrix<double> middle(rows, columns);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (!entries[k].is_defined() || !std::isfinite(entries[k].width())) return {};
    middle[k] = entries[k].middle();
  }
  return middle;
}

bool has_full_rank(std::span<const Interval> entries, std::size_t rows, std::size_t columns) {
  const auto middle = middle_of(entries, rows, columns);
  if (!middle || is_rank_deficient(*middle)) return false;
  // any left inverse will do: what is shown of the product is shown of the matrix
  const AxisMatrix<double> inverse = rows == columns ? solve(*middle, AxisMatrix<double>::identity(rows))
                                                     : solve(transpose(*middle) * *middle, transpose(*middle));
  // least |diagonal| and greatest |others| of the product
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

/// By Gaussian elimination over intervals; 0 where a pivot may be 0. @param a  n x n
int sign_of_determinant(std::vector<Interval> a, std::size_t n) {
  int sign = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t lead = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(a[i * n + k].middle()) > std::fabs(a[lead * n + k].middle())) lead = i;
    const Interval pivot = a[lead * n + k];
    if (!pivot.is_defined() || !(pivot.lower > 0 || pivot.upper < 0)) return 0;
    if (pivot.upper < 0) sign = -sign;
    if (lead != k) {
      sign = -sign;
      for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[lead * n + j]);
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const Interval factor = a[i * n + k] / pivot;
      for (std::size_t j = k + 1; j < n; ++j) a[i * n + j] = a[i * n + j] - factor * a[k * n + j];
    }
  }
  return sign;
}

}  // namespace

std::optional<std::size_t> Matrices::singular(const Place& place, Room& room) const {
  enter(place, room);
  for (std::size_t k = 0; k < size(); ++k)
    if (!has_full_rank(entries(k, room), matrices_[k].rows, matrices_[k].columns)) return k;
  return {};
}

int Matrices::sign(std::size_t k, const Place& pose, Room& room) const {
  if (matrices_[k].rows != matrices_[k].columns) return 0;
  enter(pose, room);
  return sign_of_determinant(entries(k, room), matrices_[k].rows);
}

bool Matrices::is_singular_at(std::size_t k, const Place& pose, Room& room) const {
  enter(pose, room);
  const std::size_t rows = matrices_[k].rows, columns = matrices_[k].columns;
  const std::vector<Interval> A = entries(k, room);
  const auto middle = middle_of(A, rows, columns);
  if (!middle) return false;
  Eigen::MatrixXd as_it_is(rows, columns);
  double norm = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      as_it_is(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (*middle)(i, j);
      sum += std::fabs((*middle)(i, j));
    }
    norm = std::fmax(norm, sum);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(as_it_is, Eigen::ComputeFullV);
  const Eigen::VectorXd v = decomposition.matrixV().rightCols(1);
  for (std::size_t i = 0; i < rows; ++i) {
    Interval product(0.0);
    for (std::size_t j = 0; j < columns; ++j) product += A[i * columns + j] * Interval(v[static_cast<Eigen::Index>(j)]);
    if (!(magnitude(product).upper <= kSingularRcond * norm * v.cwiseAbs().maxCoeff())) return false;
  }
  return true;
}

bool Matrices::is_continuous(std::size_t k, const Place& place, Room& room) const {
  enter(place, room);
  return std::ranges::all_of(entries(k, room),
                             [](const Interval& x) { return x.is_continuous() && std::isfinite(x.width()); });
}

namespace {

struct Box {
  Place side;
  std::vector<std::size_t> open;  ///< conditions
  bool regular = false;           ///< for certain
  // what was found:
  std::optional<std::size_t> fails;
  std::optional<std::size_t> singular;  ///< the matrix that may lack rank in it
  int sign = 0;                         ///< of that matrix's determinant in the middle; 0: unknown
  bool is_singular_at_middle = false;   ///< that matrix, to working precision
  std::size_t axis = 0;                 ///< along which it is halved
};

/// A matrix that lacks rank, and where.
struct Singularity {
  std::string what;
  Place pose;
};

class BoxSearch {
 public:
  BoxSearch(const Conditions& conditions, const Matrices* matrices, std::span<const std::array<double, 2>> ranges,
            const BoundsOptions& options)
      : conditions_(conditions), matrices_(matrices), ranges_(ranges), options_(options) {
    for (std::size_t i = 0; i < workers(); ++i)
      rooms_.push_back(
          {conditions.room(), conditions.room(), conditions.room(), matrices ? matrices->room() : Matrices::Room()});
    if (matrices) signs_.resize(matrices->size());
  }

  PosesCertificate run() {
    Box all;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) all.side[axis] = {ranges_[axis][0], ranges_[axis][1]};
    for (std::size_t k = 0; k < conditions_.size(); ++k) all.open.push_back(k);
    all.regular = !matrices_;
    PosesCertificate found;
    if (!matrices_) found.regular.kind = PosesFinding::Kind::not_examined;
    std::vector<Box> boxes = {all};
    while (!boxes.empty()) {
      parallel_for(boxes.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        for (std::size_t i = begin; i < end && !stopped(); ++i)  // a round may take long
          examine(boxes[i], rooms_[worker]);
      });
      found.boxes += boxes.size();
      found.stopped = stopped();
      const bool last = found.stopped || found.boxes >= options_.most_boxes;
      std::vector<Box> next;
      for (const Box& box : boxes) {
        if (box.fails && found.feasible.kind != PosesFinding::Kind::fails)
          found.feasible = {PosesFinding::Kind::fails, conditions_.name(*box.fails), pose(box.side)};
        if (box.fails) continue;
        if (!singularity_ && !box.regular) singularity_ = singularity_of(box);
        if (box.open.empty() && (box.regular || singularity_)) continue;
        const bool halved = !last && halve(box, next);
        if (halved) continue;
        if (!box.open.empty() && found.feasible.kind == PosesFinding::Kind::holds)
          found.feasible = {PosesFinding::Kind::undecided, conditions_.name(box.open.front()), pose(box.side)};
        if (box.singular && !singularity_ && found.regular.kind == PosesFinding::Kind::holds)
          found.regular = {PosesFinding::Kind::undecided, matrices_->name(*box.singular), pose(box.side)};
      }
      boxes = std::move(next);
      // where a pose breaks a condition, what is left is not asked for
      if (found.feasible.kind == PosesFinding::Kind::fails) {
        found.regular = {PosesFinding::Kind::not_examined, "not every pose is feasible"};
        return found;
      }
    }
    if (singularity_) found.regular = {PosesFinding::Kind::fails, singularity_->what, pose(singularity_->pose)};
    return found;
  }

 private:
  struct Room {
    Conditions::Room over, middle, corner;
    Matrices::Room matrices;
  };

  bool stopped() const { return options_.stop && options_.stop(); }

  Pose<double> pose(const Place& place) const {
    Pose<double> pose(ranges_.size());
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) pose[axis] = place[axis].middle();
    return pose;
  }
  static Place middle_of(Place place) {
    for (Interval& side : place) side = Interval(side.middle());
    return place;
  }

  /// What a box shows, alone or with one before it.
  std::optional<Singularity> singularity_of(const Box& box) {
    const std::string& name = matrices_->name(*box.singular);
    if (box.is_singular_at_middle) return Singularity{name + ", to working precision", box.side};
    if (box.sign == 0) return {};
    Signs& seen = signs_[*box.singular];
    (box.sign > 0 ? seen.positive : seen.negative) = middle_of(box.side);
    if (!seen.positive || !seen.negative || seen.brackets == kMostBrackets) return {};
    ++seen.brackets;
    const auto between = root_between(*box.singular, *seen.negative, *seen.positive);
    if (between) return Singularity{name + ", where the determinant changes its sign", *between};
    seen.negative.reset();
    seen.positive.reset();
    return {};
  }

  /// A small box between two poses that has a root of the determinant; none: the entries are not continuous there.
  std::optional<Place> root_between(std::size_t matrix, Place negative, Place positive) {
    Room& room = rooms_.front();
    const auto hull = [&] {
      Place place = negative;
      for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
        place[axis] = {std::min(negative[axis].lower, positive[axis].lower),
                       std::max(negative[axis].upper, positive[axis].upper)};
      return place;
    };
    for (int bisection = 0; bisection < 60; ++bisection) {
      const Place middle = middle_of(hull());
      const int sign = matrices_->sign(matrix, middle, room.matrices);
      if (sign == 0) break;
      (sign > 0 ? positive : negative) = middle;
    }
    const Place place = hull();
    if (!matrices_->is_continuous(matrix, place, room.matrices)) return {};
    return place;
  }

  /// Looks at a box, and at its middle for a pose that breaks a condition.
  void examine(Box& box, Room& room) const {
    std::array<double, kMostAxes> steep{};
    std::vector<std::size_t> open;
    const Place middle = middle_of(box.side);
    const std::size_t last = ranges_.size() - 1;
    conditions_.enter(box.side, room.over);
    conditions_.enter(middle, room.middle);
    for (const std::size_t k : box.open) {
      const Interval value = conditions_.value(k, box.side[last], room.over);
      if (value.is_certified_satisfied()) continue;
      const Interval at_middle = conditions_.value(k, middle[last], room.middle);
      if (value.is_certified_violated() || at_middle.is_certified_violated()) {
        box.fails = k;
        return;
      }
      const Slope slope = conditions_.slope(k, box.side[last], room.over);
      if (slope.is_known && (around(at_middle, middle, box.side, slope).is_certified_satisfied() ||
                             least(k, box.side, slope, room).is_certified_satisfied()))
        continue;
      open.push_back(k);
      for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
        steep[axis] += slope.is_known ? magnitude(slope.by[axis]).upper * box.side[axis].width() : 0;
    }
    box.open = open;
    if (!box.regular && !singularity_) {
      box.singular = matrices_->singular(box.side, room.matrices);
      box.regular = !box.singular;
    }
    if (box.singular) {
      box.sign = matrices_->sign(*box.singular, middle, room.matrices);
      box.is_singular_at_middle = box.sign == 0 && matrices_->is_singular_at(*box.singular, middle, room.matrices);
    }
    box.axis = axis_of(box, steep);
  }

  /// The condition as far from its value in the middle as its slopes lead (the mean value theorem).
  Interval around(Interval value, const Place& middle, const Place& side, const Slope& slope) const {
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) value += slope.by[axis] * (side[axis] - middle[axis]);
    return value;
  }

  /// The condition at the corner where it is least, as far as its slopes say.
  Interval least(std::size_t k, const Place& side, const Slope& slope, Room& room) const {
    Place corner = side;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) {
      if (slope.by[axis].lower >= 0) corner[axis] = Interval(side[axis].lower);
      if (slope.by[axis].upper <= 0) corner[axis] = Interval(side[axis].upper);
    }
    conditions_.enter(corner, room.corner);
    return conditions_.value(k, corner[ranges_.size() - 1], room.corner);
  }

  /// Where the open conditions change most, as far as that is known; else the side that is most of the whole.
  std::size_t axis_of(const Box& box, const std::array<double, kMostAxes>& steep) const {
    const auto share = [&](std::size_t axis) {
      const double whole = ranges_[axis][1] - ranges_[axis][0];
      return whole > 0 ? box.side[axis].width() / whole : 0;
    };
    double most = 0, longest = 0;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) longest = std::max(longest, share(axis));
    std::size_t best = 0;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) {
      if (8 * share(axis) < longest) continue;
      const double here =
          std::isfinite(steep[axis]) && !box.open.empty() ? steep[axis] + 1e-300 * share(axis) : share(axis);
      if (here <= most) continue;
      most = here;
      best = axis;
    }
    return best;
  }

  static bool halve(const Box& box, std::vector<Box>& to) {
    const Interval& side = box.side[box.axis];
    const double middle = side.middle();
    if (!(side.lower < middle && middle < side.upper)) return false;
    for (const Interval& half : {Interval(side.lower, middle), Interval(middle, side.upper)}) {
      to.push_back(box);
      to.back().side[box.axis] = half;
      to.back().singular.reset();
    }
    return true;
  }

  const Conditions& conditions_;
  const Matrices* matrices_;
  std::span<const std::array<double, 2>> ranges_;
  const BoundsOptions& options_;
  std::vector<Room> rooms_;

  /// Poses at which a determinant has either sign.
  struct Signs {
    std::optional<Place> negative, positive;
    int brackets = 0;  ///< that were bisected
  };
  static constexpr int kMostBrackets = 100;  // poles change signs, too
  std::vector<Signs> signs_;                 ///< by matrix
  std::optional<Singularity> singularity_;
};

}  // namespace

PosesCertificate certify(const Conditions& conditions, const Matrices* matrices,
                         std::span<const std::array<double, 2>> ranges, const BoundsOptions& options) {
  return BoxSearch(conditions, matrices, ranges, options).run();
}

}  // namespace pkm::bounds
