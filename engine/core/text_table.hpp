// Tables of text with aligned columns.
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// One line per row, two spaces before each cell, each column as wide as its widest cell; the cells are printable.
std::string aligned(std::vector<std::vector<std::string>> rows);
/// An empty line, the title (": none" where there are no rows), and the rows.
std::string titled(const std::string& title, const std::vector<std::vector<std::string>>& rows);

}  // namespace pkm
