// Tolerances of minimum cost, with solutions in closed form.
#include "engine/generic/tolerances/tolerance_allocation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pkm::generic {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(ToleranceAllocation, WithOneRow) {
  // t_i = b sqrt(c_i / a_i) / sum_j sqrt(a_j c_j), here sqrt(c_i / a_i) = 2, 1 and sqrt(a_j c_j) = 2, 4
  EXPECT_THAT(allocate_tolerances({4, 4}, {{{1, 4}, 12}}), ElementsAre(DoubleNear(4, 1e-5), DoubleNear(2, 1e-5)));
}

TEST(ToleranceAllocation, WithRowsThatAreActiveOrNot) {
  const std::vector<ToleranceRow> rows = {{{1, 4}, 12}, {{1, 0}, 2}, {{0, 1}, 7}};
  // the first tolerance is limited to 2, and the second one by the rest of the first row
  EXPECT_THAT(allocate_tolerances({4, 4}, rows), ElementsAre(DoubleNear(2, 1e-4), DoubleNear(2.5, 1e-4)));
}

}  // namespace
}  // namespace pkm::generic
