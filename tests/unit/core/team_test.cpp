#include "engine/core/team.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Team, DoesEveryPieceOnce) {
  for (const int threads : {1, 2, 5}) {
    Team team(threads);
    EXPECT_EQ(team.threads(), threads);
    for (const std::size_t pieces : {0, 1, 2, 3, 1000}) {
      for (int job = 0; job < 200; ++job) {
        std::vector<int> times(pieces);
        team.share(pieces, [&](std::size_t begin, std::size_t end) {
          for (std::size_t piece = begin; piece < end; ++piece) ++times[piece];
        });
        ASSERT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(pieces));
      }
    }
  }
}

TEST(Team, GivesPiecesThatRunAtOnceDifferentWorkers) {
  Team team(3);
  for (int job = 0; job < 200; ++job) {
    std::vector<std::atomic<int>> busy(3);
    std::atomic<int> clashes = 0;
    team.share(100, [&](std::size_t, std::size_t, std::size_t worker) {
      if (busy.at(worker).exchange(1) != 0) ++clashes;
      busy[worker] = 0;
    });
    ASSERT_EQ(clashes, 0);
  }
  std::size_t alone = 7;
  share_pieces(1, [&](std::size_t, std::size_t, std::size_t worker) { alone = worker; });
  EXPECT_EQ(alone, 0u);
  EXPECT_EQ(workers(), 1u);
  const LentTeam lent(team);
  EXPECT_EQ(workers(), 3u);
}

TEST(Team, ThrowsWhatAPieceThrowsOnAnyThread) {
  Team team(2);
  std::atomic<int> begun = 0;
  const auto fail_together = [&](std::size_t, std::size_t) {  // one on each thread
    ++begun;
    while (begun < 2) std::this_thread::yield();
    throw std::runtime_error("a piece");
  };
  EXPECT_THROW(team.share(2, fail_together), std::runtime_error);
  std::atomic<int> after = 0;  // the team goes on, and has forgotten the failure
  team.share(10, [&](std::size_t begin, std::size_t end) { after += static_cast<int>(end - begin); });
  EXPECT_EQ(after, 10);
}

TEST(Team, WakesThreadsThatSleep) {
  Team team(2);
  for (int job = 0; job < 3; ++job) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than they spin
    std::atomic<int> arrived = 0;
    team.share(2, [&](std::size_t, std::size_t) {  // ends only if each piece is on a thread of its own
      ++arrived;
      while (arrived < 2) std::this_thread::yield();
    });
    EXPECT_EQ(arrived, 2);
  }
}

TEST(Team, IsLentToOneThreadAndNotToItsPieces) {
  Team team(3);
  EXPECT_FALSE(has_team());
  std::vector<std::size_t> order;
  share_pieces(4, [&](std::size_t begin, std::size_t end) { order = {begin, end}; });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 4}));
  {
    const LentTeam lent(team);
    EXPECT_TRUE(has_team());
    std::atomic<int> sum = 0, with_team = 0;
    share_pieces(50, [&](std::size_t begin, std::size_t end) {
      if (has_team()) ++with_team;
      for (; begin < end; ++begin)
        share_pieces(10, [&](std::size_t from, std::size_t to) { sum += static_cast<int>(to - from); });
    });
    EXPECT_EQ(sum, 500);
    EXPECT_EQ(with_team, 0);
    EXPECT_TRUE(has_team());
  }
  EXPECT_FALSE(has_team());
}

}  // namespace
}  // namespace pkm
