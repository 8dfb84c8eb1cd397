#include "engine/core/team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <latch>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace pkm {
namespace {

class Helpers;

// Threads that take this one's pieces, itself included: many for the one that runs a region's body, else one.
thread_local std::size_t members = 1;
// Within a long piece: the threads that have none left.
thread_local Helpers* helpers = nullptr;

/// Pieces that are being shared out, by one task for each further thread, which claims some at a time. A task for every
/// few pieces (taskloop) is queued and fetched under a lock, and took up to 9 points more: benchmarks/README.md.
struct Pieces {
  WorkRef work;
  std::size_t count, threads;
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure = nullptr;

  /// Works on them until none is left.
  void take() {
    const WithoutTeam alone;
    const auto number = static_cast<std::size_t>(omp_get_thread_num());
    for (std::size_t begin = next.load(std::memory_order_relaxed); begin < count;) {
      const std::size_t end = begin + std::max<std::size_t>(1, (count - begin) / (2 * threads));
      if (!next.compare_exchange_weak(begin, end, std::memory_order_relaxed)) continue;
      try {
        work(begin, end, number);
      } catch (...) {  // no exception may leave a task
#pragma omp critical(pkm_failure)
        failure = std::current_exception();
      }
      begin = next.load(std::memory_order_relaxed);
    }
  }
};

/// Where the threads that work on long pieces leave what they share out, for those that have no piece left.
class Helpers {
 public:
  explicit Helpers(std::size_t pieces) : running_(pieces) {}

  bool waiting() const { return waiting_.load(std::memory_order_relaxed) > 0; }

  /// Works on them with whoever waits; returns when all are done.
  void share(Pieces& pieces) {
    Offer offer{pieces};
    {
      const std::lock_guard guard(mutex_);
      offers_.push_back(&offer);
    }
    changed_.notify_all();
    pieces.take();
    std::unique_lock lock(mutex_);
    std::erase(offers_, &offer);
    changed_.wait(lock, [&] { return offer.guests == 0; });
  }

  void ended_one() {
    {
      const std::lock_guard guard(mutex_);
      --running_;
    }
    changed_.notify_all();
  }

  /// Helps until every long piece has ended.
  void help() {
    ++waiting_;
    std::unique_lock lock(mutex_);
    while (running_ > 0) {
      const auto open = std::ranges::find_if(offers_, [](const Offer* o) { return o->pieces.next < o->pieces.count; });
      if (open == offers_.end()) {
        changed_.wait(lock);
        continue;
      }
      Offer& offer = **open;
      ++offer.guests;
      lock.unlock();
      offer.pieces.take();
      lock.lock();
      --offer.guests;
      changed_.notify_all();
    }
    --waiting_;
  }

 private:
  struct Offer {
    Pieces& pieces;
    int guests = 0;  ///< that work on them
  };

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Offer*> offers_;
  std::size_t running_;
  std::atomic<int> waiting_ = 0;
};

/// OpenMP ends the program where it cannot start a thread, so whether so many can be is tried before, by threads that
/// do nothing and have ended when a region begins: all that work are OpenMP's. No limit would tell instead: how much of
/// RLIMIT_NPROC or of a container's tasks is left depends on what else runs, and what a thread takes of RLIMIT_AS on
/// its stack, its arena and what is mapped already; and OpenMP, which exits, leaves nothing to be caught.
void expect_threads(int size) {
  static std::atomic<int> known = 1;  // so many could be started
  if (size <= known.load(std::memory_order_relaxed)) return;
  std::latch done(1);
  std::vector<std::thread> threads;
  std::string trouble;
  try {
    while (std::ssize(threads) < size - 1) threads.emplace_back([&done] { done.wait(); });
  } catch (const std::system_error& error) {
    trouble = error.code().message();
  } catch (const std::bad_alloc&) {
    trouble = "out of memory";
  }
  const std::size_t started = threads.size();
  done.count_down();
  for (std::thread& thread : threads) thread.join();
  if (!trouble.empty())
    throw std::runtime_error("a team of " + std::to_string(size) + " threads cannot be started: after " +
                             std::to_string(started) + " more there was no other (" + trouble +
                             "); use fewer, or allow the program more memory");
  known = size;
}

}  // namespace

int team_size(int threads) {
  return std::clamp(threads > 0 ? threads : omp_get_max_threads(), 1, omp_get_thread_limit());
}

void with_team(int threads, WorkRef body) {
  const int size = team_size(threads);
  if (size == 1 || omp_in_parallel()) return body(0, 1, 0);
  expect_threads(size);
  std::exception_ptr failure = nullptr;
#pragma omp parallel num_threads(size)
#pragma omp master  // the others wait at the region's end, and take tasks there
  {
    members = static_cast<std::size_t>(omp_get_num_threads());
    try {
      body(0, 1, 0);
    } catch (...) {  // none may leave a region
      failure = std::current_exception();
    }
    members = 1;
  }
  if (failure) std::rethrow_exception(failure);
}

WithoutTeam::WithoutTeam() : before_(std::exchange(members, 1)) {}
WithoutTeam::~WithoutTeam() { members = before_; }

bool has_team() { return members > 1 && (!helpers || helpers->waiting()); }

std::size_t workers() { return members; }

std::size_t worker() { return members == 1 ? 0 : static_cast<std::size_t>(omp_get_thread_num()); }

void share_pieces(std::size_t pieces, WorkRef work) {
  if (pieces < 2 || !has_team()) {
    if (pieces > 0) work(0, pieces, worker());
    return;
  }
  Pieces shared{work, pieces, members};
  if (helpers) {
    helpers->share(shared);
  } else {
    const std::size_t others = std::min(members, pieces) - 1;
#pragma omp taskgroup
    {
#pragma omp taskloop grainsize(1) nogroup shared(shared)
      for (std::size_t other = 0; other < others; ++other) shared.take();
      shared.take();
    }
  }
  if (shared.failure) std::rethrow_exception(shared.failure);
}

void share_long_pieces(std::size_t pieces, WorkRef work) {
  if (pieces < 2 || members == 1 || helpers) {
    for (std::size_t piece = 0; piece < pieces; ++piece) work(piece, piece + 1, worker());
    return;
  }
  Helpers helping(pieces);
  const std::size_t team = members;
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure = nullptr;
  const auto serve = [&] {
    const std::size_t before = std::exchange(members, team);
    helpers = &helping;
    for (std::size_t piece = next++; piece < pieces; piece = next++) {
      try {
        work(piece, piece + 1, worker());
      } catch (...) {
#pragma omp critical(pkm_failure)
        failure = std::current_exception();
      }
      helping.ended_one();
    }
    helping.help();
    helpers = nullptr;
    members = before;
  };
#pragma omp taskgroup
  {
#pragma omp taskloop grainsize(1) nogroup
    for (std::size_t other = 1; other < team; ++other) serve();
    serve();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pkm
