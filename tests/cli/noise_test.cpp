// Noise in a study file whose seal is right: a sentence and exit code 1, whatever libhdf5 makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "engine/storage/file_seal.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_contents.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

TEST(CliNoise, BehindARightSealIsASentence) {
  const StudyFolder folder;
  const std::string intact = folder.path() + "/intact.h5", noisy = folder.path() + "/noisy.h5";
  const std::string study = folder.write("s.toml", study_with("[workspace]\nmethod = \"columns\"\n"));
  ASSERT_EQ(pkmopt({"run", study, "--output", intact, "--quiet"}).exit_code, 0);
  const std::string bytes = read_file(intact);
  std::mt19937 random(1);  // NOLINT: the same files every time
  int refused = 0;
  for (int file = 0; file < 40; ++file) {
    // Half of them in the first kilobytes, where the structure lies.
    std::string damaged = bytes;
    const std::size_t range = file % 2 == 0 ? std::min<std::size_t>(damaged.size(), 8192) : damaged.size();
    for (int byte = 0; byte < 1 << (file % 7); ++byte)
      damaged[kSealBytes + random() % (range - kSealBytes)] = static_cast<char>(random());
    seal(damaged, kStudySchema);
    std::ofstream(noisy, std::ios::binary) << damaged;
    const auto shown = pkmopt({"show", noisy});
    if (shown.exit_code == 0) continue;  // it hit what nobody reads, or a number
    ++refused;
    EXPECT_EQ(shown.exit_code, 1) << file << ": " << shown.err;
    EXPECT_THAT(shown.err, ::testing::StartsWith("pkmopt: " + noisy + ": "));
    EXPECT_LT(shown.err.size(), 2000u);
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace pkm::testing
