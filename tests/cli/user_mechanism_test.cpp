// Commands of a program with a user's mechanism that has redundant drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/app/program.hpp"
#include "tests/own_mechanisms/three_ropes.hpp"

namespace pkm {
namespace {

/// Runs a program with the user's mechanism. @return exit code and stderr
std::pair<int, std::string> run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "own");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  Catalogues all = all_catalogues();
  all.mechanisms = {std::make_shared<test::ThreeRopes>()};
  ::testing::internal::CaptureStderr();
  const int exit_code = program_main(static_cast<int>(arguments.size()), argv.data(), all);
  return {exit_code, ::testing::internal::GetCapturedStderr()};
}

TEST(UserMechanism, RedundantDrivesHaveForcesButNoCouplingIndices) {
  const std::string at = "x=0.1,z=-1";
  const auto [exit_code, message] = run({"coupling", "three-ropes"});
  EXPECT_EQ(exit_code, 2);
  EXPECT_THAT(message,
              ::testing::HasSubstr("mechanism three-ropes has 3 joints for 2 coordinates, not as many of both, "
                                   "so it has no coupling indices"));
  EXPECT_EQ(run({"dynamics", "three-ropes", "--at", at}), std::pair(0, std::string()));
  EXPECT_EQ(run({"simulate", "three-ropes", "--at", at, "--duration", "0.1s", "--step", "1ms"}),
            std::pair(0, std::string()));
}

}  // namespace
}  // namespace pkm
