#include "engine/core/unit.hpp"

#include <gtest/gtest.h>

#include <clocale>

#include "engine/math/portable.hpp"

namespace pkm {
namespace {

TEST(Unit, ConvertsExactlyToSi) {
  struct Case {
    const char* text;
    const char* unit;
    double value;
  };
  const Case cases[] = {
      {"0.5", "1", 0.5},
      {"5 %", "1", 0.05},
      {"  7 ", "m", 7},
      {"+3", "m", 3},
      {"200 mm", "m", 0.2},
      {"35mm", "m", 0.035},
      {"1e-3 m", "m", 0.001},
      {"2.5e1 cm", "m", 0.25},
      {"3 dm", "m", 0.3},
      {"7 um", "m", 7e-6},
      {"2 km", "m", 2000},
      {"1 in", "m", 0.0254},
      {"3 inch", "m", 0.0762},
      {"10 ft", "m", 3.048},
      {"30deg", "rad", kPi / 6},
      {"-90 deg", "rad", -kPi / 2},
      {"30°", "rad", kPi / 6},
      {"-90 °", "rad", -kPi / 2},
      {"180 °/s", "rad/s", kPi},
      {"180 deg", "rad", kPi},
      {"4 mrad", "rad", 0.004},
      {"2 s", "s", 2},
      {"10 min", "s", 600},
      {"1.5 h", "s", 5400},
      {"20 ms", "s", 0.02},
      {"9 us", "s", 9e-6},
      {"5 kg", "kg", 5},
      {"300 g", "kg", 0.3},
      {"2 t", "kg", 2000},
      {"3 kN", "N", 3000},
      {"4 kg m/s^2", "N", 4},
      {"2 N m", "J", 2},
      {"2 J", "N m", 2},
      {"2 kW", "W", 2000},
      {"5 kg mm^2", "kg m^2", 5e-6},
      {"7 g*m^2", "kg m^2", 0.007},
      {"36 m/min", "m/s", 0.6},
      {"8 mm^2 rad", "m^2 rad", 8e-6},
      {"6 s^-1", "1/s", 6},
      {"0.25 m^3 rad", "m^3 rad", 0.25},
  };
  for (const auto& c : cases) EXPECT_EQ(parse_quantity(c.text, c.unit), c.value) << c.text << " in " << c.unit;
  EXPECT_DOUBLE_EQ(parse_quantity("60 rpm", "rad/s").value(), 2 * kPi);
}

TEST(Unit, RejectsInvalidTextAndOtherDimensions) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "m"},       {"mm", "m"},          {"abc", "1"},      {"1 kg", "m"},  {"1 rad", "1"},
      {"1 m", "m^2"},  {"1 m^2", "m^2 rad"}, {"inf", "m"},      {"nan", "m"},   {"-inf m", "m"},
      {"1e999", "m"},  {"1 m x", "m"},       {"1 m/", "m"},     {"1 /s", "s"},  {"1,5 m", "m"},
      {"1 mmm", "m"},  {"0x10 m", "m"},      {"1 m^", "m"},     {"1 m^0", "1"}, {"1 2 m", "m"},
      {"++1", "m"},    {"+-1", "m"},         {"1e308 km", "m"}, {"5 %", "m"},   {"1 m^99", "m"},
      {"1 °°", "rad"}, {"1 \xc2", "rad"},    {"1 MM", "m"},     {"1 1 m", "m"}, {"1__0", "1"},
  };
  for (const auto& [text, unit] : cases) EXPECT_FALSE(parse_quantity(text, unit)) << text << " in " << unit;
}

TEST(Unit, MessagesListTheUnitsOfTheDimension) {
  EXPECT_EQ(quantity_hint("m"), "a number in m, or text with a unit made of um, mm, cm, dm, m, km, in, inch, ft");
  EXPECT_EQ(quantity_hint("rad"), "a number in rad, or text with a unit made of mrad, rad, deg, °");
  EXPECT_EQ(quantity_hint("1"), "a number, or text such as \"5 %\"");
  EXPECT_EQ(quantity_hint("rad/s"),
            "a number in rad/s, or text with a unit made of rpm, mrad, rad, deg, °, us, ms, s, min, h");
}

TEST(Unit, DescribesTheDimensionOfAQuantity) {
  EXPECT_EQ(kind_of_quantity("10 deg"), "an angle");
  EXPECT_EQ(kind_of_quantity(" 2e-3 mm"), "a length");
  EXPECT_EQ(kind_of_quantity("5 %"), "a plain number");
  EXPECT_EQ(kind_of_quantity("5 g/cm"), "a quantity in g/cm");
  for (const char* text : {"10", "deg", "10 l_a", "10*deg", ""}) EXPECT_EQ(kind_of_quantity(text), "") << text;
  EXPECT_EQ(kind_of_unit("m"), "a length");
}

TEST(Unit, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) std::setlocale(LC_NUMERIC, name);
  EXPECT_EQ(parse_quantity("1.5 mm", "m"), 0.0015);
  EXPECT_FALSE(parse_quantity("1,5 mm", "m"));
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(Unit, IntegersAreParsedInDecimalOnly) {
  EXPECT_EQ(parse_integer("0"), 0);
  EXPECT_EQ(parse_integer("10"), 10);
  EXPECT_EQ(parse_integer("-7"), -7);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"", "-", "010", "00", "-0", "0x10", "1e3", "1.0", " 1", "1 ", "+1", "--1", "1'000", "1_000",
                           "9223372036854775808", "99999999999999999999", "18446744073709551617"})
    EXPECT_FALSE(parse_integer(text)) << text;
}

TEST(Unit, VeryLargeAnglesAreRejected) {
  EXPECT_EQ(angle_hint(1e5, "rad"), "");
  EXPECT_EQ(angle_hint(1e9, "m"), "");
  EXPECT_EQ(angle_hint(-1.1e5, "rad"),
            "an angle within 1e+05 rad, because larger angles lose digits; subtract whole revolutions");
}

TEST(Unit, RecognisesSiUnits) {
  for (const char* unit : {"1", "m", "m^2 rad", "kg m^2", "N m/rad", "1/s", "J", "W", "m rad"})
    EXPECT_TRUE(is_si_unit(unit)) << unit;
  for (const char* unit : {"", "mm", "deg", "%", "rpm", "kN", "g", "m^", "m rad EUR", "2", " "})
    EXPECT_FALSE(is_si_unit(unit)) << unit;
}

TEST(Unit, FormatsNumbersWithTheirUnit) {
  EXPECT_EQ(with_unit(0.1, "m"), "0.1 m");
  EXPECT_EQ(with_unit(0.1, "1"), "0.1");
  EXPECT_EQ(with_unit(3, ""), "3");
}

}  // namespace
}  // namespace pkm
