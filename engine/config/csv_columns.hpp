// Reads tables of comma-separated values: columns of numbers, identified by their names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/config/assignments.hpp"

namespace pkm {

struct CsvColumns {
  std::size_t rows = 0;
  /// For each known name, the values [SI]; std::nullopt if the table has no such column.
  std::vector<std::optional<std::vector<double>>> values;
  std::vector<std::string> others;  ///< names of the columns that are not known
};

/// Reads a table (RFC 4180) whose first line has the names of the columns, with or without a unit: "a" or "a [mm]".
/// Cells are numbers in this unit, by default the SI unit, or texts with a unit. Columns that are not known are not
/// read. Throws ConfigError, with file, line and column.
/// @param text       the file
/// @param file_name  for messages
CsvColumns read_csv_columns(const std::string& text, const std::string& file_name,
                            const std::vector<Assignable>& known);

}  // namespace pkm
