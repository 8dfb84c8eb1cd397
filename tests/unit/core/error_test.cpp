#include "engine/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <vector>

namespace pkm {
namespace {

using ::testing::StartsWith;

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

TEST(ConfigErrorText, IsShortAndPrintableWhateverTheInput) {
  const std::string much(1 << 20, '\x1b');
  for (const ConfigError& error :
       {ConfigError({much, 3, much}, much, much, much), ConfigError({much, 3, much}, much)}) {
    const std::string message = error.what();
    EXPECT_LT(message.size(), 2000u);
    EXPECT_EQ(message.find('\x1b'), std::string::npos);
  }
  EXPECT_STREQ(ConfigError({"", 0, "--at"}, "'x\x1b'", "a number").what(), "--at: found 'x\\x1b'; expected a number");
  EXPECT_LT(std::string(StorageError(much).what()).size(), 2000u);
  EXPECT_STREQ(StorageError("a\nb.h5: gone").what(), "a\\x0ab.h5: gone");
  EXPECT_EQ(message_of(std::runtime_error("a\rb")), "a\\x0db");
  EXPECT_LT(message_of(std::runtime_error(much)).size(), 2000u);
}

TEST(MessageOf, SaysWhatHasHappenedAndNotTheLibrarysWords) {
  const auto words_of = [](const auto& cause) -> std::string {
    try {
      cause();
    } catch (const std::exception& error) {
      return message_of(error);
    }
    return "nothing";
  };
  const std::vector<int> none;
  EXPECT_THAT(words_of([] { throw std::bad_alloc(); }), StartsWith("out of memory: "));
  EXPECT_THAT(words_of([] { std::string().resize(std::string::npos); }), StartsWith("internal error: "));
  EXPECT_THAT(words_of([&none] { std::ignore = none.at(3); }), StartsWith("internal error: "));
  EXPECT_THAT(words_of([] { std::ignore = std::optional<int>().value(); }), StartsWith("internal error: "));
  EXPECT_EQ(words_of([] { std::filesystem::create_directory("/proc/x"); }), "/proc/x: No such file or directory");
  EXPECT_EQ(words_of([] { throw std::system_error(std::make_error_code(std::errc::file_too_large), "open"); }),
            "File too large");
  EXPECT_EQ(words_of([] { throw std::domain_error("a rod without mass"); }), "a rod without mass");
}

TEST(NearestName, TakesNoTimeForNamesThatAreNoNames) {
  const std::string much(1 << 20, 'a');
  EXPECT_EQ(nearest_name(much, {much, "a"}), "");
  EXPECT_EQ(nearest_name("a", {much, "b"}), "b");
}

TEST(NearestName, FindsSlipsOfThePenAndNothingElse) {
  const std::vector<std::string> known{"population", "generations", "seed", "l_u", "l_d"};
  EXPECT_EQ(nearest_name("popluation", known), "population");
  EXPECT_EQ(nearest_name("generation", known), "generations");
  EXPECT_EQ(nearest_name("sed", known), "seed");
  EXPECT_EQ(nearest_name("lu", known), "l_u");
  EXPECT_EQ(nearest_name("l_d", known), "l_d");
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("popul", known), "population");  // what it begins with
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
