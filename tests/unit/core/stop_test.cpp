// Cancellation of long computations: by a flag, by a time limit, by an enclosing scope, and in the threads of a team.
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

TEST(StopScope, ThrowsWhenRequested) {
  bool requested = false;
  {
    const StopScope scope([&] { return requested; });
    check_stop();
    requested = true;
    EXPECT_THROW(check_stop(), Stopped);
  }
  check_stop();
}

TEST(StopScope, HasATimeLimit) {
  const StopScope scope(0.05);
  check_stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_THROW(check_stop(), Stopped);
  EXPECT_FALSE(scope.is_requested_by_outer_scope());
}

TEST(StopScope, IsStoppedByAnEnclosingScope) {
  bool requested = false;
  const StopScope outer([&] { return requested; });
  const StopScope inner(3600);
  check_stop();
  requested = true;
  EXPECT_THROW(check_stop(), Stopped);
  EXPECT_TRUE(inner.is_requested_by_outer_scope());
}

TEST(StopScope, AppliesToItsThreadOnly) {
  const StopScope scope([] { return true; });
  std::thread([] { check_stop(); }).join();
}

TEST(StopScope, AppliesToTheThreadsOfATeam) {
  for (const bool are_long : {false, true}) {
    std::atomic<bool> requested = false;
    std::atomic<int> ended = 0;
    const auto endless = [&](std::size_t, std::size_t) {
      for (int i = 0; i < 3000; ++i) {
        check_stop();
        if (i == 20) requested = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      ++ended;
    };
    const StopScope scope([&] { return requested.load(); });
    EXPECT_THROW(with_team(4, [&] { are_long ? parallel_for_nested(4, endless) : parallel_for(4, endless); }), Stopped);
    EXPECT_EQ(ended, 0);
  }
}

TEST(SlowStepNotice, NotifiesOnce) {
  int notifications = 0;
  const SlowStepNotice slow([&] { ++notifications; }, 0.03);
  check_stop();
  EXPECT_EQ(notifications, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  check_stop();
  check_stop();
  EXPECT_EQ(notifications, 1);
}

}  // namespace
}  // namespace pkm
