// Writer for tables of comma-separated values (RFC 4180, but lines end with a line feed). Numbers have full precision,
// missing values are empty cells. Text that a spreadsheet would execute as a formula ("=..", "@..") is prefixed with
// an apostrophe.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <vector>

namespace pkm {

/// Header of a column: "a [m]", or only the name if the unit is "1".
inline std::string column_header(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string>& columns);

  void begin_row();
  /// Starts a row that begins with these cells; further cells can be added to it.
  template <class... Cells>
  void row(const Cells&... cells) {
    begin_row();
    (add(cells), ...);
  }
  /// Adds a cell with a number. NaN is written as an empty cell, infinities as "inf" and "-inf".
  void add(double value);
  void add(std::integral auto number) { add_cell(std::to_string(number)); }
  void add(const std::string& text);
  void add_empty(std::size_t cells);
  void add(std::span<const double> values);

  /// The text of the complete file.
  std::string text() const { return text_ + '\n'; }

 private:
  void add_cell(const std::string& text);

  std::string text_;
  bool at_row_start_ = true;
};

}  // namespace pkm
