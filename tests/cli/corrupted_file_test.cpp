// Random bytes in a study file with a valid checksum: an error message and exit code 1, whatever libhdf5 does with
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "engine/storage/file_header.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_contents.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

TEST(CliCorruptedFile, RandomBytesWithValidChecksumGiveAnErrorMessage) {
  const StudyFolder folder;
  const std::string intact = folder.path() + "/intact.h5", noisy = folder.path() + "/noisy.h5";
  const std::string study = folder.write("s.toml", study_with("[workspace]\nmethod = \"columns\"\n"));
  ASSERT_EQ(pkmopt({"run", study, "--output", intact, "--quiet"}).exit_code, 0);
  const std::string bytes = read_file(intact);
  std::mt19937 random(1);  // NOLINT: the same files every time
  int refused = 0;
  for (int file = 0; file < 40; ++file) {
    // In every second file the changes are in the first kilobytes, which contain the structure.
    std::string damaged = bytes;
    const std::size_t range = file % 2 == 0 ? std::min<std::size_t>(damaged.size(), 8192) : damaged.size();
    for (int byte = 0; byte < 1 << (file % 7); ++byte)
      damaged[kHeaderBytes + random() % (range - kHeaderBytes)] = static_cast<char>(random());
    seal(damaged, kStudySchema);
    std::ofstream(noisy, std::ios::binary) << damaged;
    const auto shown = pkmopt({"show", noisy});
    if (shown.exit_code == 0) continue;  // the changes hit only numbers or unused bytes
    ++refused;
    EXPECT_EQ(shown.exit_code, 1) << file << ": " << shown.err;
    EXPECT_THAT(shown.err, ::testing::StartsWith("pkmopt: " + noisy + ": "));
    EXPECT_LT(shown.err.size(), 2000u);
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace pkm::testing
