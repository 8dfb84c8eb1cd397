// A strict view of one value of a study file: it reads what is expected and refuses everything else with file, line,
// key path, the value as written, what was expected and the nearest known name.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/toml.hpp"
#include "engine/core/error.hpp"
#include "engine/core/options.hpp"

namespace pkm {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// "a number in [0, 1]", "a number >= 0 s", "any number": a range for messages; `noun` is "a number" or "an integer".
std::string range_text(std::string_view noun, double lower, double upper, std::string_view unit = "1");

/// Refers to a TomlValue that must outlive it. Every function that reads throws ConfigError.
class ConfigValue {
 public:
  /// @param path  dotted key path: "variables.a.min"; tables of a list count from 1: "constraint[2].bound"
  ConfigValue(const TomlValue& value, std::string file, std::string path);

  bool is_table() const { return value_->kind == TomlValue::Kind::table; }
  bool is_list() const { return value_->kind == TomlValue::Kind::array; }
  bool is_flag() const { return value_->kind == TomlValue::Kind::flag; }
  bool is_integer() const { return value_->kind == TomlValue::Kind::integer; }
  bool is_text() const { return value_->kind == TomlValue::Kind::text; }

  /// A finite number in SI, or text with a unit of the dimension of `unit`; within [lower, upper].
  double number(std::string_view unit, double lower = -kUnbounded, double upper = kUnbounded) const;
  /// A finite number > 0.
  double positive(std::string_view unit) const;
  /// A whole number written without point or exponent.
  std::int64_t integer(double lower = -kUnbounded, double upper = kUnbounded) const;
  bool flag() const;
  const std::string& text(std::string_view expected) const;
  /// A number, an integer or text, whichever it is.
  Setting setting() const;
  /// Text that is one of `choices`.
  const std::string& word(const std::vector<std::string>& choices) const;
  /// The elements of an array: `path[1]`, `path[2]`, ...
  std::vector<ConfigValue> elements(std::string_view expected) const;

  // Tables
  /// Refuses any key that is not in `known`; `what` says what the keys are: "key", "parameter".
  void allow(const std::vector<std::string>& known, std::string_view what = "key") const;
  const std::vector<std::string>& keys() const { return value_->keys; }
  /// The keys, those of tables in it behind theirs: "arm2.l_b".
  /// @param of_tables  what a key holds is a table; then only tables of tables count as tables in it
  std::vector<std::string> dotted_keys(bool of_tables) const;
  bool has(const std::string& key) const { return find(key).has_value(); }
  /// The value under "arm2.l_b", whether the key is written so or the table has one called arm2.
  std::optional<ConfigValue> find(const std::string& key) const;
  std::optional<double> find_number(const std::string& key, std::string_view unit, double lower = -kUnbounded,
                                    double upper = kUnbounded) const;
  /// The value of a key that must be there.
  ConfigValue at(const std::string& key, std::string_view expected) const;
  /// Refuses anything but a table.
  const ConfigValue& expect_table(std::string_view expected = "a table") const;

  SourceLocation place() const { return {file_, value_->line, path_}; }
  /// "line 12", for a message about another place.
  std::string line() const { return "line " + std::to_string(value_->line); }
  /// found: the value as written.
  ConfigError error(std::string_view expected, std::string_view nearest = {}) const;
  ConfigError error_of(std::string_view found, std::string_view expected, std::string_view nearest = {}) const;
  /// A message that is a sentence of its own.
  ConfigError refusal(std::string_view sentence) const;
  /// Does `work`; what it refuses by std::invalid_argument is a refusal of this value.
  template <class Work>
  auto explained(Work work) const {
    try {
      return work();
    } catch (const std::invalid_argument& reason) {
      throw refusal(reason.what());
    }
  }

 private:
  const TomlValue* value_;
  std::string file_;
  std::string path_;
};

/// The options of one entry of a catalogue, read by their descriptions; defaults filled in. Only the options' own keys
/// are looked at: the caller refuses unknown keys with `allow`.
Options read_options(const ConfigValue& table, const std::vector<OptionSpec>& specs);

}  // namespace pkm
