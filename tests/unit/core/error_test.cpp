#include "engine/core/error.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(ConfigErrorText, NamesPlaceFoundExpectedAndNearest) {
  EXPECT_STREQ(ConfigError({"s.toml", 3, "study.sed"}, "an unknown key", "one of seed", "seed").what(),
               "s.toml:3: study.sed: found an unknown key; expected one of seed; did you mean 'seed'?");
  EXPECT_STREQ(ConfigError({"s.toml", 0, ""}, "nothing", "a study").what(), "s.toml: found nothing; expected a study");
  EXPECT_STREQ(ConfigError({"", 0, "--at"}, "x twice", "each name once").what(),
               "--at: found x twice; expected each name once");
  EXPECT_STREQ(ConfigError({"", 7, ""}, "x", "y").what(), "found x; expected y");
}

TEST(ConfigErrorText, MayBeASentenceOfItsOwn) {
  const ConfigError error({"s.toml", 4, "stage[1]"}, "the optimiser is tired");
  EXPECT_STREQ(error.what(), "s.toml:4: stage[1]: the optimiser is tired");
  EXPECT_EQ(error.place().line, 4);
  EXPECT_EQ(error.place().key, "stage[1]");
}

TEST(NearestName, FindsSlipsOfThePenAndNothingElse) {
  const std::vector<std::string> known{"population", "generations", "seed", "l_u", "l_d"};
  EXPECT_EQ(nearest_name("popluation", known), "population");
  EXPECT_EQ(nearest_name("generation", known), "generations");
  EXPECT_EQ(nearest_name("sed", known), "seed");
  EXPECT_EQ(nearest_name("lu", known), "l_u");
  EXPECT_EQ(nearest_name("l_d", known), "l_d");
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("q", known), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(Join, SeparatesWords) {
  EXPECT_EQ(join({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(join({"a"}, " | "), "a");
  EXPECT_EQ(join({}), "");
}

}  // namespace
}  // namespace pkm
