// Studies run by the built program: numbers of threads and seeds, existing files, concurrent processes, full disks,
// invalid input.
#include <sys/inotify.h>

#include "tests/cli/ga_program.hpp"

namespace pkm::testing {
namespace {

TEST_F(GaProgram, OneTwoAndSevenThreadsGiveTheSameResult) {
  write_toml(40);
  for (const char* threads : {"1", "2", "7"})
    ASSERT_EQ(run({"run", "study.toml", "--output", std::string(threads) + ".h5", "--threads", threads, "--quiet"}), 0)
        << output_;
  EXPECT_EQ(first_difference(read("1.h5"), read("2.h5")), "");
  EXPECT_EQ(first_difference(read("1.h5"), read("7.h5")), "");
}

TEST_F(GaProgram, NumberOfThreadsFromEnvironmentOrOption) {
  write_toml(5);
  ASSERT_EQ(setenv("OMP_NUM_THREADS", "3", 1), 0);
  EXPECT_EQ(run({"run", "study.toml", "--force"}), 0);
  EXPECT_NE(output_.find(" on 3 threads"), std::string::npos) << output_;
  EXPECT_EQ(run({"run", "study.toml", "--force", "--threads", "2"}), 0);
  EXPECT_NE(output_.find(" on 2 threads"), std::string::npos) << output_;
  ASSERT_EQ(setenv("OMP_NUM_THREADS", " 2,1", 1), 0);  // for nested parallel regions, too
  EXPECT_EQ(run({"run", "study.toml", "--force"}), 0);
  EXPECT_NE(output_.find(" on 2 threads"), std::string::npos) << output_;
  for (const char* given : {"0", "-1", "1025", "1e2", "many", "99999999999999999999"}) {
    ASSERT_EQ(setenv("OMP_NUM_THREADS", given, 1), 0);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"run", "study.toml", "--force"},
                                                    {"resume", "study.h5"},
                                                    {"evaluate", "study.toml"},
                                                    {"workspace", "study.toml"}}) {
      EXPECT_EQ(run(command), 2) << command[0];
      EXPECT_NE(output_.find("pkmopt: OMP_NUM_THREADS: found '" + std::string(given) +
                             "'; expected a whole number from 1 to 1024, in decimal without leading zeros\n"),
                std::string::npos)
          << output_;
    }
    EXPECT_EQ(run({"run", "study.toml", "--force", "--threads", "2"}), 0) << output_;
  }
  unsetenv("OMP_NUM_THREADS");
  EXPECT_EQ(run({"run", "study.toml", "--threads", "1025"}), 2);
  EXPECT_NE(output_.find("pkmopt: --threads: found '1025'; expected a whole number from 1 to 1024, in decimal"),
            std::string::npos)
      << output_;
}

TEST_F(GaProgram, ExistingFilesAreNotOverwritten) {
  write_toml(2);
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  ASSERT_TRUE(fs::exists(path("study.h5")));
  EXPECT_EQ(run({"run", "study.toml", "--quiet"}), 1);
  EXPECT_EQ(output_, "pkmopt: study.h5 exists already; resume it with --resume, or overwrite it with --force\n");
  EXPECT_EQ(run({"run", "study.toml", "--quiet", "--force"}), 0) << output_;
  EXPECT_EQ(run({"run", "study.toml", "--quiet", "--resume"}), 0) << output_;
  EXPECT_EQ(run({"run", "study.toml", "--quiet", "--resume", "--seed", "8"}), 1);
  EXPECT_NE(output_.find("study.h5 holds the study with seed 7, not 8"), std::string::npos) << output_;
  EXPECT_EQ(run({"run", "study.toml", "--seed", "-1"}), 2);
  write_toml(3);
  EXPECT_EQ(run({"run", "study.toml", "--quiet", "--resume"}), 1);
  EXPECT_NE(output_.find("study.h5 holds a study whose text differs from study.toml"), std::string::npos) << output_;
}

TEST_F(GaProgram, OutputIsNoInputAndHasAName) {
  write_toml(2);
  const auto size = fs::file_size(path("study.toml"));
  EXPECT_EQ(run({"run", "study.toml", "--output", "study.toml", "--force"}), 2);
  EXPECT_EQ(output_, "pkmopt: study.toml: is read by this command, so it is not overwritten\n");
  EXPECT_EQ(fs::file_size(path("study.toml")), size);
  EXPECT_EQ(run({"run", "study.toml", "--output", ""}), 2);
  EXPECT_EQ(output_, "pkmopt: --output: the value is empty\n");
  EXPECT_FALSE(fs::exists(path("study.h5")));
  std::ofstream(folder_ + "/precious.txt") << "precious";
  std::ofstream(folder_ + "/nul.toml") << "[study]\noutput = \"precious.txt\\u0000.h5\"\n"
                                       << "[mechanism]\n";
  EXPECT_EQ(run({"run", "nul.toml", "--force"}), 2) << output_;
  EXPECT_EQ(fs::file_size(path("precious.txt")), 8u);
}

TEST_F(GaProgram, ASecondProcessIsRefused) {
  write_toml(100000, "");
  ChildProcess first(command({"run", "study.toml", "--quiet"}), folder_);
  while (!fs::exists(path("study.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  fs::create_directory(folder_ + "/elsewhere");
  ChildProcess second(command({"resume", path("study.h5"), "--quiet"}), folder_ + "/elsewhere");
  EXPECT_EQ(second.wait(), 1);
  EXPECT_NE(second.output().find("in use by process"), std::string::npos) << second.output();
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait(), 3);
}

TEST_F(GaProgram, ResumeReadsTheStudyFileOnce) {
  write_toml(3, "");
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  StudyContents unfinished = read("study.h5");
  unfinished.state = StudyState::interrupted;
  unfinished.final.reset();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"resume", "study.h5", "--quiet"}, {"run", "study.toml", "--resume", "--quiet"}}) {
    write_study(path("study.h5"), unfinished);
    const int watch = inotify_init1(IN_NONBLOCK);
    ASSERT_GE(inotify_add_watch(watch, path("study.h5").c_str(), IN_OPEN), 0);
    EXPECT_EQ(run(arguments), 0) << output_;
    std::array<inotify_event, 64> events;  // events of a watched file have no name
    const ssize_t bytes = ::read(watch, events.data(), sizeof events);
    ::close(watch);
    // Opened for its first 64 KiB, and if it is longer for the whole file.
    EXPECT_EQ(bytes, static_cast<ssize_t>((fs::file_size(path("study.h5")) < 65536 ? 1 : 2) * sizeof(inotify_event)));
    EXPECT_EQ(read("study.h5").state, StudyState::finished);
  }
}

TEST_F(GaProgram, AFullDiskIsAnErrorAndTheLastCheckpointStays) {
  write_toml(120);
  ChildProcess::Settings small;
  small.file_size = 110'000;  // the first checkpoints fit, later ones do not
  EXPECT_EQ(run({"run", "study.toml", "--quiet"}, small), 1);
  EXPECT_NE(output_.find("study.h5"), std::string::npos) << output_;
  EXPECT_NE(output_.find("any previous file is unchanged (File too large)"), std::string::npos) << output_;
  const StudyContents left = read("study.h5");
  EXPECT_GT(left.evaluations(), 0);
  for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_NE(entry.path().extension(), ".part");
  ASSERT_EQ(run({"resume", "study.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("straight.h5"), read("study.h5")), "");
}

TEST_F(GaProgram, ResultIsPrintedBeforeAWriteError) {
  write_toml(120, "[checkpoint]\nevery = 1000\n");  // only the first and the last write
  ChildProcess::Settings small;
  small.file_size = 110'000;
  const std::string failure = "any previous file is unchanged (File too large)";
  for (const bool quiet : {false, true}) {
    std::vector<std::string> command = {"run", "study.toml", "--force"};
    if (quiet) command.push_back("--quiet");
    EXPECT_EQ(run(command, small), 1);
    const auto result = output_.find("kill me: finished, "), best = output_.find("workspace-ratio  ");
    EXPECT_LT(result, best) << output_;
    EXPECT_LT(best, output_.find(failure)) << output_;
    EXPECT_NE(output_.find(failure), std::string::npos) << output_;
    EXPECT_EQ(output_.find("written to"), std::string::npos) << output_;
    EXPECT_EQ(read("study.h5").evaluations(), 0);
  }
  EXPECT_EQ(run({"resume", "study.h5", "--quiet"}, small), 1);
  EXPECT_LT(output_.find("kill me: finished, "), output_.find(failure)) << output_;
  EXPECT_EQ(run({"run", "study.toml", "--seeds", "3"}, small), 1);
  EXPECT_LT(output_.find("kill me, 1 of 3 seeds"), output_.find(failure)) << output_;
  EXPECT_NE(output_.find("not written"), std::string::npos) << output_;
  ASSERT_EQ(run({"resume", "study.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("straight.h5"), read("study.h5")), "");
}

TEST_F(GaProgram, ExactValuesAreThoseWithinTheBox) {
  double whole = 0;
  for (const std::string box : {"[0, 1]", "[0.4, 0.5]"}) {
    SCOPED_TRACE(box);
    std::ofstream(path("study.toml")) << "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 "
                                         "}\n[workspace]\nmethod = \"voxels\"\nbox = { z = [-2, 0], theta = [\"-90 "
                                         "deg\", \"90 deg\"], x = "
                                      << box
                                      << " }\n[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = "
                                         "\"ga\"\npopulation = 4\ngenerations = 2\n";
    ASSERT_EQ(run({"run", "study.toml", "--force"}), 0) << output_;
    EXPECT_NE(output_.find("workspace-volume, exact"), std::string::npos) << output_;
    EXPECT_EQ(output_.find("no exact values"), std::string::npos) << output_;
    const StudyContents study = read("study.h5");
    const double counted = study.final->best->volume, exact = study.final->best_exact->volume;
    EXPECT_NEAR(counted / exact, 1, 0.02);
    if (box == "[0, 1]")
      whole = exact;
    else
      EXPECT_LT(exact, 0.5 * whole);
  }
}

TEST_F(GaProgram, UnusableFilesAreErrors) {
  write_toml(2);
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  EXPECT_EQ(run({"resume", "none.h5"}), 1);
  EXPECT_NE(output_.find("none.h5"), std::string::npos);
  EXPECT_EQ(run({"run", "study.toml", "--output", "study.toml/x.h5"}), 1) << output_;
  std::ofstream(folder_ + "/text.h5") << "not a study";
  EXPECT_EQ(run({"show", "text.h5"}), 1);
  EXPECT_NE(output_.find("text.h5"), std::string::npos);
  fs::copy(path("study.h5"), path("cut.h5"));
  fs::resize_file(path("cut.h5"), fs::file_size(path("cut.h5")) / 2);
  EXPECT_EQ(run({"resume", "cut.h5"}), 1);
  EXPECT_NE(output_.find("cut.h5"), std::string::npos);
  EXPECT_EQ(fs::file_size(path("cut.h5")), fs::file_size(path("study.h5")) / 2) << "left untouched";
}

TEST_F(GaProgram, ReportsTheViolatedConstraintIfNothingIsFeasible) {
  std::ofstream(folder_ + "/no.toml") << R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.2, max = 0.3 }
[workspace]
method = "columns"
[[objective]]
type = "workspace-volume"
[[constraint]]
type = "conditioning"
min = 0.9
[[stage]]
optimiser = "ga"
population = 8
generations = 3
)";
  ASSERT_EQ(run({"run", "no.toml"}), 4) << output_;
  EXPECT_NE(
      output_.find(
          "nothing feasible was found; this is the least infeasible design: conditioning is violated, margin -0."),
      std::string::npos)
      << output_;
}

TEST_F(GaProgram, SeedsAreRepeatedIntoSeparateFiles) {
  write_toml(5);
  ASSERT_EQ(run({"run", "study.toml", "--seeds", "3"}), 0) << output_;
  for (const char* name : {"study-seed-7.h5", "study-seed-8.h5", "study-seed-9.h5"})
    EXPECT_TRUE(fs::exists(path(name)));
  EXPECT_NE(output_.find("median"), std::string::npos);
  EXPECT_NE(output_.find("3 of 3 seeds ended feasible"), std::string::npos) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--seed", "8", "--output", "eight.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("eight.h5"), read("study-seed-8.h5")), "");
  EXPECT_NE(first_difference(read("eight.h5"), read("study-seed-9.h5")), "");
}

}  // namespace
}  // namespace pkm::testing
