// `pkmopt upgrade`, refusals of old names, and study files whose texts contain old names.
#include <gmock/gmock.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kOldMechanism = R"([mechanism]
name = "carriage"
[parameters]
l = { default = 1, min = 0.5, max = 2 } # report, certain, hold
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x"]
hold  = { y = 0 }   # the default
box   = { x = [0, "l"] }
[[limb]]
name = "q"
drive = "formula"
joints = { q1 = "x", q2 = "y" }
)";

constexpr const char* kOldStudy = R"(# certain = 1, [[report]]
[mechanism]
file = "m.toml"
[variables]
l = { min = 0.5, max = 2 }
[workspace]
certain = 0.5  # a gap
[[objective]]
type = "workspace-volume"
[[report]]
type = "expression"
name = "report"
expression = "2*l"
unit = "m"
[[stage]]
optimiser = "ga"
population = 4
generations = 2
)";

std::string with_replacement(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}
const std::string kUpgradedMechanism = with_replacement(kOldMechanism, "hold  =", "fixed  =");
const std::string kUpgradedStudy =
    with_replacement(with_replacement(kOldStudy, "\n[[report]]", "\n[[output]]"), "\ncertain", "\ncertified");

class Upgrade : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    write("m.toml", kOldMechanism);
    write("s.toml", kOldStudy);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

TEST_F(Upgrade, RewritesFilesInPlace) {
  EXPECT_EQ(run({"upgrade", "--check", "s.toml", "m.toml"}), 1);
  EXPECT_EQ(output_,
            "s.toml:7: workspace.certain is now called certified\ns.toml:10: report is now called output\n"
            "m.toml:9: survey.hold is now called fixed\n");
  EXPECT_EQ(slurp("s.toml"), kOldStudy);
  EXPECT_EQ(run({"upgrade", "s.toml", "m.toml"}), 0);
  EXPECT_EQ(output_,
            "s.toml:7: workspace.certain is now called certified\ns.toml:10: report is now called output\n"
            "s.toml: rewritten\nm.toml:9: survey.hold is now called fixed\nm.toml: rewritten\n");
  EXPECT_EQ(slurp("s.toml"), kUpgradedStudy);
  EXPECT_EQ(slurp("m.toml"), kUpgradedMechanism);
  const auto written = fs::last_write_time(path("s.toml"));
  EXPECT_EQ(run({"upgrade", "s.toml"}), 0);
  EXPECT_EQ(output_, "s.toml: no change needed\n");
  EXPECT_EQ(fs::last_write_time(path("s.toml")), written);
  EXPECT_EQ(run({"upgrade", "--check", "s.toml", "m.toml"}), 0);
  EXPECT_EQ(run({"check", "s.toml"}), 0) << output_;
}

TEST_F(Upgrade, ChangesNoFileIfOneCannotBeRead) {
  write("wrong.toml", "[workspace");
  EXPECT_EQ(run({"upgrade", "s.toml", "wrong.toml"}), 2);
  EXPECT_EQ(run({"upgrade", "s.toml", "none.toml"}), 2);
  EXPECT_EQ(slurp("s.toml"), kOldStudy);
}

TEST_F(Upgrade, OldNamesAreRefusedWithThePresentOnes) {
  EXPECT_EQ(run({"check", "s.toml"}), 2);
  EXPECT_THAT(output_,
              HasSubstr("s.toml:10: report: the key is now called output; 'pkmopt upgrade s.toml' renames it"));
  write("s.toml", with_replacement(kOldStudy, "\n[[report]]", "\n[[output]]"));
  EXPECT_EQ(run({"check", "s.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("m.toml:9: survey.hold: the key is now called fixed; 'pkmopt upgrade m.toml'"));
  write("m.toml", kUpgradedMechanism);
  EXPECT_EQ(run({"check", "s.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("s.toml:7: workspace.certain: the key is now called certified; 'pkmopt upgrade"));
  EXPECT_EQ(run({"workspace", "m.toml", "--held", "y=0"}), 2);
  EXPECT_THAT(output_, HasSubstr("workspace: the option --held is now called --fixed"));
  EXPECT_EQ(run({"evaluate", "m.toml", "--certain=0.1"}), 2);
  EXPECT_THAT(output_, HasSubstr("evaluate: the option --certain is now called --certified"));
  EXPECT_EQ(run({"pose", "m.toml", "--held=0.1"}), 2);
  EXPECT_THAT(output_, HasSubstr("the unknown option '--held'"));
}

TEST_F(Upgrade, StudyFilesWithOldNamesAreReadAndResumed) {
  ASSERT_EQ(run({"upgrade", "s.toml", "m.toml"}), 0);
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  StudyContents contents = read("s.h5");
  contents.toml = kOldStudy;
  contents.description->text = kOldMechanism;
  contents.text_digest.clear();
  write_study(path("old.h5"), contents);
  ASSERT_EQ(run({"show", "old.h5"}), 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("cannot read")));
  EXPECT_EQ(run({"evaluate", "--from", "old.h5", "--json"}), 0) << output_;
  EXPECT_EQ(run({"run", "s.toml", "--output", "old.h5", "--resume", "--quiet"}), 0) << output_;
  EXPECT_EQ(run({"resume", "old.h5", "--generations", "3", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("old.h5").toml, kOldStudy) << "the recorded text stays";
}

}  // namespace
}  // namespace pkm::testing
