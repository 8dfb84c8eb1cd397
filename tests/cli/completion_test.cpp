// Shell completion scripts and manual pages contain all declared commands and options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::run_program;
using ::testing::UnorderedElementsAre;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The completions that bash offers for the last of the words, in a folder.
std::vector<std::string> offered(const std::vector<std::string>& words, const std::string& folder) {
  std::string list;
  for (const std::string& word : words) list += " '" + word + "'";
  const auto result = run_program(
      {"/bin/bash", "-c",
       "compopt() { :; }; eval \"$('" PKM_PROGRAM "' completion bash)\"; COMP_WORDS=(" + list +
           "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; _pkmopt; printf '%s\\n' \"${COMPREPLY[@]}\""},
      folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return lines_of(result.out);
}

TEST(Completion, BashOffersCommandsOptionsNamesAndFiles) {
  const testing::StudyFolder folder;
  for (const char* const name : {"a.toml", "b.h5", "c.txt"}) folder.write(name, "\n");
  const std::string& here = folder.path();
  std::filesystem::create_directory(here + "/deeper");
  EXPECT_THAT(offered({"pkmopt", "re"}, here), UnorderedElementsAre("resume", "report"));
  EXPECT_THAT(offered({"pkmopt", "run", "--see"}, here), UnorderedElementsAre("--seed", "--seeds"));
  EXPECT_THAT(offered({"pkmopt", "run", "--instruction-set", "avx"}, here), UnorderedElementsAre("avx2", "avx512"));
  EXPECT_THAT(offered({"pkmopt", "run", ""}, here),
              AllOf(Contains("a.toml"), Contains("deeper"), Not(Contains("b.h5"))));
  EXPECT_THAT(offered({"pkmopt", "show", ""}, here), AllOf(Contains("b.h5"), Not(Contains("a.toml"))));
  EXPECT_THAT(offered({"pkmopt", "pose", "3crr"}, here), ElementsAre("3crr-r-cru"));
  EXPECT_THAT(offered({"pkmopt", "pose", "a"}, here), ElementsAre("a.toml"));
  EXPECT_THAT(offered({"pkmopt", "new", ""}, here), UnorderedElementsAre("mechanism", "study"));
}

TEST(Completion, BashOffersNamesOfParametersAndLimits) {
  const testing::StudyFolder folder;
  folder.write("s.toml", testing::study_with(""));
  for (const std::string robot : {"4ppa-2par", "s.toml"}) {
    EXPECT_THAT(offered({PKM_PROGRAM, "evaluate", robot, "--set", "l_"}, folder.path()),
                UnorderedElementsAre("l_u=", "l_d="));
    EXPECT_THAT(offered({PKM_PROGRAM, "pose", robot, "--limit", "beta"}, folder.path()),
                UnorderedElementsAre("beta_min=", "beta_max="));
    // bash divides a=1,b=2,l_ into words at each =
    EXPECT_THAT(offered({PKM_PROGRAM, "evaluate", robot, "--set", "a", "=", "1,b", "=", "2,l_"}, folder.path()),
                UnorderedElementsAre("2,l_u=", "2,l_d="));
    EXPECT_THAT(offered({PKM_PROGRAM, "evaluate", robot, "--set", "a", "=", "1"}, folder.path()), ElementsAre(""));
  }
  EXPECT_THAT(offered({PKM_PROGRAM, "evaluate", "none.toml", "--set", ""}, folder.path()), ElementsAre(""));
}

TEST(Completion, ZshAndFishScriptsHaveEveryOption) {
  for (const std::string shell : {"zsh", "fish"}) {
    const auto result = run_program({PKM_PROGRAM, "completion", shell});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* const word : {"resume", "generations", "instruction-set", "4ppa-2par", "vtk"})
      EXPECT_THAT(result.out, HasSubstr(word)) << shell;
    const std::string path = "/usr/bin/" + shell;
    if (!std::filesystem::exists(path)) continue;
    const testing::StudyFolder folder;
    const auto checked = run_program({path, "-n", folder.write("script", result.out)});
    EXPECT_EQ(checked.exit_code, 0) << shell << ": " << checked.err;
  }
}

/// A folder with files of several extensions, in which command lines are completed.
struct FilesToComplete : testing::StudyFolder {
  FilesToComplete() {
    for (const char* const name : {"a.toml", "b.h5", "c.txt"}) write(name, "\n");
    std::filesystem::create_directory(path() + "/deeper");
  }
};

TEST(Completion, FishCompletesCommandsOptionsNamesAndFiles) {
  const std::string fish = "/usr/bin/fish";
  if (!std::filesystem::exists(fish)) GTEST_SKIP() << "fish is not installed";
  const FilesToComplete folder;
  const auto completed = [&](const std::string& line) {
    const std::string script = "set -x PATH (path dirname " PKM_PROGRAM
                               ") $PATH; pkmopt completion fish | source; "
                               "complete -C '" +
                               line + "' | string replace -r '\t.*' ''";
    const auto result = run_program({fish, "--no-config", "-c", script}, folder.path());
    EXPECT_EQ(result.err, "") << line;
    return lines_of(result.out);
  };
  EXPECT_THAT(completed("pkmopt re"), UnorderedElementsAre("report", "resume"));
  EXPECT_THAT(completed("pkmopt --ver"), ElementsAre("--version"));
  EXPECT_THAT(completed("pkmopt help re"), UnorderedElementsAre("report", "resume"));
  EXPECT_THAT(completed("pkmopt run --see"), UnorderedElementsAre("--seed", "--seeds"));
  EXPECT_THAT(completed("pkmopt run "), UnorderedElementsAre("a.toml", "deeper/"));
  EXPECT_THAT(completed("pkmopt show "), UnorderedElementsAre("b.h5", "deeper/"));
  EXPECT_THAT(completed("pkmopt pose 3crr"), ElementsAre("3crr-r-cru"));
  EXPECT_THAT(completed("pkmopt new me"), ElementsAre("mechanism"));
  EXPECT_THAT(completed("pkmopt evaluate 4ppa-2par --set l_"), UnorderedElementsAre("l_u=", "l_d="));
  EXPECT_THAT(completed("pkmopt pose 4ppa-2par --limit beta"), UnorderedElementsAre("beta_min=", "beta_max="));
  EXPECT_THAT(completed("pkmopt evaluate 4ppa-2par --set a=1,b=2,l_"),
              UnorderedElementsAre("a=1,b=2,l_u=", "a=1,b=2,l_d="));
}

TEST(Completion, ZshCompletesCommandsOptionsNamesAndFiles) {
  const std::string zsh = "/usr/bin/zsh";
  if (!std::filesystem::exists(zsh)) GTEST_SKIP() << "zsh is not installed";
  const FilesToComplete folder;
  const auto result =
      run_program({zsh, "-f", PKM_TEST_DATA "/../cli/zsh_completion.zsh", PKM_PROGRAM, "pkmopt re", "pkmopt --ver",
                   "pkmopt help sim", "pkmopt run --liv", "pkmopt show ", "pkmopt pose 3cr", "pkmopt new ",
                   "pkmopt new study 3cr", "pkmopt evaluate 4ppa-2par --set l_",
                   "pkmopt pose 4ppa-2par --limit beta_mi", "pkmopt evaluate 4ppa-2par --set a=1,b=2,lambda_u"},
                  folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // The matches are listed before the line, if there are several.
  for (const char* const expected :
       {"report  -- Write the results", "resume  -- Resume a stopped study", "[pkmopt re]", "[pkmopt --version ]",
        "[pkmopt help simulate ]", "[pkmopt run --live ]", "b.h5     deeper/", "[pkmopt pose 3crr-r-cru ]",
        "mechanism  study", "[pkmopt new study 3crr-r-cru ]", "l_d=  l_u=", "[pkmopt pose 4ppa-2par --limit beta_min=]",
        "[pkmopt evaluate 4ppa-2par --set a=1,b=2,lambda_u=]"})
    EXPECT_THAT(result.out, HasSubstr(expected));
  EXPECT_THAT(result.out, Not(HasSubstr("_arguments")));  // an error message of zsh
}

TEST(Completion, UnknownShellIsRejectedWithTheClosestName) {
  const auto result = run_program({PKM_PROGRAM, "completion", "bsh"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "pkmopt: completion: found the unknown shell 'bsh'; expected one of bash, zsh, fish; did you mean "
            "'bash'?\n");
}

TEST(Manual, HasAPageForEveryCommandWithEveryOption) {
  const testing::StudyFolder folder;
  const auto result = run_program({PKM_PROGRAM, "manual", "--into", folder.path() + "/man"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> pages;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() + "/man"))
    pages.push_back(entry.path().filename().string());
  EXPECT_THAT(pages, IsSupersetOf({"pkmopt.1", "pkmopt-run.1", "pkmopt-manual.1", "pkmopt-workspace.1"}));
  EXPECT_THAT(run_program({PKM_PROGRAM, "manual"}).out,
              AllOf(HasSubstr("pkmopt\\-run"), HasSubstr("Exit codes"), HasSubstr("paper\\-problem.toml")));
  EXPECT_THAT(run_program({PKM_PROGRAM, "manual", "workspace"}).out,
              AllOf(HasSubstr("\\-\\-vtk F.vtkhdf"), HasSubstr(".SH SEE ALSO")));
}

}  // namespace
}  // namespace pkm
