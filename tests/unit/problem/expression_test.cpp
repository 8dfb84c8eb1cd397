// Expressions compared with the equivalent built-in entries: values and derivatives; order of evaluation, requested
// fields, bounds and units.
#include "engine/problem/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;

const std::string kMechanism =
    "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\n"
    "a = { min = 0.15, max = 0.95 }\nb = { min = 0.6, max = 1.5 }\nl_u = { min = 0.4, max = 1.2 }\n"
    "l_d = { min = 0.4, max = 1.2 }\nL0 = { min = 1, max = 4 }\nR_u = { min = 0.005, max = 0.02 }\n";
const std::string kStage = "[[stage]]\noptimiser = \"ga\"\n";

/// Built-in entries, each followed by an equivalent expression.
const std::string kPairs = R"toml(
[[objective]]
type = "workspace-ratio"
[[objective]]
type = "expression"
name = "ratio"
expression = "volume / (pi * b * (l_u + l_d))"
[[objective]]
type = "expression"
name = "ratio-by-size"
expression = "volume / size"
[[objective]]
type = "conditioning"
[[objective]]
type = "expression"
name = "mean"
expression = "conditioning_mean"
[[objective]]
type = "conditioning"
name = "worst"
statistic = "min"
sharpness = 300
[[objective]]
type = "expression"
name = "min"
expression = "conditioning_min"
sharpness = 300
[[constraint]]
type = "workspace-shape"
[[constraint]]
type = "expression"
name = "shape"
expression = "l_d - sqrt(l_u^2 + (b - a*cos_theta_min)^2)/2"
[[constraint]]
type = "rail-length"
[[constraint]]
type = "expression"
name = "rail"
expression = "L0 - 2 * l_u * cos(alpha_min)"
[[constraint]]
type = "linear"
coefficients = { a = 1, b = -0.5 }
bound = 0.1
[[constraint]]
type = "expression"
name = "sum"
expression = "a - 0.5 * b"
max = 0.1
[[constraint]]
type = "workspace-volume"
min = 0.3
[[constraint]]
type = "expression"
name = "large"
expression = "volume"
min = 0.3
)toml";

Study read(const std::string& text) {
  return read_study_toml(text, "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// Study of the pairs. alpha_min is derived from R_u and d_u, so that one threshold has derivatives.
Study pairs(const std::string& method) {
  const std::string limits =
      "limits = { h_min = 0.06, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }\n"
      "[[constraint]]\ntype = \"interference\"\n";
  return read(kMechanism + "[workspace]\n" + method + "\n" + limits + kPairs + "[[stage]]\noptimiser = \"sweep\"\n");
}

std::vector<double> some_design(const DesignProblem& problem, Stream& random) {
  std::vector<double> design;
  for (std::size_t i = 0; i < problem.space().dimension(); ++i)
    design.push_back(problem.space().from_unit(i, random.u01()));
  return design;
}

/// Names of equal quantities: built-in entry, expression.
const std::pair<const char*, const char*> kEqual[] = {{"workspace-ratio", "ratio"},
                                                      {"workspace-ratio", "ratio-by-size"},
                                                      {"conditioning", "mean"},
                                                      {"worst", "min"},
                                                      {"workspace-shape", "shape"},
                                                      {"rail-length", "rail"},
                                                      {"linear", "sum"},
                                                      {"workspace-volume", "large"}};

/// Names of the objectives, then of the margins.
std::vector<std::string> names(const DesignProblem& problem) {
  auto all = names_of(problem.objectives());
  for (const auto& name : names_of(problem.margins())) all.push_back(name);
  return all;
}
std::size_t index(const std::vector<std::string>& list, const std::string& name) {
  const auto found = std::ranges::find(list, name);
  EXPECT_NE(found, list.end()) << name;
  return static_cast<std::size_t>(found - list.begin());
}

TEST(Expression, EqualsTheEquivalentBuiltInEntry) {
  for (const std::string method : {"method = \"voxels\"", "method = \"columns\""}) {
    const Study study = pairs(method);
    const DesignProblem& problem = *study.problem;
    const auto all = names(problem);
    Stream random(1, 0, 0, Stream::Use::start);
    int with_workspace = 0;
    for (int i = 0; i < 20; ++i) {
      const DesignReport report = problem.report(problem.parameters(some_design(problem, random)));
      auto values = report.objectives;
      values.insert(values.end(), report.margins.begin(), report.margins.end());
      with_workspace += report.workspace.volume > 0;
      for (const auto& [built_in, expression] : kEqual) {
        const double expected = values[index(all, built_in)];
        EXPECT_NEAR(values[index(all, expression)], expected, 4e-16 * (1 + std::fabs(expected))) << expression;
      }
    }
    EXPECT_GT(with_workspace, 10) << method;
  }
}

TEST(Expression, DerivativesEqualThoseOfTheEquivalentBuiltInEntry) {
  const Study study = pairs("method = \"columns\"");
  const DesignProblem& problem = *study.problem;
  const auto all = names(problem);
  const std::size_t parameters = problem.parts().parameters.size(), width = 1 + parameters;
  std::vector<std::size_t> by(parameters);
  for (std::size_t i = 0; i < parameters; ++i) by[i] = i;
  Stream random(2, 0, 0, Stream::Use::start);
  int threshold_derivatives = 0;
  for (int i = 0; i < 20; ++i) {
    const auto derivatives = problem.derivatives(problem.parameters(some_design(problem, random)), by);
    for (const auto& [built_in, expression] : kEqual)
      for (std::size_t k = 0; k < width; ++k) {
        const double expected = derivatives[width * index(all, built_in) + k];
        ASSERT_TRUE(std::isfinite(expected)) << built_in;
        EXPECT_NEAR(derivatives[width * index(all, expression) + k], expected, 1e-12 * (1 + std::fabs(expected)))
            << expression << ", derivative " << k;
      }
    threshold_derivatives += derivatives[width * index(all, "rail") + 1 + 6] != 0;  // with respect to R_u
  }
  EXPECT_EQ(threshold_derivatives, 20);
}

TEST(Expression, IsEvaluatedBeforeTheWorkspaceAnalysisIfPossible) {
  const Study study =
      read(kMechanism + "[[objective]]\ntype = \"workspace-volume\"\n" + kStage +
           "[[constraint]]\ntype = \"expression\"\nname = \"late\"\nexpression = \"volume - b\"\n"
           "[[constraint]]\ntype = \"expression\"\nname = \"early\"\nexpression = \"size - b * beta_max\"\n");
  const ProblemParts& parts = study.problem->parts();
  EXPECT_THAT(names_of(parts.design_margins), ElementsAre("early"));
  EXPECT_THAT(names_of(parts.workspace_margins), ElementsAre("late"));
  EvaluationTable table(study.problem->shape());
  table.extend(1);
  const std::vector<double> design = {0.2, 0.8, 0.2, 0.2, 2.5, 0.01};  // size = 0.32 pi < 0.8 * pi / 2
  Scratch scratch;
  study.problem->evaluate(design, scratch, {{&table.objectives[0], 1}, {&table.margins[0], 2}, {}, table.status[0]});
  EXPECT_EQ(table.status[0], Status::rejected);
  EXPECT_LT(table.margins[0], 0);
  EXPECT_TRUE(std::isnan(table.margins[1]) && std::isnan(table.objectives[0]));
}

TEST(Expression, DemandsTheFieldsThatItUses) {
  const auto request = [](const std::string& more) {
    return read(kMechanism + "[[objective]]\ntype = \"workspace-volume\"\n" + kStage + more).problem->parts().request;
  };
  const std::string report = "[[output]]\ntype = \"expression\"\n",
                    constraint = "[[constraint]]\ntype = \"expression\"\n";
  EXPECT_FALSE(request(report + "expression = \"volume\"\n").has(kConditioning));
  EXPECT_TRUE(request(report + "expression = \"conditioning_mean\"\n").has(kConditioning));
  EXPECT_EQ(request(report + "expression = \"conditioning_mean\"\n").characteristic_length, std::nullopt);
  EXPECT_TRUE(request(constraint + "expression = \"conditioning_min\"\n").has(kConditioning));
  EXPECT_EQ(request(constraint + "expression = \"conditioning_min\"\ncharacteristic_length = \"50 mm\"\n")
                .characteristic_length,
            0.05);
}

TEST(Expression, CharacteristicLengthActsAsInTheBuiltInEntry) {
  const Study study = read(kMechanism + kStage +
                           "[[objective]]\ntype = \"conditioning\"\ncharacteristic_length = 0.3\n"
                           "[[output]]\ntype = \"expression\"\nexpression = \"conditioning_mean\"\n"
                           "characteristic_length = 0.3\n");
  const DesignReport report = study.problem->report(study.problem->parts().parameters);
  EXPECT_GT(report.objectives[0], 0);
  EXPECT_EQ(report.reports[0], report.objectives[0]);
}

TEST(Expression, NonFiniteValueFailsTheEvaluation) {
  for (const std::string where : {"[[objective]]\n", "[[constraint]]\n"})
    for (const std::string text : {"1 / (volume - volume)", "sqrt(-volume)", "log(a - a)"}) {
      const Study study = read(kMechanism + "[[stage]]\noptimiser = \"sweep\"\n" + where +
                               "type = \"expression\"\nexpression = \"" + text + "\"\n");
      const DesignReport report = study.problem->report(study.problem->parts().parameters);
      EXPECT_EQ(report.status, Status::failed) << where << text;
      EXPECT_EQ(report.reason, "expression is not a finite number");
    }
}

TEST(Expression, IsMaximisedByDefault) {
  const Study study =
      read(kMechanism + "[[stage]]\noptimiser = \"sweep\"\n" +
           "[[objective]]\ntype = \"expression\"\nexpression = \"a\"\nunit = \"m\"\n"
           "[[objective]]\ntype = \"expression\"\nname = \"small\"\nexpression = \"\"\"size\n  / b\"\"\"\n"
           "direction = \"minimise\"\n");
  const auto& objectives = study.problem->objectives();
  EXPECT_EQ(objectives[0].direction, Direction::maximise);
  EXPECT_EQ(objectives[0].unit, "m");
  EXPECT_EQ(objectives[0].meaning, "a");
  EXPECT_EQ(objectives[1].direction, Direction::minimise);
  EXPECT_EQ(objectives[1].unit, "1");
  EXPECT_EQ(objectives[1].meaning, "size / b");
}

TEST(Expression, ConstraintBoundsDefineTheMargin) {
  const Study study =
      read(kMechanism + kStage + "[[objective]]\ntype = \"workspace-volume\"\n" +
           "[[constraint]]\ntype = \"expression\"\nname = \"c1\"\nexpression = \"b\"\nunit = \"m\"\nmin = \"500 mm\"\n"
           "[[constraint]]\ntype = \"expression\"\nname = \"c2\"\nexpression = \"b\"\nunit = \"m\"\nmax = \"1 m\"\n"
           "[[constraint]]\ntype = \"expression\"\nname = \"c3\"\nexpression = \"b\"\n"
           "[[constraint]]\ntype = \"expression\"\nname = \"c4\"\nexpression = \"volume\"\nmax = 2\n");
  const DesignReport report = study.problem->report(study.problem->parts().parameters);
  EXPECT_EQ(report.margins[0], 0.8 - 0.5);
  EXPECT_EQ(report.margins[1], 1 - 0.8);
  EXPECT_EQ(report.margins[2], 0.8);
  EXPECT_EQ(report.margins[3], 2 - report.objectives[0]);
  const auto& margins = study.problem->margins();
  EXPECT_EQ(margins[0].meaning, "b >= 0.5 m");
  EXPECT_EQ(margins[1].meaning, "b <= 1 m");
  EXPECT_EQ(margins[2].meaning, "b >= 0");
  EXPECT_EQ(margins[3].meaning, "volume <= 2");
}

TEST(Expression, ConditioningIsUnknownForAMechanismWithoutAJacobian) {
  const auto known = [&](const Mechanism& mechanism) { return names_of(expression_names(mechanism, {})); };
  EXPECT_THAT(known(*all_mechanisms()[0]),
              ::testing::IsSupersetOf({"size", "volume", "conditioning_mean", "conditioning_min"}));
  struct Bare final : Mechanism {
    MechanismInfo own;
    const MechanismInfo& info() const override { return own; }
    PoseReport inspect(std::span<const double>, const Pose<double>&, const std::string&,
                       const LimitSpec&) const override {
      return {};
    }
  } bare;
  bare.own.coordinates = {{"x", "m"}};
  bare.own.sweeps = all_sweeps(bare.own.coordinates, {0});
  EXPECT_THAT(known(bare), ::testing::Contains("volume"));
  EXPECT_THAT(known(bare), ::testing::Not(::testing::Contains(::testing::AnyOf("size", "conditioning_mean"))));
}

}  // namespace
}  // namespace pkm
