// Tests of CheckpointClock with a simulated clock: checkpoints take at most their share of the run time.
#include "engine/storage/checkpoint_clock.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace pkm {
namespace {

/// A simulated clock.
struct Time {
  double now = 100;
  CheckpointClock clock(std::optional<double> every = {}) {
    return CheckpointClock(every, [this] { return now; });
  }
  /// A write that takes the given time.
  auto spend(double seconds) {
    return [this, seconds] { now += seconds; };
  }
};

TEST(CheckpointClock, WaitsFiftyTimesTheDurationOfTheFirstWrite) {
  Time time;
  CheckpointClock clock = time.clock();
  clock.first(time.spend(0.25));
  EXPECT_FALSE(clock.due());
  time.now += 12.25;
  EXPECT_FALSE(clock.due());
  time.now += 0.5;
  EXPECT_TRUE(clock.due());
  EXPECT_EQ(clock.share(), 0);  // the first write is excluded
}

TEST(CheckpointClock, SlowerCheckpointsAreLessFrequent) {
  Time time;
  CheckpointClock clock = time.clock();
  clock.first(time.spend(0.25));
  time.now += 1000;
  clock.checkpoint(time.spend(2));
  time.now += 99;
  EXPECT_FALSE(clock.due());
  time.now += 2;
  EXPECT_TRUE(clock.due());
}

TEST(CheckpointClock, TakesTwoPerCentWhileTheFileGrows) {
  Time time;
  CheckpointClock clock = time.clock();
  clock.first(time.spend(0.005));
  int written = 0;
  for (int generation = 1; generation <= 20000; ++generation) {
    time.now += 0.01;
    if (!clock.due()) continue;
    clock.checkpoint(time.spend(0.005 + 1e-5 * generation));
    ++written;
  }
  EXPECT_LE(clock.share(), 0.0205);
  EXPECT_GE(clock.share(), 0.018);  // fewer checkpoints would risk losing more work than necessary
  EXPECT_GT(written, 20);
}

TEST(CheckpointClock, WritesOneCheckpointAfterALongPause) {
  Time time;
  CheckpointClock clock = time.clock();
  clock.first(time.spend(0.25));
  time.now += 10000;
  ASSERT_TRUE(clock.due());
  clock.checkpoint(time.spend(0.25));
  time.now += 1;
  EXPECT_FALSE(clock.due());
}

TEST(CheckpointClock, UsesAFixedPeriodIfGiven) {
  Time time;
  CheckpointClock clock = time.clock(2.0);
  clock.first(time.spend(0.5));
  time.now += 1.75;
  EXPECT_FALSE(clock.due());
  time.now += 0.25;
  EXPECT_TRUE(clock.due());
  clock.checkpoint(time.spend(10));
  EXPECT_FALSE(clock.due());
  time.now += 2;
  EXPECT_TRUE(clock.due());
}

TEST(CheckpointClock, PeriodZeroIsAlwaysDue) {
  Time time;
  CheckpointClock clock = time.clock(0.0);
  clock.first(time.spend(1));
  EXPECT_TRUE(clock.due());
  clock.checkpoint(time.spend(1));
  EXPECT_TRUE(clock.due());
}

TEST(CheckpointClock, PassesExceptionsOfTheWriteOn) {
  Time time;
  CheckpointClock clock = time.clock();
  EXPECT_THROW(clock.checkpoint([] { throw std::runtime_error("full"); }), std::runtime_error);
}

TEST(CheckpointClock, UsesTheSystemClockByDefault) {
  CheckpointClock clock(3600.0);
  clock.first([] {});
  EXPECT_FALSE(clock.due());
}

}  // namespace
}  // namespace pkm
