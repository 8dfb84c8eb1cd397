// Vectors and matrices of dynamics as JSON and as text.
#pragma once

#include <cstdio>

#include "engine/math/small_matrix.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// A vector as a list.
inline Json vector_json(const Vector<double, 4>& v) {
  Json list = Json::array();
  for (const double element : v.m) list.push_back(element);
  return list;
}

/// A matrix as a list of its rows.
inline Json matrix_json(const Matrix<double, 4, 4>& matrix) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < 4; ++i) {
    rows.push_back(Json::array());
    for (std::size_t j = 0; j < 4; ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

inline void print_matrix(std::ostream& out, const std::string& title, const Matrix<double, 4, 4>& matrix) {
  out << '\n' << title << '\n';
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      std::array<char, 32> cell{};
      std::snprintf(cell.data(), cell.size(), "%18.11g", matrix(i, j));
      out << cell.data();
    }
    out << '\n';
  }
}

}  // namespace pkm
