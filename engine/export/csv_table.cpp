#include "engine/export/csv_table.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/core/options.hpp"

namespace pkm {
namespace {

/// Returns true if a spreadsheet would execute the text as a formula (CSV injection). Numbers such as -7 are harmless.
bool is_spreadsheet_formula(const std::string& text) {
  if (text.empty() || std::string_view("=+-@\t\r").find(text[0]) == std::string_view::npos) return false;
  const char* const begin = text.data() + (text[0] == '+' ? 1 : 0);
  const char* const end = text.data() + text.size();
  double number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error != std::errc() || stop != end;
}

}  // namespace

CsvTable::CsvTable(const std::vector<std::string>& columns) {
  for (const auto& column : columns) add(column);
}

void CsvTable::begin_row() {
  text_ += '\n';
  at_row_start_ = true;
}

void CsvTable::add_cell(const std::string& text) {
  if (!at_row_start_) text_ += ',';
  at_row_start_ = false;
  text_ += text;
}

void CsvTable::add(double value) {
  if (std::isinf(value))
    add_cell(value > 0 ? "inf" : "-inf");
  else
    add_cell(std::isnan(value) ? "" : shortest(value + 0.0));  // adding 0.0 turns -0 into 0
}

void CsvTable::add(const std::string& text) {
  const std::string cell = (is_spreadsheet_formula(text) ? "'" : "") + text;
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return add_cell(cell);
  std::string quoted;
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string{c};
  add_cell('"' + quoted + '"');
}

void CsvTable::add_empty(std::size_t cells) {
  for (; cells > 0; --cells) add_cell("");
}

void CsvTable::add(std::span<const double> values) {
  for (const double value : values) add(value);
}

}  // namespace pkm
