// The page of a running study: its text, its final state, and the share of the run time that writing it takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "engine/core/error.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/live_page.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const LivePageState kRunning{
    .study_file = "s.h5",
    .updated = "2026-01-02T03:04:05Z",
    .progress = {.stages = 3, .evaluation_limit = 5000, .evaluations_per_second = 12.5, .left = 5400, .seconds = 600}};

/// The sample study while it runs.
StudyContents running_study() {
  StudyContents contents = test::sample_study();
  contents.name = "a <b> & c";
  contents.final.reset();
  return contents;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(LivePage, RunningPageShowsProgressBestDesignAndCurves) {
  const StudyContents contents = running_study();
  const std::string page = live_page_text(contents, kRunning);
  EXPECT_THAT(page, HasSubstr("<meta http-equiv=\"refresh\" content=\"5\">"));
  EXPECT_THAT(page, HasSubstr("<title>running: a &lt;b&gt; &amp; c</title>"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("state of 2026-01-02T03:04:05Z"));
  EXPECT_THAT(page, HasSubstr("<tr><th>time left, at most</th><td>1 h 30 min</td></tr>"));
  EXPECT_THAT(page, HasSubstr("width:10.0%"));  // 10 minutes of 100
  EXPECT_THAT(page, HasSubstr("of at most 5000"));
  EXPECT_THAT(page, HasSubstr("12.5 evaluations/s"));
  for (const Variable& variable : contents.problem.variables) EXPECT_THAT(page, HasSubstr("<th>" + variable.name));
  // one chart per objective, and one of the hypervolume if there is a front
  const bool has_front = std::ranges::any_of(contents.stages, &StageRecord::has_front);
  EXPECT_EQ(count_of(page, " over the generations</h2>"), contents.problem.objectives.size() + (has_front ? 1 : 0));
  EXPECT_GE(count_of(page, "<path "), 1u);
}

TEST(LivePage, CurvesShowTheBestFeasibleValueOfEachGeneration) {
  StudyContents contents;
  contents.name = "three generations";
  contents.problem.objectives = {{.name = "length", .unit = "m", .direction = Direction::minimise}};
  contents.problem.variables = {{"a", "m", 0, 1}};
  StageRecord& stage = contents.stages.emplace_back();
  stage.optimiser = "ga";
  stage.table = EvaluationTable(contents.problem.shape());
  stage.table.extend(5);
  stage.table.designs = {0.25, 0.25, 0.25, 0.25, 0.25};
  stage.table.objectives = {0.5, 0.4, 0.2, 0.3, 0.35};
  stage.table.status = {Status::infeasible, Status::feasible, Status::infeasible, Status::feasible, Status::feasible};
  stage.generations.first_row = {0, 1, 3};
  stage.generations.feasible_share = {0, 0.5, 1};
  stage.generations.seconds = {1, 2, 3};
  contents.best = {0, 3};
  const std::string page = live_page_text(contents, kRunning);
  EXPECT_THAT(page, HasSubstr(">400</text>"));  // maximum; the infeasible 0.5 m and 0.2 m do not count
  EXPECT_THAT(page, HasSubstr(">300</text>"));
  EXPECT_THAT(page, HasSubstr("<h2>length [mm], best value over the generations</h2>"));
  EXPECT_THAT(page, HasSubstr("<td>300 mm</td>"));
  std::smatch path;
  ASSERT_TRUE(std::regex_search(page, path, std::regex("<path [^>]*d=\"M([0-9.]+) 12.0L628.0 210.0h0\"")));
  EXPECT_NEAR(std::stod(path[1]), (96 + 628) / 2.0, 0.1);  // the first generation has no feasible design
  EXPECT_THAT(page, HasSubstr("No bound and no constraint is active."));
}

TEST(LivePage, FinalStatesDoNotReload) {
  LivePageState state = kRunning;
  state.state = StudyState::finished;
  state.report = "s & t.html";
  const std::string finished = live_page_text(running_study(), state);
  EXPECT_THAT(finished, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_THAT(finished, HasSubstr("The study is finished: <a href=\"s &amp; t.html\">report</a>."));
  EXPECT_THAT(finished, Not(HasSubstr("time left")));
  state.report.clear();
  EXPECT_THAT(live_page_text(running_study(), state), HasSubstr("<code>pkmopt report s.h5</code> writes the report"));
  state.state = StudyState::interrupted;
  state.stopped = "SIGINT";
  const std::string stopped = live_page_text(running_study(), state);
  EXPECT_THAT(stopped, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_THAT(stopped, HasSubstr("The run was stopped by SIGINT. <code>pkmopt resume s.h5 --live</code>"));
  state.failure = "the disk is full & read-only";
  const std::string failed = live_page_text(running_study(), state);
  EXPECT_THAT(failed, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_THAT(failed, HasSubstr("<title>failed: a &lt;b&gt; &amp; c</title>"));
  EXPECT_THAT(failed, HasSubstr("The run ended with an error: the disk is full &amp; read-only. <code>pkmopt resume "
                                "s.h5 --live</code> continues the study"));
}

TEST(LivePage, WritingTakesAtMostOneHalfPercentOfTheTime) {
  const StudyContents contents = running_study();
  for (const double cost : {1e-9, 0.05}) {
    const test::Folder folder;
    const std::string path = folder / "s.live.html";
    double time = 0;
    const auto clock = [&] { return time += cost; };  // a write reads the clock twice, so that it takes this long
    LivePage page(path, "s.h5", contents, clock);
    ASSERT_TRUE(fs::exists(path));
    int writes = 0;
    while (time < 60) {
      time += 0.1;
      fs::remove(path);
      page.update(contents, {});
      writes += fs::exists(path) ? 1 : 0;
    }
    EXPECT_LE(writes * cost, 0.005 * time);
    EXPECT_NEAR(writes, cost > 0.01 ? 5 : 29, 1.5);  // every 10 s; every 2 s
  }
}

TEST(LivePage, LaterFailuresDoNotEndARun) {
  const test::Folder folder;
  fs::create_directory(folder / "gone");
  double time = 0;
  LivePage page(folder / "gone/s.live.html", "s.h5", running_study(), [&] { return time; });
  fs::remove_all(folder / "gone");
  time = 10;
  EXPECT_NO_THROW(page.update(running_study(), {}));
  EXPECT_THROW(LivePage(folder / "gone/s.live.html", "s.h5", running_study()), StorageError);
}

}  // namespace
}  // namespace pkm
