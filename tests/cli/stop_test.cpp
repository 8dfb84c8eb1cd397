// Studies that are killed at random times, stopped by signals or time limits, and resumed.
#include <array>

#include "tests/cli/ga_program.hpp"

namespace pkm::testing {
namespace {

TEST_F(GaProgram, KilledAtRandomInstantsAndResumedEndsTheSame) {
  write_toml(50);
  kill_at_random(4, 20);
}

TEST_F(GaProgram, AChainOfKillsEndsTheSame) {
  write_toml(120);
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  std::mt19937 engine(21);
  int kills = 0;
  std::vector<std::string> next = {"run", "study.toml", "--output", "chain.h5", "--quiet"};
  for (; kills < 12; ++kills) {
    ChildProcess child(command(next), folder_);
    while (!fs::exists(path("chain.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + engine() % 60));
    child.signal(SIGKILL);
    if (child.wait() == 0) break;
    next = {"resume", "chain.h5", "--quiet"};
  }
  if (kills == 12) {
    ASSERT_EQ(run({"resume", "chain.h5", "--quiet"}), 0) << output_;
  }
  EXPECT_GT(kills, 1);
  EXPECT_EQ(first_difference(read("straight.h5"), read("chain.h5")), "");
}

TEST_F(GaProgram, SignalsStopWithACheckpointAndTheResumeCommand) {
  write_toml(3000, "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  int stopped = 0;
  for (const int number : {SIGINT, SIGTERM}) {
    const std::string file = number == SIGINT ? "int.h5" : "term.h5";
    int code = 0;
    std::string output;
    {
      ChildProcess child(command({"run", "study.toml", "--output", file}), folder_);
      while (!fs::exists(path(file))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      child.signal(number);
      code = child.wait();
      output = child.output();
    }
    if (code == 3) {
      ++stopped;
      EXPECT_EQ(read(file).state, StudyState::interrupted);
      EXPECT_NE(output.find(number == SIGINT ? "stopped by SIGINT (Ctrl-C), exit code 3, after"
                                             : "stopped by SIGTERM, exit code 3, after"),
                std::string::npos);
      EXPECT_NE(output.find("resume with: pkmopt resume " + file), std::string::npos) << output;
      ASSERT_EQ(run({"resume", file}), 0) << output_;
    }
    EXPECT_EQ(first_difference(read("straight.h5"), read(file)), "");
  }
  EXPECT_GT(stopped, 0) << "the study ended before either signal";
}

TEST_F(GaProgram, ASignalSentTwiceAtOnceStillStopsWithACheckpoint) {
  write_toml(100000, "");  // `timeout` signals the child and then its group
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    const std::string file = "twice-" + std::to_string(number) + ".h5";
    ChildProcess child(command({"run", "study.toml", "--output", file, "--quiet"}), folder_);
    while (!fs::exists(path(file))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    child.signal(number);
    child.signal(number);
    EXPECT_EQ(child.wait(), 3) << number << child.output();
    EXPECT_EQ(read(file).state, StudyState::interrupted);
  }
}

TEST_F(GaProgram, ASignalStopsAllSeeds) {
  write_toml(60, "");
  ChildProcess child(command({"run", "study.toml", "--seeds", "1000"}), folder_);
  while (!fs::exists(path("study-seed-9.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.signal(SIGINT);
  EXPECT_EQ(child.wait(), 3) << child.output();
  EXPECT_NE(child.output().find("resume with: pkmopt run study.toml --seeds 1000 --seed 7 --resume --output study.h5"),
            std::string::npos)
      << child.output();
  EXPECT_NE(child.output().find("of 1000 seeds"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("study-seed-500.h5")));
}

TEST_F(GaProgram, ATimeLimitStopsEarlyAndTheStudyCanBeResumed) {
  write_toml(3000, "");
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  {
    ChildProcess child(command({"run", "study.toml", "--output", "t.h5", "--quiet"}), folder_);
    while (!fs::exists(path("t.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    child.signal(SIGKILL);
    child.wait();
  }
  EXPECT_EQ(run({"resume", "t.h5", "--time", "5 ms"}), 3) << output_;
  EXPECT_NE(output_.find("stopped by time limit, exit code 3, after"), std::string::npos) << output_;
  EXPECT_EQ(run({"resume", "t.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("straight.h5"), read("t.h5")), "");
}

TEST_F(GaProgram, AnIgnoredHangupDoesNotStopTheRun) {
  write_toml(60);
  ChildProcess child(command({"run", "study.toml", "--quiet"}), folder_, {.ignores_hangup = true});
  while (!fs::exists(path("study.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.signal(SIGHUP);
  EXPECT_EQ(child.wait(), 0) << child.output();
}

}  // namespace
}  // namespace pkm::testing
