// Variables that are choices from catalogues.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;

const std::string kChosenDrive = test::kMechanismFolder + "motors/chosen-drive.toml";

std::string replaced(std::string text, const std::string& before, const std::string& after) {
  const auto at = text.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  return at == std::string::npos ? text : text.replace(at, before.size(), after);
}
SourceText delta_description() { return {test::text_of_mechanism("rotary-delta"), "rotary-delta.toml"}; }

TEST(ChoiceFromACatalogue, IsTheStudyWithTheValuesOfTheRow) {
  const Study study = load_study_toml(kChosenDrive, all_catalogues());
  const DesignProblem& problem = *study.problem;
  ASSERT_EQ(names_of(problem.space().variables()), (std::vector<std::string>{"motor", "gear", "l_a", "l_b"}));
  EXPECT_EQ(problem.space()[0].upper, 4);
  EXPECT_EQ(problem.space()[0].step, 1);
  EXPECT_EQ(problem.parts().choices.at(1).rows.at(2), "10:1");
  // the third motor with the second gear
  const std::vector<double> parameters = problem.parameters(std::vector<double>{3, 2, 0.2, 0.5});
  const Mechanism& chosen = *problem.of(parameters).parts().mechanism;
  EXPECT_EQ(joint_limits(chosen).at(0).motor.value().name, "200 W");
  EXPECT_EQ(chosen.drive_trains()->at(2).ratio, 7);
  EXPECT_EQ(chosen.drive_trains()->at(2).shaft, 1.4e-5);
  EXPECT_EQ(&problem.of(parameters), &problem.of(parameters));
  std::string text = replaced(test::text_of_file(kChosenDrive), "motor = { from = \"motors.toml\" }", "");
  text = replaced(text, "gear  = { from = \"gears.toml\" }", "");
  text = replaced(text, "= \"motor.name\"", "= \"200 W\"");
  text = replaced(text, "\"gear.ratio\"", "7");
  text = replaced(text, "\"gear.inertia\"", "1.4e-5");
  text = replaced(text, "\"gear.efficiency\"", "0.97");
  const Study fixed = read_study_toml(text + test::text_of_file(test::kMechanismFolder + "motors/motors.toml"),
                                      "s.toml", all_catalogues(), delta_description());
  const DesignReport a = problem.report(parameters), b = fixed.problem->report(fixed.problem->parts().parameters);
  ASSERT_TRUE(std::isfinite(a.objectives.at(0)));
  EXPECT_EQ(a.objectives, b.objectives);
  EXPECT_EQ(a.margins, b.margins);
}

TEST(ChoiceFromACatalogue, IsEvaluatedLikeEveryDesign) {
  const Study study = load_study_toml(kChosenDrive, all_catalogues());
  const DesignProblem& problem = *study.problem;
  Scratch scratch;
  for (const double motor : {2.0, 4.0, 2.0})
    for (const double gear : {1.0, 3.0}) {
      const std::vector<double> design = {motor, gear, 0.2, 0.5};
      std::vector<double> objectives(problem.objectives().size()), margins(problem.margins().size());
      Status status = Status::failed;
      problem.evaluate(design, scratch, {objectives, margins, {}, status, Detail::complete});
      const DesignReport report = problem.report(problem.parameters(design));
      EXPECT_EQ(status, report.status);
      if (status == Status::feasible) {
        EXPECT_EQ(objectives, report.objectives) << motor << ' ' << gear;
      }
    }
}

TEST(ChoiceFromACatalogue, IsRecordedWithTheText) {
  const Study study = load_study_toml(kChosenDrive, all_catalogues());
  EXPECT_THAT(study.text, HasSubstr("continuous_torque = \\\"0.64 N m\\\""));
  const Study again = read_study_toml(study.text, "elsewhere.toml", all_catalogues(), delta_description());
  EXPECT_EQ(again.text, study.text);
  const std::vector<double> design = {4, 3, 0.2, 0.5};
  EXPECT_EQ(again.problem->report(again.problem->parameters(design)).objectives,
            study.problem->report(study.problem->parameters(design)).objectives);
}

TEST(ChoiceFromACatalogue, SetsParametersOfTheMechanism) {
  const std::string folder = ::testing::TempDir();
  std::ofstream(folder + "/radii.toml") << "[[radius]]\nname = \"small\"\nvalue = \"40 mm\"\nof_base = 0.2\n"
                                           "[[radius]]\nname = \"large\"\nvalue = \"60 mm\"\nof_base = 0.3\n";
  std::ofstream(folder + "/delta.toml") << test::text_of_mechanism("rotary-delta");
  const std::string text = R"([mechanism]
file = "delta.toml"
parameters = { r = "radius.value", R = "radius.of_base" }
[variables]
radius = { from = "radii.toml" }
[baseline]
radius = "large"
[workspace]
method = "columns"
[[objective]]
type = "expression"
expression = "R + r"
)";
  const auto read = [&](const std::string& of_study) {
    std::ofstream(folder + "/study.toml") << of_study;
    return load_study_toml(folder + "/study.toml", all_catalogues());
  };
  const auto complaint = [&](const std::string& before, const std::string& after) {
    try {
      read(replaced(text, before, after));
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Study study = read(text);
  const DesignProblem& problem = *study.problem;
  EXPECT_NEAR(problem.report(*study.baseline).objectives.at(0), 0.36, 1e-15);
  EXPECT_NEAR(problem.report(problem.parameters(std::vector<double>{1})).objectives.at(0), 0.24, 1e-15);
  EXPECT_EQ(problem.parts().rows, std::vector<std::size_t>{1});
  EXPECT_THAT(complaint("\"large\"", "\"larg\""), HasSubstr("did you mean 'large'"));
  EXPECT_THAT(complaint("\"large\"", "2"), HasSubstr("one of small, large"));
  EXPECT_THAT(complaint("radius.value", "radius.valu"), HasSubstr("did you mean 'value'"));
  EXPECT_THAT(complaint("radii.toml", "none.toml"), HasSubstr("none.toml"));
  EXPECT_THAT(complaint("from = \"radii.toml\"", "from = \"radii.toml\", min = 1"), HasSubstr("min"));
  EXPECT_THAT(complaint("[workspace]", "[parameters]\nradius = { default = 1, min = 0, max = 2 }\n[workspace]"),
              HasSubstr("is a choice from"));
  EXPECT_THAT(complaint("[[objective]]", "[[stage]]\noptimiser = \"nlopt\"\n[[objective]]"),
              HasSubstr("the variable radius is a choice from a catalogue; use a genetic algorithm"));
  std::ofstream(folder + "/radii.toml") << "[[radius]]\nname = \"small\"\nvalue = 0.04\nof_base = 0.2\n"
                                           "[[radius]]\nname = \"large\"\nvalue = 60\nof_base = 0.3\n";
  EXPECT_THAT(complaint("\"large\"", "\"small\""), HasSubstr("the row 'large'"));
}

}  // namespace
}  // namespace pkm
