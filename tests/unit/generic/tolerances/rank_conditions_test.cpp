// Determinants as formulas.
#include "engine/generic/tolerances/rank_conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/expression/program.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm::generic {
namespace {

/// Values of the conditions for a matrix whose entries are inputs of a graph; zeros are constants.
std::vector<double> conditions_of(const Eigen::MatrixXd& matrix) {
  expression::Graph graph;
  std::vector<double> inputs, registers, values;
  bounds::NamedMatrix named{"A", static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols()), {}};
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      named.entries.push_back(matrix(i, j) == 0 ? graph.number(0) : graph.input(inputs.size()));
      if (matrix(i, j) != 0) inputs.push_back(matrix(i, j));
    }
  const std::vector<expression::Node> nodes = rank_conditions(graph, named);
  const expression::Program program(graph, nodes);
  program.run_all<double>(inputs, registers);
  for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
  return values;
}

TEST(RankConditions, AreDeterminants) {
  for (Eigen::Index n = 1; n <= 6; ++n)
    for (Eigen::Index rows = n; rows <= 6; ++rows) {
      Eigen::MatrixXd A(rows, n);
      for (Eigen::Index i = 0; i < rows; ++i)
        for (Eigen::Index j = 0; j < n; ++j) A(i, j) = std::sin(static_cast<double>(7 * i * i + 3 * j + i * j + n));
      const double expected = rows == n ? A.determinant() : Eigen::MatrixXd(A.transpose() * A).determinant();
      EXPECT_THAT(conditions_of(A), ::testing::ElementsAre(::testing::DoubleNear(expected, 1e-12))) << rows << n;
    }
}

TEST(RankConditions, OfADiagonalMatrixAreItsElements) {
  Eigen::MatrixXd A = Eigen::Vector3d(2, -3, 5).asDiagonal();
  EXPECT_THAT(conditions_of(A), ::testing::ElementsAre(2, -3, 5));
  A(0, 2) = 7;
  EXPECT_THAT(conditions_of(A), ::testing::ElementsAre(-30));
}

}  // namespace
}  // namespace pkm::generic
