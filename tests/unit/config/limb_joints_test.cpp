// What the joints of the limbs hold: planes of `across` that poses leave are refused, and `check` counts the degrees of
// freedom that the joints leave the platform.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/config/mechanism_text.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The line on mobility of `pkmopt check`.
std::string mobility_of(const std::string& text) {
  const std::string all = describe_mechanism(*test::read_robot(text));
  const std::size_t at = all.find("  mobility: ");
  EXPECT_NE(at, std::string::npos) << all;
  return all.substr(at + 12, all.find('\n', at) - at - 12);
}

const std::string kDrives = "the drives determine ";

std::string robot(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(PKM_TEST_DATA "/robots/" + name + ".toml").rdbuf();
  return text.str();
}

/// Three legs between universal and ball joints.
std::string three_legs(const std::string& coordinates, const std::string& more = "") {
  return "[mechanism]\nname = \"legs\"\n[parameters]\nR = { default = 0.3, min = 0.1, max = 1, unit = \"m\" }\n"
         "[platform]\ncoordinates = " +
         coordinates + "\ncharacteristic_length = 0.1\n[survey]\n" +
         "box = { x = [-0.2, 0.2], y = [-0.2, 0.2], z = [0.4, 0.7] }\n"
         "[[limb]]\nname = \"leg\"\ncopies = { number = 3, about = \"z\" }\ndrive = \"telescope\"\n"
         "base = [\"R\", 0, 0]\nplatform = [\"R/2\", 0.05, 0]\n" +
         more;
}

/// Two cranks and two rods in a plane whose normal is n, with coordinates of two of the axes.
std::string plane(const std::string& coordinates, const std::string& across, const std::string& more = "") {
  return "[mechanism]\nname = \"plane\"\n[parameters]\na = { default = 0.2, min = 0.1, max = 1, unit = \"m\" }\n"
         "h = { default = 0, min = -1, max = 1, unit = \"m\" }\n[platform]\ncoordinates = " +
         coordinates +
         "\ncharacteristic_length = 0.1\n[[limb]]\nname = \"arm\"\ndrive = \"telescope\"\nbase = [0, 0, \"h\"]\n" +
         "across = " + across + "\n" + more;
}

TEST(Across, ARodThatLeavesItsPlaneIsRefused) {
  const std::string message = test::refusal_of(robot("3-prs-across"));
  EXPECT_THAT(
      message,
      HasSubstr("robot.toml:21: limb[1].across: the component of B - A along `across` changes with the pose ("));
  EXPECT_THAT(message, HasSubstr("give formulas in `follows`, `origin` or `end` that keep it in this plane"));
  EXPECT_EQ(test::refusal_of(test::substituted(robot("3-prs-across"), "across = [^\n]*\n", "")), "it is accepted");
}

TEST(Across, OffsetsThatNoPoseChangesArePlanar) {
  const std::string point = "platform = [0.1, 0, 0]\n";
  EXPECT_EQ(test::refusal_of(plane("{ x = \"along x\", y = \"along y\", phi = \"about z\" }", "[0, 0, 1]", point)),
            "it is accepted");
  EXPECT_EQ(test::refusal_of(plane("{ x = \"along x\", y = \"along y\", phi = \"about z\" }", "[0, 0, 1]",
                                   "across_in = \"platform\"\n" + point)),
            "it is accepted");
  EXPECT_THAT(test::refusal_of(plane("{ x = \"along x\", y = \"along y\", z = \"along z\" }", "[0, 0, 1]", point)),
              HasSubstr("limb[1].across: the component"));
  // a slide along `across` carries the end: the limb ends in its plane
  EXPECT_EQ(test::refusal_of(plane("{ x = \"along x\", y = \"along y\", z = \"along z\" }", "[0, 0, 1]",
                                   "end = [\"x\", \"y\", 0]\n")),
            "it is accepted");
  // in no plane of the axes, with rounding
  EXPECT_EQ(test::refusal_of(plane("{ s = \"along x\", t = \"along y\" }", "[1, 1, 1]",
                                   "end = [\"s/3\", \"t/7\", \"-s/3 - t/7\"]\n")),
            "it is accepted");
}

TEST(Across, OtherDesignsThanTheDefaultCount) {
  const std::string tilted = "{ x = \"along x\", z = \"along z\", beta = \"about x\" }";
  const std::string message = test::refusal_of(plane(tilted, "[0, 1, 0]", "platform = [0.1, \"h\", 0]\n"));
  EXPECT_THAT(message, HasSubstr("for a design other than the default"));
  EXPECT_EQ(test::refusal_of(plane(tilted, "[0, 1, 0]", "platform = [0.1, 0, 0]\n")), "it is accepted");
}

TEST(Across, HasNoEffectOnASlideWithoutRod) {
  const std::string slide = test::substituted(
      plane("{ x = \"along x\", y = \"along y\" }", "[0, 0, 1]", "platform = [0, 0, 0]\ndirection = [1, 0, 0]\n"),
      "telescope", "slider");
  EXPECT_THAT(test::refusal_of(slide), HasSubstr("limb[1].across: `across` has no effect on a slide without `rod`"));
}

TEST(Mobility, ThreeLegsDoNotHoldTheRotations) {
  const std::string translations = "{ x = \"along x\", y = \"along y\", z = \"along z\" }";
  EXPECT_EQ(
      mobility_of(three_legs(translations)),
      kDrives +
          "3 of 6 degrees of freedom at this pose: the joints of the file do not prevent rotation about x, rotation "
          "about y, rotation about z, which is assumed to be impossible");
}

TEST(Mobility, JointsThatHoldThePlatformAreCounted) {
  for (const char* name : {"3-rrr", "rotary-delta", "linear-delta", "orthoglide"})
    EXPECT_EQ(mobility_of(test::text_of_mechanism(name)), kDrives + "3 of 3 degrees of freedom at this pose") << name;
  for (const char* name : {"3crr-r-cru", "quadrupteron"})
    EXPECT_EQ(mobility_of(test::text_of_mechanism(name)), kDrives + "4 of 4 degrees of freedom at this pose") << name;
  EXPECT_EQ(mobility_of(test::text_of_mechanism("gough")), kDrives + "6 of 6 degrees of freedom at this pose");
}

TEST(Mobility, SingleRodsDoNotHoldTheRotationsOfADelta) {
  EXPECT_THAT(
      mobility_of(test::substituted(test::text_of_mechanism("rotary-delta"), "\npair [^\n]*", "")),
      HasSubstr("3 of 6 degrees of freedom at this pose: the joints of the file do not prevent rotation about x"));
}

TEST(Mobility, LegsInAPlaneHoldThePlatformIfTheirJointsAreParallel) {
  const std::string balls = test::substituted(test::text_of_mechanism("3-rpr"), "\nacross [^\n]*", "");
  EXPECT_THAT(mobility_of(balls),
              HasSubstr("3 of 6 degrees of freedom at this pose: the joints of the file do not prevent "
                        "translation along z, rotation about x, rotation about y"));
  EXPECT_EQ(mobility_of(test::substituted(balls, "\nradius ", "\nacross = [0, 0, 1]\nradius ")),
            kDrives + "3 of 3 degrees of freedom at this pose");
}

TEST(Mobility, TheCauseOfASingularPoseIsNamed) {
  const auto with = [](std::string text, const std::vector<std::pair<std::string, std::string>>& defaults) {
    for (const auto& [name, value] : defaults)
      text = test::substituted(text, "\n" + name + " = \\{ default = \"[^\"]*\"",
                               "\n" + name + " = { default = \"" + value + "\"");
    return text;
  };
  const std::string meeting = with(test::text_of_mechanism("3-rpr"),
                                   {{"B2x", "-100 mm"}, {"B2y", "-80 mm"}, {"B3x", "-100 mm"}, {"B3y", "-80 mm"}});
  const std::string singular =
      " of 3 degrees of freedom at this pose: the platform can move while the drives are "
      "locked, or the pose is singular; ";
  EXPECT_EQ(mobility_of(meeting), kDrives + "2" + singular + "it can move along a combination of x, y, phi");
  EXPECT_EQ(mobility_of(with(meeting, {{"A2x", "0 m"}, {"A3x", "0 m"}, {"A3y", "0 m"}})),
            kDrives + "1" + singular + "leg1, leg2, leg3 act along one line");
}

TEST(Mobility, WhatTheFileDoesNotDescribeIsUnknown) {
  const std::string unknown =
      "the drives determine the coordinates at this pose; unknown whether the joints constrain the platform's "
      "other degrees of freedom: limb ";
  EXPECT_EQ(mobility_of(test::text_of_mechanism("2t1r-p-hybrid")),
            unknown + "limbA has drive = \"formula\", so its links are unknown");
  EXPECT_THAT(mobility_of(test::text_of_mechanism("par4")), HasSubstr(unknown + "arm1 ends at `end`"));
  EXPECT_THAT(mobility_of(robot("crank-and-slide")), HasSubstr(unknown + "slide has neither `rod` nor `links`"));
}

}  // namespace
}  // namespace pkm
