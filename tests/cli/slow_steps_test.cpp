// Long-running steps: results are stored before them, their time is limited, and signals stop them immediately.
#include <gmock/gmock.h>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr double kSoon = 2;  // s, with other tests running at the same time; 0.2 s on an idle machine

class SlowSteps : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    fs::copy(std::string(PKM_TEST_DATA) + "/stops", folder_, fs::copy_options::recursive);
  }
  /// Writes study.toml: a text of tests/data/stops in which `line` is replaced by `to`.
  void change(const std::string& file, const std::string& line, const std::string& to) const {
    std::ifstream in(path(file));
    std::ostringstream text;
    text << in.rdbuf();
    std::string all = text.str();
    all.replace(all.find(line), line.size(), to);
    std::ofstream(path("study.toml")) << all;
  }
  void set_exact(const std::string& value) const {
    change("slow-exact.toml", "method = \"voxels\"", "method = \"voxels\"\nexact = " + value);
  }
  /// Sends a signal as soon as `file` contains final results. @return seconds from the signal to the end of the process
  double stop_in_final_step(ChildProcess& child, const std::string& file, int number, int& code) const {
    while (!fs::exists(path(file)) || !read(file).final) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    child.signal(number);
    const auto begin = Clock::now();
    code = child.wait();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }
};

TEST_F(SlowSteps, ExactValuesAreAbandonedAfterTheTimeLimit) {
  set_exact("\"0.3 s\"");
  ASSERT_EQ(run({"run", "study.toml"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr(", then exact values of the final designs in at most 300 ms\n"));
  const StudyContents found = read("study.h5");
  EXPECT_EQ(found.state, StudyState::finished);
  ASSERT_TRUE(found.final && found.final->best && found.final->map);
  EXPECT_FALSE(found.final->best_exact);
  EXPECT_NEAR(found.final->best->volume, 0.2275, 1e-9);
  const std::string note = "no exact values of the best design: they take longer than 300 ms ([workspace] exact)";
  EXPECT_THAT(found.notes, ElementsAre(note));
  EXPECT_THAT(output_, HasSubstr("note: " + note));
  EXPECT_EQ(run({"resume", "study.h5"}), 0) << output_;  // does not start again
  EXPECT_THAT(output_, HasSubstr("the study is finished"));
}

TEST_F(SlowSteps, ExactValuesCanBeSwitchedOff) {
  set_exact("false");
  ASSERT_EQ(run({"run", "study.toml"}), 0) << output_;
  EXPECT_TRUE(read("study.h5").notes.empty());
  EXPECT_FALSE(read("study.h5").final->best_exact);
  ASSERT_EQ(run({"check", "study.toml"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("no exact values of final designs"));
}

TEST_F(SlowSteps, InvalidTimeLimitsAreRefused) {
  const std::string expected = "expected true, false, or a time limit of the exact values > 0 s, such as \"10 s\"";
  set_exact("\"0 s\"");
  EXPECT_EQ(run({"check", "study.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("study.toml:11: workspace.exact: found \"0 s\"; " + expected));
  set_exact("[1]");
  EXPECT_EQ(run({"check", "study.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr(expected));
  change("slow-exact.toml", "method = \"voxels\"\ncells = { x = 24, y = 24 }", "method = \"columns\"\nexact = true");
  EXPECT_EQ(run({"check", "study.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("this key requires method = \"voxels\""));
}

TEST_F(SlowSteps, ResultsAreStoredBeforeExactValuesAreComputed) {
  set_exact("\"1 h\"");
  for (const int number : {SIGINT, SIGTERM}) {
    ChildProcess child(command({"run", "study.toml", "--force"}), folder_);
    int code = 0;
    EXPECT_LT(stop_in_final_step(child, "study.h5", number, code), kSoon);
    EXPECT_EQ(code, 3) << child.output();
    const StudyContents left = read("study.h5");
    EXPECT_EQ(left.state, StudyState::interrupted);
    EXPECT_NEAR(left.final.value().best.value().volume, 0.2275, 1e-9);
    fs::remove(path("study.h5"));
  }
  ChildProcess killed(command({"run", "study.toml"}), folder_);
  int code = 0;
  stop_in_final_step(killed, "study.h5", SIGKILL, code);
  EXPECT_NEAR(read("study.h5").final.value().best.value().volume, 0.2275, 1e-9);
  const auto begin = Clock::now();
  EXPECT_EQ(run({"resume", "study.h5", "--time", "0.5 s"}), 3) << output_;
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 0.5 + 2 * kSoon);
  EXPECT_EQ(read("study.h5").state, StudyState::interrupted);
}

TEST_F(SlowSteps, SignalsStopAVeryLongEvaluation) {
  for (const int number : {SIGINT, SIGTERM}) {
    ChildProcess child(command({"run", "slow-evaluations.toml", "--quiet", "--output", "slow.h5", "--force"}), folder_);
    while (!fs::exists(path("slow.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    child.signal(number);
    const auto begin = Clock::now();
    EXPECT_EQ(child.wait(), 3) << child.output();
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), kSoon);
    const StudyContents left = read("slow.h5");
    EXPECT_EQ(left.state, StudyState::interrupted);
    for (const StageRecord& stage : left.stages)
      for (const Status status : stage.table.status) EXPECT_NE(status, Status::failed);
    fs::remove(path("slow.h5"));
  }
  EXPECT_EQ(run({"run", "slow-evaluations.toml", "--quiet", "--output", "slow.h5", "--time", "0.3 s"}), 3) << output_;
  EXPECT_THAT(output_, HasSubstr("stopped by time limit"));
}

TEST_F(SlowSteps, CheckIsLimitedInTime) {
  const auto begin = Clock::now();
  EXPECT_EQ(run({"check", "slow-evaluations.toml"}), 0) << output_;
  EXPECT_THAT(output_, ::testing::AnyOf(
                           HasSubstr("no sample designs were evaluated, because a single evaluation takes too long"),
                           HasSubstr("more would take longer than 10 s")));
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 60);
}

TEST_F(SlowSteps, TheEstimateIncludesDesignsThatDoNotFailAndCertificates) {
  // The centre of the bounds fails at once; the largest cylinder of other designs takes milliseconds, its certificate
  // seconds.
  ASSERT_EQ(run({"check", PKM_EXPERIMENTS "/mechanisms/quantities/rotary-delta-cylinder.toml"}), 0) << output_;
  EXPECT_THAT(output_, ::testing::ContainsRegex(
                           "at most 180 evaluations of (about|more than) [0-9.]+ m?s and 100 with derivatives"));
  EXPECT_THAT(output_,
              ::testing::ContainsRegex(", then certificates of the final designs in at most [0-9.]+ (s|min)\n"));
}

}  // namespace
}  // namespace pkm::testing
