#include "engine/report/csv_table.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "engine/core/options.hpp"

namespace pkm {

CsvTable::CsvTable(const std::vector<std::string>& columns) {
  for (const auto& column : columns) add(column);
}

void CsvTable::begin_row() {
  text_ += '\n';
  row_begins_ = true;
}

void CsvTable::next_cell() {
  if (!row_begins_) text_ += ',';
  row_begins_ = false;
}

void CsvTable::add(double value) {
  next_cell();
  if (std::isinf(value))
    text_ += value > 0 ? "inf" : "-inf";
  else if (!std::isnan(value))
    text_ += shortest(value + 0.0);  // no "-0"
}

void CsvTable::add(std::int64_t number) {
  next_cell();
  text_ += std::to_string(number);
}

void CsvTable::add(const std::string& text) {
  next_cell();
  if (text.find_first_of(",\"\n\r") == std::string::npos) {
    text_ += text;
    return;
  }
  text_ += '"';
  for (const char c : text) text_ += c == '"' ? std::string("\"\"") : std::string{c};
  text_ += '"';
}

void CsvTable::add_empty(std::size_t cells) {
  for (; cells > 0; --cells) next_cell();
}

void CsvTable::add(const AxisVector<double>& values) {
  for (const double value : values) add(value);
}

void CsvTable::write(const std::string& path) const {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text();
  file.close();
  if (!file) throw std::runtime_error(path + ": the table cannot be written (" + std::strerror(errno) + ")");
}

}  // namespace pkm
