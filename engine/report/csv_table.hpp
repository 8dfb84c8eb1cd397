// Tables for other programs: comma-separated values (RFC 4180, lines end with a line feed), numbers in full precision,
// empty cells for what does not exist.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/small_matrix.hpp"

namespace pkm {

/// A column's header, "a [m]"; the name alone for unit "1".
inline std::string header(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string>& columns);

  void begin_row();
  void add(double value);  ///< NaN leaves the cell empty; infinities are "inf" and "-inf"
  void add(std::int64_t number);
  void add(const std::string& text);
  void add_empty(std::size_t cells);
  void add(const AxisVector<double>& values);

  /// The whole file.
  std::string text() const { return text_ + '\n'; }
  /// Throws std::runtime_error with a sentence when the file cannot be written.
  void write(const std::string& path) const;

 private:
  void next_cell();

  std::string text_;
  bool row_begins_ = true;
};

}  // namespace pkm
