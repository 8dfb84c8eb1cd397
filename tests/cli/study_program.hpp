// Test fixture that runs the built program in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <random>
#include <thread>

#include "engine/storage/study_file.hpp"
#include "tests/cli/child_process.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {

namespace fs = std::filesystem;

/// A temporary folder for studies, and functions that run the program in it.
class StudyProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "pkmopt-study-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  int run(const std::vector<std::string>& arguments, ChildProcess::Settings settings = {}) {
    ChildProcess child(command(arguments), folder_, settings);
    const int code = child.wait();
    output_ = child.output();
    return code;
  }
  static std::vector<std::string> command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), PKM_PROGRAM);
    return arguments;
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  StudyContents read(const std::string& name) const { return read_study(path(name)); }

  /// Runs study.toml several times, kills each run by SIGKILL at a random time and resumes it. Expects that each result
  /// is bit-identical to that of a run without interruption, and that at least `kills` / 2 runs were killed while the
  /// study was running. If fewer were, because other processes change the duration of a run, more runs are killed.
  void kill_at_random(int kills, unsigned seed) {
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
    const double straight_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const StudyContents straight = read("straight.h5");
    ASSERT_EQ(straight.state, StudyState::finished);

    std::mt19937 engine(seed);
    int killed_while_running = 0, identical = 0, tried = 0;
    for (int i = 0; i < kills || (killed_while_running < kills / 2 && i < 4 * kills); ++i) {
      const std::string file = "killed-" + std::to_string(i) + ".h5";
      {
        ChildProcess child(command({"run", "study.toml", "--output", file, "--quiet"}), folder_);
        const double wait_ms = straight_ms * static_cast<double>(engine() % 1000) / 1000;
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(wait_ms));
        child.signal(SIGKILL);
        child.wait();
      }
      if (fs::exists(path(file))) {
        const StudyContents left = read(file);  // throws if the file is not complete
        if (left.state == StudyState::running) ++killed_while_running;
        ASSERT_EQ(run({"resume", file, "--quiet"}), 0) << output_;
      } else {
        ASSERT_EQ(run({"run", "study.toml", "--output", file, "--quiet"}), 0)
            << output_;  // killed before the first write
      }
      const std::string difference = first_difference(straight, read(file));
      EXPECT_EQ(difference, "") << "kill " << i;
      identical += difference.empty();
      ++tried;
    }
    std::cout << tried << " runs killed by SIGKILL, " << killed_while_running
              << " of them while the study was running, " << identical << " ended bit-identical after resuming\n";
    EXPECT_GE(killed_while_running, kills / 2);
  }

  std::string folder_, output_;
};

}  // namespace pkm::testing
