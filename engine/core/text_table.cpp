#include "engine/core/text_table.hpp"

#include <algorithm>

#include "engine/core/printable.hpp"

namespace pkm {

std::string aligned(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows)
    for (std::string& cell : row) cell = printable(cell);
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c == width.size()) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += "  " + row[c] + std::string(width[c] - row[c].size(), ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string titled(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  return '\n' + title + (rows.empty() ? ": none\n" : "\n") + aligned(rows);
}

}  // namespace pkm
