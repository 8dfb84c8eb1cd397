// Margins that no sample satisfies, alone and in pairs, and counts of violations.
#include "engine/problem/margin_tally.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace pkm {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> sentences(const MarginTally& tally) {
  std::vector<std::string> list;
  for (const Reason& reason : tally.reasons("constraint", "design")) list.push_back(reason.sentence);
  return list;
}

TEST(MarginTally, ReportsMarginsThatNoSampleSatisfies) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", -0.5}});
  tally.add({{"a", -1.0}, {"b", -0.25}});
  EXPECT_THAT(sentences(tally), ElementsAre("no design satisfies b; the closest misses it by 0.25"));
  EXPECT_THAT(tally.reasons("constraint", "design")[0].names, ElementsAre("b"));
}

TEST(MarginTally, ReportsPairsThatNoSampleSatisfies) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", -0.5}, {"c", 0.0}});
  tally.add({{"a", -1.0}, {"b", 0.25}, {"c", 1.0}});
  tally.add({{"a", 1.0}, {"b", -0.5}, {"c", 1.0}});
  EXPECT_THAT(sentences(tally), ElementsAre("no design satisfies both a (satisfied by 2 of 3) and b (1 of 3)"));
  EXPECT_THAT(tally.reasons("constraint", "design")[0].names, ElementsAre("a", "b"));
}

TEST(MarginTally, OtherwiseReportsViolationsMostFrequentFirst) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", 1.0}, {"c", -1.0}});
  tally.add({{"a", 1.0}, {"b", -1.0}, {"c", 1.0}});
  tally.add({{"a", -1.0}, {"b", 1.0}, {"c", 1.0}});
  tally.add({{"a", 1.0}, {"b", 1.0}, {"c", -1.0}});
  EXPECT_THAT(sentences(tally), ElementsAre("c is violated by 2 of 4 designs", "a is violated by 1 of 4 designs",
                                            "b is violated by 1 of 4 designs"));
}

TEST(MarginTally, UnknownMarginsAreNotCounted) {
  MarginTally tally;
  tally.add({{"a", -1.0}, {"b", std::nan("")}});
  tally.add({{"a", 1.0}, {"b", -0.125}});
  tally.add({{"a", 1.0}});
  EXPECT_THAT(sentences(tally), ElementsAre("no design satisfies b (1 evaluated); the closest misses it by 0.125"));
  EXPECT_TRUE(sentences(MarginTally()).empty());
}

}  // namespace
}  // namespace pkm
