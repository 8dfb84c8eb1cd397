#include "engine/workspace/bounds/column_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/nonnegative_intervals.hpp"

namespace pkm::bounds {

std::int64_t Heights::below(double height, std::int64_t from, std::int64_t to) const {
  const double place = std::floor((height - lower) / (upper - lower) * static_cast<double>(kSteps));
  std::int64_t step = static_cast<std::int64_t>(std::clamp(place, static_cast<double>(from), static_cast<double>(to)));
  while (step > from && at(step) > height) --step;
  return step;
}
std::int64_t Heights::above(double height, std::int64_t from, std::int64_t to) const {
  const double place = std::ceil((height - lower) / (upper - lower) * static_cast<double>(kSteps));
  std::int64_t step = static_cast<std::int64_t>(std::clamp(place, static_cast<double>(from), static_cast<double>(to)));
  while (step < to && at(step) < height) ++step;
  return step;
}

namespace {

constexpr std::int64_t kLeastSplit = 64;  ///< steps

/// Neighbours with the same open conditions as one.
void merge(std::vector<Segment>& segments) {
  std::size_t last = 0;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[last].to == segments[i].from && segments[last].open == segments[i].open)
      segments[last].to = segments[i].to;
    else
      segments[++last] = segments[i];
  }
  if (!segments.empty()) segments.resize(last + 1);
}

}  // namespace

ColumnExamination::Root ColumnExamination::root_of(std::size_t condition, const Segment& segment, const Place& place,
                                                   const Place& centre, Room& room) const {
  const std::size_t z = conditions_.axes() - 1;
  const Slope slope = conditions_.slope(condition, place[z], room.over);
  if (!slope.value.is_continuous()) return {};
  Root root{.is_continuous = true};
  const Interval steep = slope.by[z];
  root.is_known = slope.is_known_along && !steep.holds(0);
  root.rises = steep.lower > 0;
  // near the root over the centre, or the end that is nearest to it
  const auto at = [&](double height) { return conditions_.value(condition, Interval(height), room.centre).middle(); };
  const double from = place[z].lower, to = place[z].upper;
  double guess = place[z].middle();
  if (root.is_known) {
    for (int step = 0; step < 2; ++step) guess = std::clamp(guess - at(guess) / steep.middle(), from, to);
  } else {
    const double at_from = at(from), at_to = at(to);
    guess = (at_from < 0) != (at_to < 0) ? bracketed_root(at, from, at_from, to, at_to, 1e-3 * (to - from))
                                         : (std::fabs(at_from) < std::fabs(at_to) ? from : to);
  }
  root.guess = heights_.below(guess, segment.from, segment.to);
  if (!root.is_known) return root;
  const Interval near(heights_.at(root.guess));
  if (!slope.is_known) {  // over every place of the box by itself
    root.zone = root.mean = near - conditions_.value(condition, near, room.over) / steep;
    root.is_known = !root.zone.is_empty();
    return root;
  }
  const Interval over_centre = near - conditions_.value(condition, near, room.centre) / steep;
  Interval away(0.0), spread(0.0);
  for (std::size_t axis = 0; axis < z; ++axis) {
    const Interval gradient = slope.by[axis] / steep;
    const Interval from_centre = place[axis] - centre[axis];
    const Interval width = Interval(place[axis].upper) - Interval(place[axis].lower);
    // the middle, as a number, is not quite the middle
    const Interval off = (Interval(place[axis].lower) + Interval(place[axis].upper)) * Interval(0.5) - centre[axis];
    const Interval half = (Interval(gradient.upper) - Interval(gradient.lower)) * Interval(0.5);
    away = away + gradient * from_centre;
    spread = spread + half * width * Interval(0.25) + magnitude(gradient) * magnitude(off);
  }
  root.zone = over_centre - away;
  root.mean = over_centre + Interval(-spread.upper, spread.upper);
  root.is_known = !root.zone.is_empty() && !root.mean.is_empty();
  return root;
}

/// Whether a condition has another sign at the other end of a segment, over the box's centre.
bool ColumnExamination::changes_at_centre(std::size_t condition, const Interval& along, Room& room) const {
  const auto fails_at = [&](double height) {
    return conditions_.value(condition, Interval(height), room.centre).middle() < 0;
  };
  return fails_at(along.lower) != fails_at(along.upper);
}

/// About how far the root over the centre moves over the box, and half of that; infinity: nobody knows.
double ColumnExamination::margin_of(std::size_t condition, std::int64_t guess, const Place& place, Room& room) const {
  const std::size_t z = conditions_.axes() - 1;
  const Slope there = conditions_.slope(condition, Interval(heights_.at(guess)), room.centre);
  double moves = 0;
  for (std::size_t axis = 0; axis < z; ++axis) moves += std::fabs(there.by[axis].middle()) * place[axis].width();
  const double margin = 0.75 * moves / std::fabs(there.by[z].middle());
  return std::isfinite(margin) ? margin : std::numeric_limits<double>::infinity();
}

void ColumnExamination::examine(ColumnBox& box, Room& room, std::vector<Step>* steps, bool skipped) const {
  const std::size_t z = conditions_.axes() - 1;
  const auto note = [&](Step step) {
    if (steps) steps->push_back(step);
  };
  Place place, centre;
  Interval area(1.0);
  double widest = 0;  // of the box's sides, as a share of the whole
  for (std::size_t axis = 0; axis < z; ++axis) {
    const auto [from, to] = box.side[axis];
    place[axis] = {from, to};
    centre[axis] = Interval(place[axis].middle());
    area = area * (Interval(to) - Interval(from));
    widest = std::max(widest, (to - from) / (whole_[axis][1] - whole_[axis][0]));
  }
  conditions_.enter(place, room.over);
  conditions_.enter(centre, room.centre);
  const auto shortest = static_cast<std::int64_t>(0.5 * widest * static_cast<double>(Heights::kSteps));

  std::vector<Segment>& left = room.left;
  left.swap(box.open);
  merge(left);
  std::ranges::reverse(left);
  box.open.clear();
  Interval length(0.0);  // feasible, of the open segments
  while (!left.empty()) {
    Segment segment = left.back();
    left.pop_back();
    if (skipped) {
      note({Step::Kind::stays});
      length += Interval(0, heights_.length(segment.from, segment.to).upper);
      box.open.push_back(segment);
      continue;
    }
    place[z] = heights_.between(segment.from, segment.to);

    bool fails = false;
    for (std::size_t k = 0; k < conditions_.size() && !fails; ++k) {
      if (!segment.open[k]) continue;
      const Interval value = conditions_.value(k, place[z], room.over);
      fails = value.is_certified_violated();
      if (fails) note({Step::Kind::fails, k});
      if (!value.is_certified_satisfied()) continue;
      segment.open.reset(k);
      note({Step::Kind::holds, k});
    }
    if (fails) continue;
    if (segment.open.none()) {
      box.inside += heights_.length(segment.from, segment.to);
      continue;
    }

    bool divided = false, may_halve = false;
    Root root;
    const auto push = [&](std::int64_t from, std::int64_t to, const Open& open) {
      if (from < to) left.push_back({from, to, open});
      divided = true;
    };
    /// Three parts, the lowest to be looked at first.
    const auto split = [&](std::int64_t low, std::int64_t high) {
      note({Step::Kind::splits, 0, low, high});
      push(high, segment.to, segment.open);
      push(low, high, segment.open);
      push(segment.from, low, segment.open);
    };
    const std::int64_t size = segment.to - segment.from;
    for (std::size_t k = 0; k < conditions_.size() && !divided; ++k) {
      if (!segment.open[k] || !conditions_.depends(k, z)) continue;
      root = root_of(k, segment, place, centre, room);
      may_halve = may_halve || !root.is_known;
      if (root.is_known) {
        // a step further than it has to be, for those who round otherwise
        const std::int64_t low = std::max(heights_.below(root.zone.lower, segment.from, segment.to) - 1, segment.from);
        const std::int64_t high = std::min(heights_.above(root.zone.upper, low, segment.to) + 1, segment.to);
        if (4 * (high - low) <= 3 * size) {
          note({Step::Kind::trims, k, low, high, root.guess});
          Open others = segment.open;
          others.reset(k);
          if (root.rises) push(high, segment.to, others);
          push(low, high, segment.open);
          if (!root.rises) push(segment.from, low, others);
          continue;
        }
      }
      if (!root.is_continuous || size <= kLeastSplit || !changes_at_centre(k, place[z], room)) continue;
      // around the guess, but no slice that is next to nothing
      const double guess = heights_.at(root.guess), whole = place[z].upper - place[z].lower;
      const double margin = std::max(std::min(margin_of(k, root.guess, place, room), whole), whole / 16);
      const std::int64_t low = heights_.below(guess - margin, segment.from, segment.to);
      const std::int64_t high = heights_.above(guess + margin, low, segment.to);
      if (4 * (high - low) <= 3 * size) split(low, high);
    }
    if (divided) continue;

    const Interval all = heights_.length(segment.from, segment.to);
    if (may_halve && size > std::max<std::int64_t>(shortest, 1)) {
      split(segment.from + size / 2, segment.from + size / 2);
      continue;
    }
    const bool one_root = segment.open.count() == 1 && root.is_known && root.zone.lower >= place[z].lower &&
                          root.zone.upper <= place[z].upper;
    note({one_root ? Step::Kind::has_root : Step::Kind::stays, 0, 0, 0, root.guess});
    Interval share(0, all.upper);
    if (one_root) {
      const Interval above = Interval(place[z].upper) - root.mean, below = root.mean - Interval(place[z].lower);
      share = intersection(root.rises ? above : below, share);
    }
    length += share;
    box.open.push_back(segment);
  }
  box.volume = area * (box.inside + length);
  box.volume.lower = std::max(box.volume.lower, 0.0);
}

}  // namespace pkm::bounds
