// Vectors and matrices of the joints as JSON and as text.
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

/// A 4 x 4 matrix, ours or Eigen's, as a list of its rows.
template <class Matrix4>
Json matrix_json(const Matrix4& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i) {
    rows.push_back(Json::array());
    for (int j = 0; j < 4; ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

template <class Matrix4>
void print_matrix(std::ostream& out, const std::string& title, const Matrix4& matrix) {
  out << '\n' << title << '\n';
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      std::array<char, 32> cell{};
      std::snprintf(cell.data(), cell.size(), "%18.11g", matrix(i, j));
      out << cell.data();
    }
    out << '\n';
  }
}

}  // namespace pkm
