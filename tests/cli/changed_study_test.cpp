// Changes of a study on the command line (--set, --limit, --cells), which are stored in the study file with the study.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "engine/core/catalogue.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::string kFiles = PKM_EXPERIMENTS "/mechanisms";

class ChangedStudy : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    std::ofstream(path("study.toml")) << R"([mechanism]
type = "4ppa-2par"
parameters = { L0 = 1.6 }
[variables]
a = { min = 0.15, max = 0.3 }
b = { min = 0.7, max = 1.5 }
[workspace]
method = "voxels"
cells = { x = 8, z = 8, theta = 8 }
limits = { beta_max = 1.3 }
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "sweep"
points = 4
)";
  }
};

TEST_F(ChangedStudy, ChangesApplyToTheRunAndAreStored) {
  ASSERT_EQ(run({"run", "study.toml", "-o", "plain.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "-o", "new.h5", "--set", "L0=2 m", "--limit", "beta_max=70deg", "--cells", "6"}),
            0)
      << output_;
  EXPECT_THAT(output_, HasSubstr("changed by --set L0=2 m --limit beta_max=70deg --cells 6\n"));
  const StudyContents plain = read("plain.h5"), changed = read("new.h5");
  EXPECT_THAT(changed.toml, HasSubstr("\n# from the command line\n[[override]]\nset = [\"L0=2 m\"]\n"));
  const auto length = [](const StudyContents& study) { return find_named(study.problem.parameters, "L0")->value; };
  EXPECT_EQ(length(plain), 1.6);
  EXPECT_EQ(length(changed), 2);
  ASSERT_TRUE(changed.final && changed.final->best);
  EXPECT_EQ(changed.final->best->cells, 6 * 6 * 6);

  // The stored text is itself a study with the same result.
  std::ofstream(path("stored.toml")) << changed.toml;
  ASSERT_EQ(run({"run", "stored.toml", "-o", "stored.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("stored.h5").final->best->objectives, changed.final->best->objectives);
  ASSERT_EQ(run({"check", "stored.toml", "--cells", "x=5,z=6,theta=7", "--json"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("\"x\": 5"));  // the last change takes precedence
  EXPECT_THAT(output_, HasSubstr("\"beta_max\": 1.22173"));
  ASSERT_EQ(run({"show", "new.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("changed by --set L0=2 m"));
}

TEST_F(ChangedStudy, ResumesOnlyWithTheSameChanges) {
  ASSERT_EQ(run({"run", "study.toml", "-o", "s.h5", "--set", "L0=2", "--quiet"}), 0) << output_;
  EXPECT_EQ(run({"run", "study.toml", "-o", "s.h5", "--set", "L0=2", "--quiet", "--resume"}), 0) << output_;
  const std::string advice = "; continue it with 'pkmopt resume s.h5', or overwrite it with --force\n";
  EXPECT_EQ(run({"run", "study.toml", "-o", "s.h5", "--set", "L0=3", "--quiet", "--resume"}), 1);
  EXPECT_THAT(output_, HasSubstr("s.h5 holds the study with --set L0=2, not with --set L0=3" + advice));
  EXPECT_EQ(run({"run", "study.toml", "-o", "s.h5", "--quiet", "--resume"}), 1);
  EXPECT_THAT(output_, HasSubstr("s.h5 holds the study with --set L0=2, not with no changes" + advice));
  EXPECT_EQ(run({"resume", "s.h5", "--quiet"}), 0) << output_;
}

TEST_F(ChangedStudy, RejectsInvalidChanges) {
  const struct {
    std::vector<std::string> arguments;
    std::string sentence;
  } cases[] = {
      {{"--set", "L=2"}, "--set: found the unknown name 'L'; expected one of a, b, l_u"},
      {{"--set", "a=0.2"},
       "--set: found a, which varies; expected a parameter that is not among the [variables] of study.toml"},
      {{"--set", "L0=2 kg"}, "--set: found L0=2 kg; expected a number in m"},
      {{"--limit", "beta_mx=70deg"}, "did you mean 'beta_max'?"},
      {{"--limit", "beta_max=700deg"}, "--limit: found beta_max=700deg; expected a number in ["},
      {{"--cells", "0"}, "--cells: found x=0; expected a whole number of cells, 1 to 1000000"},
      {{"--cells", "x=4"}, "--cells: found no value for z, theta; expected values for x, z, theta"},
      {{"--cells", "1000"}, "--cells: found 1000000000 cells; expected at most 268435456"},
  };
  for (const auto& [arguments, sentence] : cases) {
    std::vector<std::string> all = {"run", "study.toml"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    EXPECT_EQ(run(all), 2) << sentence;
    EXPECT_THAT(output_, HasSubstr(sentence));
  }
  EXPECT_FALSE(fs::exists(path("study.h5")));
  std::ofstream(path("columns.toml"))
      << "[mechanism]\ntype = \"4ppa-2par\"\n[[objective]]\ntype = \"workspace-volume\"\n"
         "[variables]\na = { min = 0.15, max = 0.3 }\n[[stage]]\noptimiser = \"sweep\"\n";
  EXPECT_EQ(run({"check", "columns.toml", "--cells", "40"}), 2);
  EXPECT_THAT(output_, HasSubstr("--cells: found 40 although the study uses exact columns, which have no cells"));
  EXPECT_EQ(run({"check", kFiles + "/par4.toml", "--cells", "40"}), 2);
  EXPECT_THAT(output_, HasSubstr("--cells 40: this option changes studies only, and the file describes a mechanism"));
}

TEST_F(ChangedStudy, OneNumberOfCellsAppliesToAllAxes) {
  const std::string delta = kFiles + "/rotary-delta.toml";
  const auto printed = [this] { return nlohmann::json::parse(output_); };
  for (const std::string& target : {delta, std::string("study.toml"), std::string("4ppa-2par")}) {
    ASSERT_EQ(run({"workspace", target, "--cells", "7", "--json"}), 0) << output_;
    EXPECT_EQ(printed()["cells"], 343) << output_;
    ASSERT_EQ(run({"evaluate", target, "--cells", "7", "--json"}), 0) << output_;
    EXPECT_EQ(printed()["workspace"]["cells"], 343) << output_;
  }
  ASSERT_EQ(run({"coupling", "3crr-r-cru", "--cells", "5", "--json"}), 0) << output_;
  EXPECT_EQ(printed()["cells"]["x"], 5);
  // --limit also works for mechanism files without a study
  const auto cells = [&](const std::string& limit) {
    EXPECT_EQ(run({"workspace", delta, "--cells", "12", "--limit", limit, "--json"}), 0) << output_;
    return printed()["feasible_cells"].get<int>();
  };
  EXPECT_LT(cells("clear_z=0.3"), cells("clear_z=0"));
  EXPECT_EQ(run({"workspace", kFiles + "/gough.toml", "--limit", "clear_z=0.1"}), 2);
  EXPECT_THAT(output_, HasSubstr("--limit: found the unknown name 'clear_z'; expected one of clearance_min"));
  ASSERT_EQ(run({"pose", delta, "--at", "x=0,y=0,z=-0.45", "--limit", "clear_z=0.6", "--json"}), 0) << output_;
  EXPECT_EQ(printed()["feasible"], false);
}

}  // namespace
}  // namespace pkm::testing
