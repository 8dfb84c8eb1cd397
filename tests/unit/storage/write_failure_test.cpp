// Tests of failing writes (full disk, read-only folder, killed process): the error is reported in one sentence and the
// previous study file is intact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "engine/storage/study_file.hpp"
#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using test::slurp;
using test::storage_error;

/// Runs `action` in a child process whose files are limited to `bytes`.
/// @return the message of its StorageError; "" if there is none
template <class F>
std::string error_under_limit(rlim_t bytes, F action) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string text = storage_error(action);
    const bool sent = ::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::_exit(sent ? 0 : 1);
  }
  ::close(ends[1]);
  std::string text(4096, '\0');
  const ssize_t n = ::read(ends[0], text.data(), text.size());
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  return text;
}

TEST(WriteFailure, LastCheckpointSurvivesAFullDisk) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, StudyContents{});
  const std::string before = slurp(path);
  StudyContents larger = test::sample_study();
  larger.stages.push_back(test::sample_stage(larger.problem.shape(), 50, 20));
  for (const rlim_t limit : {rlim_t{0}, rlim_t{1}, rlim_t{512}, rlim_t{4096}, rlim_t{30000}}) {
    EXPECT_EQ(error_under_limit(limit, [&] { write_study(path, larger); }),
              path + ": cannot be written; any previous file is unchanged (File too large)");
    EXPECT_EQ(slurp(path), before);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"s.h5"});
  }
  write_study(path, larger);  // succeeds when there is space again
  EXPECT_EQ(first_difference(read_study(path), larger), "");
}

TEST(WriteFailure, FolderInWhichNoFileCanBeCreated) {
  // The tests may run as root, to whom permissions do not apply; in /proc no user can create a file.
  EXPECT_EQ(storage_error([] { write_study("/proc/s.h5", StudyContents{}); }),
            "/proc/s.h5: cannot be written, because no file can be created in its folder (No such file or directory)");
  const Folder folder;
  test::spill(folder / "file", "a file, not a folder");
  const std::string path = folder / "file/s.h5";
  EXPECT_EQ(storage_error([&] { write_study(path, StudyContents{}); }),
            path + ": cannot be written, because no file can be created in its folder (Not a directory)");
}

TEST(WriteFailure, TargetIsAFolder) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  std::filesystem::create_directory(path);
  EXPECT_EQ(storage_error([&] { write_study(path, StudyContents{}); }), path + ": is a folder and is not replaced");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.h5"});
}

TEST(WriteFailure, TargetIsADevice) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  ASSERT_EQ(::mkfifo(path.c_str(), 0666), 0);  // in place of a device, which only root can create
  const std::string error = path + ": is not a regular file and is not replaced";
  EXPECT_EQ(storage_error([&] { write_study(path, StudyContents{}); }), error);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
  std::filesystem::create_symlink("s.h5", folder / "link.h5");
  EXPECT_EQ(storage_error([&] { write_study(folder / "link.h5", StudyContents{}); }),
            folder / "link.h5" + ": is not a regular file and is not replaced");
}

TEST(WriteFailure, SymbolicLinksRemainAndTheirTargetIsReplaced) {
  const Folder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/s.h5", folder / "link.h5");  // the target does not exist yet
  std::filesystem::create_symlink(folder / "link.h5", folder / "second.h5");
  StudyContents study;
  for (study.seed = 5; study.seed < 7; ++study.seed) {
    write_study(folder / "second.h5", study);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.h5"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "second.h5"));
    EXPECT_EQ(read_study(folder / "there/s.h5").seed, study.seed);
  }
}

TEST(WriteFailure, CircularSymbolicLinks) {
  const Folder folder;
  std::filesystem::create_symlink("b.h5", folder / "a.h5");
  std::filesystem::create_symlink("a.h5", folder / "b.h5");
  EXPECT_EQ(storage_error([&] { write_study(folder / "a.h5", StudyContents{}); }),
            folder / "a.h5" + ": cannot be opened (Too many levels of symbolic links)");
}

TEST(WriteFailure, InconsistentContentsAreNotWritten) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  StudyContents study = test::sample_study();
  study.stages[0].generations.population[5] = 12;
  EXPECT_EQ(storage_error([&] { write_study(path, study); }),
            path + ": cannot be written (/stages/1: generations: population: row index out of range)");
  study = test::sample_study();
  study.stages[0].table.designs.pop_back();
  EXPECT_EQ(storage_error([&] { write_study(path, study); }),
            path + ": cannot be written (/stages/1/evaluations/design: has 23 values, but 12 x 2 are expected)");
  study = test::sample_study();
  study.stages[0].generations.best_row.push_back(3);
  EXPECT_EQ(storage_error([&] { write_study(path, study); }),
            path + ": cannot be written (/stages/1: generations: arrays of different lengths)");
  study = test::sample_study();
  study.final.emplace().best.emplace();
  study.best = {};
  EXPECT_EQ(storage_error([&] { write_study(path, study); }),
            path + ": cannot be written (/best: row is -1, but /final/best exists)");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(WriteFailure, KilledWriterLeavesACompleteFile) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  StudyContents study = test::sample_study();
  study.stages.push_back(test::sample_stage(study.problem.shape(), 50, 20));
  write_study(path, study);
  for (int kill = 0; kill < 20; ++kill) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (study.seed = 0;; ++study.seed) write_study(path, study);
    }
    ::usleep(static_cast<useconds_t>(3000 + 1777 * kill));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    StudyContents read = read_study(path);
    read.seed = study.seed;
    EXPECT_EQ(first_difference(read, study), "");
  }
  write_study(path, study);  // temporary files of killed writers do not interfere
}

}  // namespace
}  // namespace pkm
