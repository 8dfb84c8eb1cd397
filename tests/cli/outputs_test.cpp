// The option -o of all commands that write a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

namespace fs = std::filesystem;

TEST(CliOutputs, ShortAndLongOptionWriteTheSameFile) {
  const StudyFolder folder;
  const std::vector<std::string> commands[] = {
      {"coupling", "3crr-r-cru", "--cells", "4", "--csv"},
      {"trajectory", "3crr-r-cru", "--motion", PKM_EXPERIMENTS "/3crr-r-cru/motions/pick-and-place.toml", "--csv"},
      {"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3", "--forces", "rho3=8", "--duration", "10ms",
       "--step", "1ms", "--csv"},
      {"certify", PKM_EXPERIMENTS "/mechanisms/orthoglide.toml", "--gap", "0.5", "--proof"},
      {"tolerances", PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--box", "x=0:1mm,y=300mm:301mm", "--csv"},
      {"workspace", "4ppa-2par", "--cells", "6", "--csv"},
  };
  const auto read = [&](const std::string& name) {
    std::ifstream in(folder.path() + "/" + name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (std::vector<std::string> command : commands) {
    const std::string name = command[0] + ".csv";
    command.push_back("long-" + name);
    const auto by_long = pkmopt(command, folder.path());
    EXPECT_EQ(by_long.exit_code, 0) << by_long.err;
    command.end()[-2] = "-o";
    command.back() = name;
    const auto by_short = pkmopt(command, folder.path());
    EXPECT_EQ(by_short.exit_code, 0) << by_short.err;
    EXPECT_NE(read(name), "");
    EXPECT_EQ(read(name), read("long-" + name)) << command[0];
  }
}

TEST(CliOutputs, ExtensionSelectsTheFormat) {
  const StudyFolder folder;
  const std::vector<std::string> plain = {"workspace", "4ppa-2par", "--cells", "8"};
  auto both = plain;
  both.insert(both.end(), {"-o", "w.vtkhdf", "-o", "w.stl"});
  const auto result = pkmopt(both, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::is_regular_file(folder.path() + "/w.vtkhdf"));
  EXPECT_TRUE(fs::is_regular_file(folder.path() + "/w.stl"));

  const auto refusal = [&](const std::vector<std::string>& more) {
    auto words = plain;
    words.insert(words.end(), more.begin(), more.end());
    const auto refused = pkmopt(words, folder.path());
    EXPECT_EQ(refused.exit_code, 2);
    return refused.err;
  };
  EXPECT_EQ(
      refusal({"-o", "w.dat"}),
      "pkmopt: -o: found 'w.dat'; expected a file name that ends in one of .csv, .html, .png, .stl, .svg, .vtkhdf\n");
  EXPECT_EQ(refusal({"--csv", "a.csv", "-o", "b.csv"}),
            "pkmopt: -o: found 'b.csv' in addition to 'a.csv'; expected one file per extension\n");
}

TEST(CliOutputs, ManualPagesAndCompletionContainTheShortOption) {
  EXPECT_THAT(pkmopt({"manual", "run"}).out, ::testing::HasSubstr("\n.B \\-o, \\-\\-output F.h5\n"));
  EXPECT_THAT(pkmopt({"completion", "bash"}).out, ::testing::HasSubstr("'run -o'"));
}

}  // namespace
}  // namespace pkm::testing
