// Commands that a program with a user's mechanism refuses.
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

TEST(UserMechanism, RedundantDrivesHaveNoUniqueForces) {
  const std::string sentence = "mechanism three-ropes has 3 joints for 2 coordinates, not as many of both, so ";
  const std::string at = "x=0.1,z=-1";
  const struct {
    std::vector<std::string> arguments;
    std::string lacks;
  } cases[] = {
      {{"coupling", "three-ropes"}, "it has no coupling indices"},
      {{"dynamics", "three-ropes", "--at", at}, "its dynamics are undefined"},
      {{"simulate", "three-ropes", "--at", at, "--duration", "1s", "--step", "1ms"}, "it cannot be simulated"}};
  for (const auto& [arguments, lacks] : cases) {
    SCOPED_TRACE(arguments[0]);
    const auto [exit_code, message] = run(arguments);
    EXPECT_EQ(exit_code, 2);
    EXPECT_THAT(message, ::testing::HasSubstr(sentence + lacks));
  }
}

}  // namespace
}  // namespace pkm
