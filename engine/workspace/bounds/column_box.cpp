#include "engine/workspace/bounds/column_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/roots.hpp"

namespace pkm::bounds {

std::int64_t ColumnGrid::step_below(double z, std::int64_t from, std::int64_t to) const {
  const double estimate = std::floor((z - lower) / (upper - lower) * static_cast<double>(kSteps));
  std::int64_t step =
      static_cast<std::int64_t>(std::clamp(estimate, static_cast<double>(from), static_cast<double>(to)));
  while (step > from && at(step) > z) --step;
  return step;
}
std::int64_t ColumnGrid::step_above(double z, std::int64_t from, std::int64_t to) const {
  const double estimate = std::ceil((z - lower) / (upper - lower) * static_cast<double>(kSteps));
  std::int64_t step =
      static_cast<std::int64_t>(std::clamp(estimate, static_cast<double>(from), static_cast<double>(to)));
  while (step < to && at(step) < z) ++step;
  return step;
}

namespace {

// Segments that are shorter, in steps of the z grid, are not split around a root.
constexpr std::int64_t kMinSplitSize = 64;

/// Merges adjacent segments of a column whose undecided constraints are the same.
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

ColumnPruner::Root ColumnPruner::enclose_root(std::size_t constraint, const Segment& segment, const IntervalBox& sides,
                                              const IntervalBox& centre, Scratch& scratch) const {
  const std::size_t z = constraints_.axes() - 1;
  const Derivatives over_box = constraints_.derivatives(constraint, sides[z], scratch.box);
  if (!over_box.value.is_continuous()) return {};
  Root root{.is_continuous = true};
  const Interval by_z = over_box.by_axis[z];
  root.is_enclosed = over_box.is_last_derivative_known && !by_z.holds(0);
  root.is_increasing = by_z.lower > 0;
  // Choose the expansion point z_c: near the root over the centre of the box, or, if this root is outside of the
  // segment, the nearer end of the segment.
  const auto value_at = [&](double height) {
    return constraints_.value(constraint, Interval(height), scratch.centre).middle();
  };
  const double from = sides[z].lower, to = sides[z].upper;
  double estimate = sides[z].middle();
  if (root.is_enclosed) {
    for (int step = 0; step < 2; ++step) estimate = std::clamp(estimate - value_at(estimate) / by_z.middle(), from, to);
  } else {
    const double at_from = value_at(from), at_to = value_at(to);
    estimate = (at_from < 0) != (at_to < 0) ? refine_root(value_at, from, at_from, to, at_to, 1e-3 * (to - from))
                                            : (std::fabs(at_from) < std::fabs(at_to) ? from : to);
  }
  root.expansion = grid_.step_below(estimate, segment.from, segment.to);
  if (!root.is_enclosed) return root;
  const Interval z_c(grid_.at(root.expansion));
  if (!over_box.is_known) {  // the derivatives with respect to x are unknown: enclose the root over every x directly
    root.range = root.mean = z_c - constraints_.value(constraint, z_c, scratch.box) / by_z;
    root.is_enclosed = !root.range.is_empty();
    return root;
  }
  const Interval over_centre = z_c - constraints_.value(constraint, z_c, scratch.centre) / by_z;
  Interval displacement(0.0), spread(0.0);
  for (std::size_t axis = 0; axis < z; ++axis) {
    const Interval gradient = over_box.by_axis[axis] / by_z;
    const Interval from_centre = sides[axis] - centre[axis];
    const Interval width = Interval(sides[axis].upper) - Interval(sides[axis].lower);
    // The centre is rounded: enclose the offset of the exact midpoint from it.
    const Interval offset = (Interval(sides[axis].lower) + Interval(sides[axis].upper)) * Interval(0.5) - centre[axis];
    const Interval half_width = (Interval(gradient.upper) - Interval(gradient.lower)) * Interval(0.5);
    displacement = displacement + gradient * from_centre;
    spread = spread + half_width * width * Interval(0.25) + magnitude(gradient) * magnitude(offset);
  }
  root.range = over_centre - displacement;
  root.mean = over_centre + Interval(-spread.upper, spread.upper);
  root.is_enclosed = !root.range.is_empty() && !root.mean.is_empty();
  return root;
}

/// @return true if the constraint has different signs at the two ends of a segment, with x at the centre of the box
bool ColumnPruner::changes_sign_at_centre(std::size_t constraint, const Interval& segment, Scratch& scratch) const {
  const auto is_negative_at = [&](double height) {
    return constraints_.value(constraint, Interval(height), scratch.centre).middle() < 0;
  };
  return is_negative_at(segment.lower) != is_negative_at(segment.upper);
}

/// Bound of the displacement of a root z*(x) over the box from its position at the centre of the box: 1.5 times the
/// first-order estimate sum_i |G_i| width(X_i) / (2 |G_z|); infinity if G_z vanishes.
double ColumnPruner::root_displacement(std::size_t constraint, std::int64_t expansion, const IntervalBox& sides,
                                       Scratch& scratch) const {
  const std::size_t z = constraints_.axes() - 1;
  const Derivatives at_root = constraints_.derivatives(constraint, Interval(grid_.at(expansion)), scratch.centre);
  double change = 0;
  for (std::size_t axis = 0; axis < z; ++axis)
    change += std::fabs(at_root.by_axis[axis].middle()) * sides[axis].width();
  const double displacement = 0.75 * change / std::fabs(at_root.by_axis[z].middle());
  return std::isfinite(displacement) ? displacement : std::numeric_limits<double>::infinity();
}

void ColumnPruner::prune(ColumnBox& box, Scratch& scratch, std::vector<Step>* steps, bool skipped) const {
  const std::size_t z = constraints_.axes() - 1;
  const auto record = [&](Step step) {
    if (steps) steps->push_back(step);
  };
  IntervalBox sides, centre;
  Interval area(1.0);
  double widest = 0;  // longest side of the box, relative to the range of its axis
  for (std::size_t axis = 0; axis < z; ++axis) {
    const auto [from, to] = box.side[axis];
    sides[axis] = {from, to};
    centre[axis] = Interval(sides[axis].middle());
    area = area * (Interval(to) - Interval(from));
    widest = std::max(widest, (to - from) / (whole_[axis][1] - whole_[axis][0]));
  }
  constraints_.set_box(sides, scratch.box);
  constraints_.set_box(centre, scratch.centre);
  const auto min_bisected_size = static_cast<std::int64_t>(0.5 * widest * static_cast<double>(ColumnGrid::kSteps));

  std::vector<Segment>& pending = scratch.pending;  // stack with the lowest segment on top
  pending.swap(box.open);
  merge(pending);
  std::ranges::reverse(pending);
  box.open.clear();
  Interval length(0.0);  // enclosure of the feasible length in the open segments
  while (!pending.empty()) {
    Segment segment = pending.back();
    pending.pop_back();
    if (skipped) {
      record({Step::Kind::open});
      length += Interval(0, grid_.length(segment.from, segment.to).upper);
      box.open.push_back(segment);
      continue;
    }
    sides[z] = grid_.between(segment.from, segment.to);

    bool violated = false;
    for (std::size_t k = 0; k < constraints_.size() && !violated; ++k) {
      if (!segment.open[k]) continue;
      const Interval value = constraints_.value(k, sides[z], scratch.box);
      violated = value.is_certified_violated();
      if (violated) record({Step::Kind::violated, k});
      if (!value.is_certified_satisfied()) continue;
      segment.open.reset(k);
      record({Step::Kind::satisfied, k});
    }
    if (violated) continue;
    if (segment.open.none()) {
      box.feasible_length += grid_.length(segment.from, segment.to);
      continue;
    }

    bool divided = false, may_bisect = false, all_continuous = true;
    Root root;
    const auto push = [&](std::int64_t from, std::int64_t to, const OpenConstraints& open) {
      if (from < to) pending.push_back({from, to, open});
      divided = true;
    };
    const auto split = [&](std::int64_t low, std::int64_t high) {
      record({Step::Kind::split, 0, low, high});
      push(high, segment.to, segment.open);
      push(low, high, segment.open);
      push(segment.from, low, segment.open);
    };
    const std::int64_t size = segment.to - segment.from;
    for (std::size_t k = 0; k < constraints_.size() && !divided; ++k) {
      if (!segment.open[k] || !constraints_.depends(k, z)) continue;
      root = enclose_root(k, segment, sides, centre, scratch);
      may_bisect = may_bisect || !root.is_enclosed;
      all_continuous = all_continuous && root.is_continuous;
      if (root.is_enclosed) {
        // Extend the enclosure R of the root by one grid step on either side, because a proof checker may round
        // differently.
        const std::int64_t low =
            std::max(grid_.step_below(root.range.lower, segment.from, segment.to) - 1, segment.from);
        const std::int64_t high = std::min(grid_.step_above(root.range.upper, low, segment.to) + 1, segment.to);
        if (4 * (high - low) <= 3 * size) {
          record({Step::Kind::contracted, k, low, high, root.expansion});
          OpenConstraints others = segment.open;
          others.reset(k);
          if (root.is_increasing) push(high, segment.to, others);
          push(low, high, segment.open);
          if (!root.is_increasing) push(segment.from, low, others);
          continue;
        }
      }
      if (!root.is_continuous || size <= kMinSplitSize || !changes_sign_at_centre(k, sides[z], scratch)) continue;
      // Split around the root. The middle part extends at least 1/16 of the segment to either side of z_c.
      const double at_root = grid_.at(root.expansion), whole = sides[z].upper - sides[z].lower;
      const double margin = std::max(std::min(root_displacement(k, root.expansion, sides, scratch), whole), whole / 16);
      const std::int64_t low = grid_.step_below(at_root - margin, segment.from, segment.to);
      const std::int64_t high = grid_.step_above(at_root + margin, low, segment.to);
      if (4 * (high - low) <= 3 * size) split(low, high);
    }
    if (divided) continue;

    const Interval all = grid_.length(segment.from, segment.to);
    // If a constraint may be undefined on a segment, it can remain undecided after any number of bisections. Such
    // segments are not bisected below this size, because without outer coordinates this would take very long.
    const std::int64_t min_size = all_continuous ? 1 : ColumnGrid::kSteps >> 16U;
    if (may_bisect && size > std::max(min_bisected_size, min_size)) {
      split(segment.from + size / 2, segment.from + size / 2);
      continue;
    }
    const bool one_root = segment.open.count() == 1 && root.is_enclosed && root.range.lower >= sides[z].lower &&
                          root.range.upper <= sides[z].upper;
    record({one_root ? Step::Kind::one_root : Step::Kind::open, 0, 0, 0, root.expansion});
    Interval feasible(0, all.upper);
    if (one_root) {
      const Interval above = Interval(sides[z].upper) - root.mean, below = root.mean - Interval(sides[z].lower);
      feasible = intersection(root.is_increasing ? above : below, feasible);
    }
    length += feasible;
    box.open.push_back(segment);
  }
  box.volume = area * (box.feasible_length + length);
  box.volume.lower = std::max(box.volume.lower, 0.0);
}

}  // namespace pkm::bounds
