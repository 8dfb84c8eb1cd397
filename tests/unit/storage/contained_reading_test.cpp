// A file that the helper cannot read to its end becomes one sentence. Stand-ins from the shell end in each way.
#include "engine/storage/contained_reading.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/storage/study_file.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using ::testing::EndsWith;

class ContainedReading : public testing::Test {
 protected:
  void SetUp() override { write_study(file_, test::sample_study()); }
  void TearDown() override { use_file_checker({}); }

  /// What reading says when the helper does this; "" where it is read.
  std::string with_helper(const std::string& script) {
    use_file_checker({"/bin/sh", "-c", script});
    return test::storage_error([&] { read_study(file_); });
  }

  const Folder folder_;
  const std::string file_ = folder_ / "s.h5";
};

TEST_F(ContainedReading, GivesTheHelperTheWholeFile) {
  EXPECT_EQ(with_helper("cmp -s - '" + file_ + "'"), "");
  EXPECT_NE(with_helper("cat '" + file_ + "' - | cmp -s - '" + file_ + "'"), "");
}

TEST_F(ContainedReading, PassesOnWhatTheHelperRefuses) {
  EXPECT_EQ(with_helper("printf '/best: no group'; exit 1"),
            file_ + ": not laid out as schema 5 says (/best: no group)");
}

TEST_F(ContainedReading, TellsHowTheHelperEnded) {
  EXPECT_THAT(with_helper("kill -SEGV $$"), EndsWith("s.h5: is damaged or forged: the HDF5 library crashes on it"));
  EXPECT_THAT(with_helper("exit 1"), EndsWith("the HDF5 library crashes on it"));
  EXPECT_THAT(with_helper("kill -ALRM $$"), EndsWith("is damaged or forged: reading it does not end within 20 s"));
  EXPECT_THAT(with_helper("exit 4"),
              EndsWith("is damaged or forged: reading it takes more memory than any study of its size"));
}

TEST_F(ContainedReading, SaysThatTheHelperDoesNotStart) {
  use_file_checker({"/nowhere/pkmopt"});
  EXPECT_THAT(test::storage_error([&] { read_study(file_); }),
              EndsWith("s.h5: cannot be checked, the process for it does not start (No such file or directory)"));
}

}  // namespace
}  // namespace pkm
