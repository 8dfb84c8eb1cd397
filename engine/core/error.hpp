// Exceptions whose messages are shown to the user, and PKM_EXPECTS, the check of a function's preconditions.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// Location of an input value: file, line and key path, or the command-line option that gives the value.
struct SourceLocation {
  std::string file;  ///< name of the file; "" if the value does not come from a file
  int line = 0;      ///< number of the line, from 1; 0 if unknown
  std::string key;   ///< dotted path such as "variables.a.min", or an option such as "--at"
};

/// Invalid user input. what() is one sentence: location, what was found, what was expected, most similar known name.
/// Whatever the input, it is shorter than 2 kB and printable: long parts are abbreviated, control characters escaped.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(SourceLocation place, std::string_view found, std::string_view expected, std::string_view nearest = {});
  /// Makes an error whose message does not have the form "found X; expected Y": the location, followed by `sentence`.
  ConfigError(SourceLocation place, std::string_view sentence);
  const SourceLocation& place() const { return place_; }

 private:
  SourceLocation place_;
};

/// A design that cannot be evaluated, for example because a mass is not positive; what() is one sentence that says why.
/// Evaluators turn it into a failed design; every other exception ends the run.
class DesignError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A study file that cannot be read, written or locked, or whose content is invalid. what() is one sentence with the
/// file's name, shorter than 2 kB and printable.
class StorageError : public std::runtime_error {
 public:
  explicit StorageError(std::string_view sentence);
};

/// The message that is shown to the user for any exception: shorter than 2 kB, and printable. Messages of the standard
/// library's own exceptions (such as "vector::_M_range_check") are replaced by a sentence.
std::string message_of(const std::exception& error);

/// The known name with the smallest edit distance (Levenshtein) to `name`, or one that begins with it; "" if none is
/// similar enough to be a likely misspelling.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// Joins words for messages: "a, b, c" with the separator ", ".
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// Prints the violated precondition of PKM_EXPECTS and aborts.
[[noreturn]] void precondition_violated(const char* condition, const char* file, int line);

}  // namespace pkm

// Checks a precondition whose violation is a programming error, and aborts if it does not hold. Enabled in debug and
// sanitizer builds (PKM_CHECK_CONTRACTS).
#ifdef PKM_CHECK_CONTRACTS
#define PKM_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::pkm::precondition_violated(#condition, __FILE__, __LINE__))
#else
#define PKM_EXPECTS(condition) static_cast<void>(sizeof(!(condition)))
#endif
