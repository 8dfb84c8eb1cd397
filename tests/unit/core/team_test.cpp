#include "engine/core/team_sort.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(Team, ExecutesEveryIterationOnce) {
  for (const int threads : {1, 2, 5})
    with_team(threads, [&] {
      EXPECT_EQ(workers(), static_cast<std::size_t>(threads));
      EXPECT_EQ(has_team(), threads > 1);
      for (const std::size_t iterations : {0, 1, 2, 3, 1000}) {
        for (int job = 0; job < 200; ++job) {
          std::vector<int> counts(iterations);
          parallel_for(iterations, [&](std::size_t begin, std::size_t end) {
            for (std::size_t iteration = begin; iteration < end; ++iteration) ++counts[iteration];
          });
          ASSERT_EQ(std::count(counts.begin(), counts.end(), 1), static_cast<std::ptrdiff_t>(iterations));
        }
      }
    });
}

TEST(Team, SizeIsTheRequestedNumberOfThreads) {
  EXPECT_EQ(team_size(3), 3);
  EXPECT_GE(team_size(0), 1);
  EXPECT_EQ(team_size(0), team_size(-1));
}

TEST(Team, ResultsDoNotDependOnTheNumberOfThreads) {
  const auto results = [](int threads) {
    std::vector<double> found(1000);
    with_team(threads, [&] {
      for (int generation = 1; generation <= 20; ++generation) {
        const std::vector<double> before = found;
        parallel_for(found.size(), [&](std::size_t begin, std::size_t end) {
          for (; begin < end; ++begin) found[begin] = std::sin(before[999 - begin] + static_cast<double>(begin));
        });
      }
    });
    return found;
  };
  const std::vector<double> alone = results(1);
  for (const int threads : {2, 3, 7}) EXPECT_EQ(results(threads), alone) << threads << " threads";
}

TEST(Team, SortsLikeOneThread) {
  for (const int threads : {1, 2, 3, 5})
    with_team(threads, [&] {
      for (const std::size_t count : {0, 1, 9'999, 60'001}) {
        std::vector<std::uint32_t> numbers(count);
        for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i) * 2654435761u;
        std::vector<std::uint32_t> sorted = numbers;
        const std::size_t first = count / 7;
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first), sorted.end());
        parallel_sort(numbers, first);
        EXPECT_EQ(numbers, sorted) << threads << " threads, " << count;
      }
    });
}

TEST(Team, ExecutesNestedLoopsOnce) {
  for (const int threads : {1, 2, 5})
    with_team(threads, [&] {
      for (const std::size_t iterations : {0, 1, 2, 7}) {
        std::vector<std::vector<int>> counts(iterations, std::vector<int>(100));
        std::vector<std::atomic<int>> busy(workers());
        std::atomic<int> clashes = 0;
        parallel_for_nested(iterations, [&](std::size_t iteration, std::size_t end) {
          ASSERT_EQ(end, iteration + 1);
          for (int job = 0; job < 50; ++job)
            parallel_for(100, [&](std::size_t first, std::size_t last, std::size_t worker) {
              ASSERT_LT(worker, busy.size());
              for (; first < last; ++first) ++counts[iteration][first];
            });
          ASSERT_LT(worker(), busy.size());
          clashes += busy[worker()]++;
          --busy[worker()];
        });
        EXPECT_EQ(clashes, 0);
        for (const auto& each : counts) EXPECT_EQ(std::ranges::count(each, 50), 100);
        EXPECT_EQ(has_team(), threads > 1);
      }
    });
}

TEST(Team, IdleThreadsHelpWithInnerLoops) {
  with_team(2, [] {
    std::atomic<bool> both = false;
    parallel_for_nested(2, [&](std::size_t iteration, std::size_t) {
      if (iteration == 0) return;
      const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (!both && std::chrono::steady_clock::now() < until) {
        std::vector<std::atomic<int>> done_by(workers());
        parallel_for(200, [&](std::size_t, std::size_t, std::size_t worker) {
          ++done_by[worker];
          std::this_thread::sleep_for(std::chrono::microseconds(50));
        });
        both = done_by[0] > 0 && done_by[1] > 0;
      }
    });
    EXPECT_TRUE(both);
  });
}

TEST(Team, RethrowsExceptionsOfLongIterations) {
  for (const int threads : {1, 3})
    with_team(threads, [&] {
      EXPECT_THROW(parallel_for_nested(4,
                                       [](std::size_t iteration, std::size_t) {
                                         if (iteration == 2) throw std::invalid_argument("the third");
                                       }),
                   std::invalid_argument);
      EXPECT_EQ(workers(), static_cast<std::size_t>(threads));
    });
}

TEST(Team, ConcurrentIterationsHaveDifferentWorkers) {
  with_team(3, [] {
    for (int job = 0; job < 200; ++job) {
      std::vector<std::atomic<int>> busy(3);
      std::atomic<int> clashes = 0;
      parallel_for(100, [&](std::size_t, std::size_t, std::size_t worker) {
        if (busy.at(worker).exchange(1) != 0) ++clashes;
        busy[worker] = 0;
      });
      ASSERT_EQ(clashes, 0);
    }
  });
  std::size_t alone = 7;
  parallel_for(1, [&](std::size_t, std::size_t, std::size_t worker) { alone = worker; });
  EXPECT_EQ(alone, 0u);
  EXPECT_EQ(workers(), 1u);
}

TEST(Team, RethrowsExceptionsOfAnyThread) {
  with_team(2, [] {
    std::atomic<int> started = 0;
    const auto fail_together = [&](std::size_t, std::size_t) {  // one iteration on each thread
      ++started;
      while (started < 2) std::this_thread::yield();
      throw std::runtime_error("an iteration");
    };
    EXPECT_THROW(parallel_for(2, fail_together), std::runtime_error);
    std::atomic<int> after = 0;  // the team can be used again after the exception
    parallel_for(10, [&](std::size_t begin, std::size_t end) { after += static_cast<int>(end - begin); });
    EXPECT_EQ(after, 10);
  });
}

TEST(Team, RethrowsExceptionsOfTheBody) {
  const auto fail = [] { throw std::runtime_error("the body"); };
  EXPECT_THROW(with_team(2, fail), std::runtime_error);
  EXPECT_FALSE(has_team());
  with_team(2, [&] {
    EXPECT_THROW(with_team(2, fail), std::runtime_error);
    EXPECT_TRUE(has_team());
  });
}

TEST(Team, WakesSleepingThreads) {
  with_team(2, [] {
    for (const int sleep : {0, 5, 400}) {  // [ms]; the last is longer than the spin time of OpenMP's threads
      std::this_thread::sleep_for(std::chrono::milliseconds(sleep));
      std::atomic<int> arrived = 0;
      parallel_for(2, [&](std::size_t, std::size_t) {  // terminates only if the iterations run on different threads
        ++arrived;
        while (arrived < 2) std::this_thread::yield();
      });
      EXPECT_EQ(arrived, 2);
    }
  });
}

TEST(Team, NestedRegionsUseTheOuterTeamAndIterationsHaveNone) {
  EXPECT_FALSE(has_team());
  std::vector<std::size_t> order;
  parallel_for(4, [&](std::size_t begin, std::size_t end) { order = {begin, end}; });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 4}));
  with_team(3, [&] {
    std::atomic<int> sum = 0, with_a_team = 0;
    parallel_for(50, [&](std::size_t begin, std::size_t end) {
      with_team(2, [&] {
        if (has_team()) ++with_a_team;
        for (; begin < end; ++begin)
          parallel_for(10, [&](std::size_t from, std::size_t to) { sum += static_cast<int>(to - from); });
      });
    });
    EXPECT_EQ(sum, 500);
    EXPECT_EQ(with_a_team, 0);
    EXPECT_EQ(workers(), 3u);
    with_team(5, [] { EXPECT_EQ(workers(), 3u); });
    parallel_for(1, [](std::size_t, std::size_t) { EXPECT_EQ(workers(), 3u); });  // a single iteration keeps the team
    const SerialScope alone;
    EXPECT_FALSE(has_team());
  });
  EXPECT_FALSE(has_team());
}

TEST(Team, SeveralThreadsHaveIndependentTeams) {
  std::atomic<int> sum = 0;
  const auto run = [&] {
    with_team(2, [&] {
      for (int job = 0; job < 100; ++job)
        parallel_for(10, [&](std::size_t begin, std::size_t end) { sum += static_cast<int>(end - begin); });
    });
  };
  std::thread other(run);
  run();
  other.join();
  EXPECT_EQ(sum, 2000);
}

}  // namespace
}  // namespace pkm
