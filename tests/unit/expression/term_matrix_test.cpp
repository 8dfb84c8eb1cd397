// Linear algebra of expression graphs against Eigen, for random, nearly degenerate and degenerate matrices.
#include <gtest/gtest.h>

#include <random>

#include <Eigen/Dense>

#include "engine/expression/derivative.hpp"
#include "engine/expression/program.hpp"
#include "engine/expression/term_matrix.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm::expression {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(n, n, [&] { return uniform(random); });
}

/// V diag(values) V^T with random orthonormal V.
Eigen::MatrixXd with_eigenvalues(const std::vector<double>& values, std::mt19937& random) {
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::MatrixXd V = random_matrix(n, random).householderQr().householderQ();
  const Eigen::MatrixXd A = V * Eigen::Map<const Eigen::VectorXd>(values.data(), n).asDiagonal() * V.transpose();
  return (A + A.transpose()) / 2;
}

/// A matrix of inputs, by rows.
TermMatrix inputs(Graph& graph, Eigen::Index n) {
  const auto size = static_cast<std::size_t>(n);
  TermMatrix A(graph, size, size);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) A(i, j) = Term(graph, graph.input(i * size + j));
  return A;
}

std::vector<double> evaluate(const Graph& graph, const std::vector<Node>& nodes, const Eigen::MatrixXd& A) {
  const Program program(graph, nodes);
  const Eigen::MatrixXd rows = A.transpose();  // Eigen stores by columns
  std::vector<double> registers, values;
  program.run_all<double>({rows.data(), static_cast<std::size_t>(rows.size())}, registers);
  for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
  return values;
}

TEST(TermMatrix, InvertsLikeEigen) {
  std::mt19937 random(1);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    Graph graph;
    const Inverse inverse = inverse_of(inputs(graph, n));
    std::vector<Node> nodes = {inverse.determinant.node()};
    for (std::size_t i = 0; i < inverse.adjugate.rows(); ++i)
      for (std::size_t j = 0; j < inverse.adjugate.columns(); ++j) nodes.push_back(inverse.adjugate(i, j).node());
    for (int trial = 0; trial < 10; ++trial) {
      const Eigen::MatrixXd A = random_matrix(n, random);
      const std::vector<double> found = evaluate(graph, nodes, A);
      EXPECT_NEAR(found[0], A.determinant(), 1e-14);
      const Eigen::MatrixXd expected = A.inverse() * A.determinant();
      for (Eigen::Index k = 0; k < n * n; ++k)
        EXPECT_NEAR(found[static_cast<std::size_t>(k + 1)], expected(k / n, k % n), 1e-13);
    }
  }
}

TEST(TermMatrix, FactorisesLikeEigen) {
  std::mt19937 random(2);
  Graph graph;
  const TermMatrix L = cholesky_factor(inputs(graph, 4));
  std::vector<Node> nodes;
  for (std::size_t k = 0; k < 16; ++k) nodes.push_back(L(k / 4, k % 4).node());
  const Eigen::MatrixXd A = with_eigenvalues({1, 2, 3, 4}, random), expected = A.llt().matrixL();
  const std::vector<double> found = evaluate(graph, nodes, A);
  for (Eigen::Index k = 0; k < 16; ++k) EXPECT_NEAR(found[static_cast<std::size_t>(k)], expected(k / 4, k % 4), 1e-14);
}

TEST(TermMatrix, HasTheExtremeEigenvaluesToRounding) {
  std::mt19937 random(3);
  for (const std::vector<double>& values : std::vector<std::vector<double>>{{2},
                                                                            {1, 3},
                                                                            {2, 2},
                                                                            {1, 1 + 1e-9},
                                                                            {1, 2, 4},
                                                                            {1, 1, 4},
                                                                            {1, 4, 4},
                                                                            {1, 1 + 1e-9, 4},
                                                                            {1, 4, 4 + 1e-9},
                                                                            {3, 3, 3},
                                                                            {3, 3 + 1e-9, 3 + 3e-9},
                                                                            {0, 0, 5},
                                                                            {1e-12, 2e-12, 3e-12},
                                                                            {1e12, 2e12, 5e12}}) {
    Graph graph;
    const auto [least, greatest] = eigenvalue_range(inputs(graph, static_cast<Eigen::Index>(values.size())));
    for (int trial = 0; trial < 20; ++trial) {
      const std::vector<double> found =
          evaluate(graph, {least.node(), greatest.node()}, with_eigenvalues(values, random));
      EXPECT_NEAR(found[0], values.front(), 2e-14 * values.back());
      EXPECT_NEAR(found[1], values.back(), 2e-14 * values.back());
    }
    const Eigen::MatrixXd diagonal = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)).asDiagonal();
    const std::vector<double> found = evaluate(graph, {least.node(), greatest.node()}, diagonal);
    EXPECT_NEAR(found[0], values.front(), 1e-15 * values.back());
    EXPECT_NEAR(found[1], values.back(), 1e-15 * values.back());
  }
}

TEST(TermMatrix, HasTheGreatestEigenvalueOfLargerMatrices) {
  std::mt19937 random(4);
  Graph graph;
  const Term greatest = greatest_eigenvalue(inputs(graph, 6));
  for (const std::vector<double>& values : std::vector<std::vector<double>>{
           {1, 2, 3, 4, 5, 6}, {1, 1, 1, 1, 1, 1}, {0, 0, 0, 0, 3, 3}, {1, 2, 3, 4, 5, 5 + 1e-9}})
    for (int trial = 0; trial < 5; ++trial)
      EXPECT_NEAR(evaluate(graph, {greatest.node()}, with_eigenvalues(values, random))[0], values.back(),
                  4e-12 * values.back());
}

/// d lambda = v^T dA v; at multiple eigenvalues the derivative is finite.
TEST(TermMatrix, HasDerivativesOfEigenvalues) {
  std::mt19937 random(5);
  for (Eigen::Index n : {2, 3, 6}) {
    Graph graph;
    const TermMatrix A = inputs(graph, n);
    std::vector<Node> derivatives;
    const std::vector<Term> values =
        n == 6 ? std::vector{greatest_eigenvalue(A)} : std::vector{eigenvalue_range(A)[1], eigenvalue_range(A)[0]};
    for (const Term& value : values) {
      Rates rates(graph);
      for (std::size_t i = 0; i < A.rows(); ++i)
        for (std::size_t j = 0; j < A.columns(); ++j) rates.set_rate(A(i, j).node(), graph.number(i == j ? 1.0 : 0.25));
      derivatives.push_back(rates.of(value).node());
    }
    const Eigen::MatrixXd dA = Eigen::MatrixXd::Constant(n, n, 0.25) + 0.75 * Eigen::MatrixXd::Identity(n, n);
    for (int trial = 0; trial < 10; ++trial) {
      const Eigen::MatrixXd root = random_matrix(n, random), at = root * root.transpose();
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> expected(at);
      const std::vector<double> found = evaluate(graph, derivatives, at);
      const Eigen::VectorXd last = expected.eigenvectors().col(n - 1), first = expected.eigenvectors().col(0);
      EXPECT_NEAR(found[0], last.dot(dA * last), 1e-8);
      if (n < 6) {
        EXPECT_NEAR(found[1], first.dot(dA * first), 1e-8);
      }
    }
    for (const double derivative : evaluate(graph, derivatives, 2 * Eigen::MatrixXd::Identity(n, n)))
      EXPECT_TRUE(std::isfinite(derivative)) << n;
  }
}

}  // namespace
}  // namespace pkm::expression
