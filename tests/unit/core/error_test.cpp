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

TEST(ConfigErrorMessage, ContainsLocationFoundExpectedAndSuggestion) {
  EXPECT_STREQ(ConfigError({"s.toml", 3, "study.sed"}, "an unknown key", "one of seed", "seed").what(),
               "s.toml:3: study.sed: found an unknown key; expected one of seed; did you mean 'seed'?");
  EXPECT_STREQ(ConfigError({"s.toml", 0, ""}, "nothing", "a study").what(), "s.toml: found nothing; expected a study");
  EXPECT_STREQ(ConfigError({"", 0, "--at"}, "x twice", "each name once").what(),
               "--at: found x twice; expected each name once");
  EXPECT_STREQ(ConfigError({"", 7, ""}, "x", "y").what(), "found x; expected y");
}

TEST(ConfigErrorMessage, MayBeAnySentence) {
  const ConfigError error({"s.toml", 4, "stage[1]"}, "the optimiser is not available");
  EXPECT_STREQ(error.what(), "s.toml:4: stage[1]: the optimiser is not available");
  EXPECT_EQ(error.place().line, 4);
  EXPECT_EQ(error.place().key, "stage[1]");
}

TEST(ConfigErrorMessage, IsShortAndPrintableForAnyInput) {
  const std::string long_text(1 << 20, '\x1b');
  for (const ConfigError& error : {ConfigError({long_text, 3, long_text}, long_text, long_text, long_text),
                                   ConfigError({long_text, 3, long_text}, long_text)}) {
    const std::string message = error.what();
    EXPECT_LT(message.size(), 2000u);
    EXPECT_EQ(message.find('\x1b'), std::string::npos);
  }
  EXPECT_STREQ(ConfigError({"", 0, "--at"}, "'x\x1b'", "a number").what(), "--at: found 'x\\x1b'; expected a number");
  EXPECT_LT(std::string(StorageError(long_text).what()).size(), 2000u);
  EXPECT_STREQ(StorageError("a\nb.h5: gone").what(), "a\\x0ab.h5: gone");
  EXPECT_EQ(message_of(std::runtime_error("a\rb")), "a\\x0db");
  EXPECT_LT(message_of(std::runtime_error(long_text)).size(), 2000u);
}

TEST(MessageOf, ReplacesMessagesOfTheStandardLibrary) {
  const auto message_for = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const std::exception& error) {
      return message_of(error);
    }
    return "nothing";
  };
  const std::vector<int> none;
  EXPECT_THAT(message_for([] { throw std::bad_alloc(); }), StartsWith("out of memory: "));
  EXPECT_THAT(message_for([] { std::string().resize(std::string::npos); }), StartsWith("internal error: "));
  EXPECT_THAT(message_for([&none] { std::ignore = none.at(3); }), StartsWith("internal error: "));
  EXPECT_THAT(message_for([] { std::ignore = std::optional<int>().value(); }), StartsWith("internal error: "));
  EXPECT_EQ(message_for([] { std::filesystem::create_directory("/proc/x"); }), "/proc/x: No such file or directory");
  EXPECT_EQ(message_for([] { throw std::system_error(std::make_error_code(std::errc::file_too_large), "open"); }),
            "File too large");
  EXPECT_EQ(message_for([] { throw DesignError("a rod without mass"); }), "a rod without mass");
}

TEST(NearestName, IgnoresVeryLongNames) {
  const std::string long_text(1 << 20, 'a');
  EXPECT_EQ(nearest_name(long_text, {long_text, "a"}), "");
  EXPECT_EQ(nearest_name("a", {long_text, "b"}), "b");
}

TEST(NearestName, FindsMisspellingsOnly) {
  const std::vector<std::string> known{"population", "generations", "seed", "l_u", "l_d"};
  EXPECT_EQ(nearest_name("popluation", known), "population");
  EXPECT_EQ(nearest_name("generation", known), "generations");
  EXPECT_EQ(nearest_name("sed", known), "seed");
  EXPECT_EQ(nearest_name("lu", known), "l_u");
  EXPECT_EQ(nearest_name("l_d", known), "l_d");
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("popul", known), "population");  // prefix of a known name
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
