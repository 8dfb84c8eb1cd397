// The errors that reach a user, and the check of what one caller owes another.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// Where a value was written: a study file's line and key path, or a command-line option.
struct SourcePlace {
  std::string file;  ///< "" when the value does not come from a file
  int line = 0;      ///< 1-based; 0 when unknown
  std::string key;   ///< dotted path such as "variables.a.min", or an option such as "--at"
};

/// Bad input from a user. what() is one sentence: place, what was found, what was expected, nearest known name.
/// Whatever the input, it is less than 2 kB long and printable: long parts are shortened, control characters escaped.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(SourcePlace place, std::string_view found, std::string_view expected, std::string_view nearest = {});
  /// Place and a sentence of its own, where "found, expected" does not fit.
  ConfigError(SourcePlace place, std::string_view sentence);
  const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// A study file that cannot be read, written, locked or trusted. what() is one sentence with the file's name, as short
/// and printable as a ConfigError's.
class StorageError : public std::runtime_error {
 public:
  explicit StorageError(std::string_view sentence);
};

/// What any exception has to say to a user, as short and as printable; the standard library's words are not in it.
std::string message_of(const std::exception& error);

/// The known name nearest to `name` by edit distance, or that begins with it; "" when none is near enough to be meant.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c", for messages.
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

[[noreturn]] void contract_broken(const char* condition, const char* file, int line);

}  // namespace pkm

// A contract between two pieces of this program. Active in debug and sanitizer builds (PKM_CHECK_CONTRACTS).
#ifdef PKM_CHECK_CONTRACTS
#define PKM_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::pkm::contract_broken(#condition, __FILE__, __LINE__))
#else
#define PKM_EXPECTS(condition) static_cast<void>(sizeof(!(condition)))
#endif
