#include "engine/problem/margin_tally.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/math/satisfied.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMostReasons = 4;  // of one tally: more would hide what matters

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// "40 designs", "1 pose of the least bad design".
std::string things_of(std::size_t count, const std::string& thing) {
  const auto noun_end = std::min(thing.find(' '), thing.size());
  return std::to_string(count) + " " + thing.substr(0, noun_end) + (count == 1 ? "" : "s") + thing.substr(noun_end);
}

}  // namespace

std::size_t MarginTally::number_of(const std::string& name) {
  const auto found = std::ranges::find(lines_, name, &Line::name);
  const auto number = static_cast<std::size_t>(found - lines_.begin());
  if (found == lines_.end())
    lines_.push_back(
        {.name = name, .known_with = std::vector<std::size_t>(number), .kept_with = std::vector<std::size_t>(number)});
  return number;
}

void MarginTally::add(const std::vector<std::pair<std::string, double>>& margins) {
  ++things_;
  std::vector<std::pair<std::size_t, bool>> known;  // margins of this thing, and whether it keeps them
  for (const auto& [name, margin] : margins) {
    if (std::isnan(margin)) continue;
    const std::size_t number = number_of(name);
    Line& line = lines_[number];
    const bool kept = is_satisfied(margin);
    const double miss = kept || std::isfinite(margin) ? margin : -std::numeric_limits<double>::infinity();
    if (!kept && (line.known == line.kept || miss > line.nearest)) line.nearest = miss;
    ++line.known;
    line.kept += kept;
    known.emplace_back(number, kept);
  }
  for (const auto& [a, keeps_a] : known)
    for (const auto& [b, keeps_b] : known) {
      if (b >= a) continue;
      ++lines_[a].known_with[b];
      lines_[a].kept_with[b] += keeps_a && keeps_b;
    }
}

std::vector<Reason> MarginTally::reasons(const std::string& kind, const std::string& thing) const {
  std::vector<Reason> found;
  const auto of_known = [&](std::size_t known) {
    return known == things_ ? "" : ", of the " + std::to_string(known) + " for which it is known";
  };
  for (const Line& line : lines_)
    if (line.known > 0 && line.kept == 0)
      found.push_back({kind,
                       {line.name},
                       "no " + thing + " keeps " + line.name + of_known(line.known) + ": the nearest misses it by " +
                           three_digits(-line.nearest)});
  for (std::size_t a = 0; found.empty() && a < lines_.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (lines_[a].known_with[b] > 0 && lines_[a].kept_with[b] == 0)
        found.push_back({kind,
                         {lines_[b].name, lines_[a].name},
                         "no " + thing + " keeps both " + lines_[b].name + " (kept by " +
                             std::to_string(lines_[b].kept) + " of " + std::to_string(lines_[b].known) + ") and " +
                             lines_[a].name + " (" + std::to_string(lines_[a].kept) + " of " +
                             std::to_string(lines_[a].known) + ")"});
  if (found.empty()) {
    std::vector<const Line*> broken;
    for (const Line& line : lines_)
      if (line.kept < line.known) broken.push_back(&line);
    std::ranges::stable_sort(broken,
                             [](const Line* a, const Line* b) { return a->known - a->kept > b->known - b->kept; });
    for (const Line* line : broken)
      found.push_back({kind,
                       {line->name},
                       line->name + " is broken by " + std::to_string(line->known - line->kept) + " of " +
                           things_of(line->known, thing)});
  }
  if (found.size() > kMostReasons) found.resize(kMostReasons);
  return found;
}

}  // namespace pkm
