// Tests of write_file() and check_outputs(): nothing is overwritten by accident, and no other file is modified.
#include "engine/storage/safe_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using test::slurp;
using test::spill;
using test::storage_error;
using ::testing::HasSubstr;

mode_t mode_of(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777;
}

std::string config_error(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  try {
    check_outputs(outputs, inputs, Existing::replaced);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(SafeFile, RejectsANameWithANulCharacter) {
  const Folder folder;
  const std::string precious = folder / "precious.txt", name = precious + std::string("\0.h5", 4);
  spill(precious, "precious");
  EXPECT_EQ(storage_error([&] { write_file(name, "new", Existing::replaced); }),
            precious + ": the file name contains a NUL character after this point");
  EXPECT_EQ(storage_error([&] { check_outputs({name}, {}, Existing::replaced); }),
            precious + ": the file name contains a NUL character after this point");
  EXPECT_EQ(slurp(precious), "precious");
}

TEST(SafeFile, ModifiesNoOtherFile) {
  const Folder folder;
  const std::string path = folder / "table.csv";
  spill(folder / "victim", "precious");
  std::filesystem::create_symlink("victim", path + ".part");
  write_file(path, "new", Existing::refused);
  EXPECT_EQ(slurp(path), "new");
  EXPECT_EQ(slurp(folder / "victim"), "precious");
  EXPECT_THAT(folder.names(), testing::ElementsAre("table.csv", "table.csv.part", "victim"));
}

TEST(SafeFile, ConcurrentWritersLeaveACompleteFile) {
  const Folder folder;
  const std::string path = folder / "table.csv";
  const auto write = [&](char c) {
    for (int i = 0; i < 30; ++i) write_file(path, std::string(200000, c), Existing::replaced);
  };
  std::thread other([&] { EXPECT_NO_THROW(write('b')); });
  EXPECT_NO_THROW(write('a'));
  other.join();
  const std::string left = slurp(path);
  EXPECT_TRUE(left == std::string(200000, 'a') || left == std::string(200000, 'b'));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"table.csv"});
}

TEST(SafeFile, OverwritesOnlyOnRequest) {
  const Folder folder;
  const std::string path = folder / "table.csv";
  spill(path, "old");
  EXPECT_EQ(storage_error([&] { write_file(path, "new", Existing::refused); }),
            path + ": is not overwritten (File exists)");
  EXPECT_EQ(storage_error([&] { check_outputs({path}, {}, Existing::refused); }),
            path + " exists already; overwrite it with --force");
  EXPECT_EQ(slurp(path), "old");
  check_outputs({path}, {}, Existing::replaced);
  write_file(path, "new", Existing::replaced);
  EXPECT_EQ(slurp(path), "new");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"table.csv"});
}

TEST(SafeFile, OfConcurrentWritersOfANewFileOneSucceeds) {
  const Folder folder;
  for (int i = 0; i < 30; ++i) {
    const std::string path = folder / std::to_string(i);
    std::atomic<int> written = 0;
    const auto write = [&] { written += storage_error([&] { write_file(path, "new", Existing::refused); }).empty(); };
    std::thread other(write);
    write();
    other.join();
    EXPECT_EQ(written, 1);
  }
}

TEST(SafeFile, RetainsPermissions) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  const mode_t mask = ::umask(022);
  write_file(path, "new", Existing::refused);
  EXPECT_EQ(mode_of(path), 0644u);
  for (const mode_t mode : {0600u, 0664u, 0400u}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    write_file(path, "newer", Existing::replaced);
    EXPECT_EQ(mode_of(path), mode);
  }
  ::umask(mask);
}

TEST(SafeFile, AnOutputMustNotBeAnInputOrAnotherOutput) {
  const Folder folder;
  const std::string study = folder / "study.toml", link = folder / "link";
  spill(study, "[study]");
  std::filesystem::create_symlink("study.toml", link);
  for (const std::string& output : {study, link, folder / "./study.toml"}) {
    EXPECT_EQ(config_error({output}, {"", "4ppa-2par", study}),
              output + ": is read by this command, so it is not overwritten");
  }
  EXPECT_EQ(config_error({folder / "f.csv"}, {study}), "");
  EXPECT_EQ(config_error({folder / "f.csv", folder / "./f.csv"}, {}),
            folder / "./f.csv" + ": is given for two outputs");
  EXPECT_EQ(config_error({"", ""}, {study}), "");
}

}  // namespace
}  // namespace pkm
