// The line of a running study: what it says, that it fits the terminal, that it is left in time.
#include "engine/study/progress.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>

namespace pkm {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ProgressReport half_way() {
  ProgressReport r;
  r.optimiser = "ga";
  r.generation = 50;
  r.evaluations = 1000;
  r.evaluation_limit = 2000;
  r.evaluations_per_second = 250;
  r.seconds = 4;
  r.left = 4;
  r.has_best = true;
  r.best = 0.19345678;
  r.objective = "workspace-ratio";
  r.feasible_share = 0.45;
  return r;
}

/// A terminal of our own: what is printed on `out` comes back from `written`.
class Terminal {
 public:
  Terminal() : ours_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (ours_ < 0 || ::grantpt(ours_) != 0 || ::unlockpt(ours_) != 0) return;
    out_ = std::fopen(::ptsname(ours_), "w");
    ::fcntl(ours_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    if (out_) std::fclose(out_);
    if (ours_ >= 0) ::close(ours_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::FILE* out() const { return out_; }
  void resize(std::size_t columns) const {
    const winsize size{24, static_cast<unsigned short>(columns), 0, 0};
    ::ioctl(ours_, TIOCSWINSZ, &size);
  }
  std::string written() const {
    std::string text(4096, '\0');
    const ssize_t n = ::read(ours_, text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }

 private:
  int ours_;
  std::FILE* out_ = nullptr;
};

const std::string kClear = "\r\033[K";

TEST(ProgressLine, SaysEverything) {
  EXPECT_EQ(progress_line(half_way()),
            "ga generation 50, 1000 evaluations, 250/s, workspace-ratio 0.19345678, 45 % feasible, at most 4.0 s left");
  ProgressReport r = half_way();
  r.stages = 3;
  r.stage = 1;
  r.has_best = false;
  r.violation = 0.25;
  EXPECT_EQ(progress_line(r),
            "stage 2 of 3: ga generation 50, 1000 evaluations, 250/s, nothing feasible yet (violation 0.25), "
            "45 % feasible, at most 4.0 s left");
}

TEST(ProgressLine, SaysNothingOfATimeLeftThatIsUnknown) {
  ProgressReport r = half_way();
  r.left.reset();
  EXPECT_THAT(progress_line(r), Not(HasSubstr("left")));
}

TEST(ProgressBarLine, FitsAnyWidth) {
  ProgressReport r = half_way();
  r.stages = 2;
  r.objective = "an-objective-with-quite-a-long-name";
  for (std::size_t width = 0; width < 200; ++width) EXPECT_LE(progress_bar_line(r, width).size(), width);
  r.has_best = false;
  for (std::size_t width = 0; width < 200; ++width) EXPECT_LE(progress_bar_line(r, width).size(), width);
}

TEST(ProgressBarLine, LeavesOutTheLeastImportantFirst) {
  const ProgressReport r = half_way();
  EXPECT_EQ(progress_bar_line(r, 200), "[##########..........] " + progress_line(r));
  // 80 columns show all but the number of evaluations, in short words
  EXPECT_EQ(progress_bar_line(r, 79), "[####....] generation 50, 250/s, best 0.193457, 45 % feasible, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 65), "generation 50, 250/s, best 0.193457, 45 % feasible, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 50), "generation 50, 250/s, best 0.193457, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 42), "generation 50, best 0.193457, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 10), "generation");
}

TEST(ScreenProgress, KeepsToTheTerminalsWidthAlsoAfterAResize) {
  const Terminal terminal;
  if (!terminal.out()) GTEST_SKIP() << "no terminal can be made";
  ScreenProgress progress(terminal.out());
  ProgressReport r = half_way();
  for (const std::size_t columns : {200, 80, 40, 20, 0}) {  // 0: a terminal that does not say
    terminal.resize(columns);
    progress.generation(r);
    r.seconds += 0.2;
    EXPECT_EQ(terminal.written(), kClear + progress_bar_line(half_way(), (columns == 0 ? 80 : columns) - 1));
  }
}

TEST(ScreenProgress, LeavesItsLineWhenItEnds) {
  const Terminal terminal;
  if (!terminal.out()) GTEST_SKIP() << "no terminal can be made";
  {
    ScreenProgress progress(terminal.out());
    progress.generation(half_way());
    EXPECT_NE(terminal.written(), "");
  }
  EXPECT_EQ(terminal.written(), kClear);
  { const ScreenProgress silent(terminal.out()); }
  EXPECT_EQ(terminal.written(), "");
}

TEST(ScreenProgress, PrintsALineEveryTenSecondsIntoAFile) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  ASSERT_TRUE(file);
  ScreenProgress progress(file.get());
  ProgressReport r = half_way();
  std::string expected;
  for (const double seconds : {0.1, 9.9, 10.1, 15.0, 20.2}) {
    r.seconds = seconds;
    progress.generation(r);
    if (seconds == 10.1 || seconds == 20.2) expected += progress_line(r) + "\n";
  }
  std::rewind(file.get());
  std::string text(1000, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  EXPECT_EQ(text, expected);
}

TEST(DurationText, ChoosesItsUnits) {
  EXPECT_EQ(duration_text(4.5e-6), "4.5 us");
  EXPECT_EQ(duration_text(0.045), "45 ms");
  EXPECT_EQ(duration_text(12.34), "12.3 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(3720), "1 h 02 min");
}

}  // namespace
}  // namespace pkm
