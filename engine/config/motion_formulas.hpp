// Formulas of parameters in the table of a motion, such as time = "T" or x = "-0.5*reach". For each design they are
// replaced by their values, and the table is read as if it contained these numbers.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/core/parameter.hpp"
#include "engine/expression/formula.hpp"

namespace pkm {

class MotionFormulas {
 public:
  /// Finds the formulas in a table. Throws ConfigError if one of them is invalid.
  /// @param inputs  keys besides coordinates whose values may depend on the time
  MotionFormulas(const ConfigValue& table, const std::vector<Parameter>& parameters,
                 const std::vector<std::string>& inputs);

  /// Indices of the parameters that the formulas use, ascending; empty: the table depends on no parameters.
  const std::vector<std::size_t>& used() const { return used_; }
  /// The table for given values of all parameters. Formulas of the time remain formulas of the time.
  TomlValue table_of(std::span<const double> parameters) const;

 private:
  /// A formula in the table, and its position: indices of the key in its table, of the element in its list, and so on.
  struct Place {
    std::vector<std::size_t> path;
    std::string text;
    std::optional<Formula> value;  ///< the compiled formula; std::nullopt: it depends on the time
  };
  void find(const ConfigValue& value, const std::vector<std::size_t>& path, bool may_use_time);
  void add(const ConfigValue& value, const std::vector<std::size_t>& path, bool may_use_time);
  /// The formula `text` with all parameters replaced by their values, so that it depends on the time only.
  std::string formula_of_time(const std::string& text, std::span<const double> parameters) const;

  TomlValue table_;
  std::vector<std::string> names_;    ///< names of the parameters that formulas may use
  std::vector<std::size_t> numbers_;  ///< for each of `names_`, the index of the parameter among all parameters
  std::vector<Place> places_;
  std::vector<std::size_t> used_;
};

}  // namespace pkm
