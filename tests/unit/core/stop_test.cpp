// Long computations that are stopped: by a flag, by a time limit, by a scope around, within a team.
#include "engine/core/stop.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <type_traits>

#include "engine/core/team.hpp"

namespace pkm {
namespace {

static_assert(!std::is_base_of_v<std::exception, Stopped>);

TEST(CheckStop, DoesNothingWithoutAScope) { check_stop(); }

TEST(StopScope, ThrowsOnceAsked) {
  bool asked = false;
  {
    const StopScope scope([&] { return asked; });
    check_stop();
    asked = true;
    EXPECT_THROW(check_stop(), Stopped);
  }
  check_stop();
}

TEST(StopScope, HasATimeLimit) {
  const StopScope scope(0.05);
  check_stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_THROW(check_stop(), Stopped);
  EXPECT_FALSE(scope.is_requested_outside());
}

TEST(StopScope, IsStoppedByTheOneAround) {
  bool asked = false;
  const StopScope outer([&] { return asked; });
  const StopScope inner(3600);
  check_stop();
  asked = true;
  EXPECT_THROW(check_stop(), Stopped);
  EXPECT_TRUE(inner.is_requested_outside());
}

TEST(StopScope, BelongsToItsThread) {
  const StopScope scope([] { return true; });
  std::thread([] { check_stop(); }).join();
}

TEST(StopScope, ReachesTheThreadsOfATeam) {
  for (const bool are_long : {false, true}) {
    std::atomic<bool> asked = false;
    std::atomic<int> ended = 0;
    const auto endless = [&](std::size_t, std::size_t) {
      for (int i = 0; i < 3000; ++i) {
        check_stop();
        if (i == 20) asked = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      ++ended;
    };
    const StopScope scope([&] { return asked.load(); });
    EXPECT_THROW(with_team(4, [&] { are_long ? share_long_pieces(4, endless) : share_pieces(4, endless); }), Stopped);
    EXPECT_EQ(ended, 0);
  }
}

TEST(SlowStep, SaysSoOnce) {
  int said = 0;
  const SlowStep slow([&] { ++said; }, 0.03);
  check_stop();
  EXPECT_EQ(said, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  check_stop();
  check_stop();
  EXPECT_EQ(said, 1);
}

}  // namespace
}  // namespace pkm
