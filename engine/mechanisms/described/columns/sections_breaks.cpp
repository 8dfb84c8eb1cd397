// Where the structure of an integral's slices changes along an outer coordinate: places that are looked at, parts that
// are expected there, and breaks that are closed in on.
#include <algorithm>
#include <cmath>

#include "engine/mechanisms/described/columns/sections_integral.hpp"

namespace pkm::described {
namespace {

constexpr double kNear = 1e-15;         // of the range: how well breaks are known
constexpr double kNearInLines = 1e-11;  // the same where sections are lines: measures go on where structures change
constexpr double kFar = 1e-3;           // of the range: slices that are further from a break may differ in small parts
constexpr double kNextTo = 1e-8;        // of the range: breaks that are one
constexpr double kCloseBy = 64;         // steps from a break to the next one: where rounding may decide
constexpr double kJump = 1e-7;          // of the greatest slice: what is no rounding
// Places at which structures are compared: where sections are areas, of one outer coordinate and of each of several;
// where they are lines, of the outermost coordinate, of the next while that is scanned, and of the next later, when it
// is known what to expect. And of one outer coordinate where there is something: gaps and dents may be as narrow.
constexpr int kSamples[] = {40, 24}, kSamplesInLines[] = {64, 192, 12}, kSamplesInside = 240;

/// The i-th place of some: not at equal distances, which symmetric mechanisms would have their breaks at.
double spread(double low, double high, int i, int places) {
  const double step = 0.618 * i;
  return low + (high - low) * (i + 0.4 + 0.2 * (step - std::floor(step))) / places;
}

/// Takes two breaks that are next to each other as one: where conics touch, labels change once more a little later,
/// when rounding no longer hides that they cross. It is at the one where the measure begins to behave like a root,
/// which the parts on both sides have to know to many digits: their derivatives are infinite there.
bool join(SliceBreak& first, const SliceBreak& second, double whole) {
  const double apart = second.at - first.at;
  if (first.is_box || apart > kNextTo * whole) return false;
  if (first.below.hash == 0 || first.above.hash == 0 || second.above.hash == 0) return false;
  const double soon = std::fabs(first.above.measure - first.below.measure),
               in_all = std::fabs(second.above.measure - first.below.measure);
  const double like_root = std::sqrt((first.above.at - first.at) / apart);
  if (!(soon > 0.5 * like_root * in_all)) first.at = second.at;
  first.above = second.above;
  return true;
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
  const bool has_found = std::ranges::any_of(scanned, is_found);
  if (levels() > 1 && has_found) return;  // its sections are integrals, which take long

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
      give_hints(at, room);
      scanned.push_back(slice(0, at, room));
      if (scanned.back().hash != 0) search.leave_out(at, room.search);
    }
    search.halve(room.search);
  }
  for (IntegralRoom::Level& level : room.levels) level.hints.clear();
  if (!has_found) room.levels[0].unresolved += search.unknown(room.search);
  if (std::any_of(scanned.begin() + static_cast<std::ptrdiff_t>(known), scanned.end(), is_found)) {
    std::ranges::sort(scanned, {}, &Slice::at);
  } else {  // the integral is what it was
    scanned.resize(known);
    room.sections = sections;
  }
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
  for (std::size_t level = 1; level < levels(); ++level) {
    std::vector<double>& hints = room.levels[level].hints;
    hints.clear();
    for (const SearchRoom::Box& box : room.search.boxes)
      if (box.side[0].holds(at)) hints.push_back(0.5 * (box.side[level].lower + box.side[level].upper));
    std::ranges::sort(hints);
    hints.erase(std::unique(hints.begin(), hints.end()), hints.end());
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
  own.places.insert(own.places.end(), own.hints.begin(), own.hints.end());
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

/// Measures go on where structures change, some like roots; if not, something was overlooked on one side.
bool SectionsIntegral::jumps(const Slice& low, const Slice& high, std::size_t level, const IntegralRoom& room) const {
  return ends_in_lines() && low.broken == 0 && high.broken == 0 &&
         std::fabs(low.measure - high.measure) > kJump * room.levels[level].greatest;
}

/// Adds the breaks between two slices, in order.
void SectionsIntegral::find_breaks(std::size_t level, Slice from, Slice& to, double whole, Breaks& breaks,
                                   IntegralRoom& room) const {
  const double least = kSettled * whole;
  double step = least;
  for (int more = 0; more < 24 && from.hash != to.hash && room.sections < room.most; ++more) {
    Slice low = from, high = to;
    close_in(level, low, high, whole, room);
    for (int again = 0; again < 4 && level + 1 < levels() && jumps(low, high, level, room); ++again) {
      // A part that was overlooked on one side is found there now, and followed further on.
      const bool is_low = low.measure < high.measure;
      const Slice found = slice(level, is_low ? low.at : high.at, room);
      if (found.hash == (is_low ? low : high).hash) break;
      (is_low ? high : low) = found;
      (is_low ? low : high) = is_low ? from : to;
      if (low.hash == high.hash) break;
      close_in(level, low, high, whole, room);
    }
    if (high.at == to.at && level + 1 < levels()) {
      const Slice again = slice(level, to.at, room);
      const bool is_other = again.hash != to.hash;
      to = again;
      if (is_other) continue;
    }
    // Where rounding decides, structures change again and again close by; ever longer steps leave that behind.
    step = more > 0 && high.at - from.at < kCloseBy * step ? 8 * step : least;
    const double beyond = high.at + step;
    const Slice after = beyond < to.at ? slice(level, beyond, room) : to;
    SliceBreak found{high.at, true, low, after};
    if (level + 1 < levels() && jumps(low, high, level, room))
      found.overlooked = std::fabs(low.measure - high.measure) * whole / kSamplesInLines[0];
    if (ends_in_lines() || breaks.empty() || !join(breaks.back(), found, whole)) breaks.push_back(found);
    from = after;
  }
}

void SectionsIntegral::close_in(std::size_t level, Slice& low, Slice& high, double whole, IntegralRoom& room) const {
  const double range = whole + std::fabs(low.at), near = (ends_in_lines() ? kNearInLines : kNear) * range;
  const bool is_guessed = ends_in_lines() && level + 1 == levels();
  const auto look = [&](double at) {
    const Slice found = slice(level, at, room);
    if (is_guessed) room.event.take(at, room.column.ends, room.column.labels);
    return found;
  };
  if (is_guessed) {
    slice(level, low.at, room);
    room.event.set_below(room.column.labels);
    slice(level, high.at, room);
    room.event.set_above(room.column.labels);
    look(low.at);
    look(high.at);
  }
  while (high.at - low.at > near || (jumps(low, high, level, room) && high.at - low.at > kNear * range)) {
    const double at = is_guessed ? room.event.guess(low.at, high.at, high.at - low.at > near ? near : kNear * range)
                                 : 0.5 * (low.at + high.at);
    if (at <= low.at || at >= high.at) break;
    if (level == 0) room.is_scanning = high.at - low.at > kFar * whole;
    const Slice next = look(at);
    (next.hash == low.hash ? low : high) = next;
  }
  if (level == 0) room.is_scanning = false;
}

}  // namespace pkm::described
