#include "engine/expression/term_matrix.hpp"

#include <bit>
#include <cmath>

namespace pkm::expression {

Minors::Minors(const TermMatrix& A, std::size_t excluded_row) : A_(A) {
  for (std::size_t i = 0; i < A.rows(); ++i)
    if (i != excluded_row) rows_.push_back(i);
  known_.emplace(0U, Term(A.graph(), 1.0));
}

Term Minors::of(unsigned columns) {
  if (const auto found = known_.find(columns); found != known_.end()) return found->second;
  const std::size_t row = rows_[static_cast<std::size_t>(std::popcount(columns)) - 1];
  Term sum(A_.graph(), 0.0);
  // Sign of the cofactor: it is positive for the last column of the submatrix and alternates from right to left.
  bool is_negative = false;
  for (std::size_t j = A_.columns(); j-- > 0;) {
    if ((columns >> j & 1U) == 0) continue;
    const Term product = A_(row, j) * of(columns & ~(1U << j));
    sum = is_negative ? sum - product : sum + product;
    is_negative = !is_negative;
  }
  known_.emplace(columns, sum);
  return sum;
}

namespace {

Term sum_of_squares(std::initializer_list<Term> terms) {
  Term sum = *terms.begin() * *terms.begin();
  for (const Term* each = terms.begin() + 1; each != terms.end(); ++each) sum = sum + *each * *each;
  return sum;
}

/// sqrt(square + (tiny scale)^2), whose derivatives are finite even where `square` vanishes.
Term regular_root(const Term& square, const Term& scale) {
  constexpr double kTiny = 1e-20;
  const Term tiny = scale * kTiny;
  return sqrt(square + tiny * tiny);
}

/// The eigenvalues of a symmetric 3 x 3 matrix are those of its deviator B = A - q I, q = trace(A) / 3, plus q:
///
///   q + 2 p cos((phi + 2 pi k) / 3),   p^2 = |B|^2 / 6,   p^3 cos phi = det(B) / 2,   p^3 sin phi = sqrt(D / 108)
///
/// The discriminant D = prod (lambda_i - lambda_j)^2 is 3 times the Gram determinant of B and the deviator of B^2, a
/// sum of squares. In this form nearly equal eigenvalues are accurate to rounding; from 1 - cos^2 phi they would lose
/// half of the digits.
std::array<Term, 2> eigenvalue_range_3(const TermMatrix& A) {
  const Term q = (A(0, 0) + A(1, 1) + A(2, 2)) / 3;
  const Term a = A(0, 0) - q, b = A(1, 1) - q, c = A(2, 2) - q, d = A(1, 2), e = A(0, 2), f = A(0, 1);
  const Term half = sum_of_squares({a, b, c}) * 0.5 + sum_of_squares({d, e, f});  // |B|^2 / 2
  const Term p = regular_root(half / 3, q);
  const Term det = a * (b * c - d * d) - f * (f * c - d * e) + e * (f * d - b * e);
  // Returns the orthonormal components of a symmetric matrix (B, or the deviator of S = B^2).
  const auto components = [](const Term& xx, const Term& yy, const Term& zz, const Term& yz, const Term& xz,
                             const Term& xy) {
    return std::array<Term, 5>{(xx - yy) / std::sqrt(2.0), (zz * 2 - xx - yy) / std::sqrt(6.0), yz * std::sqrt(2.0),
                               xz * std::sqrt(2.0), xy * std::sqrt(2.0)};
  };
  const auto u = components(a, b, c, d, e, f);
  const auto v = components(sum_of_squares({a, f, e}), sum_of_squares({f, b, d}), sum_of_squares({e, d, c}),
                            f * e + d * (b + c), a * e + f * d + e * c, f * (a + b) + e * d);
  Term gram(A.graph(), 0.0);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = i + 1; j < 5; ++j) {
      const Term minor = u[i] * v[j] - u[j] * v[i];
      gram = gram + minor * minor;
    }
  constexpr double kThird = 2.0943951023931953;  // 2 pi / 3
  const Term third = atan2(regular_root(gram / 36, q * q * q * 1e-40), det * 0.5) / 3;
  return {q + p * 2 * cos(third + kThird), q + p * 2 * cos(third)};
}

std::array<Term, 2> eigenvalue_range_2(const TermMatrix& A) {
  const Term mean = (A(0, 0) + A(1, 1)) * 0.5, half = (A(0, 0) - A(1, 1)) * 0.5;
  const Term radius = regular_root(sum_of_squares({half, A(0, 1)}), mean);
  // The smaller eigenvalue is computed from the product of both, not as a difference, to be accurate even near 0.
  const Term greatest = mean + radius;
  return {(A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1)) / greatest, greatest};
}

}  // namespace

TermMatrix TermMatrix::transposed() const {
  TermMatrix result(graph(), columns_, rows_);
  for (std::size_t i = 0; i < rows_; ++i)
    for (std::size_t j = 0; j < columns_; ++j) result(j, i) = (*this)(i, j);
  return result;
}

TermMatrix TermMatrix::column(std::size_t j) const {
  TermMatrix result(graph(), rows_, 1);
  for (std::size_t i = 0; i < rows_; ++i) result(i, 0) = (*this)(i, j);
  return result;
}

TermMatrix operator+(const TermMatrix& A, const TermMatrix& B) {
  TermMatrix sum = A;
  for (std::size_t i = 0; i < A.elements_.size(); ++i) sum.elements_[i] = A.elements_[i] + B.elements_[i];
  return sum;
}

TermMatrix operator*(const TermMatrix& A, const TermMatrix& B) {
  TermMatrix product(A.graph(), A.rows_, B.columns_);
  for (std::size_t i = 0; i < A.rows_; ++i)
    for (std::size_t j = 0; j < B.columns_; ++j)
      for (std::size_t k = 0; k < A.columns_; ++k) product(i, j) = product(i, j) + A(i, k) * B(k, j);
  return product;
}

TermMatrix operator*(const TermMatrix& A, const Term& factor) {
  TermMatrix product = A;
  for (Term& element : product.elements_) element = element * factor;
  return product;
}

Term squared_norm(const TermMatrix& A) {
  Term sum(A.graph(), 0.0);
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.columns(); ++j) sum = sum + A(i, j) * A(i, j);
  return sum;
}

Inverse inverse_of(const TermMatrix& A) {
  const std::size_t n = A.rows();
  const unsigned all = (1U << n) - 1;
  Inverse inverse{TermMatrix(A.graph(), n, n), Term(A.graph(), 0.0)};
  for (std::size_t row = 0; row < n; ++row) {
    Minors minors(A, row);
    for (std::size_t j = 0; j < n; ++j) {
      const Term minor = minors.of(all & ~(1U << j));
      inverse.adjugate(j, row) = (row + j) % 2 == 0 ? minor : -minor;
    }
  }
  for (std::size_t j = 0; j < n; ++j) inverse.determinant = inverse.determinant + A(0, j) * inverse.adjugate(j, 0);
  return inverse;
}

TermMatrix cholesky_factor(const TermMatrix& A) {
  TermMatrix L(A.graph(), A.rows(), A.rows());
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      Term rest = A(i, j);
      for (std::size_t k = 0; k < j; ++k) rest = rest - L(i, k) * L(j, k);
      L(i, j) = i == j ? sqrt(rest) : rest / L(j, j);
    }
  return L;
}

std::array<Term, 2> eigenvalue_range(const TermMatrix& A) {
  if (A.rows() == 1) return {A(0, 0), A(0, 0)};
  return A.rows() == 2 ? eigenvalue_range_2(A) : eigenvalue_range_3(A);
}

Term greatest_eigenvalue(const TermMatrix& A) {
  if (A.rows() <= 3) return eigenvalue_range(A)[1];
  constexpr int kSquarings = 40;
  const Operation& log = operation("log");
  const auto trace = [](const TermMatrix& of) {
    Term sum = of(0, 0);
    for (std::size_t i = 1; i < of.rows(); ++i) sum = sum + of(i, i);
    return sum;
  };
  // Compute the maximum eigenvalue lambda by repeated squaring of A, whose trace is scaled to 1 before each step:
  // log lambda = sum of log(t_k) / 2^k, where t_k is the trace of the k-th square before it is scaled.
  TermMatrix power = A;
  Term sum = Term(A.graph(), 0.0);
  for (int k = 0; k <= kSquarings; ++k) {
    if (k > 0) {
      const TermMatrix square = power;
      for (std::size_t i = 0; i < A.rows(); ++i)
        for (std::size_t j = 0; j <= i; ++j) {
          Term element = square(i, 0) * square(0, j);
          for (std::size_t l = 1; l < A.rows(); ++l) element = element + square(i, l) * square(l, j);
          power(i, j) = power(j, i) = element;
        }
    }
    const Term t = trace(power);
    power = power * (Term(A.graph(), 1.0) / t);
    sum = sum + call(log, t) / std::ldexp(1.0, k);
  }
  return call(operation("exp"), sum);
}

}  // namespace pkm::expression
