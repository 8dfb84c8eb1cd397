// Fuzz test of error messages: for any arguments and any study they are at most 2 kB long, printable, and free of texts
// of the standard library.
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/storage/study_file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

constexpr std::size_t kMaxMessage = 2048;  // bytes

/// Runs the program and checks its error message.
/// @return the defect of the message; "" if there is none
std::string fault_of(const std::vector<std::string>& arguments, const std::string& folder = ".") {
  const ProgramResult result = pkmopt(arguments, folder);
  const std::string start = result.err.substr(0, 300);
  if (result.exit_code < 0 || result.exit_code > 3)
    return "exit code " + std::to_string(result.exit_code) + ": " + start;
  if (result.exit_code != 0 && result.err.empty()) return "no message";
  if (result.err.size() > kMaxMessage) return std::to_string(result.err.size()) + " bytes: " + start;
  for (const char* const raw : {"std::", "_M_", "basic_string", "filesystem error", "stoi", "stod", "internal error"})
    if (result.err.find(raw) != std::string::npos) return result.err;
  for (const char c : result.err)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return "control characters: " + start;
  return "";
}

#ifndef PKM_SANITIZED  // sanitized runs take ten times as long
/// Selects one of five messages, so that each of the three, six or seven kinds that alternate is tested. If the
/// environment variable PKM_EVERY_MESSAGE is set, all messages are selected.
bool is_chosen() {
  static const bool are_all = std::getenv("PKM_EVERY_MESSAGE") != nullptr;
  static unsigned count = 0;
  return are_all || count++ % 5 == 0;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), none; match != none; ++match)
    found.insert((*match)[1]);
  return {found.begin(), found.end()};
}

// The arguments are below the 128 KiB to which Linux limits a single argument.
TEST(CliMessages, AreShortWhateverTheArguments) {
  std::string list;
  while (list.size() < 100'000) list += "x=1mm,";
  const std::string word(100'000, 'k'), digits(100'000, '9');
  const StudyFolder folder;
  const auto expect_short = [&folder](const std::vector<std::string>& arguments) {
    std::string shown;
    for (const std::string& argument : arguments) shown += argument.substr(0, 20) + ' ';
    if (!is_chosen()) return;
    EXPECT_EQ(fault_of(arguments, folder.path()), "") << shown;
  };
  const std::vector<std::string> commands = matches(pkmopt({"--help"}).out, "\n  ([a-z]+) ");
  ASSERT_GT(commands.size(), 10u);
  for (const std::string& much : {word, list, "--" + word, "../" + word, word.substr(0, 250)}) expect_short({much});
  for (const std::string& command : commands) {
    for (const std::string& much : {word, "--" + word, "-" + word, word + ".toml", word.substr(0, 250)})
      expect_short({command, much});
    expect_short({command, word, word, word, word, word, word, word, word, word, word});
    const std::vector<std::string> options = matches(pkmopt({command, "--help"}).out, "(--[a-z-]+)");
    ASSERT_FALSE(options.empty());
    for (const std::string& option : options) {
      expect_short({command, "4ppa-2par", option, word});
      expect_short({command, "4ppa-2par", option, list});
      expect_short({command, option + "=" + digits, "none"});
    }
  }
}

const char* const kAllTables = R"([study]
name = "all tables"
seed = 3
output = "s.h5"
[mechanism]
type = "4ppa-2par"
masses = "geometry"
[mechanism.parameters]
d = 0.15
[variables]
a = { min = 0.15, max = 0.3 }
[baseline]
a = 0.2
[workspace]
method = "columns"
nodes = { x = 8, theta = 8 }
limits = { beta_max = 1.2 }
[[region]]
name = "middle"
method = "columns"
nodes = { x = 8, theta = 8 }
[[motion]]
name = "across"
type = "points"
points = [{ x = 0.4, y = 1.25, z = -1.0, theta = 0 }, { z = -0.95 }]
time = 0.5
[[objective]]
type = "expression"
expression = "volume/a"
direction = "maximise"
unit = "m"
[[constraint]]
type = "linear"
coefficients = { a = 1 }
bound = 0.5
[[output]]
type = "conditioning"
statistic = "mean"
[[reference]]
name = "a paper"
design = { a = 0.2 }
[[stage]]
optimiser = "ga"
population = 8
generations = 3
crossover = "sbx"
[[stage]]
optimiser = "ipopt"
options = { mu_strategy = "adaptive" }
[final]
round = 0.05
[checkpoint]
every = 0
)";

TEST(CliMessages, AreShortWhateverTheStudy) {
  const std::string much(1 << 17, 'k');
  std::vector<std::string> lines;
  std::istringstream text(kAllTables);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const StudyFolder folder;
  const auto expect_short = [&](std::size_t at, const std::string& line) {
    if (!is_chosen()) return;
    std::string study;
    for (std::size_t i = 0; i < lines.size(); ++i) study += (i == at ? line : lines[i]) + "\n";
    folder.write("much.toml", study);
    EXPECT_EQ(fault_of({"check", "much.toml"}, folder.path()), "") << lines[at] << " as " << line.substr(0, 40);
  };
  folder.write("sound.toml", kAllTables);
  ASSERT_EQ(pkmopt({"check", "sound.toml"}, folder.path()).err, "");
  for (std::size_t at = 0; at < lines.size(); ++at) {
    const std::size_t equals = lines[at].find(" = "), brace = lines[at].find('{');
    if (equals == std::string::npos) {
      expect_short(at, lines[at].starts_with("[[") ? "[[" + much + "]]" : "[" + much + "]");
      continue;
    }
    const std::string key = lines[at].substr(0, equals), value = lines[at].substr(equals + 3);
    expect_short(at, much + " = " + value);
    expect_short(at, key + " = \"" + much + "\"");
    if (brace != std::string::npos) expect_short(at, key + " = { " + much + " = 1 }");
    expect_short(at, key + " = [\"" + much + "\"]");
    expect_short(at, key + " = " + std::string(much.size(), '9'));
    expect_short(at, key + " = \"" + much);
    expect_short(at, key + " = '" + std::string(much.size(), '(') + "'");
  }
}
#endif

// Warnings and notes, too: about a study file whose text cannot be read, and with a very long name.
TEST(CliMessages, WarningsAndNotesAreShort) {
  const StudyFolder folder;
  const std::string much(1 << 17, 'n');
  folder.write("s.toml",
               "[study]\nname = \"" + much + "\"\noutput = \"s.h5\"\n[mechanism]\ntype = \"4ppa-2par\"\n" +
                   "[variables]\na = { min = 0.15, max = 0.3 }\n[workspace]\nmethod = \"voxels\"\n" +
                   "cells = { x = 6, z = 6, theta = 6 }\n" + "[[reference]]\nname = \"" + much +
                   "\"\ndesign = { a = 0.2 }\n" +
                   "[[objective]]\ntype = \"workspace-ratio\"\n[[stage]]\noptimiser = \"sweep\"\npoints = 2\n");
  const auto expect_short = [&folder](const std::vector<std::string>& arguments) {
    EXPECT_EQ(fault_of(arguments, folder.path()), "") << arguments[0];
  };
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"check", "s.toml"},
                                                    {"run", "s.toml"},
                                                    {"resume", "s.h5"},
                                                    {"show", "s.h5"},
                                                    {"evaluate", "--from", "s.h5"},
                                                    {"workspace", "--from", "s.h5"},
                                                    {"export", "s.h5", "--csv", "."},
                                                    {"run", "s.toml"}})
    expect_short(arguments);
  ASSERT_TRUE(std::filesystem::exists(folder.path() + "/s.h5"));
  StudyContents unreadable = read_study(folder.path() + "/s.h5");
  unreadable.toml = "[study]\nname = \"" + much + "\"\n[" + much + "]\n";
  unreadable.text_digest.clear();  // as in files before schema 5
  write_study(folder.path() + "/s.h5", unreadable, Existing::replaced);
  std::string path;
  while (path.size() < 3000) path += "./";
  for (const std::string command : {"show", "report", "export", "resume"}) expect_short({command, path + "s.h5"});
}

}  // namespace
}  // namespace pkm::testing
