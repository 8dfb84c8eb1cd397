// Replacement of old names of keys in texts, and the scanner that finds the keys.
#include "engine/config/upgrade.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "engine/config/toml.hpp"
#include "engine/config/toml_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;

/// The paths of all keys: "a.b"; fails if a position does not point at the name.
std::vector<std::string> paths(const std::string& text) {
  std::vector<std::string> all;
  for (const TomlKey& key : find_toml_keys(text)) {
    EXPECT_EQ(text.substr(key.begin, key.size), key.path.back());
    EXPECT_EQ(key.line, 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(key.begin), '\n'));
    all.push_back(join(key.path, "."));
  }
  return all;
}

TEST(TomlKeys, AreFoundInHeadersTablesAndInlineTables) {
  EXPECT_THAT(paths("a = 1\n[b.c]\nd = 2 # e = 3\n[[f]]\n\"g h\" = 'x'\n"),
              ElementsAre("a", "b", "b.c", "b.c.d", "f", "f.g h"));
  EXPECT_THAT(paths("a.b = { c = 1, d = { e = [ { f = 2 }, 3 ] }, g = \"}\" }\nh = 4\n"),
              ElementsAre("a", "a.b", "a.b.c", "a.b.d", "a.b.d.e", "a.b.d.e.f", "a.b.g", "h"));
  EXPECT_THAT(paths("\xEF\xBB\xBF"
                    "a = [ # b = 1\n 1,\n]\r\nc = 2\r\n"),
              ElementsAre("a", "c"));
}

TEST(TomlKeys, AreNotFoundInStrings) {
  EXPECT_THAT(paths("a = \"\"\"\nb = 1\n\"\"\"\"\nc = '''d = 2'''\ne = \"\\\"\\n f = 1\"\ng = '\\'\nh = 1\n"),
              ElementsAre("a", "c", "e", "g", "h"));
}

TEST(TomlKeys, EndInAnyText) {
  std::string text;
  for (const std::string part : {"[", "{", "=", "\"", "\"\"\"", "'", "#", ".", ",", "]", "}", "\n", "a", " "})
    for (const std::string other : {"[", "{", "=", "\"", "'''", "#", ".", ",", "]", "}", "\n", "a"}) {
      text += part + other;
      find_toml_keys(text);
      find_toml_keys(part + other);
    }
}

constexpr const char* kOldStudyText = R"(# [workspace] certain = 1
name = "certain = 1"
[workspace] # certain
  certain   = 1e-2     # the [[report]]
limits = { certain = 1 }
text = """
[[report]]
certain = 2
"""

[[report]]   # first
type = "report"
[[ "report" ]]
report = 1
)";
constexpr const char* kUpgradedStudyText = R"(# [workspace] certain = 1
name = "certain = 1"
[workspace] # certain
  certified   = 1e-2     # the [[report]]
limits = { certain = 1 }
text = """
[[report]]
certain = 2
"""

[[output]]   # first
type = "report"
[[ "output" ]]
report = 1
)";

TEST(Upgrade, ReplacesTheKeysOfAStudyAndNothingElse) {
  const UpgradedText result = upgraded_file(kOldStudyText, "s.toml");
  EXPECT_EQ(result.text, kUpgradedStudyText);
  std::vector<std::string> replaced;
  for (const auto& [line, old_path, name] : result.replaced)
    replaced.push_back(std::to_string(line) + " " + old_path + " " + name);
  EXPECT_THAT(replaced, ElementsAre("4 workspace.certain certified", "11 report output", "13 report output"));
  EXPECT_TRUE(upgraded_file(kUpgradedStudyText, "s.toml").replaced.empty());
}

TEST(Upgrade, ReplacesTheKeysOfAMechanismAndNothingElse) {
  const std::string begin = "[mechanism]\nname = \"hold\"\n";
  EXPECT_EQ(upgraded_file(begin + "[survey]\r\nhold = { hold = 0 } # hold\r\n", "m.toml").text,
            begin + "[survey]\r\nfixed = { hold = 0 } # hold\r\n");
  EXPECT_EQ(upgraded_file(begin + "survey = { sweep = [\"x\"], hold = { phi = 0 } }", "m.toml").text,
            begin + "survey = { sweep = [\"x\"], hold = { phi = 0 } }")
      << "survey is a key of [mechanism] here";
  EXPECT_EQ(upgraded_file("survey.hold.phi = 0\n" + begin, "m.toml").text, "survey.fixed.phi = 0\n" + begin);
  EXPECT_EQ(upgraded_file(begin + "[survey.hold]\nphi = 0", "m.toml").text, begin + "[survey.fixed]\nphi = 0");
  const std::string other = begin + "[[report]]\n[workspace]\ncertain = 1";
  EXPECT_EQ(upgraded_file(other, "m.toml").text, other) << "keys of studies";
}

TEST(Upgrade, RefusesTextThatIsNotTomlAndTablesWithBothNames) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      upgraded_file(text, "s.toml");
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("[workspace]\ncertain = "), ::testing::HasSubstr("s.toml:2: found text that is not TOML"));
  EXPECT_EQ(
      message("[workspace]\ncertified = 1\ncertain = 1"),
      "s.toml:3: workspace.certain: the table also has the key under its present name certified; remove one of them");
}

}  // namespace
}  // namespace pkm
