// What the commands refuse of a mechanism of one's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/app/program.hpp"
#include "tests/own_mechanisms/three_ropes.hpp"

namespace pkm {
namespace {

/// The exit code, and what it says on stderr.
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

TEST(OwnMechanism, WithMoreDrivesThanCoordinatesHasNoForcesOfItsDrives) {
  const std::string sentence = "mechanism three-ropes has 3 joints for 2 coordinates, not as many of both, so no ";
  const std::string at = "x=0.1,z=-1";
  const struct {
    std::vector<std::string> arguments;
    std::string lacks;
  } cases[] = {{{"coupling", "three-ropes"}, "coupling indices"},
               {{"dynamics", "three-ropes", "--at", at}, "dynamics"},
               {{"simulate", "three-ropes", "--at", at, "--duration", "1s", "--step", "1ms"}, "dynamics"}};
  for (const auto& [arguments, lacks] : cases) {
    SCOPED_TRACE(arguments[0]);
    const auto [exit_code, said] = run(arguments);
    EXPECT_EQ(exit_code, 2);
    EXPECT_THAT(said, ::testing::HasSubstr(sentence + lacks));
  }
}

}  // namespace
}  // namespace pkm
