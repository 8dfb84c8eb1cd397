// Solves as engine/math/small_matrix.hpp does.
#include "engine/dynamics/coupling_indices.hpp"
#include "engine/generic/joint_inertia.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/lanes_functions.hpp"

namespace pkm::generic {
namespace {

template <class L>
[[gnu::always_inline]] inline L value_at(const expression::Operand& operand, const InertiaRow& row, std::size_t k) {
  return operand.row ? L::load(row.rows + operand.index * expression::kRow + k) : L(row.registers[operand.index]);
}

/// All lanes of a mask.
template <class L, class Mask>
[[gnu::always_inline]] inline bool all(const Mask& mask) {
  return least(select(mask, L(1.0), L(0.0))) > 0;
}

/// Upper triangle, factors and exchanges of an elimination.
template <class L, class Mask, int n>
struct Eliminated {
  L u[n][n], factor[n][n];
  int lead[n];       ///< of all lanes; -1: each its own
  Mask leads[n][n];  ///< by step and row, where each has its own

  /// Exchanges row k of the columns from `first` on with the row that leads step k.
  [[gnu::always_inline]] inline void exchange(L (&m)[n][n], int k, int first) const {
    for (int i = k + 1; i < n; ++i)
      for (int j = first; j < n && (lead[k] == i || lead[k] < 0); ++j) {
        const L upper = m[k][j], lower = m[i][j];
        m[k][j] = lead[k] == i ? lower : select(leads[k][i], lower, upper);
        m[i][j] = lead[k] == i ? upper : select(leads[k][i], upper, lower);
      }
  }
  /// Takes `u` as it is.
  [[gnu::always_inline]] inline void run() {
    for (int k = 0; k < n; ++k) {
      L greatest_yet = magnitude(u[k][k]), row(static_cast<double>(k));
      for (int i = k + 1; i < n; ++i) {
        const auto greater = magnitude(u[i][k]) > greatest_yet;
        greatest_yet = select(greater, magnitude(u[i][k]), greatest_yet);
        row = select(greater, L(static_cast<double>(i)), row);
      }
      const double first = least(row);
      lead[k] = first >= greatest(row) ? static_cast<int>(first) : -1;
      for (int i = k + 1; i < n && lead[k] < 0; ++i)
        leads[k][i] = (row >= static_cast<double>(i)) & (row <= static_cast<double>(i));
      exchange(u, k, k);
      const L inverse = 1.0 / u[k][k];
      for (int i = k + 1; i < n; ++i) {
        factor[i][k] = u[i][k] * inverse;
        for (int j = k + 1; j < n; ++j) u[i][j] = u[i][j] - factor[i][k] * u[k][j];
      }
    }
  }
  /// b becomes X of A X = b.
  [[gnu::always_inline]] inline void solve(L (&b)[n][n]) const {
    for (int k = 0; k < n; ++k) {
      exchange(b, k, 0);
      for (int i = k + 1; i < n; ++i)
        for (int j = 0; j < n; ++j) b[i][j] = b[i][j] - factor[i][k] * b[k][j];
    }
    for (int k = n - 1; k >= 0; --k)
      for (int j = 0; j < n; ++j) {
        for (int i = k + 1; i < n; ++i) b[k][j] = b[k][j] - u[k][i] * b[i][j];
        b[k][j] = b[k][j] / u[k][k];
      }
  }
};

/// Lanes from pose k on. False where they need to be found one by one.
template <class L, int n>
[[gnu::always_inline]] inline bool find_lanes(const InertiaRow& row, std::size_t k) {
  Eliminated<L, decltype(L() < L()), n> e;
  L size(0.0), half[n][n], M[n][n];
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      e.u[i][j] = value_at<L>(row.J[j * n + i], row, k);
      half[i][j] = value_at<L>(row.M_X[i * n + j], row, k);
      size += magnitude(e.u[i][j]);
    }
  e.run();
  // is_clearly_regular()
  L beside(0.0), inverse(0.0);
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) beside += magnitude(e.u[i][j]);
    inverse += 1.0 / magnitude(e.u[i][i]);
  }
  L bound = static_cast<double>(n * n) * size * inverse;
  for (int i = 1; i < n; ++i) bound = bound * (2.0 * (1.0 + beside * inverse));
  if (!all<L>(bound <= 0.1 / kSingularRcond)) return false;

  e.solve(half);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) M[i][j] = half[j][i];
  e.solve(M);
  L nothing(0.0), smallest = M[0][0];  // 0 times finite numbers
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) M[i][j] = M[j][i] = (M[i][j] + M[j][i]) * 0.5;
    M[i][i] = M[i][i] + row.rotors[i];
    for (int j = 0; j <= i; ++j) nothing += M[i][j] * 0.0;
    smallest = lesser(smallest, M[i][i]);
  }
  if (!all<L>(nothing >= 0.0) || !all<L>(smallest > 0.0)) return false;
  for (int i = 0; i < n; ++i) {
    L off(0.0);
    for (int j = 0; j < n; ++j) {
      M[i][j].store(row.M_q + static_cast<std::size_t>(i * n + j) * expression::kRow + k);
      if (j != i) off += magnitude(M[i][j]);
    }
    coupling_index(off, M[i][i]).store(row.indices + static_cast<std::size_t>(i) * expression::kRow + k);
  }
  return true;
}

template <class L, int n>
[[gnu::always_inline]] inline void find_row(const InertiaRow& row) {
  for (std::size_t k = 0; k < row.count; k += kLanes) L(find_lanes<L, n>(row, k) ? 1.0 : 0.0).store(row.found + k);
}

}  // namespace

template <InstructionSet set>
void find_joint_inertia(const InertiaRow& row) {
  using L = LanesOf<set>;
  switch (row.n) {
    case 1:
      return find_row<L, 1>(row);
    case 2:
      return find_row<L, 2>(row);
    case 3:
      return find_row<L, 3>(row);
    case 4:
      return find_row<L, 4>(row);
    case 5:
      return find_row<L, 5>(row);
    default:
      return find_row<L, 6>(row);
  }
}

template void find_joint_inertia<PKM_INSTRUCTION_SET>(const InertiaRow&);

}  // namespace pkm::generic
