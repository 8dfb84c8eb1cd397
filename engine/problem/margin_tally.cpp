#include "engine/problem/margin_tally.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/math/satisfied.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxReasons = 4;  // maximum number of reasons of one tally: more would hide the important ones

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Number of samples as text, such as "40 designs" or "1 pose sampled for the best-ranked design".
std::string count_text(std::size_t count, const std::string& sample) {
  const auto noun_end = std::min(sample.find(' '), sample.size());
  return std::to_string(count) + " " + sample.substr(0, noun_end) + (count == 1 ? "" : "s") + sample.substr(noun_end);
}

}  // namespace

std::size_t MarginTally::index_of(const std::string& name) {
  const auto found = std::ranges::find(counts_, name, &Count::name);
  const auto index = static_cast<std::size_t>(found - counts_.begin());
  if (found == counts_.end())
    counts_.push_back({.name = name,
                       .known_with = std::vector<std::size_t>(index),
                       .satisfied_with = std::vector<std::size_t>(index)});
  return index;
}

void MarginTally::add(const std::vector<std::pair<std::string, double>>& margins) {
  ++samples_;
  // For each margin of this sample that is not NaN: its index in `counts_`, and whether the sample satisfies it.
  std::vector<std::pair<std::size_t, bool>> known;
  for (const auto& [name, margin] : margins) {
    if (std::isnan(margin)) continue;
    const std::size_t index = index_of(name);
    Count& count = counts_[index];
    const bool satisfied = is_satisfied(margin);
    const double violation = satisfied || std::isfinite(margin) ? margin : -std::numeric_limits<double>::infinity();
    if (!satisfied && (count.known == count.satisfied || violation > count.closest)) count.closest = violation;
    ++count.known;
    count.satisfied += satisfied;
    known.emplace_back(index, satisfied);
  }
  for (const auto& [a, satisfies_a] : known)
    for (const auto& [b, satisfies_b] : known) {
      if (b >= a) continue;
      ++counts_[a].known_with[b];
      counts_[a].satisfied_with[b] += satisfies_a && satisfies_b;
    }
}

std::vector<Reason> MarginTally::reasons(const std::string& kind, const std::string& sample) const {
  std::vector<Reason> found;
  const auto known_text = [&](std::size_t known) {
    return known == samples_ ? "" : " (" + std::to_string(known) + " evaluated)";
  };
  for (const Count& count : counts_)
    if (count.known > 0 && count.satisfied == 0)
      found.push_back({kind,
                       {count.name},
                       "no " + sample + " satisfies " + count.name + known_text(count.known) +
                           "; the closest misses it by " + three_digits(-count.closest)});
  for (std::size_t a = 0; found.empty() && a < counts_.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (counts_[a].known_with[b] > 0 && counts_[a].satisfied_with[b] == 0)
        found.push_back({kind,
                         {counts_[b].name, counts_[a].name},
                         "no " + sample + " satisfies both " + counts_[b].name + " (satisfied by " +
                             std::to_string(counts_[b].satisfied) + " of " + std::to_string(counts_[b].known) +
                             ") and " + counts_[a].name + " (" + std::to_string(counts_[a].satisfied) + " of " +
                             std::to_string(counts_[a].known) + ")"});
  if (found.empty()) {
    std::vector<const Count*> violated;
    for (const Count& count : counts_)
      if (count.satisfied < count.known) violated.push_back(&count);
    const auto violations = [](const Count* count) { return count->known - count->satisfied; };
    std::ranges::stable_sort(violated, std::ranges::greater(), violations);
    for (const Count* count : violated)
      found.push_back({kind,
                       {count->name},
                       count->name + " is violated by " + std::to_string(violations(count)) + " of " +
                           count_text(count->known, sample)});
  }
  if (found.size() > kMaxReasons) found.resize(kMaxReasons);
  return found;
}

}  // namespace pkm
