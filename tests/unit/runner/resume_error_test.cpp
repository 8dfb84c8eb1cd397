// Tests of resuming studies whose file, text or program version has changed: which of them can be rebuilt or resumed,
// and the error messages of the others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/runner/records.hpp"
#include "tests/unit/runner/run_study.hpp"
#include "tests/unit/runner/stop_at.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(RunStudy, RecordedProblemsThatConflictWithTheTextAreRejected) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const StudyContents original = run_study(study, path("s.h5"), false, {}, silent).contents;
  EXPECT_EQ(study_of(original, all_catalogues()).name, "two stages");
  const auto error_of = [&](const auto& change) -> std::string {
    StudyContents changed = original;
    changed.text_digest.clear();  // as in files before schema 5
    change(changed);
    try {
      study_of(changed, all_catalogues());
    } catch (const StorageError& error) {
      return error.what();
    }
    return "none";
  };
  const std::string begin = "the text of the study does not match the recorded problem: ";
  EXPECT_EQ(error_of([](StudyContents& c) { c.problem.mechanism = "quadrupteron"; }),
            begin + "the text has mechanism 4ppa-2par, the record has quadrupteron");
  EXPECT_EQ(error_of([](StudyContents& c) {
              c.description = {"[mechanism]", "m.toml"};
            }),
            begin + "the text has no mechanism file, the record has one");
  EXPECT_EQ(error_of([](StudyContents& c) {
              c.problem.variables.push_back({"l_d", "m", 0.5, 0.7, 0});
            }),
            begin + "the text has variables a [m], b [m], l_u [m], the record has a [m], b [m], l_u [m], l_d [m]");
  EXPECT_EQ(error_of([](StudyContents& c) { c.stages.push_back(c.stages.back()); }),
            begin + "the text has 2 stages, the record has 3");
  EXPECT_EQ(error_of([](StudyContents& c) { c.stages[1].optimiser = "nlopt"; }),
            begin + "the text has optimiser ga in stage 2, the record has nlopt");
  EXPECT_EQ(error_of([](StudyContents& c) {
              c.extensions.push_back({-1, "generations", 9});
            }),
            begin + "the text has 2 stages, the record has a new limit of stage 0");
  EXPECT_EQ(
      error_of([](StudyContents& c) { c.problem.objectives[0].direction = Direction::minimise; }),
      begin + "the text has objectives maximise workspace-ratio [rad], the record has minimise workspace-ratio [rad]");
  EXPECT_EQ(error_of([](StudyContents& c) { c.problem.margins[0].name = "rail-length"; }),
            begin + "the record has constraint rail-length [m^2 rad], which the text does not define");
  EXPECT_EQ(error_of([](StudyContents& c) { c.problem.reports[0].unit = "m"; }),
            begin + "the record has output conditioning [m], which the text does not define");
  EXPECT_EQ(error_of([](StudyContents& c) { c.problem.parameters[4].unit = "mm"; }),
            begin + "the record has parameter d [mm], which the text does not define");
  EXPECT_EQ(
      error_of([](StudyContents& c) { std::swap(c.problem.parameters[0].variable, c.problem.parameters[1].variable); }),
      begin + "the record has parameter a [m], variable 2, which the text does not define");
  EXPECT_EQ(error_of([&](StudyContents& c) {
              c.text_digest = original.text_digest;
              c.toml += "\n";
            }),
            begin + "the text, or the mechanism file, was changed after the study was started");
}

// Values may differ because the file was edited or because the program has other default values.
TEST_F(RunStudy, RecordedValuesReplaceValuesOfTheText) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const StudyContents original = run_study(study, path("s.h5"), false, {}, silent).contents;
  EXPECT_EQ(original.text_digest.size(), 16u);
  const auto study_with = [&](const auto& change) {
    StudyContents changed = original;
    change(changed);
    return study_of(changed, all_catalogues());
  };
  const auto plain = study_with([](StudyContents&) {});
  EXPECT_TRUE(plain.differences.empty());

  const std::string text = ", but its text gives ", end = " in this program";
  const auto fixed = study_with([](StudyContents& c) { c.problem.parameters[4].value = 0.16; });
  EXPECT_EQ(fixed.differences, std::vector<std::string>{"it records d = 0.16 m" + text + "0.15 m" + end});
  EXPECT_EQ(fixed.problem->parts().parameters[4], 0.16);
  EXPECT_EQ(fixed.baseline->at(4), 0.16);
  const auto bounds = study_with([](StudyContents& c) {
    c.problem.variables[1].upper = 1.4;
    c.problem.variables[2].step = 0.01;
  });
  EXPECT_EQ(bounds.differences,
            (std::vector<std::string>{"it records variables.b.max = 1.4 m" + text + "1.5 m" + end,
                                      "it records variables.l_u.step = 0.01 m" + text + "0 m" + end}));
  EXPECT_EQ(bounds.problem->space()[1].upper, 1.4);
  EXPECT_EQ(bounds.problem->space()[2].step, 0.01);
  const auto options = study_with([](StudyContents& c) {
    for (std::string& line : c.stages[1].options)
      if (line.starts_with("population = ")) line = "population = 9";
  });
  EXPECT_EQ(options.differences, std::vector<std::string>{"it records population = 9 of stage 2" + text + "6" + end});
  const auto added = study_with([](StudyContents& c) {
    c.problem.margins.clear();
    c.problem.reports.clear();
  });
  EXPECT_EQ(added.differences,
            (std::vector<std::string>{"it has no constraint workspace-volume, which this program adds",
                                      "it has no output conditioning, which this program adds"}));
  for (const double wrong : {std::nan(""), -1.0, 1e9})
    EXPECT_THROW(study_with([wrong](StudyContents& c) { c.problem.parameters[4].value = wrong; }), ConfigError);
  EXPECT_THROW(study_with([](StudyContents& c) { c.problem.variables[1].upper = 0.5; }), ConfigError);
}

TEST_F(RunStudy, RejectsOtherAlgorithmVersionsAndUnreproducedEvaluations) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(3);
  auto contents = run_study(study, path("a.h5"), false, {}, at).contents;
  const auto message = [&](const StudyContents& c) {
    write_study(path("b.h5"), c);
    Progress silent;
    try {
      resume_study(path("b.h5"), all_catalogues(), {}, {}, silent);
    } catch (const StorageError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  StudyContents other = contents;
  other.algorithms = kAlgorithms + 1;
  EXPECT_THAT(message(other), HasSubstr("b.h5: written by pkmopt"));
  StudyContents edited = contents;
  edited.stages[0].table.designs[5] += 1e-9;
  EXPECT_THAT(message(edited), HasSubstr("b.h5: cannot be continued: "));
}

// The file was written before the mechanism had its last two parameters; they are added with their default values.
TEST_F(RunStudy, ParametersAddedSinceGetTheirDefaults) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto reference = run_study(study, path("reference.h5"), false, {}, silent).contents;
  StopAt at(4);
  StudyContents old = run_study(study, path("a.h5"), false, {}, at).contents;
  const std::size_t count = old.problem.parameters.size();
  old.problem.parameters.resize(count - 2);
  write_study(path("old.h5"), old);
  EXPECT_EQ(read_study(path("old.h5")).problem.parameters.size(), count - 2);
  const auto resumed = resume_study(path("old.h5"), all_catalogues(), {}, {}, silent);
  EXPECT_EQ(resumed.stopped, "");
  EXPECT_EQ(first_difference(reference, read_study(path("old.h5"))), "");
}

TEST_F(RunStudy, RejectsAChangedProblem) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(3);
  const auto contents = run_study(study, path("a.h5"), false, {}, at).contents;
  const auto message = [&](const auto& change) {
    StudyContents changed = contents;
    change(changed.problem.parameters);
    write_study(path("b.h5"), changed);
    Progress silent;
    try {
      resume_study(path("b.h5"), all_catalogues(), {}, {}, silent);
    } catch (const StorageError& error) {
      return std::string(error.what()).substr(path("b.h5").size());
    }
    return std::string("accepted");
  };
  using Parameters = std::vector<ParameterRecord>;
  EXPECT_EQ(message([](Parameters& p) { p[4].value = 0.16; }),
            ": cannot be continued: it records d = 0.16 m, but its text gives 0.15 m in this program");
  EXPECT_EQ(message([](Parameters& p) { p[4].name = "height"; }),
            ": cannot be continued: the text of the study does not match the recorded problem: the record has "
            "parameter height [m], which the text does not define");
  EXPECT_EQ(message([](Parameters&) {}), "accepted");
}

TEST_F(RunStudy, RejectsALimitThatTheLastStageDoesNotHave) {
  const Study study = read_study_toml(R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
[workspace]
method = "columns"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "sweep"
points = 5
)",
                                      "s.toml", all_catalogues());
  Progress silent;
  run_study(study, path("a.h5"), false, {}, silent);
  try {
    resume_study(path("a.h5"), all_catalogues(), {.generations = 5, .evaluations = {}}, {}, silent);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "--generations: found an optimiser 'sweep' as the last stage; expected one that has a limit on "
                 "generations");
  }
}

}  // namespace
}  // namespace pkm::testing
