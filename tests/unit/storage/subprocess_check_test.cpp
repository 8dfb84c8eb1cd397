// Tests of check_in_subprocess() with shell scripts in place of the checking process: each way in which it can end is
// reported in one sentence.
#include "engine/storage/subprocess_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/storage/study_file.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using ::testing::EndsWith;

class SubprocessCheck : public testing::Test {
 protected:
  void SetUp() override { write_study(file_, test::sample_study()); }
  void TearDown() override { set_check_command({}); }

  /// The error of read_study() if `script` is the checking process; "" if the file is read.
  std::string error_with(const std::string& script) {
    set_check_command({"/bin/sh", "-c", script});
    return test::storage_error([&] { read_study(file_); });
  }

  const Folder folder_;
  const std::string file_ = folder_ / "s.h5";
};

TEST_F(SubprocessCheck, PassesTheWholeFile) {
  EXPECT_EQ(error_with("cmp -s - '" + file_ + "'"), "");
  EXPECT_NE(error_with("cat '" + file_ + "' - | cmp -s - '" + file_ + "'"), "");
}

TEST_F(SubprocessCheck, ReportsTheMessageOfTheProcess) {
  EXPECT_EQ(error_with("printf '/best: no group'; exit 1"), file_ + ": does not conform to schema 5 (/best: no group)");
}

TEST_F(SubprocessCheck, ReportsHowTheProcessEnded) {
  EXPECT_THAT(error_with("kill -SEGV $$"), EndsWith("s.h5: is damaged or forged: the HDF5 library crashes on it"));
  EXPECT_THAT(error_with("exit 1"), EndsWith("the HDF5 library crashes on it"));
  EXPECT_THAT(error_with("kill -ALRM $$"), EndsWith("is damaged or forged: reading it takes longer than 20 s"));
  EXPECT_THAT(error_with("exit 4"),
              EndsWith("is damaged or forged: reading it needs more memory than any study of this size"));
}

TEST_F(SubprocessCheck, ReportsThatTheProcessDoesNotStart) {
  set_check_command({"/nowhere/pkmopt"});
  EXPECT_THAT(
      test::storage_error([&] { read_study(file_); }),
      EndsWith("s.h5: cannot be checked, because the checking process does not start (No such file or directory)"));
}

}  // namespace
}  // namespace pkm
