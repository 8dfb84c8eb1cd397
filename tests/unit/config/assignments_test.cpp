#include "engine/config/assignments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.hpp"
#include "engine/math/portable.hpp"
#include "tests/unit/config/fake_catalogues.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;

const MechanismInfo& slider() { return testing::fake_catalogues().mechanisms.front()->info(); }

TEST(Assignments, ReadNamesInAnyOrderWithUnits) {
  EXPECT_THAT(
      parse_all_assignments({"theta=30deg, z = -0.5", "x=200mm,y=1"}, "--at", assignable_axes(slider().coordinates)),
      ElementsAre(0.2, 1, -0.5, kPi / 6));
  EXPECT_THAT(parse_all_assignments({"q1=1,q2=2,q3=3 cm,q4=4"}, "--joints", assignable_axes(slider().joints)),
              ElementsAre(1, 2, 0.03, 4));
}

TEST(Assignments, MayNameSomeOnly) {
  EXPECT_THAT(parse_assignments({"b=800mm", "mass=2 kg"}, "--set", assignable_parameters(slider())),
              ElementsAre(std::nullopt, 0.8, std::nullopt, 2));
  EXPECT_THAT(parse_assignments({}, "--set", assignable_axes(slider().joints)),
              ElementsAre(std::nullopt, std::nullopt, std::nullopt, std::nullopt));
}

TEST(Assignments, MessagesNameOptionAndNearestName) {
  const auto message = [](const std::vector<std::string>& lists) -> std::string {
    try {
      parse_assignments(lists, "--set", assignable_parameters(slider()));
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.place().key, "--set");
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message({"tlit=1"}),
            "--set: found the unknown name 'tlit'; expected one of a, b, tilt, mass; did you mean 'tilt'?");
  EXPECT_EQ(message({"a"}), "--set: found \"a\"; expected name=value, with names out of a, b, tilt, mass");
  EXPECT_EQ(message({"a=1,"}), "--set: found \"\"; expected name=value, with names out of a, b, tilt, mass");
  EXPECT_EQ(message({""}), "--set: found \"\"; expected name=value, with names out of a, b, tilt, mass");
  EXPECT_EQ(message({"a=1,a=2"}), "--set: found a twice; expected each name once");
  EXPECT_EQ(message({"a=1", "a=1"}), "--set: found a twice; expected each name once");
  EXPECT_EQ(
      message({"a=1 kg"}),
      "--set: found a=1 kg; expected a number in m, or text with a unit made of um, mm, cm, dm, m, km, in, inch, ft");
  EXPECT_EQ(message({"a="}),
            "--set: found a=; expected a number in m, or text with a unit made of um, mm, cm, dm, m, km, in, inch, ft");
  EXPECT_EQ(message({"a=3"}), "--set: found a=3; expected a number in [0, 2] m");
}

TEST(Assignments, AnglesOfManyTurnsAreRefused) {
  for (const std::string angle : {"1e16", "100001", "-6e6deg"}) try {
      parse_assignments({"theta=" + angle}, "--at", assignable_axes(slider().coordinates));
      ADD_FAILURE() << angle;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.what(),
                "--at: found theta=" + angle +
                    "; expected an angle within 1e+05 rad, because larger angles lose digits; subtract whole "
                    "revolutions");
    }
  EXPECT_THROW(parse_values("0:1:010", "--phi", {"phi", "rad"}), ConfigError);
}

TEST(Assignments, MissingNamesAreListed) {
  try {
    parse_all_assignments({"x=1,theta=0"}, "--at", assignable_axes(slider().coordinates));
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "--at: found no value for y, z; expected values for x, y, z, theta");
  }
}

}  // namespace
}  // namespace pkm
