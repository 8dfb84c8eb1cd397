// What an entry of a catalogue (objective, constraint, optimiser) can be told, as data: one description serves the
// study file's reader, its error messages, `pkmopt list` and the documentation.
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
using Setting = std::variant<double, std::int64_t, std::string>;  ///< an option of a library, passed through
using NamedSettings = std::map<std::string, Setting>;
using OptionValue =
    std::variant<double, std::int64_t, bool, std::string, NamedNumbers, std::vector<NamedNumbers>, NamedSettings>;

enum class OptionKind { number, integer, flag, word, named_numbers, list_of_numbers, named_settings };

/// As the unit of a number: the unit of what the entry itself computes (a constraint's margin) or works on (an
/// optimiser's objective). It is known only once the study is, so the study's reader puts it in.
inline constexpr const char* kUnitOfEntry = "";

/// Which names a list of numbers knows: the variables and objectives are known only once the study is.
enum class FieldNames { listed, variables, objectives };

/// One option. A `number` carries a unit ("m", "rad", "s", ... or "1"), in which the value is held (always SI).
struct OptionSpec {
  std::string name;
  OptionKind kind = OptionKind::number;
  std::string unit = "1";
  std::optional<OptionValue> initial;                       ///< default; none: see `required`
  bool required = false;                                    ///< neither default nor required: the option may be absent
  double lower = -std::numeric_limits<double>::infinity();  ///< numbers and integers: least value allowed
  double upper = std::numeric_limits<double>::infinity();   ///< and greatest
  std::vector<std::string> choices;                         ///< words only: the words known; empty: any text
  std::string meaning;                                      ///< one line for `pkmopt list`
  std::vector<std::pair<std::string, std::string>> fields =
      {};  ///< names known, and their units, of lists of numbers; of named numbers where they are given
  FieldNames field_names = FieldNames::listed;  ///< in `fields`, or to be put there; objectives must all be given
};

/// Validated values of one entry's options, defaults included.
class Options {
 public:
  void set(const std::string& name, OptionValue value) { values_[name] = std::move(value); }
  bool has(const std::string& name) const { return values_.contains(name); }

  // Each throws std::out_of_range for a name without a value and std::bad_variant_access for the wrong kind: both
  // are faults of the entry, not of the user, because the reader has checked the values against the specs.
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

/// The options with every default of `specs` filled in and nothing else.
Options default_options(const std::vector<OptionSpec>& specs);

/// An option's value as it would be written in a study file.
std::string to_text(const OptionValue& value);

/// Shortest decimal form of a double that reads back to the same bits ("0.1", "1e-08", "inf").
std::string shortest(double value);

}  // namespace pkm
