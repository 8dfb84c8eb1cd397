// Studies of mechanisms from files: those that are shipped are right, and a run ends with the same bits however it is
// run.
#include "tests/cli/study_program.hpp"

#include <fstream>

namespace pkm::testing {
namespace {

const std::string kShipped = PKM_EXPERIMENTS "/mechanisms";

class DescribedStudy : public StudyProgram {};

TEST_F(DescribedStudy, EveryShippedMechanismHasOneThatChecks) {
  int mechanisms = 0;
  for (const auto& entry : fs::directory_iterator(kShipped)) {
    if (entry.path().extension() != ".toml") continue;
    ++mechanisms;
    const std::string study = kShipped + "/studies/" + entry.path().filename().string();
    EXPECT_EQ(run({"check", study}), 0) << output_;
    EXPECT_EQ(output_.find("warning"), std::string::npos) << study << output_;
  }
  EXPECT_EQ(mechanisms, 12);
}

TEST_F(DescribedStudy, EndsWithTheSameBitsOnAnyThreadsAndInstructionSetAndAfterKills) {
  std::ofstream(path("study.toml")) << "[mechanism]\nfile = \"" << kShipped << R"(/linear-delta.toml"
[variables]
R = { min = 0.2, max = 0.4 }
r = { min = 0.03, max = 0.1 }
l = { min = 0.4, max = 0.8 }
[workspace]
method = "voxels"
cells = { x = 10, y = 10, z = 10 }
[[objective]]
type = "workspace-ratio"
[[report]]
type = "conditioning"
[[stage]]
optimiser = "ga"
population = 10
generations = 12
[checkpoint]
every = 0
)";
  const auto run_as = [&](const std::string& file, std::vector<std::string> how) {
    how.insert(how.begin(), {"run", "study.toml", "--quiet", "--output", file});
    ASSERT_EQ(run(how), 0) << output_;
  };
  run_as("one.h5", {"--threads", "1"});
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--threads", "2"}, {"--threads", "3", "--instruction-set", "baseline"}}) {
    run_as("other.h5", how);
    EXPECT_EQ(first_difference(read("one.h5"), read("other.h5")), "") << how[1] << " threads";
    fs::remove(path("other.h5"));
  }
  kill_at_random(3, 40);
  EXPECT_EQ(first_difference(read("one.h5"), read("straight.h5")), "");
}

/// Of what is sampled; the start of the last is a point of the trade-off.
TEST_F(DescribedStudy, EndsAtTheOptimumOfWhatColumnsSample) {
  const std::string problem = "[mechanism]\nfile = \"" + kMechanisms + R"(/3-rpr.toml"
[variables]
B1x = { min = -0.15, max = -0.05 }
B2x = { min = 0.05, max = 0.15 }
[workspace]
method = "columns"
)";
  const auto expect_optimal = [&](const std::string& name, const std::string& study) {
    SCOPED_TRACE(name);
    std::ofstream(path("study.toml")) << problem << study;
    ASSERT_EQ(run({"run", "study.toml", "--quiet", "--output", name + ".h5"}), 0) << output_;
    const StageRecord& stage = read(name + ".h5").stages.back();
    ASSERT_FALSE(stage.starts.empty());
    for (const auto& start : stage.starts) EXPECT_LT(start.optimality, 1e-6) << start.message;
  };
  const std::string slsqp = "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"slsqp\"\n";
  expect_optimal("conditioning", "[[objective]]\ntype = \"conditioning\"\n" + slsqp);
  expect_optimal("coupling", "[[objective]]\ntype = \"dci-uniformity\"\nlimb = \"1\"\n" + slsqp);
  expect_optimal("inertia", "[[objective]]\ntype = \"inertia-condition\"\n[[stage]]\noptimiser = \"ipopt\"\n");
  expect_optimal("front",
                 "[[objective]]\ntype = \"conditioning\"\n[[objective]]\ntype = \"inertia-condition\"\n"
                 "[[stage]]\noptimiser = \"nsga2\"\npopulation = 12\ngenerations = 2\n" +
                     slsqp + "start = \"pareto\"\nstarts = 2\n");
}

}  // namespace
}  // namespace pkm::testing
