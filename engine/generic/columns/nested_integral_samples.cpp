// Samples of an outer coordinate at which the types of slices are compared: over the whole range, at expected
// intervals, and in boxes that interval arithmetic does not prove empty.
#include <algorithm>
#include <cmath>

#include "engine/generic/columns/nested_integral.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kSparseRatio = 8;  // a workspace is sparse if at most one of this many samples is non-empty
// Numbers of samples of a coordinate.
// kSamples, for planar slices: [0] if there is one outer coordinate, [1] for each of several.
// kSamplesInLines, for slices that are lines: [0] of the outermost coordinate; of the next one [1] during the first
// scan of the outermost one, [2] later, when intervals are expected.
// kSamplesInside: of a single outer coordinate between the first and the last non-empty slice, to find narrow gaps.
constexpr int kSamples[] = {40, 24}, kSamplesInLines[] = {kSamplesOfLines, 192, 12}, kSamplesInside = 240;

/// Position of sample i of `places` samples in (low, high). The samples are not equidistant, because the critical
/// values of a symmetric mechanism can have equal distances.
double sample_position(double low, double high, int i, int places) {
  const double step = 0.618 * i;
  return low + (high - low) * (i + 0.4 + 0.2 * (step - std::floor(step))) / places;
}

}  // namespace

/// Evaluates the slices on both sides of each change of type again. If the intervals of an inner coordinate are narrow,
/// only some of the neighbouring samples may have found them; now all of them expect these intervals.
void NestedIntegral::resample_changes(std::size_t level, IntegralScratch& scratch) const {
  std::vector<Slice>& scanned = scratch.levels[level].scanned;
  bool is_new = true;
  for (int pass = 0; pass < 4 && is_new; ++pass) {
    is_new = false;
    for (std::size_t i = 1; i < scanned.size(); ++i) {
      if (scanned[i - 1].hash == scanned[i].hash) continue;
      for (const std::size_t k : {i - 1, i}) {
        const Slice again = slice(level, scanned[k].at, scratch);
        is_new = is_new || again.hash != scanned[k].hash;
        scanned[k] = again;
      }
    }
  }
}

/// Samples the outermost coordinate between empty slices, at the centres of boxes that are not proven to be empty.
/// Boxes are bisected until all are proven to be empty, or there are too many of them.
void NestedIntegral::search_empty_gaps(IntegralScratch& scratch) const {
  constexpr std::size_t kMany = 2000;
  std::vector<Slice>& scanned = scratch.levels[0].scanned;
  const auto is_found = [](const Slice& slice) { return slice.hash != 0; };
  const auto found = static_cast<std::size_t>(std::ranges::count_if(scanned, is_found));
  const bool has_found = found > 0;
  if (levels() > 1 && has_found) {  // a further slice is an integral over the inner coordinates and takes long
    if (kSparseRatio * found <= scanned.size()) search_sparse_components(scratch);
    return;
  }

  const ComponentSearch search(plan());
  search.start(scratch.registers, scratch.search);
  for (std::size_t first = 0, last; first < scanned.size(); first = last + 1) {
    for (last = first; last < scanned.size() && scanned[last].hash == 0; ++last) {
    }
    if (last > first + 1) search.add(scanned[first].at, scanned[last - 1].at, scratch.search);
  }
  std::vector<double>& places = scratch.levels[0].places;
  const std::size_t known = scanned.size();
  const long evaluations = scratch.evaluations;
  scratch.has_hints = true;
  std::vector<SearchScratch::Box>& boxes = scratch.search.boxes;
  while (scratch.search.examined < kMany && !is_exhausted(scratch)) {
    search.examine(scratch.search);
    if (boxes.empty()) break;
    places.clear();
    for (const SearchScratch::Box& box : boxes)
      if (search.bisects_outermost(box, scratch.search))
        places.push_back(0.5 * (box.side[0].lower + box.side[0].upper));
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const double at : places) {
      scanned.push_back(slice(0, at, scratch));
      if (scanned.back().hash != 0) search.remove_containing(at, scratch.search);
    }
    search.bisect(scratch.search);
  }
  scratch.has_hints = false;
  if (!has_found) scratch.levels[0].irreducible_error += search.undecided_volume(scratch.search);
  if (std::any_of(scanned.begin() + static_cast<std::ptrdiff_t>(known), scanned.end(), is_found)) {
    std::ranges::sort(scanned, {}, &Slice::at);
  } else {  // all new slices are empty, so that the integral is left unchanged
    scanned.resize(known);
    scratch.evaluations = evaluations;
  }
}

/// To be called if few samples are non-empty, i.e. the workspace is small and may have further components. Adds samples
/// of the outermost coordinate in the boxes that can contain components; from now on, every slice samples its inner
/// coordinates there, too (has_hints).
void NestedIntegral::search_sparse_components(IntegralScratch& scratch) const {
  constexpr std::size_t kMost = 6000, kManyBoxes = 1500;
  constexpr int kPlaces = 9;
  std::vector<Slice>& scanned = scratch.levels[0].scanned;
  const ComponentSearch search(plan());
  search.start(scratch.registers, scratch.search);
  search.add(scanned.front().at, scanned.back().at, scratch.search);
  while (true) {
    search.examine(scratch.search);
    const std::size_t left = scratch.search.boxes.size();
    if (left == 0 || left > kManyBoxes || scratch.search.examined > kMost) break;
    search.bisect(scratch.search);
  }
  scratch.has_hints = true;
  std::vector<double>& places = scratch.levels[0].places;
  places.clear();
  search.add_samples(0, {}, kPlaces, places, scratch.search);
  for (const double at : places) scanned.push_back(slice(0, at, scratch));
  std::ranges::sort(scanned, {}, &Slice::at);
}

/// Adds samples between the first and the last non-empty slice, to find gaps in the workspace.
void NestedIntegral::refine_support(IntegralScratch& scratch) const {
  std::vector<Slice>& scanned = scratch.levels[0].scanned;
  const auto is_found = [](const Slice& slice) { return slice.hash != 0; };
  const auto first = std::ranges::find_if(scanned, is_found);
  if (first == scanned.end()) return;
  const auto last = std::find_if(scanned.rbegin(), scanned.rend(), is_found);
  const double low = (first == scanned.begin() ? first : first - 1)->at,
               high = (last == scanned.rbegin() ? last : last - 1)->at;
  for (int i = 0; i < kSamplesInside; ++i)
    scanned.push_back(slice(0, sample_position(low, high, i, kSamplesInside), scratch));
  std::ranges::sort(scanned, {}, &Slice::at);
}

/// Sets the hints of each inner coordinate, i.e. values at which feasible points are expected, to samples in those
/// boxes of the component search that contain the value `at` of the outermost coordinate.
void NestedIntegral::add_hints(double at, IntegralScratch& scratch) const {
  constexpr int kPlaces = 3;
  const ComponentSearch search(plan());
  for (std::size_t level = 1; level < levels(); ++level) {
    scratch.levels[level].hints.clear();
    search.add_samples(level, at, kPlaces, scratch.levels[level].hints, scratch.search);
  }
}

/// Sets `places` of a level to the values of its coordinate at which slices will be evaluated: over the whole range,
/// and at the centres of expected intervals of any width.
void NestedIntegral::choose_samples(std::size_t level, double low, double high, IntegralScratch& scratch) const {
  IntegralScratch::Level& own = scratch.levels[level];
  const double whole = high - low;
  const int samples = !ends_in_lines() ? kSamples[levels() > 1 ? 1 : 0]
                      : levels() == 1  ? kSamplesInLines[1]
                      : level == 0     ? kSamplesInLines[0]
                                       : kSamplesInLines[scratch.is_scanning ? 1 : 2];
  own.places.assign({low + kClearDistance * whole, high - kClearDistance * whole});
  for (int i = 0; i < samples; ++i) own.places.push_back(sample_position(low, high, i, samples));
  if (level > 0 && scratch.has_hints) own.places.insert(own.places.end(), own.hints.begin(), own.hints.end());
  if (level > 0) add_expected_samples(scratch.levels[level - 1].at, own);
  std::ranges::sort(own.places);
}

/// If there is no sample of the outermost coordinate between two consecutive sign changes of constraints, adds one.
void NestedIntegral::add_samples_between_changes(double low, double high, IntegralScratch& scratch) {
  scratch.ends.assign({low, high});
  for (const SignChange& change : scratch.changes.found) scratch.ends.push_back(change.at);
  std::ranges::sort(scratch.ends);
  std::vector<double>& places = scratch.levels[0].places;
  const std::size_t known = places.size();
  for (std::size_t i = 1; i < scratch.ends.size(); ++i) {
    const auto begin = places.begin(), end = begin + static_cast<std::ptrdiff_t>(known);
    const auto next = std::lower_bound(begin, end, scratch.ends[i - 1]);
    if (next == end || *next > scratch.ends[i]) places.push_back(0.5 * (scratch.ends[i - 1] + scratch.ends[i]));
  }
  std::ranges::sort(places);
}

/// Adds samples of the coordinate of `own` in the intervals in which feasible points are expected: intervals that were
/// found at the two nearest values of the next outer coordinate on either side of `outside`, and their linear
/// extrapolations.
void NestedIntegral::add_expected_samples(double outside, IntegralScratch::Level& own) {
  using ExpectedIntervals = IntegralScratch::Level::ExpectedIntervals;
  const std::size_t known = own.places.size();
  const auto expect = [&](double lower, double upper) {
    const double inset = 0.1 * (upper - lower);
    const auto begin = own.places.begin(), end = begin + static_cast<std::ptrdiff_t>(known);
    const double middle = 0.5 * (lower + upper);
    if (middle > own.places[0] && middle < own.places[1] &&
        std::none_of(begin, end, [&](double at) { return at > lower + inset && at < upper - inset; }))
      own.places.push_back(middle);
  };
  const auto expect_all = [&](const ExpectedIntervals* x, const ExpectedIntervals* y) {
    if (!x) return;
    const bool is_line = y && y->parts.size() == x->parts.size();
    const double ahead = is_line ? (outside - x->outside) / (x->outside - y->outside) : 0;
    for (std::size_t i = 0; i < x->parts.size(); ++i) {
      const auto [lower, upper] = x->parts[i];
      expect(lower, upper);
      if (is_line) expect(lower + ahead * (lower - y->parts[i][0]), upper + ahead * (upper - y->parts[i][1]));
    }
  };
  const auto begin = own.seen.begin(), end = begin + static_cast<std::ptrdiff_t>(own.seen_count);
  const auto above =
      std::partition_point(begin, end, [&](const ExpectedIntervals& seen) { return seen.outside < outside; });
  const auto seen = [&](std::ptrdiff_t i) { return i >= 0 && i < end - begin ? &begin[i] : nullptr; };
  const std::ptrdiff_t at = above - begin;
  expect_all(seen(at - 1), seen(at - 2));
  expect_all(seen(at), seen(at + 1));
}

void NestedIntegral::record_intervals(double outside, IntegralScratch::Level& own) {
  using ExpectedIntervals = IntegralScratch::Level::ExpectedIntervals;
  if (own.seen.size() == own.seen_count) own.seen.emplace_back();
  const auto begin = own.seen.begin(), end = begin + static_cast<std::ptrdiff_t>(own.seen_count);
  const auto at =
      std::partition_point(begin, end, [&](const ExpectedIntervals& seen) { return seen.outside < outside; });
  if (at != end && at->outside == outside) return;
  std::rotate(at, end, end + 1);
  ++own.seen_count;
  at->outside = outside;
  at->parts.clear();
  for (const SmoothInterval& part : own.parts) at->parts.push_back({part.piece.lower, part.piece.upper});
}

}  // namespace pkm::generic
