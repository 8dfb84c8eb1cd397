// Variables that are choices from catalogues: [variables] motor = { from = "motors.toml" }.
//
// A catalogue is a TOML file with one list of tables, [[motor]] for example, each with a `name`. A study with choices
// is read once for every combination of rows that is evaluated: the variable becomes a parameter with the values 1, 2,
// .., and the texts "motor.KEY" in [[drive_train]] and [mechanism.parameters] are replaced by the values of the row.
// The rows of a list [[motor]] are also added to the motors of the study.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/config/toml.hpp"
#include "engine/core/source_text.hpp"

namespace pkm {

struct Catalogue {
  std::string variable;
  SourceText file;
  std::string list;  ///< name of the list of tables in the file, for example "motor"
  std::vector<TomlValue> rows;
  std::vector<std::string> names;
};

/// Reads the catalogues that the [variables] of a study name. Throws ConfigError.
/// @param find  find(value): reads the file whose name is the value of a key
std::vector<Catalogue> read_catalogues(const TomlValue& study, const std::string& file_name,
                                       const std::function<SourceText(const ConfigValue& file)>& find);

/// Index of the row of each catalogue with which the study itself is read: that of the row named in [baseline],
/// otherwise 0.
std::vector<std::size_t> rows_of_baseline(const TomlValue& study, const std::string& file_name,
                                          const std::vector<Catalogue>& catalogues);

/// Names of the parameters whose values in [mechanism] are texts "VARIABLE.KEY" and therefore depend on the chosen
/// rows.
std::vector<std::string> parameters_of_rows(const TomlValue& study, const std::vector<Catalogue>& catalogues);

/// The study with the given row of every catalogue. Throws ConfigError if the study uses a key that a row lacks.
TomlValue with_rows(const TomlValue& study, const std::string& file_name, const std::vector<Catalogue>& catalogues,
                    const std::vector<std::size_t>& rows);

}  // namespace pkm
