// Choices from catalogues: design variables whose values 1, 2, .. are rows of a table, such as motors or gears.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace pkm {

struct Choice {
  std::string variable;           ///< name of the variable, which is also a parameter of the mechanism
  std::size_t parameter = 0;      ///< index of this parameter of the mechanism
  std::vector<std::string> rows;  ///< names of the rows of the table

  /// Index of the row that a value of the parameter selects.
  std::size_t row(double value) const {
    return static_cast<std::size_t>(std::fmin(std::fmax(std::round(value), 1), static_cast<double>(rows.size()))) - 1;
  }
};

}  // namespace pkm
