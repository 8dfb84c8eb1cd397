#include "engine/core/error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <numeric>
#include <system_error>

#include "engine/core/printable.hpp"

namespace pkm {
namespace {

// Bytes of a message's parts: all of them together are less than 2 kB.
constexpr std::size_t kLongestFile = 300, kLongestKey = 160, kLongestFound = 160, kLongestExpected = 1000,
                      kLongestName = 80, kLongestSentence = 1450, kLongestMessage = 1950;

/// Text of others as a message shows it.
std::string shown(std::string_view text, std::size_t longest) {
  return excerpt(printable(excerpt(text, longest)), longest);
}

std::string prefix(const SourcePlace& place) {
  std::string text;
  if (!place.file.empty()) {
    text += shown(place.file, kLongestFile);
    if (place.line > 0) text += ":" + std::to_string(place.line);
    text += ": ";
  }
  if (!place.key.empty()) text += shown(place.key, kLongestKey) + ": ";
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

ConfigError::ConfigError(SourcePlace place, std::string_view found, std::string_view expected, std::string_view nearest)
    : ConfigError(std::move(place),
                  "found " + shown(found, kLongestFound) + "; expected " + shown(expected, kLongestExpected) +
                      (nearest.empty() ? "" : "; did you mean '" + shown(nearest, kLongestName) + "'?")) {}

ConfigError::ConfigError(SourcePlace place, std::string_view sentence)
    : std::runtime_error(prefix(place) + shown(sentence, kLongestSentence)), place_(std::move(place)) {}

StorageError::StorageError(std::string_view sentence)
    : std::runtime_error(shown(sentence, kLongestFile + kLongestSentence)) {}

std::string message_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return "out of memory: this takes more than the program may have; fewer threads, cells or rows take less";
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return shown(file->path1().string(), kLongestFile) + ": " + file->code().message();
  if (const auto* system = dynamic_cast<const std::system_error*>(&error)) return system->code().message();
  const bool ours = dynamic_cast<const std::runtime_error*>(&error) ||
                    dynamic_cast<const std::invalid_argument*>(&error) ||
                    dynamic_cast<const std::domain_error*>(&error);
  if (ours) return shown(error.what(), kLongestMessage);
  return "internal error: the program has asked itself for something that is not there; please report it with the "
         "command line and the files that it was given";
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  if (name.size() > kLongestName) return best;
  std::size_t best_distance = 1 + std::max<std::size_t>(1, name.size() / 2);  // further away is another word
  for (const auto& candidate : known) {
    if (candidate.size() > 2 * kLongestName) continue;  // nor could it be shown
    std::size_t distance = edit_distance(name, candidate);
    if (name.size() > 1 && candidate.starts_with(name)) distance = std::min<std::size_t>(distance, 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const auto& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

void contract_broken(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "pkmopt: broken contract %s at %s:%d\n", condition, file, line);
  std::abort();
}

}  // namespace pkm
