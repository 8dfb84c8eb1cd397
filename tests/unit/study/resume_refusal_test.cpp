// Studies that cannot go on, and say why; and those that can although something has changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/study/records.hpp"
#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/study/run_study.hpp"
#include "tests/unit/study/stop_at.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(RunStudy, RecordsThatAreNotThoseOfTheTextAreRefused) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const StudyContents sound = run_study(study, path("s.h5"), false, {}, silent).contents;
  EXPECT_EQ(study_of(sound, all_catalogues()).name, "two stages");
  const auto refusal = [&](const auto& forge) -> std::string {
    StudyContents forged = sound;
    forged.text_digest.clear();  // as of a program before schema 5
    forge(forged);
    try {
      study_of(forged, all_catalogues());
    } catch (const StorageError& error) {
      return error.what();
    }
    return "none";
  };
  const std::string begin = "the study's text and what is recorded of it disagree: ";
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.mechanism = "quadrupteron"; }),
            begin + "4ppa-2par as mechanism, and quadrupteron");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.description = {"[mechanism]", "m.toml"};
            }),
            begin + "no file of a mechanism, and one");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.problem.variables.push_back({"l_d", "m", 0.5, 0.7, 0});
            }),
            begin + "the variables a [m], b [m], l_u [m], and a [m], b [m], l_u [m], l_d [m]");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages.push_back(c.stages.back()); }), begin + "2 stages, and 3");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages[1].optimiser = "nlopt"; }), begin + "stage 2 by ga, and by nlopt");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.extensions.push_back({-1, "generations", 9});
            }),
            begin + "2 stages, and a new limit of stage 0");
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.objectives[0].direction = Direction::minimise; }),
            begin + "the objectives maximise workspace-ratio [rad], and minimise workspace-ratio [rad]");
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.margins[0].name = "rail-length"; }),
            begin + "no constraint rail-length [m^2 rad], and one");
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.reports[0].unit = "m"; }),
            begin + "no report conditioning [m], and one");
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.parameters[4].unit = "mm"; }),
            begin + "no parameter d [mm], and one");
  EXPECT_EQ(
      refusal([](StudyContents& c) { std::swap(c.problem.parameters[0].variable, c.problem.parameters[1].variable); }),
      begin + "no parameter a [m], variable 2, and one");
  EXPECT_EQ(refusal([&](StudyContents& c) {
              c.text_digest = sound.text_digest;
              c.toml += "\n";
            }),
            begin + "its text, or its mechanism's, was changed after the study was begun");
}

// Values that differ, because somebody changed them or because the program has other defaults.
TEST_F(RunStudy, RecordedValuesReplaceThoseOfTheText) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const StudyContents sound = run_study(study, path("s.h5"), false, {}, silent).contents;
  EXPECT_EQ(sound.text_digest.size(), 16u);
  const auto study_with = [&](const auto& change) {
    StudyContents changed = sound;
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
  const auto gained = study_with([](StudyContents& c) {
    c.problem.margins.clear();
    c.problem.reports.clear();
  });
  EXPECT_EQ(gained.differences,
            (std::vector<std::string>{"it has no constraint workspace-volume, which this program adds",
                                      "it has no report conditioning, which this program adds"}));
  for (const double wrong : {std::nan(""), -1.0, 1e9})
    EXPECT_THROW(study_with([wrong](StudyContents& c) { c.problem.parameters[4].value = wrong; }), ConfigError);
  EXPECT_THROW(study_with([](StudyContents& c) { c.problem.variables[1].upper = 0.5; }), ConfigError);
}

TEST_F(RunStudy, RefusesOtherAlgorithmsAndOtherPaths) {
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
  EXPECT_THAT(message(other), HasSubstr("b.h5 was written by pkmopt"));
  StudyContents edited = contents;
  edited.stages[0].table.designs[5] += 1e-9;
  EXPECT_THAT(message(edited), HasSubstr("b.h5 cannot be continued: "));
}

// A file from before the mechanism had its last parameters: they are added, at their defaults.
TEST_F(RunStudy, AParameterGainedSinceIsNoObstacle) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto straight = run_study(study, path("straight.h5"), false, {}, silent).contents;
  StopAt at(4);
  StudyContents old = run_study(study, path("a.h5"), false, {}, at).contents;
  const std::size_t count = old.problem.parameters.size();
  old.problem.parameters.resize(count - 2);
  write_study(path("old.h5"), old);
  EXPECT_EQ(read_study(path("old.h5")).problem.parameters.size(), count - 2);
  const auto resumed = resume_study(path("old.h5"), all_catalogues(), {}, {}, silent);
  EXPECT_EQ(resumed.stopped, "");
  EXPECT_EQ(first_difference(straight, read_study(path("old.h5"))), "");
}

TEST_F(RunStudy, RefusesAProblemThatHasChanged) {
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
            " cannot be continued: it records d = 0.16 m, but its text gives 0.15 m in this program");
  EXPECT_EQ(
      message([](Parameters& p) { p[4].name = "height"; }),
      " cannot be continued: the study's text and what is recorded of it disagree: no parameter height [m], and one");
  EXPECT_EQ(message([](Parameters&) {}), "accepted");
}

TEST_F(RunStudy, RefusesALimitThatTheLastStageHasNot) {
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
