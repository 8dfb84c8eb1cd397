// SIMD kernel of find_joint_inertia(). Its operations have the order of eliminate() and substitute_back() in
// engine/math/small_matrix.hpp, so that the results have the same bits as those of scalar arithmetic.
#include "engine/dynamics/coupling_indices.hpp"
#include "engine/generic/joint_inertia.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/lanes_functions.hpp"

namespace pkm::generic {
namespace {

template <class L>
[[gnu::always_inline]] inline L value_at(const expression::Operand& operand, const InertiaKernelData& data,
                                         std::size_t k) {
  return operand.row ? L::load(data.rows + operand.index * expression::kRow + k) : L(data.registers[operand.index]);
}

/// True if a mask is set in all lanes.
template <class L, class Mask>
[[gnu::always_inline]] inline bool all(const Mask& mask) {
  return reduce_min(select(mask, L(1.0), L(0.0))) > 0;
}

/// LU decomposition with partial pivoting of one matrix per lane.
template <class L, class Mask, int n>
struct LuDecomposition {
  L u[n][n], factor[n][n];
  int pivot[n];  ///< for each step, the row that is the pivot in all lanes; -1 if the lanes have different pivots
  /// For each step and row, whether the row is the pivot of a lane; used if the lanes have different pivots.
  Mask is_pivot[n][n];

  /// Exchanges row k of m with the row that is the pivot of step k of the elimination, in columns `first`, first + 1,
  /// ...
  [[gnu::always_inline]] inline void exchange(L (&m)[n][n], int k, int first) const {
    for (int i = k + 1; i < n; ++i)
      for (int j = first; j < n && (pivot[k] == i || pivot[k] < 0); ++j) {
        const L upper = m[k][j], lower = m[i][j];
        m[k][j] = pivot[k] == i ? lower : select(is_pivot[k][i], lower, upper);
        m[i][j] = pivot[k] == i ? upper : select(is_pivot[k][i], upper, lower);
      }
  }
  /// Decomposes the matrix in `u`.
  [[gnu::always_inline]] inline void run() {
    for (int k = 0; k < n; ++k) {
      L max_so_far = magnitude(u[k][k]), row(static_cast<double>(k));
      for (int i = k + 1; i < n; ++i) {
        const auto greater = magnitude(u[i][k]) > max_so_far;
        max_so_far = select(greater, magnitude(u[i][k]), max_so_far);
        row = select(greater, L(static_cast<double>(i)), row);
      }
      const double first = reduce_min(row);
      pivot[k] = first >= reduce_max(row) ? static_cast<int>(first) : -1;
      for (int i = k + 1; i < n && pivot[k] < 0; ++i)
        is_pivot[k][i] = (row >= static_cast<double>(i)) & (row <= static_cast<double>(i));
      exchange(u, k, k);
      const L inverse = 1.0 / u[k][k];
      for (int i = k + 1; i < n; ++i) {
        factor[i][k] = u[i][k] * inverse;
        for (int j = k + 1; j < n; ++j) u[i][j] = u[i][j] - factor[i][k] * u[k][j];
      }
    }
  }
  /// Replaces b by the solution X of A X = b, where A is the decomposed matrix.
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

/// Evaluates poses k, ..., k + kLanes - 1 of the batch.
/// @return false if at least one of them must be evaluated alone in scalar arithmetic
template <class L, int n>
[[gnu::always_inline]] inline bool find_lanes(const InertiaKernelData& data, std::size_t k) {
  LuDecomposition<L, decltype(L() < L()), n> lu;
  L size(0.0), half[n][n], M[n][n];
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      lu.u[i][j] = value_at<L>(data.J[j * n + i], data, k);
      half[i][j] = value_at<L>(data.M_X[i * n + j], data, k);
      size += magnitude(lu.u[i][j]);
    }
  lu.run();
  // Bound of the condition number as in is_clearly_regular(), from sums of magnitudes: of the elements above the
  // diagonal of the upper triangular factor U, and of the reciprocals of its diagonal elements.
  L above(0.0), inverse(0.0);
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) above += magnitude(lu.u[i][j]);
    inverse += 1.0 / magnitude(lu.u[i][i]);
  }
  L bound = static_cast<double>(n * n) * size * inverse;
  for (int i = 1; i < n; ++i) bound = bound * (2.0 * (1.0 + above * inverse));
  if (!all<L>(bound <= 0.1 / kSingularRcond)) return false;

  lu.solve(half);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) M[i][j] = half[j][i];
  lu.solve(M);
  L zero(0.0), smallest = M[0][0];  // zero is 0 in a lane if all elements there are finite, otherwise NaN
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) M[i][j] = M[j][i] = (M[i][j] + M[j][i]) * 0.5;
    M[i][i] = M[i][i] + data.rotors[i];
    for (int j = 0; j <= i; ++j) zero += M[i][j] * 0.0;
    smallest = lesser(smallest, M[i][i]);
  }
  if (!all<L>(zero >= 0.0) || !all<L>(smallest > 0.0)) return false;
  for (int i = 0; i < n; ++i) {
    L off(0.0);
    for (int j = 0; j < n; ++j) {
      M[i][j].store(data.M_q + static_cast<std::size_t>(i * n + j) * expression::kRow + k);
      if (j != i) off += magnitude(M[i][j]);
    }
    coupling_index(off, M[i][i]).store(data.indices + static_cast<std::size_t>(i) * expression::kRow + k);
  }
  return true;
}

template <class L, int n>
[[gnu::always_inline]] inline void find_batch(const InertiaKernelData& data) {
  for (std::size_t k = 0; k < data.count; k += kLanes) L(find_lanes<L, n>(data, k) ? 1.0 : 0.0).store(data.found + k);
}

}  // namespace

template <InstructionSet set>
void find_joint_inertia(const InertiaKernelData& data) {
  using L = LanesOf<set>;
  switch (data.n) {
    case 1:
      return find_batch<L, 1>(data);
    case 2:
      return find_batch<L, 2>(data);
    case 3:
      return find_batch<L, 3>(data);
    case 4:
      return find_batch<L, 4>(data);
    case 5:
      return find_batch<L, 5>(data);
    default:
      return find_batch<L, 6>(data);
  }
}

template void find_joint_inertia<PKM_INSTRUCTION_SET>(const InertiaKernelData&);

}  // namespace pkm::generic
