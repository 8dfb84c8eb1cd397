// `pkmopt resume` with higher limits (--generations, --evaluations) for finished studies.
#include "tests/cli/ga_program.hpp"

namespace pkm::testing {
namespace {

TEST_F(GaProgram, LimitsCanOnlyBeRaised) {
  write_toml(5);
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  const StudyContents before = read("study.h5");
  EXPECT_EQ(run({"resume", "study.h5", "--generations", "10"}), 2);
  EXPECT_EQ(output_, "pkmopt: --generations: found 10; expected at least 20, which the study has already\n");
  EXPECT_EQ(run({"resume", "study.h5", "--evaluations", "30"}), 2);
  EXPECT_EQ(run({"resume", "study.h5", "--generations", "1000000000000"}), 2);
  EXPECT_EQ(first_difference(before, read("study.h5")), "");
  // --evaluations alone removes the limit on generations
  ASSERT_EQ(run({"resume", "study.h5", "--evaluations", "700", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("study.h5").stages[1].table.size(), 700u);
  EXPECT_EQ(read("study.h5").stages[1].stop, "evaluation limit");
}

TEST_F(GaProgram, AnExtensionSurvivesAStopDuringTheReplay) {
  write_toml(40, "");
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--output", "long.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"resume", "long.h5", "--generations", "50", "--quiet"}), 0) << output_;
  EXPECT_EQ(run({"resume", "study.h5", "--generations", "50", "--time", "1e-9"}), 3) << output_;
  EXPECT_EQ(run({"resume", "study.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("long.h5"), read("study.h5")), "");
}

TEST_F(GaProgram, AnExtendedStudyEqualsALongOne) {
  std::ofstream(folder_ + "/short.toml") << R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
b = { min = 1.0, max = 1.5 }
[workspace]
method = "voxels"
[[objective]]
type = "workspace-ratio"
[[stage]]
optimiser = "ga"
population = 12
generations = 10
)";
  ASSERT_EQ(run({"run", "short.toml", "--output", "a.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "short.toml", "--output", "b.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"resume", "a.h5", "--generations", "30"}), 0) << output_;
  ASSERT_EQ(run({"resume", "b.h5", "--generations", "17", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"resume", "b.h5", "--generations", "30", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("a.h5").stages[0].generations.size(), 31u);
  EXPECT_EQ(first_difference(read("a.h5"), read("b.h5")), "");
  // plain resume of a finished study changes nothing
  const auto before = fs::last_write_time(path("a.h5"));
  ASSERT_EQ(run({"resume", "a.h5"}), 0) << output_;
  EXPECT_NE(output_.find("the study is finished; --generations"), std::string::npos);
  EXPECT_EQ(fs::last_write_time(path("a.h5")), before);
}

}  // namespace
}  // namespace pkm::testing
