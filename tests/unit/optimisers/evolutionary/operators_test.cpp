// Unit tests of selection, crossover, mutation, initial sampling and the hash set of designs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/optimisers/evolutionary/design_hash_set.hpp"
#include "engine/optimisers/evolutionary/operators.hpp"
#include "engine/optimisers/sampling.hpp"

namespace pkm {
namespace {

TEST(Selection, UniversalSamplingDrawsEachMemberItsExpectedNumberOfTimes) {
  const std::size_t population = 20;
  for (const double pressure : {1.0, 1.5, 2.0}) {
    for (std::uint32_t generation = 0; generation < 50; ++generation) {
      std::vector<std::uint32_t> parents(40);
      Stream stream(7, generation, 0, Stream::Use::selection);
      select_parents({Selection::Kind::linear_ranking, 2, pressure}, population, stream, parents);
      for (std::size_t i = 0; i < population; ++i) {
        const double expected = 2 * (pressure - 2 * (pressure - 1) * static_cast<double>(i) / 19);
        const auto drawn = static_cast<double>(std::count(parents.begin(), parents.end(), i));
        EXPECT_GE(drawn, std::floor(expected - 1e-9)) << "member " << i << ", pressure " << pressure;
        EXPECT_LE(drawn, std::ceil(expected + 1e-9)) << "member " << i << ", pressure " << pressure;
      }
    }
  }
}

TEST(Selection, LargerTournamentsPreferBetterMembers) {
  for (const std::int64_t size : {1, 2, 4}) {
    std::vector<std::uint32_t> parents(20000);
    Stream stream(3, 1, 0, Stream::Use::selection);
    select_parents({Selection::Kind::tournament, size, 2}, 10, stream, parents);
    const double best = static_cast<double>(std::count(parents.begin(), parents.end(), 0u)) / 20000;
    EXPECT_NEAR(best, 1 - std::pow(0.9, static_cast<double>(size)), 0.015);
    EXPECT_LT(*std::max_element(parents.begin(), parents.end()), 10u);
  }
}

const std::vector<double> kTwoDesigns = {0.2, 3.0, 0.6, 7.0};  // two designs with two variables

TEST(Crossover, ScatteredTakesEachVariableFromEitherParent) {
  std::set<std::vector<double>> children;
  for (std::uint32_t i = 0; i < 100; ++i) {
    std::vector<double> child(2);
    Stream stream(1, 0, i, Stream::Use::variation);
    recombine({Crossover::Kind::scattered, 15}, {kTwoDesigns, 2}, 0, 1, stream, child);
    children.insert(child);
  }
  EXPECT_EQ(children, (std::set<std::vector<double>>{{0.2, 3}, {0.2, 7}, {0.6, 3}, {0.6, 7}}));
}

TEST(Crossover, SimulatedBinaryStepsShrinkWithTheDistributionIndex) {
  const auto mean_step = [](double eta) {
    double sum = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      std::vector<double> child(2);
      Stream stream(1, 0, i, Stream::Use::variation);
      recombine({Crossover::Kind::sbx, eta}, {kTwoDesigns, 2}, 0, 1, stream, child);
      sum += std::min(std::fabs(child[0] - 0.2), std::fabs(child[0] - 0.6));
    }
    return sum / 4000;
  };
  EXPECT_GT(mean_step(2), 2 * mean_step(20));
  EXPECT_GT(mean_step(20), 0);
}

TEST(Crossover, BlendIsUniformOnTheExtendedInterval) {
  double minimum = 1, maximum = 0, sum = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    std::vector<double> child(2);
    Stream stream(1, 0, i, Stream::Use::variation);
    recombine({Crossover::Kind::blend, 15}, {kTwoDesigns, 2}, 0, 1, stream, child);
    minimum = std::min(minimum, child[0]);
    maximum = std::max(maximum, child[0]);
    sum += child[0];
  }
  EXPECT_NEAR(minimum, 0.0, 2e-3);
  EXPECT_NEAR(maximum, 0.8, 2e-3);
  EXPECT_NEAR(sum / 4000, 0.4, 0.015);
}

TEST(Crossover, DifferentialIsInvariantUnderScalingAndTranslation) {
  const std::vector<double> designs = {0.25, 1, 0.5, -2, -1, 0.75, 2, 4, 0.125, -3};
  std::vector<double> moved = designs;
  for (double& x : moved) x = 4 * x + 8;
  for (std::uint32_t i = 0; i < 50; ++i) {
    std::vector<double> child(2), image(2);
    Stream a(1, 0, i, Stream::Use::variation), b(1, 0, i, Stream::Use::variation);
    recombine({}, {designs, 2}, i % 5, 0, a, child);
    recombine({}, {moved, 2}, i % 5, 0, b, image);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(image[k], 4 * child[k] + 8, 1e-12);
  }
}

TEST(Crossover, DifferentialDoesNotMoveACollapsedPopulation) {
  const std::vector<double> designs = {0.25, 1, 0.25, 1, 0.25, 1};
  std::vector<double> child(2);
  Stream stream(1, 0, 0, Stream::Use::variation);
  recombine({}, {designs, 2}, 1, 2, stream, child);
  EXPECT_EQ(child, (std::vector<double>{0.25, 1}));
}

TEST(Mutation, StepsHaveTheDocumentedDeviation) {
  const Variable variable{"x", "m", 10, 30, 0};
  const auto deviation = [&](Mutation mutation) {
    double sum = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      Stream stream(1, 0, i, Stream::Use::variation);
      const double step = mutate(mutation, variable, 20, stream) - 20;
      sum += step * step;
    }
    return std::sqrt(sum / 20000);
  };
  EXPECT_NEAR(deviation({Mutation::Kind::gaussian, 0.1, 20}), 2.0, 0.05);
  EXPECT_NEAR(deviation({Mutation::Kind::uniform, 0.1, 20}), 20 / std::sqrt(12.0), 0.1);
  // The mean of 10^(-8u) is 1 / (8 ln 10).
  EXPECT_NEAR(deviation({Mutation::Kind::multiscale, 0.3, 20}), 6 / std::sqrt(8 * std::log(10.0)), 0.06);
  // Polynomial: the step divided by the range has the variance 2 / ((eta + 2)(eta + 3)).
  EXPECT_NEAR(deviation({Mutation::Kind::polynomial, 0.3, 20}), 20 * std::sqrt(2.0 / (22 * 23)), 0.03);
}

TEST(Sampling, EachStratumOfEachVariableHasOnePoint) {
  const std::size_t count = 64, dimension = 25;  // more than the dimensions of the Sobol table
  for (const Start start : {Start::sobol, Start::latin_hypercube}) {
    const auto points = unit_cube_samples(start, count, dimension, 11);
    for (std::size_t variable = 0; variable < dimension; ++variable) {
      std::set<int> strata;
      for (std::size_t i = 0; i < count; ++i) strata.insert(static_cast<int>(points[i * dimension + variable] * 64));
      EXPECT_EQ(strata.size(), count) << "variable " << variable;
    }
  }
}

TEST(Sampling, SobolPointsFormANetInTwoVariables) {
  const auto points = unit_cube_samples(Start::sobol, 64, 2, 5);  // a (0, 6, 2)-net: one point in each of 8 x 8 squares
  std::set<int> squares;
  for (std::size_t i = 0; i < 64; ++i)
    squares.insert(static_cast<int>(points[2 * i] * 8) * 8 + static_cast<int>(points[2 * i + 1] * 8));
  EXPECT_EQ(squares.size(), 64u);
}

TEST(Sampling, DifferentSeedsGiveDifferentPoints) {
  for (const Start start : {Start::sobol, Start::latin_hypercube, Start::random}) {
    EXPECT_NE(unit_cube_samples(start, 20, 4, 1), unit_cube_samples(start, 20, 4, 2));
    EXPECT_EQ(unit_cube_samples(start, 20, 4, 1), unit_cube_samples(start, 20, 4, 1));
    for (const double u : unit_cube_samples(start, 500, 4, 3)) EXPECT_TRUE(u >= 0 && u < 1);
  }
}

TEST(DesignHashSet, FindsInsertedDesignsOnly) {
  EvaluationTable table({2, 1, 0, 0});
  DesignHashSet designs;
  for (std::size_t i = 0; i < 5000; ++i) {
    const std::vector<double> design = {static_cast<double>(i % 100), static_cast<double>(i / 100) * 0.1};
    EXPECT_EQ(designs.find(table, design), -1);
    const std::size_t row = table.extend(1);
    std::copy(design.begin(), design.end(), table.design(row).begin());
    designs.insert(table, row);
  }
  for (std::size_t row = 0; row < table.size(); ++row)
    EXPECT_EQ(designs.find(table, std::as_const(table).design(row)), static_cast<std::int64_t>(row));
  EXPECT_EQ(designs.find(table, std::vector<double>{3, std::nextafter(0.1, 1)}), -1);
}

}  // namespace
}  // namespace pkm
