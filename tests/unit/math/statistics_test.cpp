// Quantiles of weighted samples.
#include "engine/math/statistics.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(WeightedQuantile, EqualsNumpyForEqualWeights) {
  const std::vector<double> weight(5, 0.2), field = {10, 3, 1, 4, 2};
  // numpy.quantile([10, 3, 1, 4, 2], q): position q (n - 1) in the sorted samples
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.95), 8.8);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.5), 3);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.6), 3.4);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0), 1);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 1), 10);
}

TEST(WeightedQuantile, SamplesAreSpacedByTheMeanOfTheirWeights) {
  // The samples 1, 2, 4 with weights 1, 3, 1 are at the positions 0, 2, 4; p = 0.5, 0.25, 0.95 are at 2, 1, 3.8.
  const std::vector<double> weight = {1, 1, 3}, field = {4, 1, 2};
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.5), 2);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.25), 1.5);
  EXPECT_DOUBLE_EQ(weighted_quantile(weight, field, 0.95), 3.8);
}

TEST(WeightedQuantile, DoesNotDependOnTheScaleOfTheWeights) {
  const std::vector<double> field = {0.3, 0.1, 0.7, 0.2}, weight = {1, 2, 4, 0.5}, scaled = {8, 16, 32, 4};
  for (const double p : {0.05, 0.3, 0.5, 0.95})
    EXPECT_EQ(weighted_quantile(weight, field, p), weighted_quantile(scaled, field, p)) << p;
}

TEST(WeightedQuantile, OfOneSampleAndOfNoSamples) {
  EXPECT_EQ(weighted_quantile({2.0}, {0.4}, 0.95), 0.4);
  EXPECT_EQ(weighted_quantile({}, {}, 0.95), 0);
}

}  // namespace
}  // namespace pkm
