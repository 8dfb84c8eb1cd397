// Inverse condition number: Jacobi method and closed form against known singular values and against each other.
#include "engine/geometry/conditioning.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "engine/math/dual.hpp"
#include "tests/unit/math/uniform.hpp"

namespace pkm::testing {
namespace {

Eigen::Matrix3d random_rotation(Uniform& uniform) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i) = uniform(-1, 1);
  return Eigen::HouseholderQR<Eigen::Matrix3d>(m).householderQ();
}

Rows3<double> rows_of(const Eigen::Matrix3d& m) {
  Rows3<double> rows;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = m(i, j);
  return rows;
}

/// Inverse condition number by the Jacobi method. @param extra  square of a fourth singular value; < 0: none
template <class S>
S by_jacobi(const Rows3<S>& rows, const S& extra = S(-1.0)) {
  const bool has_extra = value_of(extra) >= 0;
  S three[3][3], four[4][4] = {};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) three[j][i] = four[j][i] = rows[i][j];
  if (!has_extra) return inverse_condition(three);
  four[3][3] = sqrt(extra);
  return inverse_condition(four);
}

TEST(Conditioning, FindsKnownSingularValues) {
  Uniform uniform(1);
  const struct {
    double s[3];
  } cases[] = {{{3, 2, 1}},        {{1, 1, 1}},        {{1, 1, 1 - 1e-15}}, {{2, 2, 1}},
               {{2, 2 - 1e-9, 1}}, {{2, 2 - 1e-5, 1}}, {{5, 1, 1}},         {{5, 1, 1 - 1e-9}},
               {{5, 1, 1 - 1e-5}}, {{5, 1, 0.3}},      {{1e8, 0.7e8, 3e7}}, {{1e-9, 7e-10, 2e-10}}};
  for (const auto& [s] : cases)
    for (int i = 0; i < 200; ++i) {
      const Eigen::Matrix3d m =
          random_rotation(uniform) * Eigen::DiagonalMatrix<double, 3>(s[0], s[1], s[2]) * random_rotation(uniform);
      EXPECT_NEAR(by_jacobi(rows_of(m)), s[2] / s[0], 2e-14);
      EXPECT_NEAR(inverse_condition(rows_of(m)), s[2] / s[0], 2e-14);
    }
}

TEST(Conditioning, ExtraSingularValueIsIncluded) {
  const Rows3<double> m{{{3, 0, 0}, {0, 2, 0}, {0, 0, 1}}};
  EXPECT_NEAR(inverse_condition(m, 16.0), 1.0 / 4, 1e-15);
  EXPECT_NEAR(inverse_condition(m, 0.25), 0.5 / 3, 1e-15);
  EXPECT_NEAR(inverse_condition(m, 4.0), 1.0 / 3, 1e-15);
}

TEST(Conditioning, IsZeroForSingularAndNonFiniteMatrices) {
  EXPECT_EQ(inverse_condition(Rows3<double>{}), 0);
  EXPECT_EQ(inverse_condition(Rows3<double>{{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}}), 0);
  EXPECT_EQ(inverse_condition(Rows3<double>{{{1, 0, 0}, {0, std::nan(""), 0}, {0, 0, 1}}}), 0);
  EXPECT_EQ(inverse_condition(Rows3<double>{{{1, 0, 0}, {0, HUGE_VAL, 0}, {0, 0, 1}}}), 0);
}

// Jacobians of 4PPa-2PaR, up to a distance of 1e-7 from its singularities: relative difference below 1e-13.
TEST(Conditioning, ClosedFormIsAsAccurateAsJacobiOnJacobiansOfAMechanism) {
  Uniform uniform(1);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    Rows3<double> m;
    const auto near_zero = [&] { return std::pow(10.0, uniform(-7, 0)); };
    const double t = 2 * near_zero(), theta_part = uniform(-1, 1);
    m[0] = {0, 0, t};
    for (std::size_t j = 0; j < 2; ++j) {
      const double s = near_zero(), c = std::sqrt(1 - s * s), k = near_zero() / near_zero(), sign = j == 0 ? 1 : -1;
      m[j + 1] = {k * s, k * c * -sign, k * s * theta_part * sign};
    }
    const double closed = inverse_condition(m, 4.0), jacobi = by_jacobi(m, 4.0);
    ASSERT_GT(jacobi, 0);
    worst = std::max(worst, std::fabs(closed / jacobi - 1));
  }
  EXPECT_LT(worst, 1e-13);
}

TEST(Conditioning, DerivativesEqualDifferences) {
  using Scalar = Dual<1>;
  Uniform uniform(1);
  for (int i = 0; i < 300; ++i) {
    Rows3<double> at, direction;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) {
        at[r][c] = uniform(-1, 1);
        direction[r][c] = uniform(-1, 1);
      }
    const auto moved = [&](double by) {
      Rows3<double> m = at;
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) m[r][c] += by * direction[r][c];
      return inverse_condition(m);
    };
    if (moved(0) < 0.02) continue;  // the differences need a smooth neighbourhood
    Rows3<Scalar> m;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) {
        m[r][c] = Scalar(at[r][c]);
        m[r][c].v[0] = direction[r][c];
      }
    const double h = 1e-5;
    EXPECT_NEAR(inverse_condition(m).v[0], (moved(h) - moved(-h)) / (2 * h), 1e-5);
  }
}

// Derivatives from singular vectors (closed form) against automatic differentiation of the Jacobi rotations.
TEST(Conditioning, DerivativesOfBothMethodsAgreeAndValuesAreThoseOfDouble) {
  using Scalar = Dual<2>;
  Uniform uniform(1);
  int extreme[3] = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    Rows3<double> plain;
    Rows3<Scalar> rows;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) {
        plain[r][c] = uniform(-1, 1);
        rows[r][c] = Scalar(plain[r][c], {{uniform(-1, 1), uniform(-1, 1)}});
      }
    const Scalar extra = i % 3 == 0 ? Scalar(-1.0) : Scalar(std::pow(10.0, uniform(-3, 1)), {{1, uniform(-1, 1)}});
    const Scalar closed = inverse_condition(rows, extra), jacobi = by_jacobi(rows, extra);
    EXPECT_EQ(closed.a, inverse_condition(plain, extra.a));
    const double without = inverse_condition(plain);
    ++extreme[closed.a == without ? 0 : extra.a < 1 ? 1 : 2];
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(closed.v[k], jacobi.v[k], 1e-9 * (1 + std::fabs(jacobi.v[k]))) << i;
  }
  for (const int count : extreme) EXPECT_GT(count, 300);
}

TEST(Conditioning, DerivativesAreFiniteForMultipleSingularValues) {
  using Scalar = Dual<1>;
  Uniform uniform(1);
  const double cases[][3] = {{1, 1, 1}, {2, 2, 1}, {5, 1, 1}, {2, 2 - 1e-15, 1}, {2, 2 - 1e-9, 1}, {1e-9, 1e-9, 1e-9}};
  for (const auto& s : cases)
    for (int i = 0; i < 100; ++i) {
      Eigen::Matrix3d m = Eigen::DiagonalMatrix<double, 3>(s[0], s[1], s[2]).toDenseMatrix();
      if (i > 0) m = random_rotation(uniform) * m * random_rotation(uniform);
      Rows3<Scalar> rows;
      double largest = 0;
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) {
          rows[r][c] = Scalar(rows_of(m)[r][c], {{uniform(-1, 1)}});
          largest = std::fmax(largest, std::fabs(rows[r][c].v[0]));
        }
      // |d(sigma_min / sigma_max)| <= (|d sigma_min| + |d sigma_max|) / sigma_max, and both are at most |dM|
      EXPECT_LE(std::fabs(inverse_condition(rows).v[0]), 6 * largest / s[0]);
    }
  EXPECT_EQ(inverse_condition(Rows3<Scalar>{}).v[0], 0);
}

}  // namespace
}  // namespace pkm::testing
