#include "engine/core/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pkm {
namespace {

TEST(Options, DefaultsAreThoseOfTheSpecsOnly) {
  const auto spec = [](const char* name, OptionKind kind, std::optional<OptionValue> initial) {
    OptionSpec made;
    made.name = name;
    made.kind = kind;
    made.initial = std::move(initial);
    return made;
  };
  const std::vector<OptionSpec> specs = {spec("rate", OptionKind::number, 0.5),
                                         spec("count", OptionKind::integer, std::int64_t{3}),
                                         spec("exact", OptionKind::flag, true),
                                         spec("kind", OptionKind::word, "mean"),
                                         spec("weights", OptionKind::named_numbers, NamedNumbers{{"a", 1}}),
                                         spec("target", OptionKind::number, {})};
  const Options options = default_options(specs);
  EXPECT_EQ(options.number("rate"), 0.5);
  EXPECT_EQ(options.integer("count"), 3);
  EXPECT_TRUE(options.flag("exact"));
  EXPECT_EQ(options.word("kind"), "mean");
  EXPECT_EQ(options.numbers("weights").at("a"), 1);
  EXPECT_FALSE(options.has("target"));
  EXPECT_EQ(options.values().size(), 5U);
  EXPECT_THROW(options.number("target"), std::out_of_range);
  EXPECT_THROW(options.number("count"), std::bad_variant_access);
}

TEST(Options, ValuesAreWrittenInTheSyntaxOfAStudyFile) {
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(std::int64_t{-4}), "-4");
  EXPECT_EQ(to_text(false), "false");
  EXPECT_EQ(to_text(std::string("mean")), "\"mean\"");
  EXPECT_EQ(to_text(std::string("a \"b\"\n\tc\\")), "\"a \\\"b\\\"\\n\\tc\\\\\"");
  EXPECT_EQ(to_text(NamedNumbers{{"b", -1}, {"a", 1}}), "{ a = 1, b = -1 }");
}

TEST(ShortestDecimal, ReadsBackToTheSameBits) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1e-8), "1e-08");
  EXPECT_EQ(shortest(std::numeric_limits<double>::infinity()), "inf");
  for (const double value : {1.0 / 3, 0.1935533684, -2.5e-300, 1e22, std::nextafter(0.3, 1.0)})
    EXPECT_EQ(std::stod(shortest(value)), value);
}

}  // namespace
}  // namespace pkm
