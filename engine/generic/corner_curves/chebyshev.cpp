#include "engine/generic/corner_curves/chebyshev.hpp"

#include "engine/math/portable.hpp"

namespace pkm::generic::corner_curves {
namespace {

using Matrix = std::array<Samples, kNodes>;

/// Value of the Chebyshev polynomial T_k at the node with index n, if there are `nodes` nodes.
double polynomial_at_node(std::size_t k, std::size_t n, std::size_t nodes) {
  const std::size_t quarters = k * (2 * n + 1) % (4 * nodes);  // of a revolution, times `nodes`: the angle
  return portable::cos(kPi * static_cast<double>(quarters) / (2.0 * static_cast<double>(nodes)));
}

/// Row k contains the Chebyshev coefficients of T_k on [0, 1] as a function of x in [-1, 1]: T_(k+1)(y) = 2 y T_k(y) -
/// T_(k-1)(y) with y = (x + 1)/2, and x T_j = (T_(j+1) + T_|j-1|)/2.
Matrix polynomials_on_upper_half() {
  Matrix rows{};
  rows[0][0] = 1;
  rows[1][0] = rows[1][1] = 0.5;
  for (std::size_t k = 1; k + 1 < kNodes; ++k) {
    const Samples& now = rows[k];
    Samples& next = rows[k + 1];
    for (std::size_t j = 0; j <= k; ++j) {
      next[j] += now[j];
      next[j + 1] += (j == 0 ? 1 : 0.5) * now[j];
      if (j > 0) next[j - 1] += 0.5 * now[j];
    }
    for (std::size_t j = 0; j < k; ++j) next[j] -= rows[k - 1][j];
  }
  return rows;
}

}  // namespace

const Samples& chebyshev_nodes(std::size_t nodes) {
  static const auto nodes_of = [](std::size_t count) {
    Samples all{};
    for (std::size_t n = 0; n < count; ++n) all[n] = polynomial_at_node(1, n, count);
    return all;
  };
  static const std::array<Samples, 4> tables{nodes_of(8), nodes_of(16), nodes_of(24), nodes_of(kNodes)};
  return tables[nodes / 8 - 1];
}

void to_coefficients(const Samples& values, Samples& coefficients) {
  // T_k is even or odd, so that its values at half of the nodes are sufficient.
  static const Matrix table = [] {
    Matrix rows{};
    for (std::size_t n = 0; n < kNodes / 2; ++n)
      for (std::size_t k = 0; k < kNodes; ++k)
        rows[n][k / 2 + (k % 2 == 0 ? 0 : kNodes / 2)] = polynomial_at_node(k, n, kNodes);
    return rows;
  }();
  with_instruction_set(
      [&]<InstructionSet set> { transform<set>(table[0].data(), values.data(), coefficients.data()); });
}

void transpose_to_values(const Samples& by_coefficients, std::size_t nodes, Samples& by_values) {
  static const auto table_of = [](std::size_t count) {
    Matrix table{};  // values of T_k at the nodes, times the factor of the interpolation formula
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < count; ++n)
        table[k][n] = polynomial_at_node(k, n, count) * (k == 0 ? 1.0 : 2.0) / static_cast<double>(count);
    return table;
  };
  static const std::array<Matrix, 4> tables{table_of(8), table_of(16), table_of(24), table_of(kNodes)};
  const Matrix& table = tables[nodes / 8 - 1];
  with_instruction_set(
      [&]<InstructionSet set> { combine_rows<set>(table[0].data(), by_coefficients.data(), nodes, by_values.data()); });
}

std::size_t significant_terms(const Samples& coefficients, std::size_t terms, double size) {
  for (double rest = 0; terms > 1; --terms) {
    rest += std::fabs(coefficients[terms - 1]);
    if (!(rest <= size)) break;
  }
  return terms;
}

void restrict_to_halves(const Samples& coefficients, std::size_t terms, Samples& lower, Samples& upper) {
  static const Matrix table = polynomials_on_upper_half();
  with_instruction_set([&]<InstructionSet set> {
    corner_curves::restrict_to_halves<set>(table[0].data(), coefficients.data(), terms, lower.data(), upper.data());
  });
}

void evaluate_at_points(const std::array<Samples, 3>& series, std::size_t terms, const double* points, double* values) {
  const double* const rows[3] = {series[0].data(), series[1].data(), series[2].data()};
  with_instruction_set([&]<InstructionSet set> { series_at_points<set>(rows, 3, terms, points, values); });
}

void differentiate_series(const double* coefficients, std::size_t terms, double* derivative) {
  // coefficients d of the derivative: d[k - 1] = d[k + 1] + 2 k c[k], but d[0] is half of that
  double next = 0, after = 0;
  for (std::size_t k = terms - 1; k > 0; --k) {
    const double here = after + 2 * static_cast<double>(k) * coefficients[k];
    derivative[k - 1] = here;
    after = next;
    next = here;
  }
  derivative[0] *= 0.5;
}

}  // namespace pkm::generic::corner_curves
