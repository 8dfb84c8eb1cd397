// Tests of solver stages in a study: starting points, recorded optimality and sensitivities, resuming at any
// evaluation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/runner/run_study.hpp"
#include "engine/runner/stage_starts.hpp"
#include "engine/storage/study_file.hpp"
#include "objectives/all.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/runner/stop_at.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

/// The problem with wide bounds; at its optimum workspace-shape and the lower bound of a are active.
std::string wide(const std::string& stages, double rail = 2.5) {
  return R"([study]
name = "wide"
seed = 3
[mechanism]
type = "4ppa-2par"
parameters = { L0 = )" +
         shortest(rail) + R"( }
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5 }
[baseline]
a = 0.1
b = 0.8
[workspace]
method = "columns"
tolerance = 1e-11
limits = { alpha_min = 0.1, h_min = 0.06, beta_min = 0.1, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }
[[objective]]
type = "workspace-ratio"
[[constraint]]
type = "workspace-shape"
[[constraint]]
type = "rail-length"
)" + stages;
}

const std::string kGa = "[[stage]]\noptimiser = \"ga\"\npopulation = 20\ngenerations = 5\n";
const std::string kSlsqp = "[[stage]]\noptimiser = \"nlopt\"\n";
const std::string kIpopt = "[[stage]]\noptimiser = \"ipopt\"\n";

Study study_of_text(const std::string& text) { return read_study_toml(text, "s.toml", all_catalogues()); }

class SolverStudy : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "pkmopt-solver-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::signal(SIGINT, SIG_DFL);  // a script's background process ignores it
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  StudyContents run(const std::string& text) const {
    Progress silent;
    return run_study(study_of_text(text), path("s.h5"), true, {}, silent).contents;
  }

  std::string folder_;
};

double best_objective(const StudyContents& contents) {
  return contents.stages[static_cast<std::size_t>(contents.best.stage)].table.objective_row(
      static_cast<std::size_t>(contents.best.row))[0];
}

TEST_F(SolverStudy, ResumedAtAnyEvaluationEqualsTheUninterruptedRun) {
  const Study study =
      study_of_text(wide(kGa + kSlsqp + "multistart = 1\n" + kIpopt + "start = \"best-of-basins\"\nstarts = 2\n") +
                    "[checkpoint]\nevery = 0\n");
  Progress silent;
  const auto reference = run_study(study, path("reference.h5"), false, {}, silent);
  const auto reports =
      static_cast<int>(reference.contents.stages[1].table.size() + reference.contents.stages[2].table.size()) + 6;
  for (int stop = 5; stop < reports; stop += 122) {
    const std::string file = path("s" + std::to_string(stop) + ".h5");
    StopAt at(stop);
    run_study(study, file, false, {}, at);
    const auto second = resume_study(file, all_catalogues(), {}, {}, silent);
    EXPECT_EQ(first_difference(reference.contents, second.contents), "") << stop;
    EXPECT_EQ(first_difference(reference.contents, read_study(file)), "") << stop;
    EXPECT_TRUE(second.warnings.empty());
  }
}

// Evaluations take some microseconds, so that several multistart runs are often evaluated concurrently.
TEST_F(SolverStudy, StartsDoNotDependOnTheNumberOfThreads) {
  const Study study = study_of_text(wide(kSlsqp + "multistart = 7\n"));
  Progress silent;
  const auto alone = run_study(study, path("alone.h5"), false, {.threads = 1}, silent);
  for (int i = 0; i < 6; ++i) {
    const auto team = run_study(study, path("team.h5"), true, {.threads = 2 + i % 3}, silent);
    ASSERT_EQ(first_difference(alone.contents, team.contents), "");
  }
}

TEST_F(SolverStudy, BothSolversAgreeOnTheOptimum) {
  const StudyContents slsqp = run(wide(kSlsqp + "multistart = 5\n"));
  const StudyContents ipopt = run(wide(kIpopt + "multistart = 5\n"));
  EXPECT_NEAR(best_objective(slsqp) / best_objective(ipopt), 1, 1e-9);
  for (const StudyContents* contents : {&slsqp, &ipopt}) {
    const StageRecord& stage = contents->stages[0];
    ASSERT_EQ(stage.starts.size(), 6u);
    for (const StartOutcome& start : stage.starts) {
      EXPECT_NEAR(stage.table.objective_row(static_cast<std::size_t>(start.end_row))[0] / best_objective(*contents), 1,
                  1e-8)
          << start.origin;
      EXPECT_LT(start.optimality, 1e-6) << start.origin;
      EXPECT_EQ(start.stop, "converged");
    }
    ASSERT_TRUE(stage.optimality);
    ASSERT_EQ(stage.optimality->active.size(), 2u);
    EXPECT_EQ(stage.optimality->active[0].name, "workspace-shape");
    EXPECT_EQ(stage.optimality->active[1].name, "a");
    EXPECT_EQ(stage.optimality->active[1].kind, "lower bound");
  }
}

TEST_F(SolverStudy, SensitivitiesEqualFiniteDifferences) {
  const StudyContents contents = run(wide(kIpopt));
  const auto& sensitivities = contents.stages[0].optimality->sensitivities;
  ASSERT_EQ(sensitivities.size(), contents.problem.parameters.size());
  const Study study = study_of_text(wide(kIpopt));
  const DesignProblem& problem = *study.problem;
  const auto row = static_cast<std::size_t>(contents.best.row);
  const std::vector<double> best = problem.parameters(contents.stages[0].table.design(row));
  for (std::size_t p = 0; p < best.size(); ++p) {  // as built: all other parameters unchanged
    const double step = 1e-7;                      // small, because the objective is strongly curved in l_u
    std::vector<double> less = best, more = best;
    less[p] -= step;
    more[p] += step;
    const double derivative = (problem.report(more).objectives[0] - problem.report(less).objectives[0]) / (2 * step);
    EXPECT_NEAR(sensitivities[p].as_built, derivative, 2e-7) << sensitivities[p].parameter;
  }
  // reoptimised: the study solved again with another rail length
  const double derivative =
      (best_objective(run(wide(kIpopt, 2.501))) - best_objective(run(wide(kIpopt, 2.499)))) / 0.002;
  const auto rail = std::ranges::find(sensitivities, "L0", &SensitivityRecord::parameter);
  EXPECT_NEAR(rail->reoptimised, derivative, 1e-5);
  EXPECT_TRUE(std::isnan(sensitivities[0].reoptimised));  // a varies
}

TEST_F(SolverStudy, MultipliersEqualTheGainFromRelaxingABound) {
  const StudyContents contents = run(wide(kIpopt));
  std::string lower = wide(kIpopt);
  lower.replace(lower.find("min = 0.15"), 10, "min = 0.149");
  const double gain = (best_objective(run(lower)) - best_objective(contents)) / 0.001;
  EXPECT_NEAR(contents.stages[0].optimality->active[1].multiplier, gain, 1e-3);
}

std::vector<std::string> origins(const std::vector<StartDesign>& starts) {
  std::vector<std::string> list;
  for (const auto& start : starts) list.push_back(start.origin);
  return list;
}

TEST_F(SolverStudy, FirstStageStartsFromTheBaselineClippedToTheBounds) {
  const Study study = study_of_text(wide(kSlsqp + "designs = [{ a = \"300 mm\" }, { b = 1.2, l_u = 1 }]\n"));
  const auto starts = start_designs(study, study.stages[0], StudyContents{});
  EXPECT_THAT(origins(starts), ElementsAre("the baseline", "given design 1", "given design 2"));
  EXPECT_EQ(starts[0].design[0], 0.15);  // lower bound; the baseline's 0.1 is outside
  EXPECT_EQ(starts[1].design[0], 0.3);
  EXPECT_EQ(starts[1].design[1], 0.8);  // variables that are not given have the baseline's values
  EXPECT_EQ(starts[2].design[2], 1);
}

TEST_F(SolverStudy, BasinsAreDesignsWithoutABetterOneNearby) {
  const Study study =
      study_of_text(wide(kGa + kSlsqp + "start = \"best-of-basins\"\nstarts = 3\nbasin_radius = 0.2\n"));
  StudyContents contents;
  contents.problem = problem_record(study);
  StageRecord& stage = contents.stages.emplace_back();
  stage.table = EvaluationTable(study.problem->shape());
  const auto add = [&](double unit, double objective, Status status = Status::feasible) {
    const std::size_t row = stage.table.extend(1);
    for (std::size_t v = 0; v < 4; ++v) stage.table.design(row)[v] = study.problem->space().from_unit(v, unit);
    stage.table.slot(row).objectives[0] = objective;
    stage.table.status[row] = status;
  };
  add(0.50, 0.30);
  add(0.65, 0.29);                      // in the basin of the first
  add(0.80, 0.28);                      // in the basin of the second, although far from the first
  add(0.10, 0.10);                      // a separate basin
  add(0.95, 0.00, Status::infeasible);  // near a better one
  add(0.99, 0.99, Status::failed);      // excluded
  contents.best = {0, 0};
  const auto starts = start_designs(study, study.stages[1], contents);
  EXPECT_THAT(origins(starts), ElementsAre("basin 1, from stage 1", "basin 2, from stage 1"));
  EXPECT_THAT(starts[1].design[0], DoubleNear(0.23, 1e-12));
}

}  // namespace
}  // namespace pkm::testing
