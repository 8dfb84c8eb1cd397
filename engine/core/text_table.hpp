// Tables of text with aligned columns.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// Where the point of the number is, or would be, that a text begins with: of "12.5 mm" 2, of "7 of 9" 1. None: the
/// first word is no number.
std::optional<std::size_t> point_of_number(std::string_view text);

/// One line per row, two spaces before each cell, each column as wide as its widest cell; the cells are printable.
/// Points of numbers stand below one another in columns of nothing else but a name in the first row of a table.
std::string aligned(std::vector<std::vector<std::string>> rows);
/// An empty line, the title (": none" where there are no rows), and the rows.
std::string titled(const std::string& title, const std::vector<std::vector<std::string>>& rows);

}  // namespace pkm
