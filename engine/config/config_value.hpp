// Strict reader of one value of a TOML file. It accepts what is expected and refuses everything else with file, line,
// key path, the value as written, what is expected, and the nearest known name.
//
// A table is read by its description (TableSpec in engine/core/options.hpp): keys that the description lacks are
// refused, and the values have the types, units, ranges and defaults that it gives. `pkmopt schema` and the reference
// of keys are generated from the same descriptions, so a reader that reads a key or a type that its description lacks
// is an error of the program: std::logic_error.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
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

/// Text for messages that states which values an option accepts: "an integer in [1, 200]", "one of box, sphere,
/// capsule".
std::string expectation(const OptionSpec& spec);

/// A value of a TOML file with its position and its description. It refers to a TomlValue that must outlive it. Every
/// function that reads throws ConfigError.
class ConfigValue {
 public:
  /// @param path  dotted key path: "variables.a.min"; tables of a list count from 1: "constraint[2].bound"
  ConfigValue(const TomlValue& value, std::string file, std::string path);

  bool is_table() const { return value_->kind == TomlValue::Kind::table; }
  bool is_list() const { return value_->kind == TomlValue::Kind::array; }
  bool is_flag() const { return value_->kind == TomlValue::Kind::flag; }
  bool is_integer() const { return value_->kind == TomlValue::Kind::integer; }
  bool is_text() const { return value_->kind == TomlValue::Kind::text; }

  // Functions for values whose description contains their unit, their range or the words that are allowed:

  /// A finite number in SI, or text with a unit.
  double number() const;
  std::int64_t integer() const;
  const std::string& word() const;
  /// The elements of a list: `path[1]`, `path[2]`, ...
  std::vector<ConfigValue> elements() const;

  // Functions for values whose unit, range or allowed words depend on the mechanism or the study:

  /// A finite number in SI, or text with a unit of the dimension of `unit`; within [lower, upper].
  double number(std::string_view unit, double lower = -kUnbounded, double upper = kUnbounded) const;
  /// A finite number > 0.
  double positive(std::string_view unit) const;
  /// An integer without decimal point or exponent.
  std::int64_t integer(double lower, double upper) const;
  bool flag() const;
  const std::string& text(std::string_view expected) const;
  /// This value as a number, an integer or a text, whichever it is.
  Setting setting() const;
  /// Text that is one of `choices`.
  const std::string& word(const std::vector<std::string>& choices) const;
  std::vector<ConfigValue> elements(std::string_view expected) const;

  // Functions for values that are tables:

  /// This value as a table described by `spec`. Refuses values that are not tables, and keys that are not described. If
  /// the table has variants, also refuses a missing or unknown TableSpec::choice, and keys of other variants.
  /// @param more  further keys: those of a catalogue entry, or the names of TableSpec::named if these are known
  ConfigValue described_by(const TableSpec& spec, const std::vector<OptionSpec>& more = {}) const;
  /// This value as a table that has the keys given by the description of this value.
  ConfigValue table(const std::vector<OptionSpec>& more = {}) const;
  /// This value as a table whose keys are names chosen by the user. Refuses keys that are not in `names`.
  ConfigValue table_of_names(const std::vector<std::string>& names) const;
  /// The table [key] with its description; std::nullopt if the file has none.
  std::optional<ConfigValue> find_table(const std::string& key, const std::vector<OptionSpec>& more = {}) const;
  /// The description of this value as a table.
  const TableSpec& table_spec() const { return *described_as(OptionKind::table).table; }
  /// The tables [[key]] with their description; empty if the file has none.
  std::vector<ConfigValue> tables(const std::string& key, const std::vector<OptionSpec>& more = {}) const;
  /// Refuses any key that is not in `known`. @param what  what the keys are: "key", "parameter"
  void allow(const std::vector<std::string>& known, std::string_view what = "key") const;
  const std::vector<std::string>& keys() const { return value_->keys; }
  /// The keys of this table. A nested table contributes dotted keys, such as "arm2.l_b", instead of its own key.
  /// @param of_tables  the values of this table are themselves tables; then only tables that contain nothing but tables
  ///                   contribute dotted keys
  std::vector<std::string> dotted_keys(bool of_tables) const;
  bool has(const std::string& key) const { return find(key).has_value(); }
  /// The value under a dotted key such as "arm2.l_b", written in this form or as a table arm2 with the key l_b.
  std::optional<ConfigValue> find(const std::string& key) const;
  /// The value of a required key.
  ConfigValue at(const std::string& key, std::string_view expected) const;
  /// The value of a required key; the message for a missing key is taken from the description of the key.
  ConfigValue at(const std::string& key) const;
  /// The value of a key, or its default.
  double number_at(const std::string& key) const;
  bool flag_at(const std::string& key) const;
  std::string word_at(const std::string& key) const;
  /// The value of a key that may be absent.
  std::optional<double> find_number(const std::string& key) const;
  std::optional<double> find_number(const std::string& key, std::string_view unit, double lower = -kUnbounded,
                                    double upper = kUnbounded) const;
  /// Returns this value; throws ConfigError if it is not a table.
  const ConfigValue& expect_table(std::string_view expected = "a table") const;
  /// The value of `key`, which must be one of `choices`. It decides which other keys are allowed, and is therefore read
  /// before these are checked. If it is missing, the message suggests the most similar key that is present.
  const std::string& choice(const std::string& key, const std::vector<std::string>& choices) const;

  /// Throws std::logic_error if the description of this value is not that of a formula with this unit.
  void expect_formula(std::string_view unit) const { spec_as({OptionKind::formula}, unit); }

  const TomlValue& toml() const { return *value_; }
  SourceLocation place() const { return {file_, value_->line, path_}; }
  /// Text such as "line 12" for a message that refers to the position of this value.
  std::string line() const { return "line " + std::to_string(value_->line); }
  /// An error that names the value as written, what is expected, and the nearest known name.
  ConfigError error(std::string_view expected, std::string_view nearest = {}) const;
  ConfigError error_of(std::string_view found, std::string_view expected, std::string_view nearest = {}) const;
  /// An error whose message is the given sentence, at the position of this value.
  ConfigError refusal(std::string_view sentence) const;
  /// Calls `work`, and converts a std::invalid_argument that it throws into a ConfigError at the position of this
  /// value.
  template <class Work>
  auto explained(Work work) const {
    try {
      return work();
    } catch (const std::invalid_argument& reason) {
      throw refusal(reason.what());
    }
  }

 private:
  /// The description of a table, with further keys (of a catalogue entry, or names chosen by the user) that this table
  /// accepts.
  struct Description {
    const TableSpec* spec;
    std::vector<OptionSpec> more;
  };
  using Spec = std::shared_ptr<const OptionSpec>;  // shares the ownership of `Description::more`

  ConfigValue child(const TomlValue& value, std::string path, Spec spec) const;
  /// The description of a key; null if this table has no description. Throws std::logic_error if its description lacks
  /// the key.
  Spec spec_of(const std::string& key) const;
  /// The description of this value; null if it has none. Throws std::logic_error if the description has none of these
  /// kinds, or another unit. @param unit  "" accepts any unit
  const OptionSpec* spec_as(std::initializer_list<OptionKind> kinds, std::string_view unit = "") const;
  /// The description of this value, which has to be of this kind.
  const OptionSpec& described_as(OptionKind kind) const;

  const TomlValue* value_;
  std::string file_;
  std::string path_;
  Spec spec_ = nullptr;                                 ///< description of this value
  std::shared_ptr<const Description> table_ = nullptr;  ///< if this value is a table: description of its keys
};

/// One description for each of the given names: a copy of the description TableSpec::named, with this name.
std::vector<OptionSpec> named_keys(const TableSpec& table, const std::vector<std::string>& names);

/// The options of a catalogue entry, with defaults filled in. Keys that `specs` does not describe are ignored: they
/// were checked by described_by() before.
Options read_options(const ConfigValue& table, const std::vector<OptionSpec>& specs);

}  // namespace pkm
