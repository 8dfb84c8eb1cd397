#include "engine/generic/tolerances/rank_conditions.hpp"

#include <bit>

namespace pkm::generic {

using expression::Graph, expression::Node, expression::Term;

namespace {

/// The determinant of a square matrix, by expansion along the last row, with the minors of the first rows for all sets
/// of columns.
/// @param entries  elements of the matrix, row by row
Term determinant(Graph& graph, const std::vector<Term>& entries, std::size_t size) {
  // For each set of columns, the determinant of the submatrix that consists of the first rows and these columns.
  std::vector<Term> minors(std::size_t{1} << size, Term(graph, 1.0));
  for (std::size_t columns = 1; columns < minors.size(); ++columns) {
    const auto row = static_cast<std::size_t>(std::popcount(columns)) - 1;
    Term sum(graph, 0.0);
    bool is_negative = row % 2 == 1;  // true: the term of the next column is subtracted
    for (std::size_t j = 0; j < size; ++j) {
      if (!(columns >> j & 1U)) continue;
      const Term product = entries[row * size + j] * minors[columns ^ (std::size_t{1} << j)];
      sum = is_negative ? sum - product : sum + product;
      is_negative = !is_negative;
    }
    minors[columns] = sum;
  }
  return minors.back();
}

}  // namespace

std::vector<Node> rank_conditions(Graph& graph, const bounds::NamedMatrix& matrix) {
  const std::size_t rows = matrix.rows, columns = matrix.columns;
  std::vector<Term> entries;
  for (const Node entry : matrix.entries) entries.emplace_back(graph, entry);
  if (rows != columns) {
    std::vector<Term> product;
    for (std::size_t i = 0; i < columns; ++i)
      for (std::size_t j = 0; j < columns; ++j) {
        Term sum(graph, 0.0);
        for (std::size_t k = 0; k < rows; ++k) sum = sum + entries[k * columns + i] * entries[k * columns + j];
        product.push_back(sum);
      }
    return {determinant(graph, product, columns).node()};
  }
  bool is_diagonal = true;
  std::vector<Node> diagonal;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      if (i == j)
        diagonal.push_back(entries[i * columns + j].node());
      else
        is_diagonal = is_diagonal && entries[i * columns + j].is(0);
  if (is_diagonal) return diagonal;
  return {determinant(graph, entries, columns).node()};
}

}  // namespace pkm::generic
