// Studies of mechanism files: the shipped studies are valid, runs are bit-identical under all conditions, and gradient
// solvers reach optima of sampled objectives.
#include "tests/cli/study_program.hpp"

#include <fstream>

namespace pkm::testing {
namespace {

const std::string kShipped = PKM_EXPERIMENTS "/mechanisms";

class MechanismFileStudy : public StudyProgram {};

TEST_F(MechanismFileStudy, EveryShippedMechanismHasAValidStudy) {
  int mechanisms = 0;
  for (const auto& entry : fs::directory_iterator(kShipped)) {
    if (entry.path().extension() != ".toml") continue;
    ++mechanisms;
    const std::string study = kShipped + "/studies/" + entry.path().filename().string();
    EXPECT_EQ(run({"check", study}), 0) << output_;
    EXPECT_EQ(output_.find("warning"), std::string::npos) << study << output_;
  }
  EXPECT_EQ(mechanisms, 8);
}

TEST_F(MechanismFileStudy, IsBitIdenticalForAnyThreadsAndInstructionSetAndAfterKills) {
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
[[output]]
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

/// Objectives that are sampled along columns. The last study starts its solver from points of a Pareto front.
TEST_F(MechanismFileStudy, SolversReachTheOptimumOfSampledObjectives) {
  const std::string problem = "[mechanism]\nfile = \"" + kShipped + R"(/3-rpr.toml"
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
