// Output to a terminal: the same text as to a pipe, coloured if the terminal supports it and colours are not disabled,
// and wrapped at its width.
#include <pty.h>

#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/app/line_wrapping.hpp"
#include "experiments/app/terminal_colours.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kColouredCommand = {
    "pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg", "--limit", "beta_max=10deg"};

/// Runs the program on a pseudo-terminal. @return the output, both stdout and stderr
std::string on_terminal(std::vector<std::string> arguments, const std::map<std::string, std::string>& environment = {},
                        const std::string& folder = ".", unsigned short columns = 0) {
  arguments.insert(arguments.begin(), PKM_PROGRAM);
  std::vector<char*> argv;
  for (const auto& word : arguments) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  int terminal = -1;
  winsize size{};
  size.ws_col = columns;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child < 0) throw std::runtime_error("no pseudo-terminal");
  if (child == 0) {
    unsetenv("NO_COLOR");
    setenv("TERM", "xterm-256color", 1);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    if (chdir(folder.c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  std::string text;
  char part[4096];
  for (ssize_t n; (n = read(terminal, part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(n));
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  std::erase(text, '\r');  // the terminal ends lines with \r\n
  return text;
}

std::string without_colours(const std::string& text) {
  return std::regex_replace(text, std::regex("\x1b\\[[0-9]*m"), "");
}

TEST(CliTerminal, HeadingsAndResultsAreColoured) {
  const std::string text = on_terminal(kColouredCommand);
  EXPECT_THAT(text, HasSubstr("\n\x1b[1mmargins (satisfied if >= 0)\x1b[0m\n"));
  EXPECT_THAT(text, HasSubstr("  \x1b[32msatisfied\x1b[0m\n"));
  EXPECT_THAT(text, HasSubstr("  \x1b[31mviolated\x1b[0m\n"));
  EXPECT_THAT(text, HasSubstr("\x1b[31mno: beta_max is violated\x1b[0m\n"));
  EXPECT_EQ(without_colours(text), pkmopt(kColouredCommand).out);
}

TEST(CliTerminal, NoColoursInPipesOrIfDisabled) {
  const std::string text = pkmopt(kColouredCommand).out;
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_EQ(on_terminal(kColouredCommand, {{"NO_COLOR", "1"}}), text);
  EXPECT_EQ(on_terminal(kColouredCommand, {{"TERM", "dumb"}}), text);
}

TEST(CliTerminal, ErrorsAreRed) {
  EXPECT_THAT(on_terminal({"pose"}), HasSubstr("\x1b[31mpkmopt: \x1b[0mfound no design"));
}

TEST(CliTerminal, ControlCharactersInNamesAreEscaped) {
  const StudyFolder folder;
  folder.write("esc.toml",
               "[study]\nname = \"\\u001b[31mred\"\n[mechanism]\ntype = \"4ppa-2par\"\n[variables]\n"
               "a = { min = 0.1, max = 0.2 }\n[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\n"
               "optimiser = \"sweep\"\n");
  EXPECT_THAT(on_terminal({"check", "esc.toml"}, {}, folder.path()), HasSubstr("\\x1b[31mred"));
}

TEST(Colours, OfTheSummaryOfARun) {
  EXPECT_EQ(coloured("study: finished, 420 evaluations\n"
                     "stage 1: ga, ended: generation limit\n"
                     "\n"
                     "                     best    baseline  gain\n"
                     "  volume        m^3  0.1727  0.0797    +116.60 %\n"
                     "  force         N    12.5    11.25     +11.11 %, worse\n"
                     "\n"
                     "active: R at its lower bound\n"
                     "diagnosis: infeasible: no design reaches it\n"
                     "next: pkmopt report study.h5\n",
                     "pkmopt"),
            "study: finished, 420 evaluations\n"
            "stage 1: ga, ended: generation limit\n"
            "\n"
            "                     \x1b[2mbest\x1b[0m    \x1b[2mbaseline\x1b[0m  \x1b[2mgain\x1b[0m\n"
            "  volume        m^3  0.1727  0.0797    \x1b[32m+116.60 %\x1b[0m\n"
            "  force         N    12.5    11.25     \x1b[31m+11.11 %, worse\x1b[0m\n"
            "\n"
            "\x1b[33mactive:\x1b[0m\x1b[33m R at its lower bound\x1b[0m\n"
            "\x1b[31mdiagnosis:\x1b[0m infeasible: no design reaches it\n"
            "\x1b[2mnext:\x1b[0m\x1b[1m pkmopt report study.h5\x1b[0m\n");
}

TEST(Colours, OfWarningsAndColumnNamesButNotOfJson) {
  EXPECT_EQ(coloured("own: warning: a box is touched\nown: study.toml:3: found\n", "own"),
            "own: \x1b[33mwarning:\x1b[0m a box is touched\n\x1b[31mown: \x1b[0mstudy.toml:3: found\n");
  EXPECT_EQ(coloured("{\n  \"active\": 1,\n  \"next: \": \"yes\"\n}\n", "pkmopt"),
            "{\n  \"active\": 1,\n  \"next: \": \"yes\"\n}\n");
  EXPECT_EQ(coloured("  name  unit  default\n  a     m     0.2\n", "pkmopt"),
            "  \x1b[2mname\x1b[0m  \x1b[2munit\x1b[0m  \x1b[2mdefault\x1b[0m\n  a     m     0.2\n");
}

TEST(LineWrapping, TheSentenceOfARowContinuesBelowItsBeginning) {
  const char* const row = "  a  0.2 m  distance of the platform's two revolute joints\n";
  EXPECT_EQ(wrap_table_rows(row, 40), "  a  0.2 m  distance of the platform's\n            two revolute joints\n");
  EXPECT_EQ(wrap_table_rows(row, 38), "  a  0.2 m  distance of the platform's\n            two revolute joints\n");
  EXPECT_EQ(wrap_table_rows(row, 37),
            "  a  0.2 m  distance of the\n            platform's two revolute\n            joints\n");
  for (const std::size_t columns : {0u, 20u, 58u}) EXPECT_EQ(wrap_table_rows(row, columns), row) << columns;
  EXPECT_EQ(wrap_table_rows("  alpha  \x1b[31mno: 20\u00B0 are too many for it\x1b[0m", 33),
            "  alpha  \x1b[31mno: 20\u00B0 are too many for\n         it\x1b[0m");
}

TEST(LineWrapping, CommandsNumbersAndJsonAreNotWrapped) {
  for (const char* line : {"next: pkmopt run a-study-of-a-long-name.toml  or another one of these\n",
                           "  \"meaning\": \"what is said  in two parts by a text of JSON\"\n",
                           "  0.123456789012  0.123456789012  0.123456789012  0.123456789012\n",
                           "    pkmopt pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg\n"})
    EXPECT_EQ(wrap_table_rows(line, 40), line);
}

TEST(LineWrapping, AtTheWidthOfTheTerminal) {
  const std::vector<std::string> command = {"evaluate", "4ppa-2par"};
  const std::string text = without_colours(on_terminal(command, {}, ".", 80));
  EXPECT_THAT(text, HasSubstr("the links of an\n                           upper connector add"));
  EXPECT_EQ(without_colours(on_terminal(command, {}, ".", 300)), pkmopt(command).out);
  EXPECT_EQ(on_terminal(command, {{"NO_COLOR", "1"}}, ".", 80), text);
}

}  // namespace
}  // namespace pkm::testing
