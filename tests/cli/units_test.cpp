// Units on the command line and in what is printed.
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
  EXPECT_THAT(pkmopt(pose).out, HasSubstr("z = -1 m, theta = 0.349065850399 rad (20 deg)\n"));
  const auto forward = pkmopt({"forward", "4ppa-2par", "--joints", "q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846"});
  EXPECT_THAT(forward.out, HasSubstr("  0.523598775598 rad (30 deg)  below,below\n"));
}

TEST(CliUnits, AVolumeOverASizeIsNoAngle) {
  const auto ratio = pkmopt({"evaluate", "experiments/4ppa-2par/paper-problem.toml"}, PKM_EXPERIMENTS "/..");
  EXPECT_THAT(ratio.out, HasSubstr(" rad"));
  EXPECT_THAT(ratio.out, Not(HasSubstr(" deg)")));
}

}  // namespace
}  // namespace pkm::testing
