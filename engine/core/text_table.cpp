#include "engine/core/text_table.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/core/printable.hpp"

namespace pkm {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Places that a text takes: bytes, but for those that go on with a character of UTF-8.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

/// Moves the numbers of a column to the right, until their points are where that of the widest is.
void align_points(Rows& rows, std::size_t column) {
  const bool has_head = rows[0].size() != 2 || rows[0][0].empty();  // else names and what belongs to them
  std::size_t furthest = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (column >= rows[r].size()) continue;
    const std::string& cell = rows[r][column];
    const auto point = point_of_number(cell);
    const bool holds_none = cell.empty() || cell == "-" || cell == "not computed";
    if (!point && !holds_none && (r > 0 || !has_head)) return;
    furthest = std::max(furthest, point.value_or(0));
  }
  for (auto& row : rows)
    if (column < row.size())
      if (const auto point = point_of_number(row[column])) row[column].insert(0, furthest - *point, ' ');
}

}  // namespace

std::optional<std::size_t> point_of_number(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = std::min(text.find(' ', begin), text.size());
  std::string_view digits = text.substr(begin, end - begin);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (read.ec != std::errc() || read.ptr != digits.data() + digits.size()) return {};
  if (std::ranges::none_of(digits, [](unsigned char c) { return std::isdigit(c) != 0; })) return {};  // "inf"
  return std::min(text.find_first_of(".e", begin), end);
}

std::string aligned(Rows rows) {
  std::size_t columns = 0;
  for (auto& row : rows) {
    columns = std::max(columns, row.size());
    for (std::string& cell : row) cell = printable(cell);
  }
  std::vector<std::size_t> width(columns, 0);
  for (std::size_t c = 0; c < columns; ++c) {
    align_points(rows, c);
    for (const auto& row : rows)
      if (c < row.size()) width[c] = std::max(width[c], width_of(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += "  " + row[c] + std::string(width[c] - width_of(row[c]), ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string titled(const std::string& title, const Rows& rows) {
  return '\n' + title + (rows.empty() ? ": none\n" : "\n") + aligned(rows);
}

}  // namespace pkm
