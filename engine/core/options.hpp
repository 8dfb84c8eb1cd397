// Declarative description of the keys of a TOML table: the options of a catalogue entry (objective, constraint,
// optimiser) and the tables of studies and mechanism files. Each key has a name, type, unit, default value, range and
// meaning. It is used by the readers of the files, their error messages, `pkmopt list`, `pkmopt schema` and the
// documentation.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pkm {

using NamedNumbers = std::map<std::string, double>;
/// Value of an option that is passed on unchanged to an external library.
using Setting = std::variant<double, std::int64_t, std::string>;
using NamedSettings = std::map<std::string, Setting>;
using OptionValue =
    std::variant<double, std::int64_t, bool, std::string, NamedNumbers, std::vector<NamedNumbers>, NamedSettings>;

/// Kinds of options. Catalogue entries use only the kinds up to named_settings; keys of tables may be of any kind.
enum class OptionKind {
  number,
  integer,
  flag,
  word,
  named_numbers,
  list_of_numbers,
  named_settings,
  formula,  ///< a number, text with a unit, or a formula
  list,     ///< a list whose elements are described by `parts`
  table,    ///< a table that is described by `table`
  any_of    ///< one of the kinds that are described by `parts`
};

struct TableSpec;

/// Placeholder for the unit of an option of a catalogue entry, if it is the unit of the quantity that the entry
/// computes (the value of a constraint) or uses (the objective of an optimiser). This unit depends on the study; the
/// reader of the study substitutes it.
inline constexpr const char* kUnitOfEntry = "";

/// Which names are valid in a list of named numbers: those in OptionSpec::fields, or the names of the study's variables
/// or objectives, which are substituted when the study is read.
enum class FieldNames { listed, variables, objectives };

/// One option. A `number` has an SI unit ("m", "rad", "s", ... or "1"); its value is stored in that unit.
struct OptionSpec {
  std::string name;
  OptionKind kind = OptionKind::number;
  std::string unit = "1";
  std::optional<OptionValue> initial;  ///< default value, if any
  bool required = false;               ///< an option that has no default and is not required may be absent
  double lower = -std::numeric_limits<double>::infinity();  ///< minimum (numbers and integers)
  double upper = std::numeric_limits<double>::infinity();   ///< maximum
  std::vector<std::string> choices;                         ///< valid words (words only); empty: any text
  std::string meaning;                                      ///< one-line description for `pkmopt list`
  std::vector<std::pair<std::string, std::string>> fields =
      {};  ///< list_of_numbers, named_numbers: valid names and their units; named_numbers: any name if empty
  FieldNames field_names = FieldNames::listed;  ///< FieldNames::objectives: a value is required for every objective

  bool positive = false;               ///< numbers have to be > 0
  std::size_t count = 0;               ///< number of elements of a list; 0: any
  std::vector<OptionSpec> parts = {};  ///< list: one spec for all elements; any_of: the alternatives
  const TableSpec* table = nullptr;    ///< keys of the table (tables only)
};

/// The keys of a table for one value of TableSpec::choice.
struct TableVariant {
  std::string word, meaning;
  std::vector<OptionSpec> keys;
  std::vector<OptionSpec> named = {};  ///< see TableSpec::named
};

/// A TOML table: the keys that it may always have, and those that it may have only for one value of its key `choice`
/// (for example "drive", "shape" or "type").
struct TableSpec {
  std::string header;  ///< "[[region]]"; "" for inline tables
  std::string meaning;
  std::vector<OptionSpec> keys;
  std::string choice = {};  ///< key that selects one of the variants; "": there are none
  std::vector<TableVariant> variants = {};
  std::vector<OptionSpec> named = {};  ///< at most one: describes the keys whose names the user chooses
  std::string noun = "key";            ///< what a key is, for messages: "coordinate", "parameter", "table"

  /// The key called `name`, of the table or of one of its variants; null if there is none.
  const OptionSpec* find(const std::string& name) const;
};

/// Validated values of one entry's options, defaults included.
class Options {
 public:
  void set(const std::string& name, OptionValue value) { values_[name] = std::move(value); }
  bool has(const std::string& name) const { return values_.contains(name); }

  // These functions throw std::out_of_range if the option has no value, and std::bad_variant_access if it is of another
  // kind. Both are programming errors of the catalogue entry, not of the user: the reader has validated all values.
  double number(const std::string& name) const { return std::get<double>(values_.at(name)); }
  std::int64_t integer(const std::string& name) const { return std::get<std::int64_t>(values_.at(name)); }
  bool flag(const std::string& name) const { return std::get<bool>(values_.at(name)); }
  const std::string& word(const std::string& name) const { return std::get<std::string>(values_.at(name)); }
  const NamedNumbers& numbers(const std::string& name) const { return std::get<NamedNumbers>(values_.at(name)); }
  const std::vector<NamedNumbers>& list(const std::string& name) const {
    return std::get<std::vector<NamedNumbers>>(values_.at(name));
  }
  const NamedSettings& settings(const std::string& name) const { return std::get<NamedSettings>(values_.at(name)); }

  const std::map<std::string, OptionValue>& values() const { return values_; }

 private:
  std::map<std::string, OptionValue> values_;
};

/// The default values of `specs`. Options without a default are absent.
Options default_options(const std::vector<OptionSpec>& specs);

/// An option's value in the syntax of a study file (TOML).
std::string to_text(const OptionValue& value);

/// Shortest decimal form of a double that reads back to the same bits ("0.1", "1e-08", "inf").
std::string shortest(double value);

}  // namespace pkm
