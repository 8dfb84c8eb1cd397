// Study files whose recorded values or text were changed, with a valid checksum: every command compares text and
// records, and all commands treat such a file in the same way.
#include <gmock/gmock.h>

#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

#include "engine/core/catalogue.hpp"
#include "engine/report/html_page.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kMechanism = R"([mechanism]
name = "five-bar"
[parameters]
d   = { default = "150 mm", min = 0, max = "4 m" }
l_a = { default = "250 mm", min = "10 mm", max = "4 m" }
l_b = { default = "350 mm", min = "10 mm", max = "4 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x", "y"]
box   = { x = [-1, 1], y = [0, "l_a + l_b"] }
[[limb]]
name = "left"
drive = "crank"
base = ["-d", 0, 0]
axis = [0, 0, 1]
zero = [1, 0, 0]
crank = "l_a"
rod = "l_b"
platform = [0, 0, 0]
branch = "+"
[[limb]]
name = "right"
drive = "crank"
base = ["d", 0, 0]
axis = [0, 0, 1]
zero = [1, 0, 0]
crank = "l_a"
rod = "l_b"
platform = [0, 0, 0]
branch = "-"
)";

constexpr const char* kStudyText = R"([mechanism]
file = "five-bar.toml"
parameters = { d = 0.16 }
[variables]
l_a = { min = 0.2, max = 0.3 }
l_b = { min = 0.3, max = 0.8 }
[baseline]
l_a = 0.25
l_b = 0.5
[workspace]
method = "voxels"
cells = { x = 12, y = 12 }
[[objective]]
type = "workspace-volume"
[[constraint]]
type = "expression"
name = "width"
expression = "0.5 - l_a"
unit = "m"
[[stage]]
optimiser = "ga"
population = 6
generations = 2
)";

class RecordedStudy : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    std::ofstream(path("five-bar.toml")) << kMechanism;
    std::ofstream(path("study.toml")) << kStudyText;
    ASSERT_EQ(run({"run", "study.toml", "-o", "unchanged.h5", "--quiet"}), 0) << output_;
    unchanged_ = read("unchanged.h5");
  }
  void change(const std::function<void(StudyContents&)>& change) {
    StudyContents contents = unchanged_;
    change(contents);
    write_study(path("s.h5"), contents);
  }
  /// Commands that evaluate a design of a study file again.
  static std::vector<std::vector<std::string>> evaluating() {
    return {{"evaluate", "--from", "s.h5"},
            {"workspace", "--from", "s.h5"},
            {"pose", "--from", "s.h5", "--at", "x=0,y=0.5"},
            {"forward", "--from", "s.h5", "--joints", "left=120deg,right=60deg"},
            {"export", "s.h5", "--vtk", "w.vtkhdf", "--force"}};
  }
  /// Commands that show what a study file records.
  static std::vector<std::vector<std::string>> showing() {
    std::vector<std::vector<std::string>> all = {{"show", "s.h5"}, {"export", "s.h5", "--csv", "tables", "--force"}};
    try {
      page_assets();
      all.push_back({"report", "s.h5", "--force"});
    } catch (const std::exception&) {  // this build has no page
    }
    return all;
  }
  StudyContents unchanged_;
};

TEST_F(RecordedStudy, UnchangedFilesGiveNoWarning) {
  change([](StudyContents&) {});
  for (auto commands : {evaluating(), showing(), {{"resume", "s.h5"}}})
    for (const auto& command : commands) {
      EXPECT_EQ(run(command), 0) << command[0] << output_;
      EXPECT_THAT(output_, Not(::testing::AnyOf(HasSubstr("warning: s.h5"), HasSubstr("note:")))) << command[0];
    }
}

TEST_F(RecordedStudy, ChangedValuesAreUsedWithOneWarning) {
  const struct {
    std::function<void(StudyContents&)> change;
    std::string sentence;
  } cases[] = {
      {[](StudyContents& c) { c.problem.parameters[0].value = 0.17; },
       "it records d = 0.17 m, but its text gives 0.16 m in this program"},
      {[](StudyContents& c) { c.problem.variables[0].lower = 0.15; },
       "it records variables.l_a.min = 0.15 m, but its text gives 0.2 m in this program"},
      {[](StudyContents& c) { c.problem.variables[1].upper = 0.9; },
       "it records variables.l_b.max = 0.9 m, but its text gives 0.8 m in this program"},
      {[](StudyContents& c) { c.problem.variables[1].step = 0.1; },
       "it records variables.l_b.step = 0.1 m, but its text gives 0 m in this program"},
      {[](StudyContents& c) { c.stages[0].options[0] += "9"; }, " of stage 1, but its text gives "},
  };
  for (const auto& [forge, sentence] : cases) {
    change(forge);
    for (auto commands : {evaluating(), showing()})
      for (const auto& command : commands) {
        EXPECT_EQ(run(command), 0) << command[0] << output_;
        const auto at = output_.find("pkmopt: warning: s.h5: it records ");
        ASSERT_NE(at, std::string::npos) << command[0] << output_;
        const std::string line = output_.substr(at, output_.find('\n', at) - at);
        EXPECT_THAT(line, HasSubstr(sentence)) << command[0];
        EXPECT_TRUE(line.ends_with("; the recorded values are used")) << line;
        EXPECT_EQ(output_.find("pkmopt: warning: s.h5", at + 1), std::string::npos) << output_;
      }
    for (const std::vector<std::string>& command : {std::vector<std::string>{"resume", "s.h5"},
                                                    {"resume", "s.h5", "--generations", "3"},
                                                    {"run", "study.toml", "-o", "s.h5", "--resume"}}) {
      EXPECT_EQ(run(command), 1) << output_;
      EXPECT_THAT(output_, HasSubstr("pkmopt: s.h5: cannot be continued: it records ")) << command[0];
      EXPECT_THAT(output_, HasSubstr(sentence)) << command[0];
    }
  }
  change(cases[0].change);
  ASSERT_EQ(run({"evaluate", "--from", "s.h5", "--json"}), 0);
  EXPECT_EQ(Json::parse(output_.substr(output_.find('{')))["parameters"]["d"], 0.17);
  ASSERT_EQ(run({"evaluate", "--from", "s.h5", "--baseline", "--json"}), 0);
  EXPECT_EQ(Json::parse(output_.substr(output_.find('{')))["parameters"]["d"], 0.17);
}

TEST_F(RecordedStudy, ChangedTextsAndNamesAreRefusedByCommandsThatEvaluate) {
  const auto replace = [](std::string& text, const std::string& old, const std::string& with) {
    ASSERT_NE(text.find(old), std::string::npos) << old;
    text.replace(text.find(old), old.size(), with);
  };
  const std::function<void(StudyContents&)> cases[] = {
      [&](StudyContents& c) { replace(c.toml, "d = 0.16", "d = 0.17"); },
      [&](StudyContents& c) { replace(c.toml, "max = 0.3", "max = 0.4"); },
      [&](StudyContents& c) { replace(c.toml, "\"0.5 - l_a\"", "\"0.4 - l_a\""); },
      [&](StudyContents& c) { replace(c.toml, "workspace-volume", "conditioning"); },
      [&](StudyContents& c) { c.toml += "[[override]]\ncells = [\"20\"]\n"; },
      [&](StudyContents& c) { replace(c.description->text, "[-1, 1]", "[-1, 0.9]"); },
      [](StudyContents& c) { c.problem.objectives[0].direction = Direction::minimise; },
      [](StudyContents& c) { c.problem.objectives[0].name = "area"; },
      [](StudyContents& c) { c.problem.margins[0].name = "breadth"; },
      [](StudyContents& c) { c.problem.parameters[0].name = "reach"; },
  };
  const std::string sentence = "the text of the study does not match the recorded problem: ";
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    change(cases[i]);
    for (const auto& command : evaluating()) {
      EXPECT_EQ(run(command), 1) << i << command[0] << output_;
      EXPECT_THAT(output_, HasSubstr("pkmopt: s.h5: " + sentence)) << i << command[0];
    }
    for (const auto& command : showing()) {
      EXPECT_EQ(run(command), 0) << i << command[0] << output_;
      EXPECT_THAT(output_, HasSubstr("note: ")) << i << command[0];
      EXPECT_THAT(output_, HasSubstr(sentence)) << i << command[0];
    }
    EXPECT_EQ(run({"resume", "s.h5", "--generations", "3"}), 1) << i << output_;
    EXPECT_THAT(output_, HasSubstr("s.h5: cannot be continued: " + sentence)) << i;
  }
}

}  // namespace
}  // namespace pkm::testing
