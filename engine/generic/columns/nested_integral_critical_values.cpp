// Critical values of an outer coordinate of a nested integral: bracketing of every change of the slice type.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/generic/columns/nested_integral.hpp"

namespace pkm::generic {
namespace {

// Width to which the interval around a critical value is reduced, relative to the range of the coordinate. At a
// square-root singularity, a width w causes a relative error of derivatives of the order of w^(1/2) (3e-8 for 1e-15),
// and of volumes of the order of w^(3/2); so 1e-11 is sufficient for volumes if the slices are lines.
constexpr double kBracketWidth = 1e-15, kBracketWidthOfLines = 1e-11;
// If two slices are farther apart than this, relative to the range of the coordinate, a small component can be the
// reason why they differ. Inner coordinates are then sampled as densely as in the first scan of the range.
constexpr double kSmallDistance = 1e-3;
constexpr double kMergeDistanceOfValues = 1e-8;  // relative to the range: closer critical values are merged
// A change of type within kStepFactor steps of the previous one is due to rounding errors: the next step is longer by
// the factor kStepGrowth. The slices of coordinates that are not the innermost are integrals, hence the larger factor.
constexpr double kStepFactor = 64, kStepGrowth = 8, kStepGrowthOfOuter = 512;

/// Merges two adjacent critical values into `first`, if they are close. Near a tangency of conics, the type changes a
/// second time slightly later, when rounding errors no longer hide the intersections. The merged value is the one at
/// which the square-root singularity begins, which has to be accurate because derivatives are infinite there.
/// @return false if they are not merged
bool join(CriticalValue& first, const CriticalValue& second, double whole) {
  const double apart = second.at - first.at;
  if (first.is_box || apart > kMergeDistanceOfValues * whole) return false;
  if (first.below.hash == 0 || first.above.hash == 0 || second.above.hash == 0) return false;
  const double soon = std::fabs(first.above.measure - first.below.measure),
               in_all = std::fabs(second.above.measure - first.below.measure);
  const double like_root = std::sqrt((first.above.at - first.at) / apart);
  if (!(soon > 0.5 * like_root * in_all)) first.at = second.at;
  first.above = second.above;
  return true;
}

}  // namespace

/// Whether the measure is discontinuous at a critical value between two slices. It is continuous, possibly with a
/// square-root singularity, unless a constraint is satisfied on one side only, or a component was missed on one side.
bool NestedIntegral::is_discontinuous(const Slice& low, const Slice& high, std::size_t level,
                                      const IntegralScratch& scratch) const {
  return ends_in_lines() && low.violated == 0 && high.violated == 0 &&
         std::fabs(low.measure - high.measure) > kDiscontinuity * scratch.levels[level].largest;
}

/// Appends the critical values between two slices in ascending order. When the budget is used up, a single critical
/// value in the middle represents all of them.
void NestedIntegral::find_critical_values(std::size_t level, Slice from, Slice& to, double whole,
                                          CriticalValues& critical_values, IntegralScratch& scratch) const {
  const double least = kClearDistance * whole;
  double step = least;
  for (int more = 0; more < 24 && from.hash != to.hash && !is_exhausted(scratch); ++more) {
    Slice low = from, high = to;
    // Rounding errors can cause many changes of type close to each other. Bisection ends at one of them; extrapolation
    // would visit all of them in turn.
    const bool extrapolates = more < 2;
    bracket(level, low, high, whole, extrapolates, scratch);
    for (int again = 0; again < 4 && level + 1 < levels() && is_discontinuous(low, high, level, scratch); ++again) {
      // If a component was missed on one side, evaluating the slice on that side again finds it now, because the slice
      // on the opposite side has located it.
      const bool is_low = low.measure < high.measure;
      const Slice found = slice(level, is_low ? low.at : high.at, scratch);
      if (found.hash == (is_low ? low : high).hash) break;
      (is_low ? high : low) = found;
      (is_low ? low : high) = is_low ? from : to;
      if (low.hash == high.hash) break;
      bracket(level, low, high, whole, extrapolates, scratch);
    }
    if (high.at == to.at && level + 1 < levels()) {
      const Slice again = slice(level, to.at, scratch);
      const bool is_other = again.hash != to.hash;
      to = again;
      if (is_other) continue;
    }
    // If the type depends on rounding errors, it changes repeatedly within a small distance; increasing steps leave
    // this region.
    const double growth = level + 1 < levels() ? kStepGrowthOfOuter : kStepGrowth;
    step = more > 0 && high.at - from.at < kStepFactor * step ? growth * step : least;
    const double beyond = high.at + step;
    const Slice after = beyond < to.at ? slice(level, beyond, scratch) : to;
    CriticalValue found{high.at, true, low, after};
    if (level + 1 < levels() && is_discontinuous(low, high, level, scratch))
      found.missed_error = unexplained_jump(level, found, scratch) * whole / kSamplesOfLines;
    if (ends_in_lines() || critical_values.empty() || !join(critical_values.back(), found, whole))
      critical_values.push_back(found);
    from = after;
  }
  if (from.hash == to.hash || !is_exhausted(scratch)) return;
  critical_values.push_back({0.5 * (from.at + to.at), false, from, to});
  scratch.levels[level].irreducible_error += (to.at - from.at) * std::max(from.measure, to.measure);
}

void NestedIntegral::find_features(std::size_t level, BoundaryFeatures& features,
                                   const IntegralScratch& scratch) const {
  features.clear();
  if (level + 1 < levels()) {
    const std::vector<SmoothInterval>& parts = scratch.levels[level + 1].parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const SmoothInterval& part = parts[i];
      features.push_back({2 * part.below.hash, 2 * i, part.piece.lower});
      features.push_back({2 * part.below.hash + 1, 2 * i + 1, part.piece.upper});
    }
  } else if (const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_)) {
    planar_slice->find_features(scratch.planar_slice, features);
  } else {
    for (const auto& [z, label] : scratch.column.ends)
      features.push_back(
          {label, label >> 1U, z, 0, std::ranges::find(scratch.column.labels, label) != scratch.column.labels.end()});
  }
}

void NestedIntegral::bracket(std::size_t level, Slice& low, Slice& high, double whole, bool extrapolates,
                             IntegralScratch& scratch) const {
  const double range = whole + std::fabs(low.at),
               near = (ends_in_lines() && !scratch.for_gradient ? kBracketWidthOfLines : kBracketWidth) * range;
  IntegralScratch::Level& own = scratch.levels[level];
  const bool is_innermost = level + 1 == levels(), are_columns = is_innermost && ends_in_lines(),
             are_planar_slices = is_innermost && !ends_in_lines();
  // 1 + index of the independent constraint that is violated only on one side of the critical value; 0 if there is none
  std::uint32_t closing = 0;
  own.solver.reset(are_columns);
  const auto look = [&](double at) {
    const Slice found = slice(level, at, scratch);
    const bool is_upper = found.hash != low.hash;
    const std::uint32_t now = low.violated == 0 ? high.violated : high.violated == 0 ? low.violated : 0;
    if (now != closing) own.solver.reset(are_columns);
    closing = now;
    if (closing != 0) {
      own.solver.add_size(at, is_upper, scratch.registers[plan().independent[level + 1][closing - 1]]);
    } else {
      find_features(level, own.features, scratch);
      own.solver.add_sample(at, is_upper, found.hash, own.features,
                            [&](const BoundaryFeature& feature, const BoundaryFeature& other) {
                              return are_planar_slices ? PlanarSlice::distance(feature, other, scratch.planar_slice)
                                                       : std::numeric_limits<double>::infinity();
                            });
    }
    return found;
  };
  if (are_columns) {
    look(low.at);
    look(high.at);
  }
  // If one end of the interval has not moved for several iterations, evaluate its slice again: the inner integral may
  // have missed a component there that later samples have located.
  const std::array<Slice, 2> outer{low, high};
  std::array<int, 2> stays{};
  const auto resample_other_side = [&](bool has_upper_moved) {
    stays[has_upper_moved] = 0;
    int& steps = stays[!has_upper_moved];
    if (++steps % 4 != 0) return;
    Slice &other = has_upper_moved ? low : high, &differentiable_root = has_upper_moved ? high : low;
    const Slice again = slice(level, other.at, scratch);
    if (again.hash == other.hash) return;
    if (again.hash == differentiable_root.hash) {
      differentiable_root = again;
      other = outer[!has_upper_moved];
    } else {
      other = again;
    }
    own.solver.reset(are_columns);
    stays = {};
  };
  while (high.at - low.at > near ||
         (is_discontinuous(low, high, level, scratch) && high.at - low.at > kBracketWidth * range)) {
    const double wanted = high.at - low.at > near ? near : kBracketWidth * range;
    const double at = extrapolates ? own.solver.next_sample(low.at, high.at, wanted) : 0.5 * (low.at + high.at);
    if (at <= low.at || at >= high.at) break;
    if (level == 0) scratch.is_scanning = high.at - low.at > kSmallDistance * whole;
    const Slice next = look(at);
    // The sample has neither the type of `low` nor the type of `high`: rounding errors may have determined its type.
    if (extrapolates && next.hash != low.hash && next.hash != high.hash) {
      extrapolates = false;
      if (are_planar_slices) {
        low = outer[0];
        high = outer[1];
        continue;
      }
    }
    (next.hash == low.hash ? low : high) = next;
    if (!is_innermost) resample_other_side(next.hash != low.hash);
  }
  if (level == 0) scratch.is_scanning = false;
}

}  // namespace pkm::generic
