#include "engine/core/team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <latch>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/thread_limit.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

class Room;

// Threads that take this one's pieces, itself included: many for the one that runs a region's body, else one.
thread_local std::size_t members = 1;
// Where they wait.
thread_local Room* room = nullptr;
// Then only threads that have no long piece left take its pieces.
thread_local bool in_long_piece = false;

/// OpenMP reads the variable itself, and takes whatever number is there; a list's first is that of our regions.
void check_environment() {
  const char* const given = std::getenv("OMP_NUM_THREADS");
  const std::string text = given ? given : "";
  if (trimmed(text).empty()) return;
  const auto number = parse_integer(trimmed(std::string_view(text).substr(0, text.find(','))));
  if (!number || *number < 1 || *number > kMostThreads)
    throw ConfigError(
        {"", 0, "OMP_NUM_THREADS"}, "'" + text + "'",
        "a whole number from 1 to " + std::to_string(kMostThreads) + ", in decimal without leading zeros");
}

/// Waits until the value is another one: awake for a moment, then asleep. OpenMP's own barriers keep threads awake for
/// milliseconds by default, and where other programs use the cores, the scheduler makes threads that never sleep wait
/// when at last they have work: benchmarks/README.md.
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  constexpr auto kAwake = std::chrono::microseconds(100);
  constexpr int kLooks = 64;  // between two looks at the clock
  const auto end = std::chrono::steady_clock::now() + kAwake;
  do {
    for (int i = 0; i < kLooks; ++i) {
      if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
  } while (std::chrono::steady_clock::now() < end);
  value.wait(old, std::memory_order_acquire);
}

/// What one thread shares out: pieces, of which each thread that takes part claims some at a time. A thread that is
/// pushed off its core before it has claimed any is not waited for, so an offer stays when its pieces are done.
class Offer {
 public:
  void open(std::uint32_t pieces, const WorkRef& work) {
    const std::uint64_t job = (next_.load(std::memory_order_relaxed) >> 32) + 1;
    work_.store(&work, std::memory_order_release);
    scope_.store(StopScope::current(), std::memory_order_release);
    pieces_.store(pieces, std::memory_order_release);
    done_.store(0, std::memory_order_release);
    next_.store(job << 32, std::memory_order_release);
  }

  /// Works on the pieces until none is left.
  void take(std::uint32_t threads) {
    const WithoutTeam alone;
    const auto number = static_cast<std::size_t>(omp_get_thread_num());
    for (std::uint64_t next = next_.load(std::memory_order_acquire);;) {
      const WorkRef* const work = work_.load(std::memory_order_acquire);
      const StopScope* const scope = scope_.load(std::memory_order_acquire);
      const std::uint32_t pieces = pieces_.load(std::memory_order_acquire), begin = static_cast<std::uint32_t>(next);
      if (begin >= pieces) return;
      const std::uint32_t count = std::max<std::uint32_t>(1, (pieces - begin) / (2 * threads));
      // Fails where the job has ended, too: what was read then belongs to none, or to another.
      if (!next_.compare_exchange_weak(next, next + count, std::memory_order_acquire, std::memory_order_acquire))
        continue;
      try {
        const StopScope::Adopted adopted(scope);
        check_stop();
        (*work)(begin, begin + count, number);
      } catch (...) {
#pragma omp critical(pkm_failure)
        failure_ = std::current_exception();
      }
      if (done_.fetch_add(count, std::memory_order_acq_rel) + count == pieces) done_.notify_one();
      next = next_.load(std::memory_order_acquire);
    }
  }

  /// Returns when all are done. Throws what one of them has thrown.
  void close() {
    const std::uint32_t pieces = pieces_.load(std::memory_order_relaxed);
    for (std::uint32_t done = done_.load(std::memory_order_acquire); done != pieces;
         done = done_.load(std::memory_order_acquire))
      await_change(done_, done);
    next_.store(next_.load(std::memory_order_relaxed) | kNoPiece, std::memory_order_relaxed);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  static constexpr std::uint32_t kNoPiece = 0xffffffff;

 private:
  std::atomic<std::uint64_t> next_ = kNoPiece;  ///< the job's number, and its first piece that nobody has claimed
  std::atomic<const WorkRef*> work_ = nullptr;
  std::atomic<const StopScope*> scope_ = nullptr;  ///< of the thread that shares it out
  std::atomic<std::uint32_t> pieces_ = 0, done_ = 0;
  std::exception_ptr failure_ = nullptr;
};

/// Where threads without work wait for what others share out.
class Room {
 public:
  /// @param works  that have to end before those who help may leave
  Room(std::size_t works, std::size_t threads) : running_(works), offers_(threads) {}

  bool has_guests() const { return waiting_.load(std::memory_order_relaxed) > 0; }

  /// Has pieces done by this thread and whoever waits.
  void share(std::size_t pieces, const WorkRef& work) {
    PKM_EXPECTS(pieces < Offer::kNoPiece);
    Offer& mine = offers_[static_cast<std::size_t>(omp_get_thread_num())];
    mine.open(static_cast<std::uint32_t>(pieces), work);
    tell();
    mine.take(threads());
    mine.close();
  }

  void ended_one() {
    running_.fetch_sub(1, std::memory_order_acq_rel);
    tell();
  }

  /// Helps until every work has ended.
  void help() {
    ++waiting_;
    for (;;) {
      const std::uint32_t seen = changes_.load(std::memory_order_acquire);
      if (running_.load(std::memory_order_acquire) == 0) break;
      for (Offer& offer : offers_) offer.take(threads());
      await_change(changes_, seen);
    }
    --waiting_;
  }

 private:
  std::uint32_t threads() const { return static_cast<std::uint32_t>(offers_.size()); }
  void tell() {
    changes_.fetch_add(1, std::memory_order_acq_rel);
    changes_.notify_all();
  }

  std::atomic<std::size_t> running_;
  std::vector<Offer> offers_;  ///< of each thread
  std::atomic<std::uint32_t> changes_ = 0;
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
  if (threads <= 0) check_environment();
  return std::clamp(threads > 0 ? threads : omp_get_max_threads(), 1, omp_get_thread_limit());
}

void with_team(int threads, WorkRef body) {
  const int size = team_size(threads);
  if (size == 1 || omp_in_parallel()) return body(0, 1, 0);
  expect_threads(size);
  Room waiting(1, static_cast<std::size_t>(size));
  std::exception_ptr failure = nullptr;
#pragma omp parallel num_threads(size)
  if (omp_get_thread_num() > 0) {
    waiting.help();
  } else {
    members = static_cast<std::size_t>(omp_get_num_threads());
    room = &waiting;
    try {
      body(0, 1, 0);
    } catch (...) {  // none may leave a region
      failure = std::current_exception();
    }
    members = 1;
    waiting.ended_one();
  }
  if (failure) std::rethrow_exception(failure);
}

WithoutTeam::WithoutTeam() : before_(std::exchange(members, 1)) {}
WithoutTeam::~WithoutTeam() { members = before_; }

bool has_team() { return members > 1 && (!in_long_piece || room->has_guests()); }

std::size_t workers() { return members; }

std::size_t worker() { return members == 1 ? 0 : static_cast<std::size_t>(omp_get_thread_num()); }

void share_pieces(std::size_t pieces, WorkRef work) {
  if (pieces < 2 || !has_team()) {
    if (pieces > 0) work(0, pieces, worker());
    return;
  }
  room->share(pieces, work);
}

void share_long_pieces(std::size_t pieces, WorkRef work) {
  if (pieces < 2 || members == 1 || in_long_piece) {
    for (std::size_t piece = 0; piece < pieces; ++piece) work(piece, piece + 1, worker());
    return;
  }
  const std::size_t team = members;
  Room helping(pieces, team);
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure = nullptr;
  const auto serve = [&](std::size_t, std::size_t) {
    const std::size_t before = std::exchange(members, team);
    Room* const outside = std::exchange(room, &helping);
    in_long_piece = true;
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
    in_long_piece = false;
    room = outside;
    members = before;
  };
  room->share(team, serve);  // one for each thread
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pkm
