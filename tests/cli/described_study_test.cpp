// Studies of mechanisms from files: those that are shipped are right, and a run ends with the same bits however it is
// run.
#include "tests/cli/study_program.hpp"

#include <fstream>

namespace pkm::testing {
namespace {

const std::string kShipped = PKM_EXPERIMENTS "/mechanisms";

class DescribedStudy : public StudyProgram {};

TEST_F(DescribedStudy, EveryShippedMechanismHasOneThatChecks) {
  int mechanisms = 0;
  for (const auto& entry : fs::directory_iterator(kShipped)) {
    if (entry.path().extension() != ".toml") continue;
    ++mechanisms;
    const std::string study = kShipped + "/studies/" + entry.path().filename().string();
    EXPECT_EQ(run({"check", study}), 0) << output_;
    EXPECT_EQ(output_.find("warning"), std::string::npos) << study << output_;
  }
  EXPECT_EQ(mechanisms, 12);
}

TEST_F(DescribedStudy, EndsWithTheSameBitsOnAnyThreadsAndInstructionSetAndAfterKills) {
  std::ofstream(path("study.toml")) << "[mechanism]\nfile = \"" << kShipped << R"(/rotary-delta.toml"
[variables]
R   = { min = 0.05, max = 0.4 }
l_a = { min = 0.1, max = 0.4 }
l_b = { min = 0.2, max = 0.8 }
[workspace]
method = "voxels"
cells = { x = 10, y = 10, z = 10 }
limits = { clear_z = 0.02 }
[[objective]]
type = "workspace-ratio"
[[report]]
type = "conditioning"
[[constraint]]
type = "rods longer than cranks"
[[stage]]
optimiser = "ga"
population = 10
generations = 12
[checkpoint]
every = 0
)";
  const auto run_as = [&](const std::string& file, std::vector<std::string> how) {
    how.insert(how.begin(), {"run", "study.toml", "--quiet", "--output", file});
    ASSERT_EQ(run(how), 0) << output_;
  };
  run_as("one.h5", {"--threads", "1"});
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--threads", "2"}, {"--threads", "3", "--instruction-set", "baseline"}}) {
    run_as("other.h5", how);
    EXPECT_EQ(first_difference(read("one.h5"), read("other.h5")), "") << how[1] << " threads";
    fs::remove(path("other.h5"));
  }
  kill_at_random(3, 40);
  EXPECT_EQ(first_difference(read("one.h5"), read("straight.h5")), "");
}

}  // namespace
}  // namespace pkm::testing
