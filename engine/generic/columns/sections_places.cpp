// Places along an outer coordinate at which the structure of an integral's slices is compared: all over the range,
// where parts are expected, and where intervals say that something may be.
#include <algorithm>
#include <cmath>

#include "engine/generic/columns/sections_integral.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kFew = 8;  // one of so many places
// Places at which structures are compared: where sections are areas, of one outer coordinate and of each of several;
// where they are lines, of the outermost coordinate, of the next while that is scanned, and of the next later, when it
// is known what to expect. And of one outer coordinate where there is something: gaps and dents may be as narrow.
constexpr int kSamples[] = {40, 24}, kSamplesInLines[] = {kPlacesInLines, 192, 12}, kSamplesInside = 240;

/// The i-th place of some: not at equal distances, which symmetric mechanisms would have their breaks at.
double spread(double low, double high, int i, int places) {
  const double step = 0.618 * i;
  return low + (high - low) * (i + 0.4 + 0.2 * (step - std::floor(step))) / places;
}

}  // namespace

/// Parts that are narrow at one place may have been seen at its neighbours alone: now they are expected.
void SectionsIntegral::look_again(std::size_t level, IntegralRoom& room) const {
  std::vector<Slice>& scanned = room.levels[level].scanned;
  bool is_new = true;
  for (int pass = 0; pass < 4 && is_new; ++pass) {
    is_new = false;
    for (std::size_t i = 1; i < scanned.size(); ++i) {
      if (scanned[i - 1].hash == scanned[i].hash) continue;
      for (const std::size_t k : {i - 1, i}) {
        const Slice again = slice(level, scanned[k].at, room);
        is_new = is_new || again.hash != scanned[k].hash;
        scanned[k] = again;
      }
    }
  }
}

/// Between places of the outermost coordinate that found nothing: in the middle of boxes that may hold something, which
/// are halved until all are known to be empty, or there are many of them.
void SectionsIntegral::look_between(IntegralRoom& room) const {
  constexpr std::size_t kMany = 2000;
  std::vector<Slice>& scanned = room.levels[0].scanned;
  const auto is_found = [](const Slice& slice) { return slice.hash != 0; };
  const auto found = static_cast<std::size_t>(std::ranges::count_if(scanned, is_found));
  const bool has_found = found > 0;
  if (levels() > 1 && has_found) {  // its sections are integrals, which take long
    if (kFew * found <= scanned.size()) look_beside(room);
    return;
  }

  const SectionSearch search(plan());
  search.start(room.registers, room.search);
  for (std::size_t first = 0, last; first < scanned.size(); first = last + 1) {
    for (last = first; last < scanned.size() && scanned[last].hash == 0; ++last) {
    }
    if (last > first + 1) search.add(scanned[first].at, scanned[last - 1].at, room.search);
  }
  std::vector<double>& places = room.levels[0].places;
  const std::size_t known = scanned.size();
  const long sections = room.sections;
  room.has_hints = true;
  std::vector<SearchRoom::Box>& boxes = room.search.boxes;
  while (room.search.examined < kMany && room.sections < room.most) {
    search.examine(room.search);
    if (boxes.empty()) break;
    places.clear();
    for (const SearchRoom::Box& box : boxes)
      if (search.halves_outermost(box, room.search)) places.push_back(0.5 * (box.side[0].lower + box.side[0].upper));
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const double at : places) {
      scanned.push_back(slice(0, at, room));
      if (scanned.back().hash != 0) search.leave_out(at, room.search);
    }
    search.halve(room.search);
  }
  room.has_hints = false;
  if (!has_found) room.levels[0].unresolved += search.unknown(room.search);
  if (std::any_of(scanned.begin() + static_cast<std::ptrdiff_t>(known), scanned.end(), is_found)) {
    std::ranges::sort(scanned, {}, &Slice::at);
  } else {  // the integral is what it was
    scanned.resize(known);
    room.sections = sections;
  }
}

/// A workspace that few places have met is small, and may have other parts beside the one that was met: boxes that may
/// hold them are looked at in every slice.
void SectionsIntegral::look_beside(IntegralRoom& room) const {
  constexpr std::size_t kMost = 6000, kManyBoxes = 1500;
  constexpr int kPlaces = 9;
  std::vector<Slice>& scanned = room.levels[0].scanned;
  const SectionSearch search(plan());
  search.start(room.registers, room.search);
  search.add(scanned.front().at, scanned.back().at, room.search);
  while (true) {
    search.examine(room.search);
    const std::size_t left = room.search.boxes.size();
    if (left == 0 || left > kManyBoxes || room.search.examined > kMost) break;
    search.halve(room.search);
  }
  room.has_hints = true;
  std::vector<double>& places = room.levels[0].places;
  places.clear();
  search.spread(0, {}, kPlaces, places, room.search);
  for (const double at : places) scanned.push_back(slice(0, at, room));
  std::ranges::sort(scanned, {}, &Slice::at);
}

/// Closer, from where something begins to where the last of it ends.
void SectionsIntegral::look_closer(IntegralRoom& room) const {
  std::vector<Slice>& scanned = room.levels[0].scanned;
  const auto is_found = [](const Slice& slice) { return slice.hash != 0; };
  const auto first = std::ranges::find_if(scanned, is_found);
  if (first == scanned.end()) return;
  const auto last = std::find_if(scanned.rbegin(), scanned.rend(), is_found);
  const double low = (first == scanned.begin() ? first : first - 1)->at,
               high = (last == scanned.rbegin() ? last : last - 1)->at;
  for (int i = 0; i < kSamplesInside; ++i) scanned.push_back(slice(0, spread(low, high, i, kSamplesInside), room));
  std::ranges::sort(scanned, {}, &Slice::at);
}

/// Of the coordinates within the outermost one.
void SectionsIntegral::give_hints(double at, IntegralRoom& room) const {
  constexpr int kPlaces = 3;
  const SectionSearch search(plan());
  for (std::size_t level = 1; level < levels(); ++level) {
    room.levels[level].hints.clear();
    search.spread(level, at, kPlaces, room.levels[level].hints, room.search);
  }
}

/// Where structures are compared: all over the range, and in the middle of expected parts, however narrow they are.
void SectionsIntegral::find_places(std::size_t level, double low, double high, IntegralRoom& room) const {
  IntegralRoom::Level& own = room.levels[level];
  const double whole = high - low;
  const int samples = !ends_in_lines() ? kSamples[levels() > 1 ? 1 : 0]
                      : levels() == 1  ? kSamplesInLines[1]
                      : level == 0     ? kSamplesInLines[0]
                                       : kSamplesInLines[room.is_scanning ? 1 : 2];
  own.places.assign({low + kSettled * whole, high - kSettled * whole});
  for (int i = 0; i < samples; ++i) own.places.push_back(spread(low, high, i, samples));
  if (level > 0 && room.has_hints) own.places.insert(own.places.end(), own.hints.begin(), own.hints.end());
  if (level > 0) add_expected_places(room.levels[level - 1].at, own);
  std::ranges::sort(own.places);
}

/// Parts are expected as they are at the two nearest places outside on either side, and as a line through those has it.
void SectionsIntegral::add_expected_places(double outside, IntegralRoom::Level& own) {
  using Seen = IntegralRoom::Level::Seen;
  const std::size_t known = own.places.size();
  const auto expect = [&](double lower, double upper) {
    const double inset = 0.1 * (upper - lower);
    const auto begin = own.places.begin(), end = begin + static_cast<std::ptrdiff_t>(known);
    const double middle = 0.5 * (lower + upper);
    if (middle > own.places[0] && middle < own.places[1] &&
        std::none_of(begin, end, [&](double at) { return at > lower + inset && at < upper - inset; }))
      own.places.push_back(middle);
  };
  const auto expect_all = [&](const Seen* x, const Seen* y) {
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
  const auto above = std::partition_point(begin, end, [&](const Seen& seen) { return seen.outside < outside; });
  const auto seen = [&](std::ptrdiff_t i) { return i >= 0 && i < end - begin ? &begin[i] : nullptr; };
  const std::ptrdiff_t at = above - begin;
  expect_all(seen(at - 1), seen(at - 2));
  expect_all(seen(at), seen(at + 1));
}

void SectionsIntegral::remember(double outside, IntegralRoom::Level& own) {
  using Seen = IntegralRoom::Level::Seen;
  if (own.seen.size() == own.seen_count) own.seen.emplace_back();
  const auto begin = own.seen.begin(), end = begin + static_cast<std::ptrdiff_t>(own.seen_count);
  const auto at = std::partition_point(begin, end, [&](const Seen& seen) { return seen.outside < outside; });
  if (at != end && at->outside == outside) return;
  std::rotate(at, end, end + 1);
  ++own.seen_count;
  at->outside = outside;
  at->parts.clear();
  for (const SlicePart& part : own.parts) at->parts.push_back({part.piece.lower, part.piece.upper});
}

}  // namespace pkm::generic
