// Units on the command line and in the output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CliUnits, InchesAndDegreesAreRead) {
  const auto pose = [](const std::string& at) { return pkmopt({"pose", "4ppa-2par", "--json", "--at", at}).json(); };
  const auto one = pose("x=10in,y=0.85,z=-0.8,theta=30°");
  EXPECT_EQ(one["pose"]["x"], 0.254);
  EXPECT_EQ(one, pose("x=0.254 m,y=850mm,z=-80cm,theta=30deg"));
}

TEST(CliUnits, AnglesArePrintedInDegreesToo) {
  const std::vector<std::string> pose = {"pose", "4ppa-2par", "--at", "x=0.3,y=1.2,z=-1,theta=20deg"};
  EXPECT_THAT(pkmopt(pose).out, HasSubstr("z = -1000 mm, theta = 20 deg\n"));
  const auto forward = pkmopt({"forward", "4ppa-2par", "--joints", "q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846"});
  EXPECT_THAT(forward.out, HasSubstr("  30 deg  below,below\n"));
}

TEST(CliUnits, AnglesAboveOneRevolutionGiveANote) {
  const std::string note = "note       theta exceeds one revolution; for degrees, write theta=30deg\n";
  EXPECT_THAT(pkmopt({"pose", "4ppa-2par", "--at", "x=0.3,y=1.2,z=-1,theta=30"}).out, HasSubstr(note));
  const auto cut = pkmopt({"workspace", "4ppa-2par", "--cells", "4", "--cut", "theta=30"});
  EXPECT_THAT(cut.out, HasSubstr("theta exceeds one revolution; for degrees, write theta=30deg\n"));
  EXPECT_THAT(pkmopt({"pose", "4ppa-2par", "--at", "x=0.3,y=1.2,z=-1,theta=6"}).out, Not(HasSubstr("note")));
}

TEST(CliUnits, ListsContinueWithoutRepeatingTheOption) {
  const auto volume = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"workspace", "4ppa-2par", "--json"});
    return pkmopt(words).json()["volume"];
  };
  EXPECT_EQ(volume({"--cells", "x=6", "z=5", "theta=4", "--box", "x=0.2:0.5", "z=-1:-0.7"}),
            volume({"--cells", "x=6,z=5,theta=4", "--box", "x=0.2:0.5,z=-1:-0.7"}));
  EXPECT_EQ(volume({"--cells", "6", "--cut", "theta=0", "x=0.3"}), volume({"--cells", "6", "--cut", "theta=0,x=0.3"}));
}

TEST(CliUnits, AVolumeRatioIsNotPrintedInDegrees) {
  const auto ratio = pkmopt({"evaluate", "experiments/4ppa-2par/paper-problem.toml"}, PKM_EXPERIMENTS "/..");
  EXPECT_THAT(ratio.out, HasSubstr(" rad"));
  EXPECT_THAT(ratio.out, Not(HasSubstr("deg")));
}

}  // namespace
}  // namespace pkm::testing
