// Files and commands named in README.md must exist.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace pkm::house {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// Files of the repository that a Markdown text names: targets of links, images, and words in shell blocks that begin
/// with one of the source folders.
std::vector<std::string> files_named(const std::string& markdown) {
  static const std::regex link(R"re((?:\]\(|src=")(?!https?:|#)([^)"#\s]+))re");
  static const std::regex word(
      R"((?:^|\s)(?:\./)?((?:engine|objectives|constraints|experiments|tests|benchmarks)/\S*))");
  static const std::regex shell(R"(^\s*```(?:sh|bash|console)?\s*$)");
  std::vector<std::string> names;
  const auto collect = [&names](const std::string& line, const std::regex& pattern) {
    for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it) names.push_back((*it)[1]);
  };
  std::istringstream lines(markdown);
  bool inside = false, in_shell = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("```") != std::string::npos) {
      inside = !inside;
      in_shell = inside && std::regex_match(line, shell);
    } else if (in_shell) {
      collect(line, word);
    } else if (!inside) {
      collect(line, link);
    }
  }
  return names;
}

TEST(Readme, FileNamesAreExtractedFromMarkdown) {
  EXPECT_THAT(
      files_named("See [this](engine/storage/README.md#x) and [that](https://example.org/tests/a).\n"
                  "<img src=\"experiments/a.svg\" width=\"1\">\n"
                  "```sh\n$ tests/run.sh  # all\npkmopt run ./experiments/a.toml\n```\n"
                  "```cpp\n#include \"engine/no.hpp\"\n tests/no\n```\nand tests/not-this\n"),
      UnorderedElementsAre("engine/storage/README.md", "experiments/a.svg", "tests/run.sh", "experiments/a.toml"));
}

TEST(Readme, NamedFilesExistAndCommandsAreExecutable) {
  const fs::path root = PKM_ROOT;
  std::ostringstream text;
  text << std::ifstream(root / "README.md").rdbuf();
  const auto names = files_named(text.str());
  std::vector<std::string> missing;
  for (const auto& name : names)
    if (!fs::exists(root / name)) missing.push_back(name);
  EXPECT_THAT(missing, IsEmpty());
  for (const std::string command : {"experiments/quickstart.sh", "tests/run.sh"}) {
    EXPECT_THAT(names, Contains(command));
    EXPECT_EQ(access((root / command).c_str(), X_OK), 0) << command << " cannot be executed";
  }
}

}  // namespace
}  // namespace pkm::house
