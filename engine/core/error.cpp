#include "engine/core/error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <system_error>

#include "engine/core/printable.hpp"

namespace pkm {
namespace {

// Maximum lengths of the parts of a message in bytes; together they are less than 2 kB.
constexpr std::size_t kMaxFile = 300, kMaxKey = 160, kMaxFound = 160, kMaxExpected = 1000, kMaxName = 80,
                      kMaxSentence = 1450, kMaxMessage = 1950;

/// Text from outside the program as it is shown in a message: printable, and at most `max_size` bytes long.
std::string displayed(std::string_view text, std::size_t max_size) {
  return excerpt(printable(excerpt(text, max_size)), max_size);
}

std::string prefix(const SourceLocation& place) {
  std::string text;
  if (!place.file.empty()) {
    text += displayed(place.file, kMaxFile);
    if (place.line > 0) text += ":" + std::to_string(place.line);
    text += ": ";
  }
  if (!place.key.empty()) text += displayed(place.key, kMaxKey) + ": ";
  return text;
}

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Twice the Levenshtein distance of two texts, in which letters that differ in case only count as half a substitution.
/// Dynamic programming that stores one row of the table.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto substitution = [](char x, char y) -> std::size_t {
    return x == y ? 0 : lower_case(x) == lower_case(y) ? 1 : 2;
  };
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = 2 * j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = 2 * i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 2, row[j - 1] + 2, diagonal + substitution(a[i - 1], b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

ConfigError::ConfigError(SourceLocation place, std::string_view found, std::string_view expected,
                         std::string_view nearest)
    : ConfigError(std::move(place),
                  "found " + displayed(found, kMaxFound) + "; expected " + displayed(expected, kMaxExpected) +
                      (nearest.empty() ? "" : "; did you mean '" + displayed(nearest, kMaxName) + "'?")) {}

ConfigError::ConfigError(SourceLocation place, std::string_view sentence)
    : std::runtime_error(prefix(place) + displayed(sentence, kMaxSentence)), place_(std::move(place)) {}

StorageError::StorageError(std::string_view sentence)
    : std::runtime_error(displayed(sentence, kMaxFile + kMaxSentence)) {}

std::string message_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return "out of memory: this needs more than the program may use; use fewer threads, cells or rows";
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return displayed(file->path1().string(), kMaxFile) + ": " + file->code().message();
  if (const auto* system = dynamic_cast<const std::system_error*>(&error)) return system->code().message();
  const bool is_own =
      dynamic_cast<const std::runtime_error*>(&error) || dynamic_cast<const std::invalid_argument*>(&error);
  if (is_own) return displayed(error.what(), kMaxMessage);
  return "internal error: an unexpected exception occurred in the program; please report it with the command line and "
         "the input files";
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  if (name.size() > kMaxName) return best;
  // A known name at this edit distance or more is unlikely to be the intended one.
  std::size_t best_distance = 2 + 2 * std::max<std::size_t>(1, name.size() / 2);
  for (const auto& candidate : known) {
    if (candidate.size() > 2 * kMaxName) continue;  // a name this long would not fit into a message
    std::size_t distance = edit_distance(name, candidate);
    if (name.size() > 1 && candidate.starts_with(name)) distance = std::min<std::size_t>(distance, 2);
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

void precondition_violated(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "pkmopt: precondition violated: %s at %s:%d\n", condition, file, line);
  std::abort();
}

}  // namespace pkm
