// `pkmopt generate`: the generated code compiles without warnings and agrees with the engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

/// The built-in mechanisms, and the mechanism files of the experiments.
std::vector<std::string> mechanisms() {
  std::vector<std::string> all = {"4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid"};
  for (const auto& entry : std::filesystem::directory_iterator(PKM_EXPERIMENTS "/mechanisms"))
    if (entry.path().extension() == ".toml") all.push_back(entry.path().string());
  return all;
}

std::string poses_of_tests(const char* fewer) {
  const char* const given = std::getenv("PKM_GENERATED_POSES");
  return given ? given : fewer;
}

/// Runs shell commands in a folder. @return their output
ProgramResult shell(const std::string& commands, const std::string& folder) {
  return run_program({"/bin/sh", "-c", commands}, folder, std::chrono::seconds(120));
}

/// Generates code in a folder of its own, builds and runs its test. @return the output, empty on failure
void expect_agreement(const std::string& mechanism, const std::vector<std::string>& options,
                      const std::string& commands, const char* poses) {
  const StudyFolder folder;
  std::vector<std::string> arguments = {"generate",    mechanism,      "-o",
                                        folder.path(), "--test-poses", poses_of_tests(poses)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramResult generated = pkmopt(arguments);
  ASSERT_EQ(generated.exit_code, 0) << mechanism << ": " << generated.err;
  const ProgramResult done = shell(commands, folder.path());
  EXPECT_EQ(done.exit_code, 0) << mechanism << ": " << done.out << done.err;
  EXPECT_THAT(done.out, HasSubstr("largest difference")) << mechanism;
}

const std::string kC = PKM_C_COMPILER
    " -std=c99 -O1 -ffp-contract=off -Wall -Wextra -Wpedantic -Werror *.c -lm && ./a.out",
                  kCpp =
                      PKM_CXX_COMPILER " -std=c++17 -O1 -ffp-contract=off -Wall -Wextra -Werror *_test.cpp && ./a.out",
                  kPython = "/usr/bin/python3 -W error *_test.py";

TEST(CliGenerate, CAgreesForAllMechanisms) {
  for (const std::string& mechanism : mechanisms()) expect_agreement(mechanism, {"--language", "c"}, kC, "60");
}

TEST(CliGenerate, PythonAgreesForAllMechanisms) {
  for (const std::string& mechanism : mechanisms())
    expect_agreement(mechanism, {"--language", "python"}, kPython, "60");
}

TEST(CliGenerate, CppAgrees) {
  for (const std::string mechanism : {"4ppa-2par", PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml"})
    expect_agreement(mechanism, {"--language", "cpp"}, kCpp, "60");
}

TEST(CliGenerate, ParametersAndSinglePrecision) {
  const std::string delta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";
  expect_agreement("3crr-r-cru", {"--language", "c", "--parameters"}, kC, "20");
  expect_agreement(delta, {"--language", "c", "--float"}, kC, "20");
  expect_agreement(delta, {"--language", "cpp", "--parameters", "--float"}, kCpp, "20");
  expect_agreement(delta, {"--language", "python", "--parameters", "--set", "l_a=220mm"}, kPython, "20");
  expect_agreement("4ppa-2par", {"--language", "c", "--mode", "upper,lower"}, kC, "20");
  expect_agreement("4ppa-2par", {"--language", "c", "--limit", "beta_max=80deg"}, kC, "20");
}

TEST(CliGenerate, OctaveAgrees) {
  if (shell("octave-cli --version", ".").exit_code != 0) GTEST_SKIP() << "Octave is not installed";
  for (const std::string mechanism : {"4ppa-2par", PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml"})
    for (const std::string option : {"--parameters", "--json"})  // the latter changes the output only
      expect_agreement(mechanism, {"--language", "matlab", option},
                       "octave-cli --no-init-file --quiet --eval $(basename *_test.m .m)", "10");
}

TEST(CliGenerate, HasNoInverseOfADifferentNumberOfJoints) {
  const StudyFolder folder;
  std::ifstream file(PKM_EXPERIMENTS "/mechanisms/3-rpr.toml");
  std::string text(std::istreambuf_iterator<char>(file), {});
  text += "\n[[limb]]\nname = \"extra\"\ndrive = \"formula\"\nunit = \"m\"\njoints = { fourth = \"x + y\" }\n";
  const std::string redundant = folder.write("redundant.toml", text), code = folder.path() + "/code";
  ASSERT_EQ(pkmopt({"generate", redundant, "--language", "c", "-o", code}).exit_code, 0);
  EXPECT_EQ(shell("grep -c _forward *.h", code).out, "0\n");
  EXPECT_EQ(shell(kC, code).exit_code, 0);
}

TEST(CliGenerate, Mistakes) {
  const StudyFolder folder;
  EXPECT_THAT(pkmopt({"generate", "4ppa-2par", "--language", "rust", "-o", folder.path()}).err,
              HasSubstr("--language: found 'rust'; expected one of c, cpp, python, matlab"));
  EXPECT_THAT(pkmopt({"generate", "4ppa-2par", "--language", "python", "--float", "-o", folder.path()}).err,
              HasSubstr("--float"));
  const std::vector<std::string> twice = {"generate", "4ppa-2par", "--language", "c", "-o", folder.path()};
  EXPECT_EQ(pkmopt(twice).exit_code, 0);
  EXPECT_THAT(pkmopt(twice).err, HasSubstr("exists already"));
}

}  // namespace
}  // namespace pkm::testing
