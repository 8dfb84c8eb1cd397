#include "engine/core/text_table.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/core/printable.hpp"

namespace pkm {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Width of a text in terminal columns: the number of UTF-8 characters, i.e. of bytes that are not continuation bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

/// Aligns the decimal points of a numeric column by indenting its cells; leaves other columns unchanged.
void align_decimal_points(Rows& rows, std::size_t column) {
  // False: the table is a list of names and values, which has no heading.
  const bool has_heading = rows[0].size() != 2 || rows[0][0].empty();
  std::size_t max_position = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (column >= rows[r].size()) continue;
    const std::string& cell = rows[r][column];
    const auto position = decimal_point_index(cell);
    const bool is_missing = cell.empty() || cell == "-" || cell == "not computed";
    if (!position && !is_missing && (r > 0 || !has_heading)) return;
    max_position = std::max(max_position, position.value_or(0));
  }
  for (auto& row : rows)
    if (column < row.size())
      if (const auto position = decimal_point_index(row[column])) row[column].insert(0, max_position - *position, ' ');
}

}  // namespace

std::optional<std::size_t> decimal_point_index(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = std::min(text.find(' ', begin), text.size());
  std::string_view digits = text.substr(begin, end - begin);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (read.ec != std::errc() || read.ptr != digits.data() + digits.size()) return {};
  // The text is a value without digits, such as "inf".
  if (std::ranges::none_of(digits, [](unsigned char c) { return std::isdigit(c) != 0; })) return {};
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
    align_decimal_points(rows, c);
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

std::string format_titled_table(const std::string& title, const Rows& rows) {
  return '\n' + title + (rows.empty() ? ": none\n" : "\n") + aligned(rows);
}

}  // namespace pkm
