#include "engine/survey/bounds/pose_box.hpp"

#include <algorithm>

#include "engine/core/team.hpp"
#include "engine/model/singular.hpp"

namespace pkm::bounds {

using graph::Node, graph::Program;

Matrices::Matrices(const graph::Graph& graph, const std::vector<NamedMatrix>& matrices, std::vector<std::size_t> axes,
                   const std::vector<Interval>& inputs)
    : matrices_(matrices), axes_(std::move(axes)) {
  std::vector<Node> entries;
  for (const NamedMatrix& matrix : matrices_)
    entries.insert(entries.end(), matrix.entries.begin(), matrix.entries.end());
  program_ = Program(graph, entries);
  start_ = inputs;
  start_.resize(inputs.size() + program_.registers());
}

const std::string* Matrices::singular(const Place& place, Room& room) const {
  const std::size_t inputs = room.size() - program_.registers();
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) room[axes_[axis]] = place[axis];
  const std::span<Interval> registers = std::span(room).subspan(inputs);
  program_.run_all<Interval>(std::span(room).first(inputs), registers);
  std::size_t output = 0;
  for (const NamedMatrix& matrix : matrices_) {
    std::vector<Interval> entries;
    while (entries.size() < matrix.rows * matrix.rows) entries.push_back(registers[program_.outputs()[output++]]);
    if (!is_regular(entries, matrix.rows)) return &matrix.name;
  }
  return nullptr;
}

bool Matrices::is_regular(std::span<const Interval> entries, std::size_t rows) const {
  AxisMatrix<double> middle = AxisMatrix<double>::zero(rows, rows);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < rows; ++j) {
      const Interval& entry = entries[i * rows + j];
      if (!entry.is_defined() || !std::isfinite(entry.width())) return false;
      middle(i, j) = entry.middle();
    }
  if (is_singular(middle)) return false;
  const AxisMatrix<double> inverse = solve(middle, AxisMatrix<double>::identity(rows));
  for (std::size_t i = 0; i < rows; ++i) {
    Interval diagonal(0.0), others(0.0);
    for (std::size_t j = 0; j < rows; ++j) {
      Interval product(0.0);
      for (std::size_t k = 0; k < rows; ++k) product += Interval(inverse(i, k)) * entries[k * rows + j];
      if (product.is_empty()) return false;
      if (i == j)
        diagonal = product;
      else
        others += magnitude(product);
    }
    if (!(diagonal.lower > others.upper)) return false;
  }
  return true;
}

namespace {

struct Box {
  Place side;
  std::vector<std::size_t> open;  ///< conditions
  bool regular = false;           ///< for certain
  // what was found:
  std::optional<std::size_t> fails;
  const std::string* singular = nullptr;
  std::size_t axis = 0;  ///< along which it is halved
};

class BoxSearch {
 public:
  BoxSearch(const Conditions& conditions, const Matrices* matrices, std::span<const std::array<double, 2>> ranges,
            const BoundsOptions& options)
      : conditions_(conditions), matrices_(matrices), ranges_(ranges), options_(options) {
    for (std::size_t i = 0; i < workers(); ++i)
      rooms_.push_back(
          {conditions.room(), conditions.room(), conditions.room(), matrices ? matrices->room() : Matrices::Room()});
  }

  PosesCertificate run() {
    Box all;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) all.side[axis] = {ranges_[axis][0], ranges_[axis][1]};
    for (std::size_t k = 0; k < conditions_.size(); ++k) all.open.push_back(k);
    all.regular = !matrices_;
    PosesCertificate found;
    if (matrices_) found.regular.emplace();
    std::vector<Box> boxes = {all};
    while (!boxes.empty()) {
      share_pieces(boxes.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
        for (std::size_t i = begin; i < end && !stopped(); ++i)  // a round may take long
          examine(boxes[i], rooms_[worker]);
      });
      found.boxes += boxes.size();
      found.stopped = stopped();
      const bool last = found.stopped || found.boxes >= options_.most_boxes;
      std::vector<Box> next;
      for (const Box& box : boxes) {
        if (box.fails && found.feasible.kind != PosesVerdict::Kind::fails)
          found.feasible = {PosesVerdict::Kind::fails, conditions_.name(*box.fails), pose(box)};
        if (box.fails || (box.open.empty() && box.regular)) continue;
        const bool halved = !last && halve(box, next);
        if (halved) continue;
        if (!box.open.empty() && found.feasible.kind == PosesVerdict::Kind::holds)
          found.feasible = {PosesVerdict::Kind::undecided, conditions_.name(box.open.front()), pose(box)};
        if (!box.regular && found.regular->kind == PosesVerdict::Kind::holds)
          found.regular = {PosesVerdict::Kind::undecided, box.singular ? *box.singular : "", pose(box)};
      }
      boxes = std::move(next);
      // where a pose breaks a condition, what is left is not asked for
      if (found.feasible.kind == PosesVerdict::Kind::fails) {
        if (found.regular) found.regular.reset();
        return found;
      }
    }
    return found;
  }

 private:
  struct Room {
    Conditions::Room over, middle, corner;
    Matrices::Room matrices;
  };

  bool stopped() const { return options_.stop && options_.stop(); }

  Pose<double> pose(const Box& box) const {
    Pose<double> pose(ranges_.size());
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) pose[axis] = box.side[axis].middle();
    return pose;
  }

  /// Looks at a box, and at its middle for a pose that breaks a condition.
  void examine(Box& box, Room& room) const {
    std::array<double, kMostAxes> steep{};
    std::vector<std::size_t> open;
    Place middle = box.side;
    for (Interval& side : middle) side = Interval(side.middle());
    const std::size_t last = ranges_.size() - 1;
    conditions_.enter(box.side, room.over);
    conditions_.enter(middle, room.middle);
    for (const std::size_t k : box.open) {
      const Interval value = conditions_.value(k, box.side[last], room.over);
      if (value.surely_holds()) continue;
      const Interval at_middle = conditions_.value(k, middle[last], room.middle);
      if (value.surely_fails() || at_middle.surely_fails()) {
        box.fails = k;
        return;
      }
      const Slope slope = conditions_.slope(k, box.side[last], room.over);
      if (slope.is_known &&
          (around(at_middle, middle, box.side, slope).surely_holds() || least(k, box.side, slope, room).surely_holds()))
        continue;
      open.push_back(k);
      for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
        steep[axis] += slope.is_known ? magnitude(slope.by[axis]).upper * box.side[axis].width() : 0;
    }
    box.open = open;
    if (!box.regular) {
      box.singular = matrices_->singular(box.side, room.matrices);
      box.regular = box.singular == nullptr;
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
      to.back().singular = nullptr;
    }
    return true;
  }

  const Conditions& conditions_;
  const Matrices* matrices_;
  std::span<const std::array<double, 2>> ranges_;
  const BoundsOptions& options_;
  std::vector<Room> rooms_;
};

}  // namespace

PosesCertificate certify(const Conditions& conditions, const Matrices* matrices,
                         std::span<const std::array<double, 2>> ranges, const BoundsOptions& options) {
  return BoxSearch(conditions, matrices, ranges, options).run();
}

}  // namespace pkm::bounds
