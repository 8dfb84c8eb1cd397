// Small dense matrices whose elements are nodes of an expression graph, with the linear algebra that formulas of
// mechanisms need: determinants, adjugates, Cholesky factors and extreme eigenvalues, all without branches.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "engine/expression/graph.hpp"

namespace pkm::expression {

class TermMatrix {
 public:
  /// Makes a matrix of the given size whose elements are 0.
  TermMatrix(Graph& graph, std::size_t rows, std::size_t columns)
      : rows_(rows), columns_(columns), elements_(rows * columns, Term(graph, 0.0)) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  Term& operator()(std::size_t row, std::size_t column) { return elements_[row * columns_ + column]; }
  const Term& operator()(std::size_t row, std::size_t column) const { return elements_[row * columns_ + column]; }
  Graph& graph() const { return elements_.front().graph(); }
  TermMatrix transposed() const;
  TermMatrix column(std::size_t j) const;

  friend TermMatrix operator+(const TermMatrix& A, const TermMatrix& B);
  friend TermMatrix operator*(const TermMatrix& A, const TermMatrix& B);
  friend TermMatrix operator*(const TermMatrix& A, const Term& factor);

 private:
  std::size_t rows_, columns_;
  std::vector<Term> elements_;
};

/// Determinants of square submatrices that consist of the first rows of a matrix and some of its columns, by Laplace
/// expansion along their last rows.
class Minors {
 public:
  /// @param A             at most 32 columns; it has to outlive this object
  /// @param excluded_row  index of a row that is excluded from all submatrices; A.rows(): none is excluded
  Minors(const TermMatrix& A, std::size_t excluded_row);
  /// Determinant of a submatrix. @param columns  set of its columns, one bit each; it has as many rows as columns
  Term of(unsigned columns);

 private:
  const TermMatrix& A_;
  std::vector<std::size_t> rows_;
  std::map<unsigned, Term> known_;
};

/// Sum of the squares of all elements.
Term squared_norm(const TermMatrix& A);

/// The adjugate and the determinant of a square matrix, A^-1 = adjugate / determinant, by Laplace expansion. Both are
/// defined for singular matrices, too.
struct Inverse {
  TermMatrix adjugate;
  Term determinant;
};
Inverse inverse_of(const TermMatrix& A);

/// The lower triangular L with A = L L^T, for a symmetric positive definite matrix.
TermMatrix cholesky_factor(const TermMatrix& A);

/// Minimum and maximum eigenvalue of a symmetric positive semidefinite matrix of at most three rows, in closed form. At
/// a double eigenvalue, where they are not differentiable, their derivatives are those of the mean of the two.
std::array<Term, 2> eigenvalue_range(const TermMatrix& A);

/// Maximum eigenvalue of a symmetric positive semidefinite matrix: in closed form up to three rows, otherwise
/// trace(A^p)^(1/p) for p = 2^40 by repeated squaring, which is too large by a factor of at most 1 + 2e-12 for six
/// rows.
Term greatest_eigenvalue(const TermMatrix& A);

}  // namespace pkm::expression
