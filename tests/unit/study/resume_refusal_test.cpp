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
            begin + "the variables a, b, l_u, and a, b, l_u, l_d");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages.push_back(c.stages.back()); }), begin + "2 stages, and 3");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages[1].optimiser = "nlopt"; }), begin + "stage 2 by ga, and by nlopt");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.extensions.push_back({-1, "generations", 9});
            }),
            begin + "2 stages, and a new limit of stage 0");
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
            " cannot be continued: it was begun with d = 0.16 m, where this program takes 0.15 m");
  EXPECT_EQ(message([](Parameters& p) { p[4].name = "height"; }),
            " cannot be continued: it has the parameter height, which this program's mechanism 4ppa-2par has not");
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
