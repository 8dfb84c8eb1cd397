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

class ThreadPool;

// Number of threads, this one included, that execute the loops of this thread: the size of the team for the thread that
// runs the body of with_team(), otherwise 1.
thread_local std::size_t thread_count = 1;
// The pool in which the other threads of the team wait; null without a team.
thread_local ThreadPool* pool = nullptr;
// True while this thread executes an iteration of parallel_for_nested(). Its inner loops are then shared only with
// threads for which no iteration of parallel_for_nested() is left.
thread_local bool in_long_iteration = false;

/// Validates OMP_NUM_THREADS, which OpenMP itself accepts unchecked. If it is a list, its first number applies to the
/// parallel regions of this program.
void check_environment() {
  const char* const given = std::getenv("OMP_NUM_THREADS");
  const std::string text = given ? given : "";
  if (trimmed(text).empty()) return;
  const auto number = parse_integer(trimmed(std::string_view(text).substr(0, text.find(','))));
  if (!number || *number < 1 || *number > kMaxThreads)
    throw ConfigError({"", 0, "OMP_NUM_THREADS"}, "'" + text + "'",
                      "a whole number from 1 to " + std::to_string(kMaxThreads) + ", in decimal without leading zeros");
}

/// Waits until the value differs from `old`: spins for a short time, then sleeps. OpenMP's own barriers spin for
/// milliseconds by default; if other programs use the cores, the scheduler then preempts these threads just when they
/// have work to do (benchmarks/README.md).
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  constexpr auto kSpinTime = std::chrono::microseconds(100);
  constexpr int kSpins = 64;  // number of loads of the value between two readings of the clock
  const auto end = std::chrono::steady_clock::now() + kSpinTime;
  do {
    for (int i = 0; i < kSpins; ++i) {
      if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
  } while (std::chrono::steady_clock::now() < end);
  value.wait(old, std::memory_order_acquire);
}

/// A parallel loop started by one thread. Participating threads claim chunks of its iterations from an atomic counter.
/// A thread that is preempted before it has claimed a chunk is not waited for and may access the object later;
/// therefore the object outlives the loop and is reused for the next one.
class SharedLoop {
 public:
  void start(std::uint32_t iterations, const WorkRef& work) {
    const std::uint64_t loop_id = (next_.load(std::memory_order_relaxed) >> 32) + 1;
    work_.store(&work, std::memory_order_release);
    scope_.store(StopScope::current(), std::memory_order_release);
    iterations_.store(iterations, std::memory_order_release);
    done_.store(0, std::memory_order_release);
    next_.store(loop_id << 32, std::memory_order_release);
  }

  /// Claims and executes chunks until no iteration is left.
  /// @param threads  number of threads of the team
  void execute_chunks(std::uint32_t threads) {
    const SerialScope serial;
    const auto worker = static_cast<std::size_t>(omp_get_thread_num());
    for (std::uint64_t next = next_.load(std::memory_order_acquire);;) {
      const WorkRef* const work = work_.load(std::memory_order_acquire);
      const StopScope* const scope = scope_.load(std::memory_order_acquire);
      const std::uint32_t total = iterations_.load(std::memory_order_acquire), begin = static_cast<std::uint32_t>(next);
      if (begin >= total) return;
      const std::uint32_t count = std::max<std::uint32_t>(1, (total - begin) / (2 * threads));
      // The exchange also fails if the loop has ended meanwhile: the values read above may then belong to another loop.
      if (!next_.compare_exchange_weak(next, next + count, std::memory_order_acquire, std::memory_order_acquire))
        continue;
      try {
        const StopScope::InheritedScope inherited(scope);
        check_stop();
        (*work)(begin, begin + count, worker);
      } catch (...) {
#pragma omp critical(pkm_failure)
        failure_ = std::current_exception();
      }
      if (done_.fetch_add(count, std::memory_order_acq_rel) + count == total) done_.notify_one();
      next = next_.load(std::memory_order_acquire);
    }
  }

  /// Waits until all iterations are complete. Rethrows an exception that one of them has thrown.
  void finish() {
    const std::uint32_t iterations = iterations_.load(std::memory_order_relaxed);
    for (std::uint32_t done = done_.load(std::memory_order_acquire); done != iterations;
         done = done_.load(std::memory_order_acquire))
      await_change(done_, done);
    next_.store(next_.load(std::memory_order_relaxed) | kNoIteration, std::memory_order_relaxed);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  static constexpr std::uint32_t kNoIteration = 0xffffffff;

 private:
  /// (number of the loop << 32) | index of the first unclaimed iteration.
  std::atomic<std::uint64_t> next_ = kNoIteration;
  std::atomic<const WorkRef*> work_ = nullptr;
  std::atomic<const StopScope*> scope_ = nullptr;  ///< StopScope of the thread that started the loop
  std::atomic<std::uint32_t> iterations_ = 0, done_ = 0;
  std::exception_ptr failure_ = nullptr;
};

/// Pool of threads that have no work of their own, and execute iterations of the loops that other threads start.
class ThreadPool {
 public:
  /// @param tasks  number of tasks; the waiting threads are released when all of them have ended
  ThreadPool(std::size_t tasks, std::size_t threads) : unfinished_(tasks), loops_(threads) {}

  bool has_waiting_threads() const { return waiting_.load(std::memory_order_relaxed) > 0; }

  /// Executes a parallel loop on this thread and the waiting threads.
  void run_loop(std::size_t iterations, const WorkRef& work) {
    PKM_EXPECTS(iterations < SharedLoop::kNoIteration);
    SharedLoop& own = loops_[static_cast<std::size_t>(omp_get_thread_num())];
    own.start(static_cast<std::uint32_t>(iterations), work);
    wake_waiting();
    own.execute_chunks(threads());
    own.finish();
  }

  void end_task() {
    unfinished_.fetch_sub(1, std::memory_order_acq_rel);
    wake_waiting();
  }

  /// Executes iterations of other threads' loops until all tasks have ended.
  void help_until_done() {
    ++waiting_;
    for (;;) {
      const std::uint32_t seen = changes_.load(std::memory_order_acquire);
      if (unfinished_.load(std::memory_order_acquire) == 0) break;
      for (SharedLoop& loop : loops_) loop.execute_chunks(threads());
      await_change(changes_, seen);
    }
    --waiting_;
  }

 private:
  std::uint32_t threads() const { return static_cast<std::uint32_t>(loops_.size()); }
  void wake_waiting() {
    changes_.fetch_add(1, std::memory_order_acq_rel);
    changes_.notify_all();
  }

  std::atomic<std::size_t> unfinished_;
  std::vector<SharedLoop> loops_;  ///< the loop that each thread starts, by thread number
  std::atomic<std::uint32_t> changes_ = 0;
  std::atomic<int> waiting_ = 0;
};

/// Throws std::runtime_error if `size` threads cannot be started. OpenMP would terminate the program in this case,
/// without an exception. Therefore the same number of idle threads is started first, as a trial; they end before OpenMP
/// starts its own threads. Reading the resource limits cannot replace the trial: how much of RLIMIT_NPROC or of the
/// task limit of a container is left depends on other processes, and how much of RLIMIT_AS a thread needs depends on
/// its stack, its malloc arena and the existing mappings.
void require_threads(int size) {
  static std::atomic<int> tested = 1;  // size of the largest team that could be started so far
  if (size <= tested.load(std::memory_order_relaxed)) return;
  std::latch done(1);
  std::vector<std::thread> threads;
  std::string reason;
  try {
    while (std::ssize(threads) < size - 1) threads.emplace_back([&done] { done.wait(); });
  } catch (const std::system_error& error) {
    reason = error.code().message();
  } catch (const std::bad_alloc&) {
    reason = "out of memory";
  }
  const std::size_t started = threads.size();
  done.count_down();
  for (std::thread& thread : threads) thread.join();
  if (!reason.empty())
    throw std::runtime_error("cannot start a team of " + std::to_string(size) + " threads: only " +
                             std::to_string(started) + " additional threads could be started (" + reason +
                             "); use fewer threads, or allow the program more memory");
  tested = size;
}

}  // namespace

int team_size(int threads) {
  if (threads <= 0) check_environment();
  return std::clamp(threads > 0 ? threads : omp_get_max_threads(), 1, omp_get_thread_limit());
}

void with_team(int threads, WorkRef body) {
  const int size = team_size(threads);
  if (size == 1 || omp_in_parallel()) return body(0, 1, 0);
  require_threads(size);
  ThreadPool own_pool(1, static_cast<std::size_t>(size));
  std::exception_ptr failure = nullptr;
#pragma omp parallel num_threads(size)
  if (omp_get_thread_num() > 0) {
    own_pool.help_until_done();
  } else {
    thread_count = static_cast<std::size_t>(omp_get_num_threads());
    pool = &own_pool;
    try {
      body(0, 1, 0);
    } catch (...) {  // an exception must not leave an OpenMP parallel region
      failure = std::current_exception();
    }
    thread_count = 1;
    own_pool.end_task();
  }
  if (failure) std::rethrow_exception(failure);
}

SerialScope::SerialScope() : previous_(std::exchange(thread_count, 1)) {}
SerialScope::~SerialScope() { thread_count = previous_; }

bool has_team() { return thread_count > 1 && (!in_long_iteration || pool->has_waiting_threads()); }

std::size_t workers() { return thread_count; }

std::size_t worker() { return thread_count == 1 ? 0 : static_cast<std::size_t>(omp_get_thread_num()); }

void parallel_for(std::size_t iterations, WorkRef work) {
  if (iterations < 2 || !has_team()) {
    if (iterations > 0) work(0, iterations, worker());
    return;
  }
  pool->run_loop(iterations, work);
}

void parallel_for_nested(std::size_t iterations, WorkRef work) {
  if (iterations < 2 || thread_count == 1 || in_long_iteration) {
    for (std::size_t iteration = 0; iteration < iterations; ++iteration) work(iteration, iteration + 1, worker());
    return;
  }
  const std::size_t team = thread_count;
  ThreadPool inner_pool(iterations, team);
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure = nullptr;
  const auto serve = [&](std::size_t, std::size_t) {
    const std::size_t previous_count = std::exchange(thread_count, team);
    ThreadPool* const previous_pool = std::exchange(pool, &inner_pool);
    in_long_iteration = true;
    for (std::size_t iteration = next++; iteration < iterations; iteration = next++) {
      try {
        work(iteration, iteration + 1, worker());
      } catch (...) {
#pragma omp critical(pkm_failure)
        failure = std::current_exception();
      }
      inner_pool.end_task();
    }
    inner_pool.help_until_done();
    in_long_iteration = false;
    pool = previous_pool;
    thread_count = previous_count;
  };
  pool->run_loop(team, serve);  // one iteration for each thread of the team
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pkm
