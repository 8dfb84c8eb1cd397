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

/// Description of one option. A `number` has an SI unit ("m", "rad", "s", ... or "1"); its value is stored in that
/// unit.
struct OptionSpec {
  std::string name;
  OptionKind kind = OptionKind::number;
  std::string unit = "1";
  std::optional<OptionValue> initial;  ///< default value; std::nullopt: none
  bool required = false;  ///< true: the option must be given; false: it may be absent, even if it has no default
  double lower = -std::numeric_limits<double>::infinity();  ///< minimum of a number or an integer
  double upper = std::numeric_limits<double>::infinity();   ///< maximum of a number or an integer
  std::vector<std::string> choices;                         ///< valid words, if the option is a word; empty: any text
  std::string meaning;                                      ///< one-line description for `pkmopt list`
  /// For list_of_numbers and named_numbers: the valid names and their units. If empty, named_numbers accepts any
  /// name.
  std::vector<std::pair<std::string, std::string>> fields = {};
  FieldNames field_names = FieldNames::listed;  ///< FieldNames::objectives: every objective must have a value

  bool positive = false;  ///< true: numbers must be > 0
  std::size_t count = 0;  ///< number of elements of a list; 0: any number
  /// List: one element, which describes all elements of the list; any_of: the alternatives.
  std::vector<OptionSpec> parts = {};
  const TableSpec* table = nullptr;  ///< description of the keys of a table; null for options that are not tables
};

/// The additional keys of a table for one value of the key TableSpec::choice.
struct TableVariant {
  std::string word, meaning;
  std::vector<OptionSpec> keys;
  std::vector<OptionSpec> named = {};  ///< at most one element: description of the keys that the user names
};

/// A TOML table: the keys that it may always have, and those that it may have only for one value of its key `choice`
/// (for example "drive", "shape" or "type").
struct TableSpec {
  std::string header;  ///< header in the file, for example "[[region]]"; "" for inline tables
  std::string meaning;
  std::vector<OptionSpec> keys;
  std::string choice = {};  ///< name of the key that selects a variant; "": the table has no variants
  std::vector<TableVariant> variants = {};
  /// Description of the keys whose names the user chooses; empty if there are none, otherwise one element.
  std::vector<OptionSpec> named = {};
  std::string noun = "key";  ///< word for a key in messages: "coordinate", "parameter", "table"

  /// Finds the description of the key `name`, in the table or in one of its variants; null if there is none.
  const OptionSpec* find(const std::string& name) const;
};

/// Validated values of the options of one catalogue entry, including default values.
class Options {
 public:
  void set(const std::string& name, OptionValue value) { values_[name] = std::move(value); }
  bool has(const std::string& name) const { return values_.contains(name); }

  // The following functions throw std::out_of_range if the option has no value, and std::bad_variant_access if it is of
  // another kind. Both are programming errors of the catalogue entry, not of the user: the reader has validated all
  // values.
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

/// Options with the default values of `specs`. Options without a default are absent.
Options default_options(const std::vector<OptionSpec>& specs);

/// Writes the value of an option in the syntax of a study file (TOML).
std::string to_text(const OptionValue& value);

/// Shortest decimal form of a double that reads back to the same bits ("0.1", "1e-08", "inf").
std::string shortest(double value);

}  // namespace pkm
