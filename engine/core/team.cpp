#include "engine/core/team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
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

class Room;

// Threads that take this one's pieces, itself included: many for the one that runs a region's body, else one.
thread_local std::size_t members = 1;
// Where they wait.
thread_local Room* room = nullptr;
// Then only threads that have no long piece left take its pieces.
thread_local bool in_long_piece = false;

/// Pieces that are being shared out: each thread that takes part claims some at a time.
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
      } catch (...) {
#pragma omp critical(pkm_failure)
        failure = std::current_exception();
      }
      begin = next.load(std::memory_order_relaxed);
    }
  }
};

/// Where threads without work wait for pieces that others share out: awake for a moment, then asleep. OpenMP's own
/// barriers keep them awake for milliseconds by default, and where other programs use the cores, the scheduler makes
/// threads that never sleep wait when at last they have work: benchmarks/README.md.
class Room {
 public:
  /// @param works  that have to end before those who help may leave
  explicit Room(std::size_t works) : running_(works) {}

  bool has_guests() const { return waiting_.load(std::memory_order_relaxed) > 0; }

  /// Works on them with whoever waits; returns when all are done.
  void share(Pieces& pieces) {
    Offer offer{pieces};
    {
      const std::lock_guard guard(mutex_);
      offers_.push_back(&offer);
    }
    tell();
    pieces.take();
    std::unique_lock lock(mutex_);
    std::erase(offers_, &offer);
    while (offer.guests > 0) await_change(lock);
  }

  void ended_one() {
    {
      const std::lock_guard guard(mutex_);
      --running_;
    }
    tell();
  }

  /// Helps until every work has ended.
  void help() {
    ++waiting_;
    std::unique_lock lock(mutex_);
    while (running_ > 0) {
      const auto open = std::ranges::find_if(offers_, [](const Offer* o) { return o->pieces.next < o->pieces.count; });
      if (open == offers_.end()) {
        await_change(lock);
        continue;
      }
      Offer& offer = **open;
      ++offer.guests;
      lock.unlock();
      offer.pieces.take();
      lock.lock();
      if (--offer.guests == 0) tell();
    }
    --waiting_;
  }

 private:
  struct Offer {
    Pieces& pieces;
    int guests = 0;  ///< that work on them
  };

  void tell() {
    changes_.fetch_add(1, std::memory_order_release);
    changes_.notify_all();
  }

  /// Waits until tell() is called after the lock was taken.
  void await_change(std::unique_lock<std::mutex>& lock) {
    constexpr auto kAwake = std::chrono::microseconds(100);
    constexpr int kLooks = 64;  // between two looks at the clock
    const std::uint32_t old = changes_.load(std::memory_order_relaxed);
    lock.unlock();
    const auto changed = [&] { return changes_.load(std::memory_order_acquire) != old; };
    for (const auto end = std::chrono::steady_clock::now() + kAwake; std::chrono::steady_clock::now() < end;)
      for (int i = 0; i < kLooks; ++i) {
        if (changed()) return lock.lock();
        pause();
      }
    changes_.wait(old, std::memory_order_acquire);
    lock.lock();
  }

  static void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }

  std::mutex mutex_;
  std::vector<Offer*> offers_;
  std::size_t running_;
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
  return std::clamp(threads > 0 ? threads : omp_get_max_threads(), 1, omp_get_thread_limit());
}

void with_team(int threads, WorkRef body) {
  const int size = team_size(threads);
  if (size == 1 || omp_in_parallel()) return body(0, 1, 0);
  expect_threads(size);
  Room waiting(1);
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
  Pieces shared{work, pieces, members};
  room->share(shared);
  if (shared.failure) std::rethrow_exception(shared.failure);
}

void share_long_pieces(std::size_t pieces, WorkRef work) {
  if (pieces < 2 || members == 1 || in_long_piece) {
    for (std::size_t piece = 0; piece < pieces; ++piece) work(piece, piece + 1, worker());
    return;
  }
  Room helping(pieces);
  const std::size_t team = members;
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
  Pieces shares{serve, team, team};  // one for each thread
  room->share(shares);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pkm
