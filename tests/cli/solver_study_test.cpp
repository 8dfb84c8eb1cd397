// Studies with solver stages, run by the built program: killed inside NLopt and Ipopt, stopped by Ctrl-C, extended;
// incompatible settings.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class SolverProgram : public StudyProgram {
 protected:
  void write_toml(const std::string& stages, const std::string& more = "[checkpoint]\nevery = 0\n") const {
    std::ofstream(folder_ + "/study.toml") << R"([study]
name = "kill me"
seed = 7
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5 }
[workspace]
method = "columns"
tolerance = 1e-10
limits = { alpha_min = 0.1, h_min = 0.06, beta_min = 0.1, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }
[[objective]]
type = "workspace-ratio"
[[constraint]]
type = "workspace-shape"
[[constraint]]
type = "rail-length"
[[constraint]]
type = "linear"
coefficients = { a = 1, b = -1 }
)" << stages << more;
  }
  static constexpr const char* kSlsqp = "[[stage]]\noptimiser = \"nlopt\"\nstart = \"none\"\nmultistart = 3\n";
  static constexpr const char* kIpopt = "[[stage]]\noptimiser = \"ipopt\"\nstart = \"none\"\nmultistart = 3\n";
};

TEST_F(SolverProgram, KilledInsideNloptAndResumedEndsTheSame) {
  write_toml(kSlsqp);
  kill_at_random(2, 30);
}

TEST_F(SolverProgram, KilledInsideIpoptAndResumedEndsTheSame) {
  write_toml(kIpopt);
  kill_at_random(2, 31);
}

TEST_F(SolverProgram, TheEstimateCountsDerivatives) {
  const auto estimate = [&](const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {"run", "study.toml", "--force", "--threads", "1"};
    command.insert(command.end(), more.begin(), more.end());
    EXPECT_EQ(run(command), 0) << output_;
    const auto at = output_.find("kill me: at most ");
    return at == std::string::npos ? output_ : output_.substr(at, output_.find('\n', at) - at);
  };
  const std::string ga = "[[stage]]\noptimiser = \"ga\"\npopulation = 10\ngenerations = 2\n";
  const std::string one = "of about [0-9.]+ [a-z]+", all = ", together about [0-9.]+ [a-z]+ on 1 thread";
  const std::string solver =
      "[[stage]]\noptimiser = \"nlopt\"\nstart = \"best-of-basins\"\nstarts = 2\nevaluations = 30\n";
  write_toml(ga + solver);
  EXPECT_THAT(estimate(),
              MatchesRegex("kill me: at most 30 evaluations " + one + " and 60 with derivatives " + one + all));
  EXPECT_THAT(estimate({"--seeds", "2"}),
              MatchesRegex("kill me: at most 30 evaluations " + one + " and 60 with derivatives " + one +
                           ", for each of 2 seeds" + all));
  write_toml(ga);
  EXPECT_THAT(estimate(), MatchesRegex("kill me: at most 30 evaluations " + one + all));
  write_toml("[[stage]]\noptimiser = \"nlopt\"\nstart = \"none\"\nmultistart = 3\nevaluations = 20\n");
  EXPECT_THAT(estimate(), MatchesRegex("kill me: at most 60 evaluations with derivatives " + one + all));
}

TEST_F(SolverProgram, CtrlCStopsInsideASolver) {
  for (const char* stage : {kSlsqp, kIpopt}) {
    write_toml(stage);
    ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--force", "--quiet"}), 0) << output_;
    fs::remove(path("stopped.h5"));
    int code = 0;
    {
      ChildProcess child(command({"run", "study.toml", "--output", "stopped.h5", "--quiet"}), folder_);
      while (!fs::exists(path("stopped.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
      child.signal(SIGINT);
      code = child.wait();
    }
    EXPECT_EQ(code, 3);
    const StudyContents left = read("stopped.h5");
    EXPECT_EQ(left.state, StudyState::interrupted);
    EXPECT_GT(left.evaluations(), 0);
    ASSERT_EQ(run({"resume", "stopped.h5", "--quiet"}), 0) << output_;
    EXPECT_EQ(first_difference(read("straight.h5"), read("stopped.h5")), "");
  }
}

TEST_F(SolverProgram, StageStoppedInItsFirstStartHasNoStarts) {
  write_toml(kSlsqp, "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "s.h5", "--time", "0.0001", "--quiet"}), 3) << output_;
  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("stage 1: nlopt, 0 starts, "));
}

TEST_F(SolverProgram, ThreadsDoNotMatter) {
  write_toml(std::string(kSlsqp) + kIpopt, "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "one.h5", "--threads", "1", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--output", "seven.h5", "--threads", "7", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("one.h5"), read("seven.h5")), "");
}

TEST_F(SolverProgram, ShowsStartsOptimalityAndSensitivities) {
  write_toml(kSlsqp, "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "s.h5"}), 0) << output_;
  for (const char* part :
       {"stage 1: nlopt, 3 starts, ", "Sobol point 1", "converged (", "KKT residual: relative improvement ",
        "first-order optimality (KKT residual) ", "workspace-shape  constraint ", "lower bound ",
        "sensitivity of workspace-ratio [rad], largest first within each unit", "others fixed", "reoptimised"})
    EXPECT_THAT(output_, HasSubstr(part));
  ASSERT_EQ(run({"show", "s.h5", "--json"}), 0);
  const auto printed = nlohmann::json::parse(output_);
  EXPECT_TRUE(printed["reproducible"]);
  const auto& stage = printed["stages"][0];
  ASSERT_EQ(stage["starts"].size(), 3u);
  for (const auto& start : stage["starts"]) {
    EXPECT_EQ(start["stop"], "converged");
    EXPECT_LT(start["optimality"], 1e-6);
    EXPECT_NEAR(start["end"]["objectives"]["workspace-ratio"], 0.31162610, 1e-8);
    EXPECT_EQ(start["optimum"], 1);
  }
  EXPECT_EQ(stage["optimality"]["active"][0]["name"], "workspace-shape");
  const StudyContents found = read("s.h5");
  ASSERT_EQ(stage["optimality"]["sensitivities"].size(), found.problem.parameters.size());
  for (std::size_t i = 0; i < found.problem.parameters.size(); ++i)
    EXPECT_EQ(stage["optimality"]["sensitivities"][i]["as_built"],
              found.stages[0].optimality->sensitivities[i].as_built);
}

TEST_F(SolverProgram, StartsFromDistinctBasinsFindSeveralOptima) {
  ASSERT_EQ(run({"run", PKM_EXPERIMENTS "/4ppa-2par/conditioning-optima.toml", "--output", "s.h5", "--quiet"}), 0)
      << output_;
  ASSERT_EQ(run({"show", "s.h5", "--json"}), 0);
  const auto printed = nlohmann::json::parse(output_);
  std::map<int, double> optima;
  for (const auto& start : printed["stages"][1]["starts"]) {
    EXPECT_LT(start["optimality"], 1e-6) << start["origin"];
    double& best = optima[start["optimum"]];  // starts in one basin differ by rounding
    best = std::max(best, start["end"]["objectives"]["conditioning"].get<double>());
  }
  ASSERT_GE(optima.size(), 2u);
  EXPECT_GT(optima[1], optima[2] + 0.01);
  EXPECT_EQ(printed["best"]["objectives"]["conditioning"], optima[1]);
}

TEST_F(SolverProgram, ATimeLimitIsRecordedAndReplayed) {
  write_toml("[[stage]]\noptimiser = \"nlopt\"\nmultistart = 2\ntime = \"0 s\"\n" + std::string(kSlsqp), "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("time limit"));
  EXPECT_THAT(
      output_,
      HasSubstr("note: a time limit stopped a start, so another run with the same seed may give a different result"));
  const StudyContents before = read("s.h5");
  EXPECT_FALSE(before.reproducible());
  ASSERT_EQ(run({"resume", "s.h5", "--evaluations", "2000", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("s.h5").stages[0].table.size(), before.stages[0].table.size());
}

TEST_F(SolverProgram, AFinishedStudyGetsMoreEvaluations) {
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const auto stage = [&](int evaluations) {
      return "[[stage]]\noptimiser = \"" + optimiser +
             "\"\nmultistart = 2\nevaluations = " + std::to_string(evaluations) + "\n";
    };
    write_toml(stage(9), "");
    ASSERT_EQ(run({"run", "study.toml", "--output", "s.h5", "--force", "--quiet"}), 0) << output_;
    ASSERT_EQ(read("s.h5").stages[0].stop, "evaluation limit");
    EXPECT_EQ(run({"resume", "s.h5", "--evaluations", "8", "--quiet"}), 2);
    EXPECT_THAT(output_, HasSubstr("at least 9"));
    ASSERT_EQ(run({"resume", "s.h5", "--evaluations", "500", "--quiet"}), 0) << output_;
    write_toml(stage(500), "");
    ASSERT_EQ(run({"run", "study.toml", "--output", "t.h5", "--force", "--quiet"}), 0) << output_;
    const StudyContents longer = read("s.h5"), straight = read("t.h5");
    EXPECT_EQ(longer.stages[0].table.designs, straight.stages[0].table.designs);
    EXPECT_EQ(longer.stages[0].starts.size(), 3u);
    EXPECT_EQ(longer.best.row, straight.best.row);
  }
}

TEST_F(SolverProgram, CheckReportsIncompatibleSettings) {
  const auto message = [&](const std::string& stage, const std::string& from = "", const std::string& to = "") {
    write_toml(stage, "");
    std::string text;
    {
      std::ifstream file(path("study.toml"));
      text.assign(std::istreambuf_iterator<char>(file), {});
    }
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    std::ofstream(path("study.toml")) << text;
    EXPECT_EQ(run({"check", "study.toml"}), 2);
    return output_;
  };
  const std::string nlopt = "[[stage]]\noptimiser = \"nlopt\"\n", ipopt = "[[stage]]\noptimiser = \"ipopt\"\n";
  EXPECT_THAT(message(nlopt + "algorithm = \"bobyqa\"\n"),
              HasSubstr("the optimiser nlopt with the algorithm bobyqa handles no constraints, but the study has "
                        "workspace-shape, rail-length, linear"));
  EXPECT_THAT(message(nlopt, "\"columns\"\ntolerance = 1e-10", "\"voxels\"\ncells = { x = 8, z = 8, theta = 8 }"),
              HasSubstr("the optimiser nlopt with the algorithm slsqp needs derivatives, but voxel counts"));
  EXPECT_THAT(message(ipopt, "l_d = { min = 0.25, max = 1.5 }", "l_d = { min = 0.25, max = 1.5, step = 0.01 }"),
              HasSubstr("the optimiser ipopt handles continuous variables only, but the variable l_d has a step"));
  EXPECT_THAT(message(ipopt + "options = { tolx = 1e-9 }\n"), HasSubstr("Ipopt has no option 'tolx'"));
  EXPECT_THAT(message(nlopt + "designs = [{ a = 3.0 }]\n"),
              HasSubstr("stage[1].designs: a = 3 m lies outside the variable's bounds 0.15 m to 0.95 m"));
  EXPECT_THAT(message(nlopt + "designs = [{ q = 3.0 }]\n"),
              HasSubstr("stage[1].designs[1].q: found an unknown name; expected one of a, b, l_u, l_d"));
  EXPECT_THAT(message(nlopt + "start = \"pareto\"\n"), HasSubstr("needs 2 objectives, but the study has one"));
  EXPECT_THAT(message(nlopt + "start = \"none\"\n"), HasSubstr("no start"));
}

}  // namespace
}  // namespace pkm::testing
