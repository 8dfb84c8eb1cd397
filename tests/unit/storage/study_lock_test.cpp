// One process per study, whatever happened to the one before.
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

/// A child process that holds the lock until it is killed.
pid_t start_holder(const std::string& path) {
  int ends[2];
  if (::pipe(ends) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    const StudyLock lock(path);
    const bool told = ::write(ends[1], "x", 1) == 1;
    while (told) ::pause();
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

TEST(StudyLock, NamesTheProcessThatHoldsIt) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  const pid_t child = start_holder(path);
  ASSERT_GT(child, 0);
  const std::string error = storage_error([&] { const StudyLock lock(path); });
  kill_hard(child);
  EXPECT_THAT(error, testing::StartsWith(path + ": in use by process " + std::to_string(child)));
  EXPECT_THAT(error, testing::EndsWith(" (it holds " + path + ".lock)"));
}

TEST(StudyLock, OfAKilledProcessBlocksNobody) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  const pid_t child = start_holder(path);
  ASSERT_GT(child, 0);
  kill_hard(child);
  ASSERT_TRUE(std::filesystem::exists(path + ".lock"));
  const StudyLock lock(path);
  EXPECT_THAT(test::slurp(path + ".lock"), testing::StartsWith("pkmopt-lock " + std::to_string(::getpid())));
}

TEST(StudyLock, IsHeldOnceAndRemovedAtItsEnd) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  for (int i = 0; i < 3; ++i) {
    const StudyLock lock(path);
    EXPECT_NE(storage_error([&] { const StudyLock second(path); }), "");
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
}

TEST(StudyLock, OfAnotherStudyIsAnotherLock) {
  const Folder folder;
  const StudyLock a(folder / "a.h5"), b(folder / "b.h5");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.h5.lock"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b.h5.lock"));
}

TEST(StudyLock, NeverHasTwoHoldersWhileLocksComeAndGo) {
  // Four processes take and drop the lock as fast as they can. A holder creates a file exclusively; two holders at once
  // would meet there.
  const Folder folder;
  const std::string path = folder / "s.h5", token = folder / "token";
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      int held = 0;
      while (held < 200) {
        std::optional<StudyLock> lock;
        if (!storage_error([&] { lock.emplace(path); }).empty()) continue;
        if (::mkdir(token.c_str(), 0777) != 0) ::_exit(1);
        ::rmdir(token.c_str());
        ++held;
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

TEST(StudyLock, NeedsAFolderThatTakesIt) {
  EXPECT_EQ(storage_error([] { const StudyLock lock("/proc/s.h5"); }),
            "/proc/s.h5: the lock file /proc/s.h5.lock cannot be created (No such file or directory)");
}

TEST(StudyLock, CanBeSwitchedOff) {
  const Folder folder;
  ::setenv("PKMOPT_LOCK", "off", 1);
  {
    const StudyLock a(folder / "s.h5"), b(folder / "s.h5");
    EXPECT_FALSE(std::filesystem::exists(folder / "s.h5.lock"));
  }
  ::unsetenv("PKMOPT_LOCK");
}

TEST(StudyLock, IsNotSwitchedOffByHdf5sVariable) {
  const Folder folder;
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  {
    const StudyLock a(folder / "s.h5");
    EXPECT_TRUE(std::filesystem::exists(folder / "s.h5.lock"));
    EXPECT_NE(storage_error([&] { const StudyLock b(folder / "s.h5"); }), "");
  }
  ::unsetenv("HDF5_USE_FILE_LOCKING");
}

TEST(StudyLock, TouchesNoFileOfAnotherProgram) {
  const Folder folder;
  const std::string path = folder / "poetry", lock_file = folder / "poetry.lock", victim = folder / "victim";
  const std::string refusal = path + ": cannot be locked: " + lock_file +
                              " is no lock of pkmopt and is left alone; give the study another name";
  const auto expect_refused = [&](const char* what) {
    EXPECT_EQ(storage_error([&] { const StudyLock lock(path); }), refusal) << what;
  };
  test::spill(lock_file, "[[package]]\nname = \"numpy\"\n");
  expect_refused("a file of another program");
  EXPECT_EQ(test::slurp(lock_file), "[[package]]\nname = \"numpy\"\n");

  test::spill(victim, "");
  std::filesystem::remove(lock_file);
  std::filesystem::create_hard_link(victim, lock_file);
  expect_refused("another name of a file");
  std::filesystem::remove(lock_file);
  std::filesystem::create_symlink("victim", lock_file);
  expect_refused("a link");
  EXPECT_EQ(std::filesystem::file_size(victim), 0u);
  std::filesystem::remove(lock_file);
  std::filesystem::create_symlink("nothing", lock_file);
  expect_refused("a link to nothing");
  EXPECT_FALSE(std::filesystem::exists(folder / "nothing"));
  std::filesystem::remove(lock_file);
  ASSERT_EQ(::mkfifo(lock_file.c_str(), 0666), 0);
  expect_refused("a pipe");
}

TEST(StudyLock, OfAFullDiskIsEmptyAndOurs) {
  const Folder folder;
  for (const char* left : {"", "pkmo"}) {
    test::spill(folder / "s.h5.lock", left);
    EXPECT_EQ(storage_error([&] { const StudyLock lock(folder / "s.h5"); }), "");
  }
}

TEST(StudyLock, KnowsThatItWasTakenAway) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  std::optional<StudyLock> first(std::in_place, path);
  EXPECT_TRUE(first->held());
  std::filesystem::remove(path + ".lock");
  EXPECT_FALSE(first->held());
  const StudyLock second(path);
  EXPECT_FALSE(first->held());
  first.reset();  // and leaves the second's lock where it is
  EXPECT_TRUE(second.held());
}

TEST(StudyLock, IsSharedByAllNamesOfAStudy) {
  const Folder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/s.h5", folder / "link.h5");
  const StudyLock lock(folder / "link.h5");
  EXPECT_THAT(storage_error([&] { const StudyLock second(folder / "there/s.h5"); }),
              testing::StartsWith(folder / "there/s.h5: in use by process "));
}

}  // namespace
}  // namespace pkm
