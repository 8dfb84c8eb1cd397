// Regions of a study: what is read, what is refused, and what objectives and task-workspace make of them.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/config/real_studies.hpp"

namespace pkm::testing {
namespace {

const std::string kTask =
    "[mechanism]\ntype = \"3crr-r-cru\"\nmasses = \"geometry\"\n[variables]\nl_41 = { min = 0.12, max = 0.3 }\n"
    "[workspace]\nlimits = { s_min = 0.2, c_min = 0.1 }\n"
    "[[region]]\nname = \"task\"\nnodes = { x = 3, y = 3 }\n"
    "box = { x = [0.12, 0.2], y = [0.12, 0.2], z = [0.17, 0.24] }\nphi = [\"-30 deg\", 0, \"30 deg\"]\n";

std::string with_task(const std::string& more) { return kTask + more + "[[stage]]\noptimiser = \"ga\"\n"; }

Study read_task(const std::string& more) { return read_real(with_task(more)); }

std::string task_complaint(const std::string& more) { return real_complaint(with_task(more)); }

TEST(Regions, AreSurveysOfTheirOwn) {
  const Study study = read_task(
      "[[objective]]\ntype = \"dci\"\nregion = \"task\"\n[[output]]\ntype = \"workspace-volume\"\nregion = \"task\"\n"
      "[[output]]\ntype = \"workspace-volume\"\nname = \"all\"\n[[constraint]]\ntype = \"task-workspace\"\n"
      "region = \"task\"\nmargin = \"5 mm\"\n");
  const DesignReport report = study.problem->report(study.problem->parts().parameters);
  EXPECT_EQ(report.status, Status::feasible) << report.reason;
  EXPECT_NEAR(report.reports[0], 0.08 * 0.08 * 0.07, 1e-12) << "all of the box, at each of three angles";
  EXPECT_GT(report.reports[1], 10 * report.reports[0]);
  EXPECT_EQ(report.workspace.volume, report.reports[1]);
  // The margin falls one to one with what is asked for.
  const Study wider = read_task(
      "[[objective]]\ntype = \"dci\"\nregion = \"task\"\n[[constraint]]\ntype = \"task-workspace\"\n"
      "region = \"task\"\nmargin = \"7 mm\"\n");
  const DesignReport other = wider.problem->report(wider.problem->parts().parameters);
  EXPECT_NEAR(report.margins[0] - other.margins[0], 2e-3, 1e-15);
  EXPECT_EQ(other.objectives, report.objectives);
}

TEST(Regions, TaskWorkspaceTellsWhatTheSurveyCounts) {
  // A short rod: part of the box is out of reach, and what the region counts is less than the box.
  const Study study = read_task(
      "[[objective]]\ntype = \"workspace-volume\"\nregion = \"task\"\n[[constraint]]\ntype = \"task-workspace\"\n"
      "region = \"task\"\n");
  auto parameters = study.problem->parts().parameters;
  int cut = 0, whole = 0;
  for (double l_41 = 0.02; l_41 < 0.3; l_41 += 0.01) {
    parameters[6] = l_41;
    const DesignReport report = study.problem->report(parameters);
    const bool all = std::fabs(report.objectives[0] / (0.08 * 0.08 * 0.07) - 1) < 1e-12;
    EXPECT_EQ(report.margins[0] >= 0, all) << l_41;
    ++(all ? whole : cut);
  }
  EXPECT_GT(cut, 3);
  EXPECT_GT(whole, 3);
}

TEST(Regions, MistakesAreNamed) {
  const std::string objective = "[[objective]]\ntype = \"dci\"\n";  // lines 13, 14
  EXPECT_EQ(task_complaint(objective + "region = \"tsk\"\n"),
            "s.toml:15: objective[1].region: found \"tsk\"; expected one of task; did you mean 'task'?");
  EXPECT_EQ(task_complaint(objective + "mode = \"-,-,-,*\"\n"),
            "s.toml:13: objective[1]: mechanism 3crr-r-cru has no working mode '-,-,-,*'; did you mean '-,-,-,-'?");
  EXPECT_EQ(task_complaint(objective + "limb = 5\n"),
            "s.toml:13: objective[1]: mechanism 3crr-r-cru has 4 joints; found joint 5");
  EXPECT_EQ(task_complaint(objective + "limb = 9\n"),
            "s.toml:15: objective[1].limb: found 9; expected one of 1, 2, 3, 4, 5, 6, 7, 8, worst, mean");
  EXPECT_EQ(task_complaint(objective + "limb = 4\n"), "accepted");
  EXPECT_EQ(task_complaint(objective + "[[region]]\nname = \"task\"\n"),
            "s.toml:16: region[2].name: there is already a region called 'task'");
  EXPECT_EQ(task_complaint(objective + "[[region]]\nname = \"plane\"\n[[constraint]]\ntype = \"task-workspace\"\n"
                                       "region = \"plane\"\n"),
            "s.toml:17: constraint[1]: task-workspace needs a box, and region 'plane' has none");
  EXPECT_EQ(task_complaint(objective + "[[constraint]]\ntype = \"task-workspace\"\nregion = \"box\"\n"),
            "s.toml:15: constraint[1]: the study has no [[region]] called 'box'");
  EXPECT_EQ(task_complaint(objective + "statistic = \"p95\"\n[[stage]]\noptimiser = \"ipopt\"\n"),
            "s.toml:17: stage[1].optimiser: the optimiser ipopt needs derivatives, but dci with statistic = \"p95\" is "
            "a quantile, which has none; use \"mean\", \"max\" or \"std\"");
}

}  // namespace
}  // namespace pkm::testing
