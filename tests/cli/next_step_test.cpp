// What the program says of what to type next, and of what was meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/storage/study_lock.hpp"
#include "tests/cli/study_folder.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class CliNextStep : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    std::ofstream(path("my study.toml")) << study_with("") << "population = 8\ngenerations = 2\n";
    std::ofstream(path("s.toml")) << study_with("") << "population = 8\ngenerations = 2\n";
  }
};

TEST_F(CliNextStep, EachStepNamesTheNext) {
  ASSERT_EQ(run({"new", "mechanism", "delta", "-o", "d.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt check d.toml\n"));
  ASSERT_EQ(run({"check", "d.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt new study d.toml -o study.toml\n"));
  ASSERT_EQ(run({"new", "study", "d.toml", "-o", "study.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt run study.toml\n"));
  ASSERT_EQ(run({"check", "my study.toml", "--limit", "beta_max=70deg"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt run 'my study.toml' --limit beta_max=70deg\n"));
  ASSERT_EQ(run({"run", "my study.toml"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nwritten to my study.h5\nnext: pkmopt report 'my study.h5'\n"));
  ASSERT_EQ(run({"run", "s.toml", "--seeds", "2"}), 0) << output_;
  EXPECT_THAT(output_, EndsWith("\nnext: pkmopt report s-seed-1.h5 s-seed-2.h5\n"));
}

TEST_F(CliNextStep, WhatIsPrintedAsAFileHoldsNoNextStep) {
  ASSERT_EQ(run({"new", "study", "4ppa-2par"}), 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("next: ")));
}

TEST_F(CliNextStep, AFileOfTheOtherKindNamesTheCommandThatTakesIt) {
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"show", "s.toml"}, "pkmopt check s.toml"},
      {{"resume", "s.toml"}, "pkmopt run s.toml"},
      {{"report", "s.h5", "s.toml"}, "pkmopt run s.toml"},
      {{"export", "s.toml", "--csv", "t"}, "pkmopt workspace s.toml"}};
  for (const auto& [arguments, meant] : cases) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(
        output_,
        "pkmopt: s.toml: found a file in TOML; expected a study file, F.h5, as 'pkmopt run' writes it; did you mean '" +
            meant + "'?\n");
  }
  const std::pair<std::vector<std::string>, std::string> others[] = {
      {{"run", "s.h5"}, "pkmopt resume s.h5"},
      {{"check", "s.h5"}, "pkmopt show s.h5"},
      {{"workspace", "s.h5"}, "pkmopt workspace --from s.h5"}};
  for (const auto& [arguments, meant] : others) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(output_, "pkmopt: s.h5: found a study file; expected a study or a mechanism in TOML; did you mean '" +
                           meant + "'?\n");
  }
}

TEST_F(CliNextStep, AMechanismWhereAFileIsReadNamesTheCommandThatTakesIt) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"run", "4ppa-2par"}, "a study in TOML; did you mean 'pkmopt new study 4ppa-2par'?"},
      {{"check", "4ppa-2par"}, "a study or a mechanism in TOML; did you mean 'pkmopt list mechanisms 4ppa-2par'?"},
      {{"show", "4ppa-2par"}, "a study file, F.h5; did you mean 'pkmopt list mechanisms 4ppa-2par'?"},
      {{"new", "4ppa-2par"}, "one of mechanism, study; did you mean 'pkmopt new study 4ppa-2par'?"}};
  for (const auto& [arguments, expected] : cases) {
    EXPECT_EQ(run(arguments), 2) << arguments[0];
    EXPECT_EQ(output_, "pkmopt: found the mechanism '4ppa-2par'; expected " + expected + '\n');
  }
}

TEST_F(CliNextStep, ShowTellsAKilledStudyFromOneThatIsRunning) {
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  StudyContents contents = read("s.h5");
  contents.state = StudyState::running;  // as a kill leaves it
  contents.final.reset();
  write_study(path("s.h5"), contents);
  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("s: interrupted, "));
  EXPECT_THAT(output_, EndsWith("\nit was interrupted; go on with: pkmopt resume s.h5\n"));

  const StudyLock lock(path("s.h5"));
  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("s: running, "));
  EXPECT_THAT(output_, HasSubstr("\nprocess " + std::to_string(getpid()) + " "));
  EXPECT_THAT(output_, EndsWith(" works on it\n"));
}

}  // namespace
}  // namespace pkm::testing
