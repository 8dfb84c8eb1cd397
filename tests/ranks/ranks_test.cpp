// Runs of a study by several MPI processes (ranks): bit-identical files for any number of ranks, resuming after kills,
// and rejection of inconsistent ranks.
#include <gmock/gmock.h>

#include <array>
#include <iostream>
#include <random>
#include <set>

#include "tests/cli/study_program.hpp"

#ifndef PKM_MPIRUN
#define PKM_MPIRUN ""
#endif

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHead = R"([study]
name = "ranks"
seed = 7
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5, step = 0.001 }
[workspace]
method = "columns"
limits = { alpha_min = 0.1, h_min = 0.06, beta_min = 0.1, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }
[[constraint]]
type = "workspace-shape"
)";
constexpr const char* kRatio = "[[objective]]\ntype = \"workspace-ratio\"\n";
constexpr const char* kVolume = "[[objective]]\ntype = \"workspace-volume\"\n";
constexpr const char* kGa = "[[stage]]\noptimiser = \"ga\"\npopulation = 40\ngenerations = 12\n";

class Ranks : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    if (!fs::exists(PKM_MPIRUN)) GTEST_SKIP() << "mpirun is missing, or the program was built without MPI";
    // Open MPI otherwise rejects root and more ranks than cores.
    for (const char* given :
         {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "OMPI_MCA_rmaps_base_oversubscribe"})
      setenv(given, "1", 1);
    // Open MPI's plugins leak memory, and are unloaded before the leaks can be attributed to them.
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
  }

  void write_toml(const std::string& rest, const std::string& head = kHead) const {
    std::ofstream(path("study.toml")) << head << rest;
  }
  /// Arguments of mpirun that start the program on a number of ranks.
  static std::vector<std::string> mpi_command(int ranks, std::vector<std::string> arguments,
                                              const std::string& program = PKM_PROGRAM) {
    const std::vector<std::string> words = {PKM_MPIRUN, "-n", std::to_string(ranks), "--bind-to", "none", program};
    arguments.insert(arguments.begin(), words.begin(), words.end());
    return arguments;
  }
  int run_on(int ranks, const std::vector<std::string>& arguments, const std::string& program = PKM_PROGRAM) {
    ChildProcess child(mpi_command(ranks, arguments, program), folder_);
    const int code = child.wait();
    output_ = child.output();
    return code;
  }
  /// Runs study.toml with each number of ranks, on 1 and 2 threads, and expects the file of a run by one process.
  void expect_same_files(const std::set<int>& ranks, const std::string& program = PKM_PROGRAM) {
    ChildProcess alone({program, "run", "study.toml", "--output", "alone.h5", "--quiet", "--threads", "1"}, folder_);
    ASSERT_EQ(alone.wait(), 0) << alone.output();
    for (const int count : ranks)
      for (const char* threads : {"1", "2"}) {
        const std::string file = std::to_string(count) + "x" + threads + ".h5";
        ASSERT_EQ(run_on(count, {"run", "study.toml", "--output", file, "--quiet", "--threads", threads}, program), 0)
            << output_;
        EXPECT_EQ(first_difference(read("alone.h5"), read(file)), "") << file;
      }
  }
  /// kHead without variables with steps and without constraints, which not all solvers handle.
  static std::string head_for_solvers() {
    std::string head = kHead;
    head.erase(head.find(", step = 0.001"), 14);
    return head.substr(0, head.find("[[constraint]]"));
  }
  /// Process ids of the ranks that have the argument `word` and run in the folder of this test. Other tests, which run
  /// at the same time, use files of the same name.
  std::vector<pid_t> find_ranks(const std::string& word) const {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      std::error_code ended;
      const fs::path folder = fs::read_symlink(entry.path() / "cwd", ended);
      if (line.starts_with(PKM_PROGRAM) && folder == fs::canonical(folder_, ended) &&
          line.find('\0' + word + '\0') != std::string::npos)
        found.push_back(std::stoi(name));
    }
    return found;
  }
  /// Kills one of two ranks at a random time, resumes the study with another number of ranks, and compares the file
  /// with that of an uninterrupted run. Repeats this twice, or PKM_RANK_KILLS times; studies that end before they
  /// are killed do not count.
  void expect_resumable_after_kills() {
    ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
    const char* const given = std::getenv("PKM_RANK_KILLS");
    const int kills = given ? std::atoi(given) : 2;
    const std::array<int, 3> others = {1, 3, 2};
    std::mt19937 engine(22);
    int killed = 0, longest = 1000;  // ms
    for (int attempt = 0; killed < kills; ++attempt) {
      ASSERT_LT(attempt, 3 * kills) << "the study ends too early to be killed";
      const std::string file = std::to_string(attempt) + ".h5";
      {
        ChildProcess child(mpi_command(2, {"run", "study.toml", "--output", file, "--quiet", "--threads", "1"}),
                           folder_);
        while (!fs::exists(path(file))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(
            std::chrono::milliseconds(20 + engine() % static_cast<std::mt19937::result_type>(longest)));
        const std::vector<pid_t> ranks = find_ranks(file);
        if (!ranks.empty()) kill(ranks[engine() % ranks.size()], SIGKILL);
        const bool survived = child.wait() == 0;
        killed += !survived;
        if (survived) longest = std::max(50, longest / 2);
      }
      const int other = others[static_cast<std::size_t>(attempt) % others.size()];
      if (read(file).state != StudyState::finished) {
        ASSERT_EQ(run_on(other, {"resume", file, "--quiet", "--threads", "1"}), 0) << output_;
      }
      EXPECT_EQ(first_difference(read("straight.h5"), read(file)), "") << file << " by " << other << " ranks";
    }
    std::cout << killed << " kills, all resumed\n";
  }
};

TEST_F(Ranks, ExchangeMessages) {
  for (const int ranks : {1, 2, 3}) {
    EXPECT_EQ(run_on(ranks, {"--exchange"}, PKM_RANK_PROGRAM), 0) << output_;
    EXPECT_THAT(output_, HasSubstr(std::to_string(ranks) + " ranks: all messages received"));
  }
}

TEST_F(Ranks, GeneticAlgorithmGivesTheSameFile) {
  write_toml(std::string(kRatio) + kGa);
  expect_same_files({1, 2, 3, 7});
}

TEST_F(Ranks, PythonFunctionsGiveTheSameFile) {
  std::ofstream(path("cost.py")) << "def cost(design):\n    return design['a'] ** 2 + design['l_u'] / design['b']\n";
  write_toml("[[objective]]\ntype = \"python\"\ncall = \"cost.py:cost\"\n" + std::string(kGa));
  expect_same_files({2});
}

TEST_F(Ranks, Nsga2GivesTheSameFile) {
  write_toml(std::string(kRatio) + kVolume + "[[stage]]\noptimiser = \"nsga2\"\npopulation = 40\ngenerations = 8\n");
  expect_same_files({1, 2, 3, 7});
}

TEST_F(Ranks, SweepsAndSolversGiveTheSameFile) {
  write_toml(std::string(kRatio) +
                 "[[stage]]\noptimiser = \"sweep\"\ndesign = \"full-factorial\"\npoints = 4\n"
                 "[[stage]]\noptimiser = \"sweep\"\npoints = 9\n"
                 "[[stage]]\noptimiser = \"nlopt\"\nstart = \"best-of-basins\"\nstarts = 2\n"
                 "multistart = 5\n",
             head_for_solvers());
  expect_same_files({1, 2, 3, 7});
}

TEST_F(Ranks, SharingOrientationsAndMotionsGivesTheSameFile) {
  write_toml(R"([mechanism]
type = "3crr-r-cru"
masses = "geometry"
[variables]
l_11 = { min = 0.2, max = 0.3 }
l_41 = { min = 0.2, max = 0.3 }
[[region]]
name = "task"
method = "columns"
nodes = { x = 3, y = 3 }
box = { x = [0.12, 0.2], y = [0.12, 0.2], z = [0.17, 0.24] }
phi = ["-60 deg", "-30 deg", 0, "30 deg", "60 deg"]
[[motion]]
name = "diagonal"
type = "points"
points = [{ x = 0.12, y = 0.12, z = 0.17, phi = 0 }, { x = 0.2, y = 0.2, z = 0.24, phi = "60 deg" }]
acceleration = 10
angular_acceleration = 100
[[objective]]
type = "dci"
region = "task"
[[constraint]]
type = "peak-force"
motion = "diagonal"
max = "12 N"
[[stage]]
optimiser = "sweep"
points = 2
[[stage]]
optimiser = "nlopt"
evaluations = 15
)",
             "");
  expect_same_files({1, 2});
}

TEST_F(Ranks, RunIpopt) {  // its sequential MUMPS defines MPI_Init, too
  write_toml(std::string(kRatio) + "[[stage]]\noptimiser = \"ipopt\"\nstart = \"none\"\nmultistart = 4\n",
             head_for_solvers());
  expect_same_files({2, 3});
}

TEST_F(Ranks, ClaimDesignsDynamicallyIfTheyTakeUnevenTimes) {
  write_toml(
      "[[objective]]\ntype = \"slow\"\n[[stage]]\noptimiser = \"sweep\"\ndesign = \"full-factorial\"\npoints = 20\n"
      "[[stage]]\noptimiser = \"ga\"\npopulation = 60\ngenerations = 3\n",
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.95 }\nb = { min = 0.5, max = 1 }\n");
  expect_same_files({2, 3}, PKM_RANK_PROGRAM);
}

TEST_F(Ranks, AreReportedWithTheirThreads) {
  write_toml(std::string(kRatio) + kGa);
  ASSERT_EQ(run_on(2, {"run", "study.toml", "--output", "two.h5", "--threads", "1"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr(" on 2 ranks x 1 thread, messages between ranks "));
  EXPECT_EQ(output_.find("this run:"), output_.rfind("this run:")) << "only one rank prints";
  const StudyContents two = read("two.h5");
  ASSERT_EQ(two.notes.size(), 1u);
  EXPECT_THAT(two.notes[0], HasSubstr("520 evaluations by 2 ranks x 1 thread on "));
}

TEST_F(Ranks, WarnOfMoreThreadsThanCores) {
  write_toml(std::string(kRatio) + kGa);
  const std::string cores = std::to_string(std::thread::hardware_concurrency());
  ASSERT_EQ(run_on(2, {"run", "study.toml", "--quiet", "--threads", cores}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("pkmopt: warning: "));
  EXPECT_THAT(output_, HasSubstr(" has 2 ranks of " + cores + " thread"));
}

TEST_F(Ranks, RunSeedsConsecutively) {
  write_toml(std::string(kRatio) + kGa);
  ASSERT_EQ(run({"run", "study.toml", "--seeds", "2", "--output", "alone.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run_on(2, {"run", "study.toml", "--seeds", "2", "--output", "two.h5", "--quiet"}), 0) << output_;
  for (const char* seed : {"-seed-7.h5", "-seed-8.h5"})
    EXPECT_EQ(first_difference(read(std::string("alone") + seed), read(std::string("two") + seed)), "");
}

TEST_F(Ranks, KilledAndResumedWithAnotherNumberGiveTheSameFile) {
  write_toml("[[stage]]\noptimiser = \"ga\"\npopulation = 40\ngenerations = 60\n[checkpoint]\nevery = 0\n",
             std::string(kHead) + kRatio);
  expect_resumable_after_kills();
}

TEST_F(Ranks, KilledInSolversAndResumedWithAnotherNumberGiveTheSameFile) {
  write_toml(
      "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"sbplx\"\nstart = \"none\"\nmultistart = 8\n"
      "evaluations = 30\n[checkpoint]\nevery = 0\n",
      head_for_solvers() + kVolume);
  expect_resumable_after_kills();
}

TEST_F(Ranks, MechanismFileGivesTheSameFileAlsoIfItIsRemoved) {
  fs::copy(PKM_EXPERIMENTS "/mechanisms/linear-delta.toml", path("delta.toml"));
  write_toml("[[stage]]\noptimiser = \"ga\"\npopulation = 40\ngenerations = 30\n[checkpoint]\nevery = 0\n",
             R"([mechanism]
file = "delta.toml"
[variables]
R = { min = 0.2, max = 0.4 }
rail2.l = { min = 0.4, max = 0.6 }
[workspace]
method = "voxels"
cells = { x = 12, y = 12, z = 12 }
[[objective]]
type = "workspace-volume"
)");
  expect_same_files({2, 3});
  expect_resumable_after_kills();
  const StudyContents alone = read("alone.h5");
  EXPECT_EQ(run_on(2, {"run", "study.toml", "--output", "left.h5", "--quiet", "--time", "10ms"}), 3) << output_;
  fs::remove(path("delta.toml"));
  EXPECT_EQ(run_on(3, {"resume", "left.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(alone, read("left.h5")), "");
}

TEST_F(Ranks, StopTogetherOnASignalOrATimeLimit) {
  write_toml("[[stage]]\noptimiser = \"ga\"\npopulation = 40\ngenerations = 100000\n", std::string(kHead) + kRatio);
  EXPECT_EQ(run_on(2, {"run", "study.toml", "--output", "time.h5", "--quiet", "--time", "300ms"}), 3) << output_;
  EXPECT_THAT(output_, HasSubstr("stopped by time limit, exit code 3, after "));
  EXPECT_EQ(read("time.h5").state, StudyState::interrupted);
  ChildProcess child(mpi_command(2, {"run", "study.toml", "--output", "signal.h5", "--quiet"}), folder_);
  while (!fs::exists(path("signal.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  for (const pid_t rank : find_ranks("signal.h5")) kill(rank, SIGTERM);
  EXPECT_EQ(child.wait(), 3) << child.output();
  EXPECT_THAT(child.output(), HasSubstr("stopped by SIGTERM, exit code 3, after "));
}

TEST_F(Ranks, AreNamedIfTheirResultsDiffer) {
  write_toml("[[objective]]\ntype = \"inconsistent\"\n" + std::string(kGa), kHead);
  EXPECT_NE(run_on(3, {"run", "study.toml", "--quiet"}, PKM_RANK_PROGRAM), 0);
  EXPECT_THAT(output_, HasSubstr("rank 1 on "));
  EXPECT_THAT(output_, HasSubstr("differ from those on rank 0 ("));
  EXPECT_THAT(output_, Not(HasSubstr("rank 2 on ")));
  // A single design, which each rank evaluates itself.
  write_toml("[[objective]]\ntype = \"inconsistent\"\n[[stage]]\noptimiser = \"sweep\"\n", kHead);
  EXPECT_NE(run_on(3, {"run", "study.toml", "--quiet", "--force"}, PKM_RANK_PROGRAM), 0);
  EXPECT_THAT(output_, HasSubstr("rank 1 on "));
  EXPECT_THAT(output_, HasSubstr("evaluations in generation 0 of stage 1 differ from those on rank 0 ("));
}

TEST_F(Ranks, AreNamedIfTheirInputsDiffer) {
  write_toml(std::string(kRatio) + kGa);
  std::ofstream(path("other.toml")) << kHead << kVolume << kGa;
  fs::create_directory(path("here"));
  fs::create_directory(path("there"));
  std::ofstream(path("here/study.toml")) << kHead << kRatio << kGa;
  std::ofstream(path("there/study.toml")) << kHead << kVolume << kGa;
  const auto two = [&](const std::vector<std::string>& first, const std::vector<std::string>& second) {
    std::vector<std::string> words = {PKM_MPIRUN, "--bind-to", "none", "-n", "1"};
    words.insert(words.end(), first.begin(), first.end());
    words.insert(words.end(), {":", "-n", "1"});
    words.insert(words.end(), second.begin(), second.end());
    ChildProcess child(words, folder_);
    const int code = child.wait();
    output_ = child.output();
    return code;
  };
  EXPECT_NE(two({PKM_PROGRAM, "run", "study.toml", "--quiet", "-o", "a.h5"},
                {PKM_PROGRAM, "run", "other.toml", "--quiet", "-o", "a.h5"}),
            0);
  EXPECT_THAT(output_,
              HasSubstr("called as 'pkmopt run other.toml --quiet -o a.h5', but as 'pkmopt run study.toml --quiet "
                        "-o a.h5' on rank 0 ("));
  EXPECT_NE(two({"--wdir", path("here"), PKM_PROGRAM, "run", "study.toml", "--quiet"},
                {"--wdir", path("there"), PKM_PROGRAM, "run", "study.toml", "--quiet"}),
            0);
  EXPECT_THAT(output_, HasSubstr("study.toml: differs from the file read on rank 0 ("));
  // A missing file is received from rank 0.
  fs::remove(path("there/study.toml"));
  EXPECT_EQ(two({"--wdir", path("here"), PKM_PROGRAM, "run", "study.toml", "--quiet", "--force"},
                {"--wdir", path("there"), PKM_PROGRAM, "run", "study.toml", "--quiet", "--force"}),
            0)
      << output_;
}

TEST_F(Ranks, EndTogetherIfRank0CannotStart) {
  write_toml("[[stage]]\noptimiser = \"gaa\"\n", std::string(kHead) + kRatio);
  EXPECT_EQ(run_on(3, {"run", "study.toml", "--quiet"}), 2);
  EXPECT_THAT(output_, HasSubstr("gaa"));
  EXPECT_EQ(output_.find("pkmopt: "), output_.rfind("pkmopt: ")) << output_;
  write_toml(std::string(kRatio) + kGa);
  EXPECT_EQ(run_on(2, {"run", "study.toml", "--quiet", "--output", "no/folder.h5"}), 1) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("MPI_ABORT"))) << output_;
}

TEST_F(Ranks, RunOtherCommandsOnRank0Only) {
  EXPECT_EQ(run_on(2, {"list", "optimisers"}), 0) << output_;
  EXPECT_EQ(output_.find("  sweep"), output_.rfind("  sweep")) << output_;
}

// The launcher of another MPI library starts N processes that cannot communicate.
TEST_F(StudyProgram, ProcessesWithoutTheirLauncherAreRejected) {
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // leaks of MPI, see above
  setenv("PMI_SIZE", "3", 1);
  for (const char* rank : {"0", "1"}) {
    setenv("PMI_RANK", rank, 1);
    EXPECT_EQ(run({"list"}), 1);
    if (*rank == '0')
      EXPECT_THAT(output_, ::testing::StartsWith("pkmopt: mpiexec has started 3 processes, but "));
    else
      EXPECT_EQ(output_, "");
  }
  unsetenv("PMI_SIZE");
  unsetenv("PMI_RANK");
}

}  // namespace
}  // namespace pkm::testing
