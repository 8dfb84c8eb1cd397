// `pkmopt report`: missing, damaged and existing files. The contents of the page are tested in tests/browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/report/html_page.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class ReportProgram : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    try {
      page_assets();
    } catch (const std::exception& reason) {
      GTEST_SKIP() << reason.what();
    }
    std::ofstream(path("study.toml"))
        << "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 }\n[baseline]\na = 0.21\n"
           "[workspace]\nmethod = \"voxels\"\ncells = { x = 6, z = 6, theta = 6 }\n[[objective]]\ntype = "
           "\"workspace-ratio\"\n[[stage]]\noptimiser = \"ga\"\npopulation = 4\ngenerations = 2\n";
    ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  }
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

TEST_F(ReportProgram, IsNamedAfterTheStudyAndOverwritesNoFile) {
  ASSERT_EQ(run({"report", "study.h5"}), 0) << output_;
  EXPECT_THAT(output_, StartsWith("study.html: "));
  const std::string page = slurp("study.html");
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"study\""));
  EXPECT_EQ(run({"report", "study.h5"}), 1);
  EXPECT_THAT(output_, HasSubstr("study.html exists already; overwrite it with --force"));
  EXPECT_EQ(run({"report", "study.h5", "-o", "./study.h5", "--force"}), 2);
  EXPECT_THAT(output_, HasSubstr("./study.h5: is read by this command, so it is not overwritten"));
}

TEST_F(ReportProgram, IsTheSameOnAnyNumberOfThreads) {
  ASSERT_EQ(run({"report", "study.h5"}), 0) << output_;
  const std::string page = slurp("study.html");
  EXPECT_EQ(run({"report", "study.h5", "--force", "--threads", "1"}), 0) << output_;
  EXPECT_EQ(slurp("study.html"), page);
}

TEST_F(ReportProgram, DamagedAndMissingFilesAreReported) {
  std::string bytes = slurp("study.h5");
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(path("damaged.h5"), std::ios::binary) << bytes;
  std::ofstream(path("empty.h5"));
  for (const std::string file : {"damaged.h5", "empty.h5", "missing.h5"}) {
    EXPECT_EQ(run({"report", "study.h5", file, "-o", "page.html"}), 1);
    EXPECT_THAT(output_, HasSubstr("pkmopt: " + file + ": "));
    EXPECT_FALSE(fs::exists(path("page.html")));
  }
}

TEST_F(ReportProgram, WorkspaceWritesAPageOfOneDesign) {
  ASSERT_EQ(run({"workspace", "study.toml", "--html", "one.html"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("wrote one.html"));
  EXPECT_THAT(slurp("one.html"), HasSubstr("\"design\":{"));
  EXPECT_EQ(run({"workspace", "study.toml", "--html", "one.html"}), 1);
}

}  // namespace
}  // namespace pkm::testing
