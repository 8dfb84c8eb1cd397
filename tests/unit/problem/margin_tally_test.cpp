// Which margins nothing keeps, alone and in pairs.
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

TEST(MarginTally, NamesWhatNothingKeepsAndByHowMuch) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", -0.5}});
  tally.add({{"a", -1.0}, {"b", -0.25}});
  EXPECT_THAT(sentences(tally), ElementsAre("no design keeps b: the nearest misses it by 0.25"));
  EXPECT_THAT(tally.reasons("constraint", "design")[0].names, ElementsAre("b"));
}

TEST(MarginTally, NamesPairsThatNothingKeepsTogether) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", -0.5}, {"c", 0.0}});
  tally.add({{"a", -1.0}, {"b", 0.25}, {"c", 1.0}});
  tally.add({{"a", 1.0}, {"b", -0.5}, {"c", 1.0}});
  EXPECT_THAT(sentences(tally), ElementsAre("no design keeps both a (kept by 2 of 3) and b (1 of 3)"));
  EXPECT_THAT(tally.reasons("constraint", "design")[0].names, ElementsAre("a", "b"));
}

TEST(MarginTally, ElseCountsWhatIsBrokenMostOftenFirst) {
  MarginTally tally;
  tally.add({{"a", 1.0}, {"b", 1.0}, {"c", -1.0}});
  tally.add({{"a", 1.0}, {"b", -1.0}, {"c", 1.0}});
  tally.add({{"a", -1.0}, {"b", 1.0}, {"c", 1.0}});
  tally.add({{"a", 1.0}, {"b", 1.0}, {"c", -1.0}});
  EXPECT_THAT(sentences(tally), ElementsAre("c is broken by 2 of 4 designs", "a is broken by 1 of 4 designs",
                                            "b is broken by 1 of 4 designs"));
}

TEST(MarginTally, WhatIsNotKnownCountsNothing) {
  MarginTally tally;
  tally.add({{"a", -1.0}, {"b", std::nan("")}});
  tally.add({{"a", 1.0}, {"b", -0.125}});
  tally.add({{"a", 1.0}});
  EXPECT_THAT(sentences(tally),
              ElementsAre("no design keeps b, of the 1 for which it is known: the nearest misses it by 0.125"));
  EXPECT_TRUE(sentences(MarginTally()).empty());
}

}  // namespace
}  // namespace pkm
