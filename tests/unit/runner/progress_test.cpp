// Tests of the progress display: contents of the line, fitting it to the width of the terminal, and removing it.
#include "engine/runner/progress.hpp"

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

ProgressReport sample_report() {
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

/// A pseudo-terminal: written() returns what has been printed to out().
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    out_ = std::fopen(::ptsname(master_), "w");
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    if (out_) std::fclose(out_);
    if (master_ >= 0) ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::FILE* out() const { return out_; }
  void resize(std::size_t columns) const {
    const winsize size{24, static_cast<unsigned short>(columns), 0, 0};
    ::ioctl(master_, TIOCSWINSZ, &size);
  }
  std::string written() const {
    std::string text(4096, '\0');
    const ssize_t n = ::read(master_, text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }

 private:
  int master_;
  std::FILE* out_ = nullptr;
};

const std::string kClear = "\r\033[K";

TEST(ProgressLine, ContainsAllItems) {
  EXPECT_EQ(progress_line(sample_report()),
            "ga generation 50, 1000 evaluations, 250/s, workspace-ratio 0.19345678, 45 % feasible, at most 4.0 s left");
  ProgressReport r = sample_report();
  r.stages = 3;
  r.stage = 1;
  r.has_best = false;
  r.violation = 0.25;
  EXPECT_EQ(progress_line(r),
            "stage 2 of 3: ga generation 50, 1000 evaluations, 250/s, nothing feasible yet (violation 0.25), "
            "45 % feasible, at most 4.0 s left");
}

TEST(ProgressLine, OmitsAnUnknownRemainingTime) {
  ProgressReport r = sample_report();
  r.left.reset();
  EXPECT_THAT(progress_line(r), Not(HasSubstr("left")));
}

TEST(ProgressBarLine, FitsAnyWidth) {
  ProgressReport r = sample_report();
  r.stages = 2;
  r.objective = "an-objective-with-quite-a-long-name";
  for (std::size_t width = 0; width < 200; ++width) EXPECT_LE(progress_bar_line(r, width).size(), width);
  r.has_best = false;
  for (std::size_t width = 0; width < 200; ++width) EXPECT_LE(progress_bar_line(r, width).size(), width);
}

TEST(ProgressBarLine, OmitsTheLeastImportantItemsFirst) {
  const ProgressReport r = sample_report();
  EXPECT_EQ(progress_bar_line(r, 200), "[##########..........] " + progress_line(r));
  // 80 columns show everything but the number of evaluations, abbreviated
  EXPECT_EQ(progress_bar_line(r, 79), "[####....] generation 50, 250/s, best 0.193457, 45 % feasible, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 65), "generation 50, 250/s, best 0.193457, 45 % feasible, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 50), "generation 50, 250/s, best 0.193457, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 42), "generation 50, best 0.193457, 4.0 s left");
  EXPECT_EQ(progress_bar_line(r, 10), "generation");
}

TEST(ScreenProgress, FitsTheTerminalAlsoAfterAResize) {
  const Terminal terminal;
  if (!terminal.out()) GTEST_SKIP() << "cannot create a pseudo-terminal";
  ScreenProgress progress(terminal.out());
  ProgressReport r = sample_report();
  for (const std::size_t columns : {200, 80, 40, 20, 0}) {  // 0: unknown width
    terminal.resize(columns);
    progress.generation(r);
    r.seconds += 0.2;
    EXPECT_EQ(terminal.written(), kClear + progress_bar_line(sample_report(), (columns == 0 ? 80 : columns) - 1));
  }
}

TEST(ScreenProgress, RemovesItsLineAtItsEnd) {
  const Terminal terminal;
  if (!terminal.out()) GTEST_SKIP() << "cannot create a pseudo-terminal";
  {
    ScreenProgress progress(terminal.out());
    progress.generation(sample_report());
    EXPECT_NE(terminal.written(), "");
  }
  EXPECT_EQ(terminal.written(), kClear);
  { const ScreenProgress silent(terminal.out()); }
  EXPECT_EQ(terminal.written(), "");
}

TEST(ScreenProgress, PrintsALineEveryTenSecondsToAFile) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  ASSERT_TRUE(file);
  ScreenProgress progress(file.get());
  ProgressReport r = sample_report();
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

TEST(DurationText, HasSuitableUnits) {
  EXPECT_EQ(duration_text(4.5e-6), "4.5 us");
  EXPECT_EQ(duration_text(0.045), "45 ms");
  EXPECT_EQ(duration_text(12.34), "12.3 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(3720), "1 h 02 min");
}

}  // namespace
}  // namespace pkm
