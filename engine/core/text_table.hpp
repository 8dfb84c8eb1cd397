// Plain-text tables with aligned columns.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// Finds the decimal point in a text that begins with a number: 2 for "12.5 mm". Without a decimal point, the position
/// after the integer part: 1 for "7 of 9".
/// @return std::nullopt if the first word is not a number
std::optional<std::size_t> decimal_point_index(std::string_view text);

/// Formats a table: one line per row, two spaces before each cell, each column as wide as its widest cell. Cells are
/// escaped by printable(). In columns that contain only numbers, apart from a heading, the decimal points are aligned.
std::string aligned(std::vector<std::vector<std::string>> rows);
/// Formats an empty line, a title and a table. If there are no rows, ": none" follows the title.
std::string format_titled_table(const std::string& title, const std::vector<std::vector<std::string>>& rows);

}  // namespace pkm
