// [tolerance]: samples of built machines, yields, robust statistics with derivatives, and worst corners.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/team.hpp"
#include "engine/problem/tolerance_analysis.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;

const std::string kVariables = "[variables]\nl_a = { min = 0.15, max = 0.3 }\nl_b = { min = 0.4, max = 0.7 }\n";
const std::string kVolumeObjective = "[[objective]]\ntype = \"workspace-volume\"\n";
const std::string kArms = "[tolerance]\nl_a = \"0.2 mm\"\nl_b = \"0.2 mm\"\n";

Study delta(const std::string& more, const StudyChanges& changes = {}) {
  const SourceText file{test::text_of_mechanism("rotary-delta"), "rotary-delta.toml"};
  return read_study_toml("[mechanism]\nfile = \"rotary-delta.toml\"\n" + kVariables + more +
                             "[workspace]\nmethod = \"columns\"\ntolerance = 1e-6\n[[stage]]\noptimiser = \"ga\"\n",
                         "s.toml", all_catalogues(), file, changes);
}

std::string complaint(const std::string& more) {
  try {
    delta(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// An output that is a formula of the length of the platform, which no limb copies have: one common error.
std::string formula(const std::string& text, const std::string& more) {
  return "[[objective]]\ntype = \"expression\"\nunit = \"m\"\nexpression = \"" + text + "\"\n" + more;
}

DesignReport nominal_report(const Study& study) { return study.problem->report(study.problem->parts().parameters); }

TEST(Tolerance, EveryArmHasErrorsOfItsOwn) {
  const Study study =
      delta(kVolumeObjective + "robust = \"mean\"\n" + kArms + "q_max = { bound = \"1 deg\", copies = \"common\" }\n");
  const ToleranceModel& model = *study.tolerances;
  std::vector<std::string> names;
  for (const ParameterError& error : model.errors) names.push_back(error.name);
  EXPECT_EQ(names, (std::vector<std::string>{"arm1.l_a", "arm2.l_a", "arm3.l_a", "arm1.l_b", "arm2.l_b", "arm3.l_b",
                                             "q_max"}));
  const std::vector<double>& design = study.problem->parts().parameters;
  std::vector<double> machine, again;
  double sums[7] = {}, product = 0;
  const std::size_t count = 20000;
  for (std::size_t k = 0; k < count; ++k) {
    model.sample(k, design, machine);
    ASSERT_EQ(machine.size(), design.size() + 6);
    EXPECT_EQ(machine[2], design[2]);  // the common parameter, which no limb uses
    for (std::size_t i = 0; i < 7; ++i) {
      const ParameterError& error = model.errors[i];
      const double nominal = i < 3 ? design[2] : i < 6 ? design[3] : design[5];
      const double scaled = (machine[error.parameter] - nominal) / error.bound;
      ASSERT_LE(std::fabs(scaled), 1 + 1e-9);
      sums[i] += scaled;
      if (i == 1) product += scaled * (machine[model.errors[0].parameter] - design[2]) / error.bound;
    }
  }
  const double deviation = std::sqrt(static_cast<double>(count) / 3);
  for (const double sum : sums) EXPECT_LT(std::fabs(sum), 4 * deviation);
  EXPECT_LT(std::fabs(product), 4 * deviation);
  model.sample(7, design, machine);
  model.sample(7, design, again);
  EXPECT_EQ(machine, again);
}

TEST(Tolerance, NormalErrorsAreTruncatedAndCorrelated) {
  const Study study = delta(kVolumeObjective +
                            "[tolerance]\nl_a = { bound = \"0.2 mm\", distribution = \"normal\" }\n"
                            "arm2.l_a = { bound = \"0.1 mm\", distribution = \"normal\", sigma = \"0.1 mm\" }\n"
                            "correlation = [{ between = [\"arm1.l_a\", \"arm3.l_a\"], coefficient = 0.8 }]\n");
  const ToleranceModel& model = *study.tolerances;
  const std::vector<double>& design = study.problem->parts().parameters;
  std::vector<double> machine;
  double squares[3] = {}, product13 = 0, product12 = 0;
  const std::size_t count = 20000;
  for (std::size_t k = 0; k < count; ++k) {
    model.sample(k, design, machine);
    double error[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto of = std::ranges::find(model.errors, "arm" + std::to_string(i + 1) + ".l_a", &ParameterError::name);
      error[i] = (machine[of->parameter] - design[2]) / 1e-4;
      ASSERT_LE(std::fabs(error[i]), (i == 1 ? 1 : 2) + 1e-9);
      squares[i] += error[i] * error[i] / count;
    }
    product13 += error[0] * error[2] / count;
    product12 += error[0] * error[1] / count;
  }
  // Variances of a standard normal distribution truncated to +-3 and +-1: 0.97334 and 0.29113
  EXPECT_NEAR(squares[0], 4.0 / 9 * 0.97334, 0.02);
  EXPECT_NEAR(squares[1], 0.29113, 0.01);
  EXPECT_NEAR(product13 / std::sqrt(squares[0] * squares[2]), 0.8, 0.02);
  EXPECT_NEAR(product12, 0, 0.02);
}

TEST(Tolerance, QuantilesAgreeWithAMillionSamplesAndWithTheDistribution) {
  // l_a is uniform within +-2 mm about 0.2 m; the volume is not used
  const std::string tolerance = "[tolerance]\nl_a = { bound = \"2 mm\", copies = \"common\" }\nsamples = ";
  const std::string objective = formula("l_a", "robust = \"quantile:0.05\"\n");
  const auto quantile = [&](const std::string& direction, int samples) {
    return nominal_report(delta(objective + direction + tolerance + std::to_string(samples) + "\n")).objectives.at(0);
  };
  const double minimised = quantile("direction = \"minimise\"\n", 1'000'000);
  const double maximised = quantile("direction = \"maximise\"\n", 1'000'000);
  EXPECT_NEAR(maximised, 0.2 - 0.0018, 4e-3 * std::sqrt(0.05 * 0.95 / 1e6) * 4);
  EXPECT_NEAR(minimised, 0.2 + 0.0018, 4e-3 * std::sqrt(0.05 * 0.95 / 1e6) * 4);
  for (const int samples : {1000, 10000})
    EXPECT_NEAR(quantile("direction = \"maximise\"\n", samples), maximised,
                4e-3 * std::sqrt(0.05 * 0.95 / samples) * 4);
}

TEST(Tolerance, StatisticsOfAFewSamples) {
  const std::string tolerance = "[tolerance]\nl_a = { bound = \"2 mm\", copies = \"common\" }\nsamples = 5\n";
  const auto value = [&](const std::string& robust) {
    return nominal_report(delta(formula("l_a", "direction = \"minimise\"\nrobust = \"" + robust + "\"\n") + tolerance))
        .objectives.at(0);
  };
  const Study study = delta(kVolumeObjective + tolerance);
  std::vector<double> machine, values;
  for (std::size_t k = 0; k < 5; ++k) {
    study.tolerances->sample(k, study.problem->parts().parameters, machine);
    values.push_back(machine[2]);
  }
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 5;
  std::ranges::sort(values);
  EXPECT_EQ(value("worst"), values[4]);
  EXPECT_NEAR(value("mean"), mean, 1e-15);
  EXPECT_NEAR(value("quantile:0.1"), 0.6 * values[4] + 0.4 * values[3], 1e-15);  // position 0.1 * 4 from the worst
}

TEST(Tolerance, YieldLiesWithinItsConfidenceInterval) {
  // l_a + 2 l_b has the standard deviation sqrt(5/3) mm for errors within +-1 mm; P(sum of errors <= 1 mm) = 0.75
  const std::string constraint =
      "[[constraint]]\ntype = \"expression\"\nunit = \"m\"\nexpression = \"1.201 - l_a - 2*l_b\"\n";
  const std::string errors =
      "[tolerance]\nl_a = { bound = \"1 mm\", copies = \"common\" }\nl_b = { bound = \"1 mm\", copies = \"common\" }\n";
  const std::string yields =
      "[[output]]\ntype = \"yield\"\n[[output]]\ntype = \"yield\"\nname = \"lower\"\nstatistic = "
      "\"lower\"\n[[output]]\ntype = \"yield\"\nname = \"upper\"\nstatistic = \"upper\"\n";
  int outside = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    const Study study = delta("[study]\nseed = " + std::to_string(seed) + "\n" + formula("l_a", "") + constraint +
                              yields + errors + "samples = 200\n");
    const DesignReport report = nominal_report(study);
    ASSERT_TRUE(report.yield);
    EXPECT_EQ(report.reports[0], report.yield->share());
    EXPECT_EQ(report.yield->violated.at(0), report.yield->machines - report.yield->good);
    EXPECT_LT(report.reports[1], report.reports[0]);
    EXPECT_GT(report.reports[2], report.reports[0]);
    outside += !(report.reports[1] <= 0.75 && 0.75 <= report.reports[2]);
  }
  EXPECT_LE(outside, 6);  // 2 expected of 40
  const DesignReport many =
      nominal_report(delta(formula("l_a", "") + constraint + yields + errors, {.machines = 1'000'000}));
  EXPECT_NEAR(many.reports[0], 0.75, 4 * std::sqrt(0.75 * 0.25 / 1e6));
}

TEST(Tolerance, YieldIsAnObjectiveAndAConstraint) {
  const std::string constraint =
      "[[constraint]]\ntype = \"workspace-volume\"\nmin = 0.07\n[[constraint]]\ntype = \"yield\"\nmin = 0.9\n";
  const Study study = delta("[[objective]]\ntype = \"yield\"\n" + constraint + kArms + "samples = 8\n");
  const DesignReport report = nominal_report(study);
  EXPECT_EQ(report.objectives.at(0), 1);
  EXPECT_NEAR(report.margins.at(1), 0.1, 1e-15);
  EXPECT_EQ(report.status, Status::feasible);
  EXPECT_THAT(study.problem->why_no_derivatives().value_or(""), HasSubstr("a yield is a share of samples"));
}

TEST(Tolerance, DerivativesOfRobustQuantitiesEqualDifferences) {
  for (const std::string robust : {"worst", "mean", "quantile:0.3"}) {
    const Study study =
        delta(kVolumeObjective + "robust = \"" + robust + "\"\n[[constraint]]\ntype = \"expression\"\nunit = " +
              "\"m\"\nexpression = \"l_b - l_a^2\"\nrobust = \"" + robust + "\"\n" + kArms + "samples = 6\n");
    const DesignProblem& problem = *study.problem;
    ASSERT_FALSE(problem.why_no_derivatives());
    Scratch scratch;
    EvaluationTable table(problem.shape(Detail::derivatives));
    table.extend(1);
    const std::vector<double> design = {0.2, 0.5};
    problem.evaluate(design, scratch, table.slot(0));
    const std::vector<double> found(table.derivative_row(0).begin(), table.derivative_row(0).end());
    EXPECT_EQ(found[0], table.objectives[0]);
    for (std::size_t v = 0; v < 2; ++v) {
      const auto at = [&](double step) {
        std::vector<double> moved = design;
        moved[v] += step;
        return problem.report(problem.parameters(moved));
      };
      const DesignReport above = at(1e-5), below = at(-1e-5);
      EXPECT_NEAR(found[1 + v], (above.objectives[0] - below.objectives[0]) / 2e-5, 1e-4) << robust;
      EXPECT_NEAR(found[4 + v], (above.margins[0] - below.margins[0]) / 2e-5, 1e-6) << robust;
    }
  }
}

TEST(Tolerance, ResultsDoNotDependOnThreads) {
  const Study study = delta(kVolumeObjective +
                            "robust = \"quantile:0.2\"\n[[constraint]]\ntype = \"workspace-volume\"\nmin = "
                            "0.0791\n[[output]]\ntype = \"yield\"\n" +
                            kArms + "samples = 16\n");
  const DesignReport alone = nominal_report(study);
  DesignReport together;
  with_team(4, [&] { together = nominal_report(study); });
  EXPECT_EQ(alone.objectives, together.objectives);
  EXPECT_EQ(alone.reports, together.reports);
  EXPECT_GT(alone.reports[0], 0);
  EXPECT_LT(alone.reports[0], 1);
}

TEST(Tolerance, WorstCornerIsTheWorstOfAllCorners) {
  const Study study = delta(kVolumeObjective + kArms);
  const DesignProblem& machine = *study.machine;
  std::vector<double> nominal;
  ToleranceModel exact = *study.tolerances;
  exact.groups.clear();  // without errors
  exact.sample(0, study.problem->parts().parameters, nominal);
  std::vector<double> bounds(nominal.size());
  for (const ParameterError& error : exact.errors) bounds[error.parameter] = error.bound;
  const DesignReport report = machine.report(nominal);
  const auto gradients = quantity_gradients(machine, report);
  const WorstCase found = worst_case(machine, report, gradients, 0, bounds);
  double worst = report.objectives[0], squares = 0;
  for (std::size_t corner = 0; corner < 64; ++corner) {
    std::vector<double> parameters = nominal;
    for (std::size_t i = 0; i < 6; ++i)
      parameters[exact.errors[i].parameter] += (corner >> i & 1 ? 1 : -1) * exact.errors[i].bound;
    worst = std::min(worst, machine.report(parameters).objectives[0]);
  }
  EXPECT_EQ(found.evaluated, worst);
  const double change = report.objectives[0] - worst;
  EXPECT_NEAR(found.first_order, worst, 0.01 * change);
  for (const ParameterError& error : exact.errors)
    squares += std::pow(gradients[0].by[error.parameter] * error.bound, 2);
  EXPECT_NEAR(found.rss, std::sqrt(squares), 1e-15);
  EXPECT_LT(found.rss, change);
}

TEST(Tolerance, MachinesThatCannotBeBuilt) {
  // q_max may be at most 180 deg
  const std::string objective = "[mechanism.parameters]\nq_max = \"179.9 deg\"\n" + kVolumeObjective;
  const std::string tolerance = "[tolerance]\nq_max = { bound = \"1 deg\", copies = \"common\" }\nsamples = 20\n";
  const DesignReport robust = nominal_report(delta(objective + "robust = \"mean\"\n" + tolerance));
  EXPECT_EQ(robust.status, Status::failed);
  EXPECT_THAT(robust.reason, HasSubstr("workspace-volume: built machine "));
  EXPECT_THAT(robust.reason, HasSubstr("q_max"));
  const DesignReport yield = nominal_report(
      delta(objective + "[[constraint]]\ntype = \"workspace-volume\"\nmin = 0.01\n[[output]]\ntype = \"yield\"\n" +
            tolerance));
  EXPECT_GT(yield.yield->failed, 0U);
  EXPECT_EQ(yield.yield->failed + yield.yield->good, 20U);
}

TEST(Tolerance, LimbsOfABuiltInMechanismHaveErrorsOfTheirOwn) {
  const auto study = [](const std::string& tolerance) {
    return testing::read_real(
        "[mechanism]\ntype = \"3crr-r-cru\"\n[variables]\nl_11 = { min = 0.15, max = 0.2 }\n[workspace]\n"
        "method = \"voxels\"\ncells = { x = 8, y = 8, z = 8 }\n[[objective]]\ntype = \"workspace-volume\"\n"
        "robust = \"worst\"\n[[stage]]\noptimiser = \"ga\"\n[tolerance]\nsamples = 4\n" +
        tolerance);
  };
  const Study independent = study("rho_max = \"5 mm\"\n");
  std::vector<std::string> names;
  for (const ParameterError& error : independent.tolerances->errors) names.push_back(error.name);
  EXPECT_EQ(names, (std::vector<std::string>{"limb1.rho_max", "limb2.rho_max", "limb3.rho_max", "limb4.rho_max"}));
  const DesignReport report = nominal_report(independent);
  EXPECT_EQ(report.status, Status::feasible) << report.reason;
  EXPECT_GT(report.objectives[0], 0);
  EXPECT_EQ(study("rho_max = { bound = \"5 mm\", copies = \"common\" }\n").tolerances->errors.size(), 1U);
  const Study one = study("limb2.rho_max = \"5 mm\"\n");
  EXPECT_EQ(one.tolerances->errors.size(), 1U);
}

TEST(Tolerance, ErrorsOfTheReader) {
  const std::pair<std::string, std::string> cases[] = {
      {kVolumeObjective + "robust = \"mean\"\n",
       "s.toml:8: objective[1].robust: robust needs the errors of the built machines: give a table [tolerance]"},
      {"[[objective]]\ntype = \"yield\"\n", "the objective yield needs the errors of the built machines"},
      {kVolumeObjective + "[[output]]\ntype = \"yield\"\n" + kArms, "a yield needs a [[constraint]]"},
      {kVolumeObjective + "robust = \"quantile\"\n" + kArms,
       "robust: found \"quantile\"; expected \"worst\", \"mean\", or \"quantile:\" with a number between 0 and 1"},
      {kVolumeObjective + "robust = \"quantile:1\"\n" + kArms, "robust: found \"quantile:1\"; expected"},
      {kVolumeObjective + "[tolerance]\n", "tolerance: found no parameter"},
      {kVolumeObjective + "[tolerance]\nl_c = \"1 mm\"\n",
       "tolerance.l_c: found an unknown parameter; expected one of R, r,"},
      {kVolumeObjective + "[tolerance]\narm4.l_a = \"1 mm\"\n",
       "tolerance.arm4.l_a: found an unknown copy of l_a; expected one of arm1.l_a, arm2.l_a, arm3.l_a; did you mean"},
      {kVolumeObjective + "[tolerance]\nl_a = -1\n", "tolerance.l_a: found -1; expected"},
      {kVolumeObjective + "[tolerance]\nl_a = { bound = 1e-3, sigma = 1e-3 }\n",
       "only a normal distribution has a standard"},
      {kVolumeObjective + "[tolerance]\nl_a = { bound = 1e-3, distribution = \"normal\", sigma = 2e-3 }\n",
       "found 2e-3; expected a standard deviation of at most the bound 0.001 m"},
      {kVolumeObjective +
           "[tolerance]\nl_a = 1e-3\ncorrelation = [{ between = [\"l_a\", \"l_a\"], coefficient = 0.5 }]\n",
       "the error of l_a is uniform; correlated errors need distribution = \"normal\""},
      {kVolumeObjective +
           "[tolerance]\nl_a = { bound = 1e-3, distribution = \"normal\" }\ncorrelation = [{ between = [\"l_a\", "
           "\"l_a\"], coefficient = -0.6 }]\n",
       "the matrix of these correlations is not positive definite"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(complaint(text), HasSubstr(message)) << text;
  const std::string built_in = "[mechanism]\ntype = \"4ppa-2par\"\n[workspace]\nmethod = \"columns\"\n" +
                               kVolumeObjective +
                               "[[stage]]\noptimiser = \"ga\"\n"
                               "[variables]\na = { min = 0.1, max = 0.2 }\n[tolerance]\n";
  EXPECT_EQ(testing::real_complaint(built_in + "l_u = 1e-4\n"), "accepted");
  EXPECT_THAT(testing::real_complaint(built_in + "l_u = { bound = 1e-4, copies = \"independent\" }\n"),
              HasSubstr("the limbs of this mechanism share l_u; expected copies = \"common\""));
}

}  // namespace
}  // namespace pkm
