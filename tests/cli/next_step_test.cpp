// Suggestions of the next command, and of the command that was probably meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "engine/report/html_page.hpp"
#include "engine/storage/study_lock.hpp"
#include "tests/cli/study_folder.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

/// Whether this build contains the HTML page of reports.
bool has_page() {
  try {
    page_assets();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

class CliNextStep : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    std::ofstream(path("my study.toml")) << study_with("") << "population = 8\ngenerations = 2\n";
    std::ofstream(path("s.toml")) << study_with("") << "population = 8\ngenerations = 2\n";
  }
};

TEST_F(CliNextStep, EachStepSuggestsTheNextCommand) {
  ASSERT_EQ(run({"new", "mechanism", "delta", "-o", "d.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt check d.toml\n"));
  ASSERT_EQ(run({"check", "d.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt new study d.toml -o study.toml\n"));
  ASSERT_EQ(run({"new", "study", "d.toml", "-o", "study.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt run study.toml\n"));
  ASSERT_EQ(run({"check", "my study.toml", "--limit", "beta_max=70deg"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt run 'my study.toml' --limit beta_max=70deg\n"));
  ASSERT_EQ(run({"run", "my study.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nwritten to my study.h5\nnext: pkmopt report 'my study.h5'\n"));
  ASSERT_EQ(run({"run", "s.toml", "--seeds", "2"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt report s-seed-1.h5 s-seed-2.h5\n"));
}

TEST_F(CliNextStep, SuggestedCommandsAreQuotedForTheShell) {
  const auto shell = [&](const std::string& printed) {
    ChildProcess child({"/bin/sh", "-c", "exec '" PKM_PROGRAM "'" + printed.substr(std::strlen("pkmopt"))}, folder_);
    const int code = child.wait();
    output_ = child.output();
    return code;
  };
  const auto command_after = [this](const std::string& word) {
    const auto at = output_.find(word);
    return at == std::string::npos ? "" : output_.substr(at + word.size(), output_.find('\n', at) - at - word.size());
  };
  for (const std::string stem : {"-x", "--json", "two words", "it's", "a$b;c", "\"q\""}) {
    fs::copy_file(path("s.toml"), path(stem + ".toml"));
    ASSERT_EQ(run({"run", "./" + stem + ".toml", "--time", "1e-9"}), 3) << output_;
    const std::string resume = command_after("resume with: ");
    EXPECT_THAT(resume, ::testing::StartsWith("pkmopt resume "));
    ASSERT_EQ(run({"show", "./" + stem + ".h5"}), 0) << output_;
    EXPECT_EQ(shell(command_after("resume with: ") + " --time 1e-9"), 3) << output_;
    ASSERT_EQ(shell(resume), 0) << resume << output_;
    const std::string report = command_after("next: ");
    EXPECT_THAT(report, ::testing::StartsWith("pkmopt report "));
    EXPECT_EQ(shell(report + " --no-such-option"), 2) << report;
    EXPECT_THAT(output_, HasSubstr("unknown option '--no-such-option'"));
    ASSERT_EQ(run({"new", "study", "4ppa-2par", "-o", "./" + stem + "2.toml"}), 0) << output_;
    EXPECT_EQ(shell(command_after("next: ") + " --time 1e-9 --quiet"), 3) << output_;
    ASSERT_EQ(run({"run", "./" + stem + ".toml", "--seeds", "2", "--time", "1e-9"}), 3) << output_;
    EXPECT_EQ(shell(command_after("resume with: ")), 0) << output_;
  }
  EXPECT_EQ(run({"show", "./-x.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("did you mean 'pkmopt check ./-x.toml'?"));
}

TEST_F(CliNextStep, NewStudyVariesInfluentialParametersOnly) {
  std::ofstream(path("m.toml")) << R"([mechanism]
name = "five-bar"
[parameters]
width  = { default = "20 mm", min = "1 mm", max = "100 mm" }
paint  = { default = "1 mm", min = 0, max = "2 mm" }
cover  = { default = "5 mm", min = 0, max = "20 mm" }
weight = { default = "30 mm", min = 0, max = "50 mm" }
d      = { default = "150 mm", min = 0, max = "4 m" }
l_a    = { default = "250 mm", min = "10 mm", max = "4 m" }
l_b    = { default = "350 mm", min = "10 mm", max = "4 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x", "y"]
box   = { x = ["d - l_a - l_b", "l_a + l_b - d"], y = [0, "l_a + l_b"] }
[[limb]]
name     = "left"
drive    = "crank"
base     = ["-d", 0, 0]
axis     = [0, 0, 1]
zero     = [1, 0, 0]
crank    = "l_a"
rod      = "l_b"
platform = [0, 0, 0]
branch   = "+"
radius   = "width + paint + cover + weight"
[[limb]]
name     = "right"
drive    = "crank"
base     = ["d", 0, 0]
axis     = [0, 0, 1]
zero     = [1, 0, 0]
crank    = "l_a"
rod      = "l_b"
platform = [0, 0, 0]
branch   = "-"
)";
  ASSERT_EQ(run({"new", "study", "m.toml"}), 0) << output_;
  for (const char* varies : {"\nd = {", "\nl_a = {", "\nl_b = {"}) EXPECT_THAT(output_, HasSubstr(varies));
  for (const char* idle : {"width", "paint", "cover", "weight"}) EXPECT_THAT(output_, Not(HasSubstr(idle)));
}

TEST_F(CliNextStep, NewStudyOfAMechanismWithUnboundedCoordinateIsRefused) {
  std::ifstream file(PKM_EXPERIMENTS "/mechanisms/cables/cogiro.toml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto begin = text.find("[survey"), end = text.find("\n[[limb]]", begin);
  ASSERT_NE(begin, std::string::npos);
  std::ofstream(path("m.toml")) << text.erase(begin, end - begin);
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"-o", "new.toml"}}) {
    std::vector<std::string> arguments = {"new", "study", "m.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments), 2);
    EXPECT_EQ(
        output_,
        "pkmopt: m.toml: mechanism cogiro has no [survey] box for z, and its limbs do not bound it; give [survey] "
        "box = { z = [from, to] }, or limit the drives by `range`\n");
  }
  EXPECT_FALSE(fs::exists(path("new.toml")));
}

TEST_F(CliNextStep, ExistingOutputIsReportedAfterAllOtherErrors) {
  for (const char* file : {"x.csv", "x.html", "x.toml", "x.stl", "x.vtkhdf"}) std::ofstream(path(file)) << "mine";
  ASSERT_EQ(run({"run", "s.toml", "-o", "s.h5", "--quiet"}), 0) << output_;
  const std::string five_bar = PKM_EXPERIMENTS "/mechanisms/five-bar.toml";
  const std::string motors = PKM_EXPERIMENTS "/mechanisms/motors/rotary-delta.toml";
  const struct {
    std::vector<std::string> right, wrong;
    std::string sentence;
  } cases[] = {
      {{"new", "study", "4ppa-2par", "-o", "x.toml"}, {"new", "study", "4ppa-2pra", "-o", "x.toml"}, "4ppa-2pra"},
      {{"new", "mechanism", "delta", "-o", "x.toml"}, {"new", "mechanism", "del/ta", "-o", "x.toml"}, "del/ta"},
      {{"report", "s.h5", "-o", "x.html"}, {"report", "s.h5", "none.h5", "-o", "x.html"}, "none.h5"},
      {{"export", "s.h5", "--vtk", "x.vtkhdf"}, {"export", "s.h5", "--vtk", "x.vtkhdf", "--front", "1"}, "--front"},
      {{"workspace", "s.toml", "--csv", "x.csv"}, {"workspace", "s.toml", "--csv", "x.csv", "--cells", "0"}, "--cells"},
      {{"workspace", "s.toml", "--csv", "x.csv"}, {"workspace", "s.toml", "--csv", "x.csv", "--cut", "w=0"}, "--cut"},
      {{"workspace", "s.toml", "--csv", "x.csv"}, {"workspace", "s.toml", "--csv", "x.csv", "--mode", "m"}, "--mode"},
      {{"coupling", "3crr-r-cru", "--cells", "4", "--csv", "x.csv"},
       {"coupling", "3crr-r-cru", "--cells", "4", "--csv", "x.csv", "--mode", "m"},
       "--mode"},
      {{"trajectory", motors, "--motion", "cycle", "-o", "x.csv"},
       {"trajectory", motors, "--motion", "circle", "-o", "x.csv"},
       "circle"},
      {{"trajectory", motors, "--motion", "cycle", "-o", "x.csv"},
       {"trajectory", motors, "--motion", "cycle", "--motors", "none.toml", "-o", "x.csv"},
       "none.toml"},
      {{"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3", "--duration", "0.01", "--step", "1e-3", "-o",
        "x.csv"},
       {"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3", "--duration", "soon", "--step", "1e-3", "-o",
        "x.csv"},
       "soon"},
      {{"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg", "--stl", "x.stl"},
       {"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8", "--stl", "x.stl"},
       "theta"},
      {{"certify", five_bar, "-o", "x.csv"}, {"certify", five_bar, "-o", "x.csv", "--mode", "m"}, "--mode"},
  };
  for (const auto& [right, wrong, sentence] : cases) {
    if (right[0] == "report" && !has_page()) continue;
    EXPECT_EQ(run(right), 1) << right[0];
    EXPECT_THAT(output_, HasSubstr(" exists already; overwrite it with --force")) << right[0];
    EXPECT_NE(run(wrong), 0) << wrong[0];
    EXPECT_THAT(output_, HasSubstr(sentence)) << wrong[0];
    EXPECT_THAT(output_, Not(HasSubstr("exists already"))) << wrong[0];
  }
}

TEST_F(CliNextStep, FilesOnStandardOutputContainNoNextStep) {
  ASSERT_EQ(run({"new", "study", "4ppa-2par"}), 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("next: ")));
}

TEST_F(CliNextStep, WrongKindOfFileSuggestsTheRightCommand) {
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"show", "s.toml"}, "pkmopt check s.toml"},
      {{"resume", "s.toml"}, "pkmopt run s.toml"},
      {{"report", "s.h5", "s.toml"}, "pkmopt run s.toml"},
      {{"export", "s.toml", "--csv", "t"}, "pkmopt workspace s.toml"}};
  for (const auto& [arguments, meant] : cases) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(
        output_,
        "pkmopt: s.toml: found a file in TOML; expected a study file, F.h5, as 'pkmopt run' writes it; did you mean '" +
            meant + "'?\n");
  }
  const std::pair<std::vector<std::string>, std::string> others[] = {
      {{"run", "s.h5"}, "pkmopt resume s.h5"},
      {{"check", "s.h5"}, "pkmopt show s.h5"},
      {{"workspace", "s.h5"}, "pkmopt workspace --from s.h5"}};
  for (const auto& [arguments, meant] : others) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(output_, "pkmopt: s.h5: found a study file; expected a study or a mechanism in TOML; did you mean '" +
                           meant + "'?\n");
  }
}

TEST_F(CliNextStep, MechanismNameInsteadOfAFileSuggestsTheRightCommand) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"run", "4ppa-2par"}, "a study in TOML; did you mean 'pkmopt new study 4ppa-2par'?"},
      {{"check", "4ppa-2par"}, "a study or a mechanism in TOML; did you mean 'pkmopt list mechanisms 4ppa-2par'?"},
      {{"show", "4ppa-2par"}, "a study file, F.h5; did you mean 'pkmopt list mechanisms 4ppa-2par'?"},
      {{"new", "4ppa-2par"}, "one of mechanism, study; did you mean 'pkmopt new study 4ppa-2par'?"}};
  for (const auto& [arguments, expected] : cases) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(output_, "pkmopt: found the mechanism '4ppa-2par'; expected " + expected + '\n');
  }
}

TEST_F(CliNextStep, ShowDistinguishesKilledFromRunningStudies) {
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  StudyContents contents = read("s.h5");
  contents.state = StudyState::running;  // as recorded when the process was killed
  contents.final.reset();
  write_study(path("s.h5"), contents);
  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("s: interrupted, "));
  EXPECT_THAT(output_, EndsWith("\nstudy interrupted; resume with: pkmopt resume s.h5\n"));

  const StudyLock lock(path("s.h5"));
  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("s: running, "));
  EXPECT_THAT(output_, HasSubstr("\nthe study is being run by process " + std::to_string(getpid()) + " "));
}

}  // namespace
}  // namespace pkm::testing
