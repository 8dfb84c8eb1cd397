// Tests of StudyLock: only one process can lock a study, and a killed process does not block it.
#include "engine/storage/study_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>

#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using test::storage_error;

/// Starts a child process that locks the study until it is killed.
/// @return its process id, once it holds the lock; -1 if it does not
pid_t start_holder(const std::string& path) {
  int ends[2];
  if (::pipe(ends) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    const StudyLock lock(path);
    const bool reported = ::write(ends[1], "x", 1) == 1;
    while (reported) ::pause();
    ::_exit(1);
  }
  ::close(ends[1]);
  char byte = 0;
  const bool locked = ::read(ends[0], &byte, 1) == 1;
  ::close(ends[0]);
  return locked ? child : -1;
}

void kill_hard(pid_t child) {
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

TEST(StudyLock, ErrorNamesTheProcessThatHoldsTheLock) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  const pid_t child = start_holder(path);
  ASSERT_GT(child, 0);
  const std::string error = storage_error([&] { const StudyLock lock(path); });
  kill_hard(child);
  EXPECT_THAT(error, testing::StartsWith(path + ": in use by process " + std::to_string(child)));
  EXPECT_THAT(error, testing::EndsWith(" (it holds " + path + ".lock)"));
}

TEST(StudyLock, OfAKilledProcessBlocksNoOtherProcess) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  const pid_t child = start_holder(path);
  ASSERT_GT(child, 0);
  kill_hard(child);
  ASSERT_TRUE(std::filesystem::exists(path + ".lock"));
  const StudyLock lock(path);
  EXPECT_THAT(test::slurp(path + ".lock"), testing::StartsWith("pkmopt-lock " + std::to_string(::getpid())));
}

TEST(StudyLock, CanBeOwnedOnlyOnceAndIsRemovedAtItsEnd) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  for (int i = 0; i < 3; ++i) {
    const StudyLock lock(path);
    EXPECT_NE(storage_error([&] { const StudyLock second(path); }), "");
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
}

TEST(StudyLock, OfAnotherStudyIsIndependent) {
  const Folder folder;
  const StudyLock a(folder / "a.h5"), b(folder / "b.h5");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.h5.lock"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b.h5.lock"));
}

TEST(StudyLock, NeverHasTwoHoldersUnderContention) {
  // Four processes lock and unlock the study as fast as they can. A holder creates a folder, which fails if there are
  // two holders at once.
  const Folder folder;
  const std::string path = folder / "s.h5", token = folder / "token";
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      int acquisitions = 0;
      while (acquisitions < 200) {
        std::optional<StudyLock> lock;
        if (!storage_error([&] { lock.emplace(path); }).empty()) continue;
        if (::mkdir(token.c_str(), 0777) != 0) ::_exit(1);
        ::rmdir(token.c_str());
        ++acquisitions;
      }
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
}

TEST(StudyLock, NeedsAWritableFolder) {
  EXPECT_EQ(storage_error([] { const StudyLock lock("/proc/s.h5"); }),
            "/proc/s.h5: the lock file /proc/s.h5.lock cannot be created (No such file or directory)");
}

TEST(StudyLock, CanBeDisabled) {
  const Folder folder;
  ::setenv("PKMOPT_LOCK", "off", 1);
  {
    const StudyLock a(folder / "s.h5"), b(folder / "s.h5");
    EXPECT_FALSE(std::filesystem::exists(folder / "s.h5.lock"));
  }
  ::unsetenv("PKMOPT_LOCK");
}

TEST(StudyLock, IsNotDisabledByTheVariableOfHdf5) {
  const Folder folder;
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  {
    const StudyLock a(folder / "s.h5");
    EXPECT_TRUE(std::filesystem::exists(folder / "s.h5.lock"));
    EXPECT_NE(storage_error([&] { const StudyLock b(folder / "s.h5"); }), "");
  }
  ::unsetenv("HDF5_USE_FILE_LOCKING");
}

TEST(StudyLock, LeavesFilesOfOtherProgramsUnchanged) {
  const Folder folder;
  const std::string path = folder / "poetry", lock_file = folder / "poetry.lock", victim = folder / "victim";
  const std::string error = path + ": cannot be locked: " + lock_file +
                            " is not a lock file of pkmopt and is left unchanged; give the study another name";
  const auto expect_error = [&](const char* what) {
    EXPECT_EQ(storage_error([&] { const StudyLock lock(path); }), error) << what;
  };
  test::spill(lock_file, "[[package]]\nname = \"numpy\"\n");
  expect_error("a file of another program");
  EXPECT_EQ(test::slurp(lock_file), "[[package]]\nname = \"numpy\"\n");

  test::spill(victim, "");
  std::filesystem::remove(lock_file);
  std::filesystem::create_hard_link(victim, lock_file);
  expect_error("another name of a file");
  std::filesystem::remove(lock_file);
  std::filesystem::create_symlink("victim", lock_file);
  expect_error("a link");
  EXPECT_EQ(std::filesystem::file_size(victim), 0u);
  std::filesystem::remove(lock_file);
  std::filesystem::create_symlink("nothing", lock_file);
  expect_error("a link to nothing");
  EXPECT_FALSE(std::filesystem::exists(folder / "nothing"));
  std::filesystem::remove(lock_file);
  ASSERT_EQ(::mkfifo(lock_file.c_str(), 0666), 0);
  expect_error("a pipe");
}

TEST(StudyLock, AcceptsALockFileTruncatedByAFullDisk) {
  const Folder folder;
  for (const char* left : {"", "pkmo"}) {
    test::spill(folder / "s.h5.lock", left);
    EXPECT_EQ(storage_error([&] { const StudyLock lock(folder / "s.h5"); }), "");
  }
}

TEST(StudyLock, DetectsThatTheLockFileWasRemoved) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  std::optional<StudyLock> first(std::in_place, path);
  EXPECT_TRUE(first->owns_lock());
  std::filesystem::remove(path + ".lock");
  EXPECT_FALSE(first->owns_lock());
  const StudyLock second(path);
  EXPECT_FALSE(first->owns_lock());
  first.reset();  // does not remove the lock file of `second`
  EXPECT_TRUE(second.owns_lock());
}

TEST(StudyLock, IsSharedByAllPathsToAStudy) {
  const Folder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/s.h5", folder / "link.h5");
  const StudyLock lock(folder / "link.h5");
  EXPECT_THAT(storage_error([&] { const StudyLock second(folder / "there/s.h5"); }),
              testing::StartsWith(folder / "there/s.h5: in use by process "));
}

}  // namespace
}  // namespace pkm
