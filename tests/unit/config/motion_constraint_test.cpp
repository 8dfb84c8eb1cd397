// The constraint that a motion keeps every limit of a pose: which studies have it, and its margin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/runner/final_record.hpp"
#include "engine/runner/records.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_real;

const std::string kHead = R"([mechanism]
type = "3crr-r-cru"
[variables]
l_11 = { min = 0.1, max = 0.5 }
rho_max = { min = 0.1, max = 0.5 }
[[motion]]
name = "cycle"
type = "pick-and-place"
x = "30 mm"
y = "170 mm"
z = "190 mm"
phi = 0
lift = "25 mm"
reach = "305 mm"
direction = 0
lift_time = "120 ms"
reach_time = "400 ms"
)";
const std::string kGeneticStage = "[[stage]]\noptimiser = \"ga\"\n";

std::string entry(const std::string& role, const std::string& type, const std::string& more) {
  return "[[" + role + "]]\ntype = \"" + type + "\"\n" + more + "\n";
}
const std::string kWorkspaceVolume = entry("objective", "workspace-volume", "");
const std::string kForce = entry("objective", "peak-force", "motion = \"cycle\"");

Study study(const std::string& entries, const std::string& of_motion = "") {
  return read_real(kHead + of_motion + entries + kGeneticStage);
}
std::vector<std::string> margins(const Study& of) { return names_of(of.problem->margins()); }

TEST(MotionConstraint, StudiesHaveItForEveryMotionThatTheirEntriesName) {
  EXPECT_THAT(margins(study(kWorkspaceVolume)), IsEmpty());
  EXPECT_THAT(margins(study(kForce)), ElementsAre("motion-cycle"));
  EXPECT_THAT(margins(study(kWorkspaceVolume + entry("output", "peak-power", "motion = \"cycle\""))),
              ElementsAre("motion-cycle"));
  const Study bounded =
      study(kForce + entry("constraint", "peak-power", "motion = \"cycle\"\nmax = 100\nsamples = 401"));
  EXPECT_THAT(margins(bounded), ElementsAre("peak-power", "motion-cycle"));
  EXPECT_THAT(bounded.problem->margins()[1].meaning, HasSubstr("along the motion cycle, over 401 samples"));
  EXPECT_THAT(describe(bounded),
              HasSubstr("motion-cycle (motion): margin >= 0, in m, because of peak-force and peak-power"));
  const std::string other_mode = entry("output", "peak-force", "name = \"up\"\nmotion = \"cycle\"\nmode = \"+,+,+,+\"");
  EXPECT_EQ(margins(study(kForce + other_mode)).size(), 2u) << "one per working mode";
}

TEST(MotionConstraint, NotWhereTheStudySaysSo) {
  const Study free = study(kForce, "follow = false\n");
  EXPECT_THAT(margins(free), IsEmpty());
  EXPECT_THAT(describe(free), HasSubstr("may violate limits of a pose (follow = false)"));
  EXPECT_THAT(margins(study(kForce, "follow = true\n")), ElementsAre("motion-cycle"));
  const Study stated =
      study(kForce + entry("constraint", "motion", "name = \"reach\"\nmotion = \"cycle\"\nsamples = 31"));
  EXPECT_THAT(margins(stated), ElementsAre("reach"));
  EXPECT_EQ(stated.problem->parts().followed.size(), 1u);
  EXPECT_THAT(
      [] { study(entry("constraint", "motion", "motion = \"cycel\"")); },
      ::testing::Throws<ConfigError>(::testing::Property(
          &ConfigError::what, HasSubstr("the study has no motion called 'cycel'; it has cycle; did you mean"))));
}

TEST(MotionConstraint, StudiesStoredByEarlierProgramsHaveNone) {
  StudyContents contents = new_contents(study(kForce));
  EXPECT_THAT(margins(study_of(contents, all_catalogues())), ElementsAre("motion-cycle"));
  contents.algorithms = 5;
  contents.problem.margins.clear();
  EXPECT_THAT(margins(study_of(contents, all_catalogues())), IsEmpty());
}

/// The linear Delta by columns, along a motion, with certified bounds.
Study certified_study(const std::string& to) {
  return read_study_toml(R"([mechanism]
file = "linear-delta.toml"
[variables]
l = { min = 0.4, max = 0.6 }
[workspace]
method = "columns"
certified = 0.3
[[motion]]
name = "across"
type = "points"
points = [{ x = 0, y = 0, z = 0 }, )" +
                             to + R"(]
time = 1
[[objective]]
type = "workspace-volume"
[[constraint]]
type = "motion"
motion = "across"
samples = 2
[[stage]]
optimiser = "ga"
)",
                         "s.toml", all_catalogues(),
                         SourceText{test::text_of_mechanism("linear-delta"), "linear-delta.toml"});
}

/// The end of a study whose only design is l = 0.5.
FinalRecord end_of(const Study& of, StudyContents& contents) {
  contents = new_contents(of);
  contents.stages.push_back({"ga", {}, EvaluationTable(of.problem->shape())});
  EvaluationTable& table = contents.stages[0].table;
  table.extend(1);
  table.design(0)[0] = 0.5;
  contents.best = {0, 0};
  contents.final = final_record(of, contents);
  complete_final_record(of, contents, [](const std::string&) {});
  return *contents.final;
}

TEST(MotionConstraint, FinalDesignsAreCertifiedBetweenTheSamples) {
  StudyContents contents;
  const FinalRecord kept = end_of(certified_study("{ x = 0.1 }"), contents);
  EXPECT_EQ(kept.best->status, Status::feasible);
  EXPECT_THAT(contents.notes, ::testing::Contains("along the motion across the best design satisfies every limit of a "
                                                  "pose at every instant (certified)"));
  // out of reach and back: neither sample is there
  const Study out = certified_study("{ x = 1 }, { x = 0 }");
  EXPECT_GE(out.problem->report(out.problem->parts().parameters).margins[0], 0);
  const FinalRecord left = end_of(out, contents);
  EXPECT_EQ(left.best->status, Status::failed);
  EXPECT_THAT(left.best->reason, HasSubstr("along the motion across, "));
  EXPECT_THAT(left.best->reason, HasSubstr(" is violated at t = "));
}

/// A margin is negative where a sample of the trajectory leaves a limit, and there alone.
TEST(MotionConstraint, AgreesWithTheTrajectory) {
  const Study of = study(kForce, "[workspace]\nlimits = { s_min = 0.01 }\n");
  const ProblemParts& parts = of.problem->parts();
  int kept = 0, left = 0;
  for (double l_11 = 0.12; l_11 <= 0.4; l_11 += 0.04)
    for (double rho_max = 0.2; rho_max <= 0.5; rho_max += 0.1) {
      const std::vector<double> design = of.problem->parameters(std::vector<double>{l_11, rho_max});
      const Trajectory along = compute_trajectory(*parts.mechanism, design, parts.mechanism->info().modes.front(),
                                                  parts.plan.limits, *of.motions.front().motion, 201);
      const double margin = of.problem->report(design).margins[0];
      ASSERT_TRUE(std::isfinite(margin));
      EXPECT_EQ(margin >= 0, along.summary.infeasible == 0) << l_11 << ' ' << rho_max << ' ' << margin;
      ++(margin >= 0 ? kept : left);
    }
  EXPECT_GT(kept, 0);
  EXPECT_GT(left, 0);
}

/// Of designs that cannot assemble along the motion, those that come nearer to it have a larger margin; they are
/// rejected by it, not failed.
TEST(MotionConstraint, OrdersDesignsThatDoNotReachTheMotion) {
  std::string text =
      kHead + kForce + entry("constraint", "peak-power", "motion = \"cycle\"\nmax = 100") + kGeneticStage;
  text.insert(text.find("[variables]"), "parameters = { l_12 = 0.05 }\n");
  const Study of = read_real(text);
  Scratch scratch;
  double before = -1e9;
  for (const double l_11 : {0.05, 0.06, 0.07, 0.08}) {
    EvaluationTable table(of.problem->shape());
    table.extend(1);
    table.design(0)[0] = l_11;
    table.design(0)[1] = 0.4;
    of.problem->evaluate(table.design(0), scratch, table.slot(0));
    EXPECT_EQ(table.status[0], Status::rejected);
    const double margin = table.margin_row(0)[1];
    EXPECT_GT(margin, before);
    EXPECT_LT(margin, 0);
    before = margin;
    const DesignReport report = of.problem->report(of.problem->parameters(table.design(0)));
    EXPECT_EQ(report.status, Status::rejected);
    EXPECT_THAT(report.reason, HasSubstr("the motion cycle leaves the reach of the mechanism at t = "));
  }
}

/// Least margins of the samples as poses are inspected, of mechanisms whose margins have units of their own.
TEST(MotionConstraint, IsTheMinimumOfThePosesMargins) {
  const Study of = read_real(R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
[workspace]
limits = { alpha_min = 0.05 }
[[constraint]]
type = "clearance"
min = 0.001
[[motion]]
name = "m"
type = "points"
points = [{ x = 0.4, y = 1.25, z = -0.9, theta = 0 }, { x = 0.45, z = -0.8, theta = 0.2, time = 1 }]
[[objective]]
type = "peak-force"
motion = "m"
[[stage]]
optimiser = "ga"
)");
  const ProblemParts& parts = of.problem->parts();
  for (const double a : {0.15, 0.2, 0.3}) {
    const std::vector<double> design = of.problem->parameters(std::vector<double>{a});
    double least = 1e9;
    for (const MotionSample& at : sample(*of.motions[0].motion, 201)) {
      const PoseReport pose = parts.mechanism->inspect(design, at.pose, "lower,lower", parts.plan.limits);
      ASSERT_TRUE(pose.assembles);
      for (const auto& [name, margin] : pose.margins) least = std::min(least, margin);
    }
    EXPECT_DOUBLE_EQ(of.problem->report(design).margins[0], least) << a;
  }
}

}  // namespace
}  // namespace pkm
