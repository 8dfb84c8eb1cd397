// Tables for other programs: comma-separated values, numbers in full precision, empty cells for what does not exist.
#pragma once

#include <string>
#include <vector>

#include "engine/math/small_matrix.hpp"

namespace pkm {

class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string>& columns);

  void begin_row();
  void add(double value);  ///< a number that is not finite leaves the cell empty
  void add(const std::string& text);
  void add_empty(std::size_t cells);
  void add(const Vector<double, 4>& values);

  /// Throws std::runtime_error with a sentence when the file cannot be written.
  void write(const std::string& path) const;

 private:
  void next_cell();

  std::string text_;
  bool row_begins_ = true;
};

}  // namespace pkm
