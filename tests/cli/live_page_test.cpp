// `pkmopt run --live`: the page of a running study, also after Ctrl-C and resume.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/report/html_page.hpp"
#include "tests/cli/ga_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class LiveProgram : public GaProgram {
 protected:
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static bool has_report() {
    try {
      page_assets();
      return true;
    } catch (const std::exception&) {  // built without npm
      return false;
    }
  }
};

TEST_F(LiveProgram, InterruptedAndResumedPageEndsAtTheReport) {
  write_toml(500, "");
  {
    ChildProcess child(command({"run", "study.toml", "--live", "--quiet"}), folder_);
    while (!fs::exists(path("study.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_THAT(slurp("study.live.html"), HasSubstr("http-equiv=\"refresh\""));
    child.signal(SIGINT);
    ASSERT_EQ(child.wait(), 3) << child.output();
  }
  const std::string stopped = slurp("study.live.html");
  EXPECT_THAT(stopped, HasSubstr("The run was stopped by SIGINT. <code>pkmopt resume study.h5 --live</code>"));
  EXPECT_THAT(stopped, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_FALSE(fs::exists(path("study.html")));
  ASSERT_EQ(run({"resume", "study.h5", "--live"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("live page: study.live.html\n"));
  const std::string finished = slurp("study.live.html");
  EXPECT_THAT(finished, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_THAT(finished, HasSubstr("workspace-ratio [rad], best value over the generations"));
  EXPECT_EQ(fs::exists(path("study.html")), has_report());
  EXPECT_THAT(finished,
              HasSubstr(has_report() ? "<a href=\"study.html\">report</a>" : "<code>pkmopt report study.h5</code>"));
  // The page changes neither the results nor the existing files of another study.
  ASSERT_EQ(run({"run", "study.toml", "--output", "plain.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("plain.h5"), read("study.h5")), "");
  fs::remove(path("study.h5"));
  EXPECT_EQ(run({"run", "study.toml", "--live"}), 1);
  EXPECT_THAT(output_, HasSubstr("study.live.html exists already; overwrite it with --force"));
  EXPECT_FALSE(fs::exists(path("study.h5")));
}

TEST_F(LiveProgram, ThePageOfAFailedRunShowsTheError) {
  write_toml(5, "");
  fs::create_directory(path("study.h5.lock"));  // the lock file cannot be created
  EXPECT_EQ(run({"run", "study.toml", "--live", "--quiet"}), 1);
  const std::string page = slurp("study.live.html");
  EXPECT_THAT(page, HasSubstr("<title>failed: "));
  EXPECT_THAT(page, HasSubstr("The run ended with an error: study.h5: the lock file study.h5.lock cannot be created"));
  EXPECT_THAT(page, Not(HasSubstr("http-equiv=\"refresh\"")));
}

}  // namespace
}  // namespace pkm::testing
