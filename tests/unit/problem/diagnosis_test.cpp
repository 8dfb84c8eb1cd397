// Consistency checks of studies, and the diagnosis of runs without a useful design.
#include "engine/problem/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A study of 4ppa-2par with the variables a and b; `more` is appended to its text.
Study study(const std::string& more, const std::string& objective = "workspace-volume") {
  return read_study_toml(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.3 }\nb = { min = 0.8, max = 1.0 }\n"
      "[[objective]]\ntype = \"" +
          objective + "\"\n[[stage]]\noptimiser = \"ga\"\n" + more,
      "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

std::vector<std::string> found(const Study& study) {
  std::vector<std::string> list;
  for (const Reason& reason : contradictions(study.problem->parts())) list.push_back(reason.sentence);
  return list;
}
std::vector<std::string> found(const std::string& more) { return found(study(more)); }

TEST(Contradictions, NoneInAConsistentStudy) {
  EXPECT_THAT(found(""), IsEmpty());
  EXPECT_THAT(found("[workspace]\ny = 0.5\nlimits = { beta_min = 0.1, beta_max = 0.2 }\n"
                    "[[constraint]]\ntype = \"conditioning\"\nmin = 0.9\n"),
              IsEmpty());
}

TEST(Contradictions, LowerThresholdAboveTheUpperOne) {
  EXPECT_THAT(found("[workspace]\nlimits = { beta_min = 0.9, beta_max = 0.5 }\n"),
              ElementsAre("beta_min = 0.9 rad is not below beta_max = 0.5 rad; no pose satisfies both"));
  // derived from the radius and spacing of the bars: asin(2 R_d / d_d)
  EXPECT_THAT(found("[workspace]\nlimits = { beta_max = 0.1 }\n[[constraint]]\ntype = \"interference\"\n"),
              ElementsAre(HasSubstr("beta_min = 0.252")));
}

TEST(Contradictions, FixedCoordinatesOutOfReach) {
  EXPECT_THAT(found("[workspace]\ny = 2.6\n"),
              ElementsAre("workspace.y = 2.6 m is out of reach; designs within the bounds reach 0 .. 2.5 m"));
  EXPECT_THAT(found("[workspace]\ny = 2.5\n"), IsEmpty());
  const std::string region =
      "[[region]]\nname = \"r\"\nmethod = \"voxels\"\ny = [-1, 1]\n"
      "[[output]]\ntype = \"workspace-volume\"\nregion = \"r\"\n";
  EXPECT_THAT(found(region), IsEmpty());
  EXPECT_THAT(study(region).warnings,
              ElementsAre("region r.y = -1 m is out of reach; designs within the bounds reach 0 .. 2.5 m"));
}

TEST(Contradictions, BoxOutOfReach) {
  const std::string box = "[workspace]\nmethod = \"voxels\"\ncells = { x = 4, z = 4, theta = 4 }\nbox = ";
  EXPECT_THAT(found(box + "{ x = [5, 6], z = [-1, 0], theta = [-1, 1] }\n"),
              ElementsAre("workspace.box.x = 5 .. 6 m is out of reach; designs within the bounds reach 0 .. 1 m"));
  EXPECT_THAT(found(box + "{ x = [0.9, 6], z = [-1, 0], theta = [-1, 1] }\n"), IsEmpty());
}

TEST(Contradictions, ConstraintBoundsOutsideTheRangeOfTheirQuantity) {
  const auto constraint = [](const std::string& text) { return "[[constraint]]\ntype = " + text + "\n"; };
  EXPECT_THAT(
      found(constraint("\"conditioning\"\nmin = 1.2")),
      ElementsAre("constraint conditioning >= 1.2 is satisfied by no design, because its values are never above 1"));
  EXPECT_THAT(found(constraint("\"dci\"\nmax = -0.1")),
              ElementsAre("constraint dci <= -0.1 is satisfied by no design, because its values are never below 0"));
  EXPECT_THAT(found(constraint("\"dci\"\nstatistic = \"std\"\nmin = 0.6")), ElementsAre(HasSubstr("never above 0.5")));
  EXPECT_THAT(found(constraint("\"workspace-ratio\"\nmax = \"-1 rad\"")), ElementsAre(HasSubstr("never below 0 rad")));
  EXPECT_THAT(found("[workspace]\nmethod = \"voxels\"\ncells = { x = 4, z = 4, theta = 4 }\n"
                    "box = { x = [0, 0.5], z = [-1, 0], theta = [-1, 1] }\n" +
                    constraint("\"workspace-volume\"\nmin = 1.5")),
              ElementsAre(HasSubstr("never above 1 m^2 rad")));
  EXPECT_THAT(
      study(constraint("\"conditioning\"\nmin = -1")).warnings,
      ElementsAre("constraint conditioning >= -1 is satisfied by every design, because its values are never below 0"));
}

TEST(Contradictions, TargetOutOfRangeGivesAWarning) {
  const auto warnings = [](const std::string& target) {
    return study("target = " + target + "\n", "conditioning").warnings;
  };
  EXPECT_THAT(
      warnings("1.5"),
      ElementsAre("stage 1: the target 1.5 is never reached, because values of conditioning are never above 1"));
  EXPECT_THAT(warnings("0.5"), IsEmpty());
}

/// Diagnosis of five designs, a = 0.2 + 0.02 i, b = 1 - 0.04 i.
std::optional<Diagnosis> diagnosis(const Study& study, bool with_problem = true) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape());
  table.extend(5);
  Scratch scratch;
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.design(i)[0] = 0.2 + 0.02 * static_cast<double>(i);
    table.design(i)[1] = 1 - 0.04 * static_cast<double>(i);
    problem.evaluate(table.design(i), scratch, table.slot(i));
  }
  return diagnose({&table}, problem.objectives(), problem.margins(), with_problem ? &problem : nullptr);
}

TEST(Diagnosis, NoneIfAUsefulDesignExists) {
  EXPECT_FALSE(diagnosis(study("")));
  const Study any = study("");
  EXPECT_FALSE(diagnose({}, any.problem->objectives(), any.problem->margins(), any.problem.get()));
}

TEST(Diagnosis, NamesTheConstraintThatNoDesignSatisfies) {
  const auto v = diagnosis(study("[[constraint]]\ntype = \"conditioning\"\nmin = 0.9\n"));
  ASSERT_TRUE(v);
  EXPECT_EQ(v->finding, "nothing feasible");
  EXPECT_EQ(v->sentence, "none of 5 designs is feasible: 5 infeasible");
  ASSERT_EQ(v->reasons.size(), 1u);
  EXPECT_EQ(v->reasons[0].kind, "constraint");
  EXPECT_THAT(v->reasons[0].names, ElementsAre("conditioning"));
  EXPECT_THAT(one_line_summary(*v), HasSubstr("; no design satisfies conditioning; the closest misses it by "));
}

TEST(Diagnosis, NamesConstraintsThatContradictEachOther) {
  const auto v =
      diagnosis(study("[[constraint]]\ntype = \"linear\"\nname = \"narrow\"\ncoefficients = { b = 1 }\n"
                      "bound = 0.9\n[[constraint]]\ntype = \"linear\"\nname = \"wide\"\n"
                      "coefficients = { b = -1 }\nbound = -0.95\n"));
  ASSERT_TRUE(v);
  ASSERT_EQ(v->reasons.size(), 1u);
  EXPECT_EQ(v->reasons[0].sentence, "no design satisfies both narrow (satisfied by 2 of 5) and wide (2 of 5)");
}

TEST(Diagnosis, NamesTheLimitThatEmptiesTheWorkspace) {
  const auto v = diagnosis(study("[workspace]\nlimits = { h_min = 3 }\n"));
  ASSERT_TRUE(v);
  EXPECT_EQ(v->finding, "nothing found");
  EXPECT_EQ(v->sentence, "workspace-volume is 0 for each of the 5 feasible designs");
  ASSERT_FALSE(v->reasons.empty());
  EXPECT_EQ(v->reasons[0].kind, "limit");
  EXPECT_THAT(v->reasons[0].sentence, HasSubstr("no pose sampled for the best-ranked design satisfies h_min"));
}

TEST(Diagnosis, PutsContradictionsFirst) {
  const auto v = diagnosis(study("[workspace]\nlimits = { beta_min = 0.9, beta_max = 0.5 }\n"));
  ASSERT_TRUE(v);
  ASSERT_GE(v->reasons.size(), 2u);
  EXPECT_EQ(v->reasons[0].kind, "contradiction");
  EXPECT_THAT(v->reasons[1].sentence, HasSubstr("no pose sampled for the best-ranked design satisfies beta_max"));
}

TEST(Diagnosis, CouplingIndexOfAnEmptyWorkspaceIsNoResult) {
  const Study empty = study("[workspace]\nlimits = { h_min = 3 }\n", "dci");
  const auto v = diagnosis(empty);
  ASSERT_TRUE(v);
  EXPECT_EQ(v->sentence, "dci has the value of an empty workspace for each of the 5 feasible designs");
  EXPECT_FALSE(diagnosis(empty, false)) << "not recognised without the problem";
}

/// The argument `objective` of study() for a formula.
std::string formula(const std::string& text) { return "expression\"\nexpression = \"" + text; }

TEST(Diagnosis, ObjectivesIndependentOfTheWorkspaceCountAsResults) {
  const std::string voxels = "[workspace]\nmethod = \"voxels\"\ncells = { x = 4, z = 4, theta = 4 }\n";
  for (const std::string& method : {std::string("[workspace]\n"), voxels})
    for (const std::string text : {"a", "a + b", "3", "0", "a - a"}) {
      EXPECT_FALSE(diagnosis(study(method, formula(text)))) << method << text;
      EXPECT_FALSE(diagnosis(study(method + "limits = { h_min = 3 }\n", formula(text)))) << method << text;
    }
}

TEST(Diagnosis, EmptyWorkspaceIsRecognisedByItsVolume) {
  for (const std::string text : {"0 * volume", "max(0, volume - 1000)", "min(1, 1 + volume)"}) {
    EXPECT_FALSE(diagnosis(study("", formula(text)))) << text << ": the workspace is not empty";
    const auto v = diagnosis(study("[workspace]\nlimits = { h_min = 3 }\n", formula(text)));
    ASSERT_TRUE(v) << text;
    EXPECT_EQ(v->finding, "nothing found");
  }
}

TEST(Diagnosis, UsesTheRegionOfTheObjective) {
  const auto with_region = [](const std::string& x) {
    return "region = \"r\"\n[[region]]\nname = \"r\"\nmethod = \"voxels\"\ncells = { x = 4, z = 4, theta = 4 }\n"
           "box = { x = " +
           x + ", z = [-0.9, -0.7], theta = [-0.1, 0.1] }\n";
  };
  const auto of = [&](const std::string& x) {
    return diagnosis(read_study_toml(
        "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.3 }\nb = { min = 0.8, max = 1.0 }\n"
        "[[stage]]\noptimiser = \"ga\"\n[[objective]]\ntype = \"expression\"\nexpression = \"0 * volume\"\n" +
            with_region(x),
        "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()}));
  };
  EXPECT_FALSE(of("[0.3, 0.5]"));
  ASSERT_TRUE(of("[20, 21]"));
  EXPECT_EQ(of("[20, 21]")->finding, "nothing found");
}

TEST(Diagnosis, ReportsWhyEvaluationsFailed) {
  const auto v =
      diagnosis(study("[[constraint]]\ntype = \"expression\"\nname = \"root\"\nexpression = \"sqrt(-a)\"\n"));
  ASSERT_TRUE(v);
  EXPECT_EQ(v->sentence, "none of 5 designs is feasible: 5 failed");
  ASSERT_EQ(v->reasons.size(), 1u);
  EXPECT_EQ(v->reasons[0].kind, "failure");
  EXPECT_THAT(v->reasons[0].sentence, HasSubstr("5 of 5 designs could not be evaluated; the first: "));
}

}  // namespace
}  // namespace pkm
