// Tables for other programs: comma-separated values (RFC 4180, lines end with a line feed), numbers in full precision,
// empty cells for what does not exist. Text that a spreadsheet would run as a formula ("=..", "@..") begins with a '.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <vector>

namespace pkm {

/// A column's header, "a [m]"; the name alone for unit "1".
inline std::string header(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string>& columns);

  void begin_row();
  /// A row that begins with these cells.
  template <class... Cells>
  void row(const Cells&... cells) {
    begin_row();
    (add(cells), ...);
  }
  void add(double value);  ///< NaN leaves the cell empty; infinities are "inf" and "-inf"
  void add(std::integral auto number) { add_cell(std::to_string(number)); }
  void add(const std::string& text);
  void add_empty(std::size_t cells);
  void add(std::span<const double> values);

  /// The whole file.
  std::string text() const { return text_ + '\n'; }

 private:
  void add_cell(const std::string& text);

  std::string text_;
  bool row_begins_ = true;
};

}  // namespace pkm
