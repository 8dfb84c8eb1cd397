// Parallel loops on a persistent thread team: one OpenMP parallel region around a whole run, whose threads wait for the
// iterations of loops.
//
// The thread that starts a loop takes part in it, and at the end waits only for threads that are executing iterations
// of it. An OpenMP region for every generation would wait for all threads, including those that the operating system
// has preempted in favour of other programs.
#pragma once

#include <cstddef>
#include <type_traits>

namespace pkm {

/// Non-owning reference to a callable: a loop body work(begin, end) or work(begin, end, worker) that executes the
/// iterations [begin, end), or a function without arguments. `worker` is the index of the executing thread: concurrent
/// calls have different indices, so that data of one worker needs no lock.
class WorkRef {
 public:
  template <class F>
  WorkRef(const F& f)
      : object_(&f), call_([](const void* object, std::size_t begin, std::size_t end, std::size_t worker) {
          if constexpr (std::is_invocable_v<const F&, std::size_t, std::size_t, std::size_t>)
            (*static_cast<const F*>(object))(begin, end, worker);
          else if constexpr (std::is_invocable_v<const F&>)
            (*static_cast<const F*>(object))();
          else
            (*static_cast<const F*>(object))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end, std::size_t worker) const { call_(object_, begin, end, worker); }

 private:
  using Call = void (*)(const void*, std::size_t, std::size_t, std::size_t);
  const void* object_;
  Call call_;
};

/// Number of threads of a team: `threads` itself if it is positive, otherwise OpenMP's default (OMP_NUM_THREADS, or the
/// number of cores available to the process); at most OMP_THREAD_LIMIT. Throws ConfigError if OMP_NUM_THREADS is
/// invalid.
int team_size(int threads);

/// Runs body() on this thread with a team of team_size(threads) threads, this one included, which execute the loops of
/// parallel_for() in it. Exceptions of body() are rethrown. Calls do not nest: inside a parallel region, of this file
/// or of other code, body() uses the team that exists already. Throws std::runtime_error if the threads cannot be
/// started.
void with_team(int threads, WorkRef body);

/// While an instance exists, the loops of this thread are executed by this thread alone.
class SerialScope {
 public:
  SerialScope();
  ~SerialScope();
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;

 private:
  std::size_t previous_;
};

/// Returns true if a parallel_for() called by this thread uses more than one thread.
bool has_team();

/// Maximum number of workers of a parallel_for() called by this thread, for allocating data for each worker.
std::size_t workers();
/// Index of this thread among the workers of the parallel_for() that it executes; less than workers().
std::size_t worker();

/// Parallel loop: executes each of the iterations [0, iterations) once, by calls work(begin, end) or work(begin, end,
/// worker) with worker < workers(), in any order and on any thread, and returns when all are complete. Guided
/// self-scheduling: idle threads claim chunks in proportion to the iterations that remain. The result of an iteration
/// must not depend on the thread. Iterations have no team of their own (loops in them are serial) and are subject to
/// the caller's StopScope. An exception thrown by `work` is rethrown here; if several calls throw, only one exception
/// is. Without a team: a single call work(0, iterations, 0) on this thread.
void parallel_for(std::size_t iterations, WorkRef work);

/// Parallel loop for a few long iterations that contain parallel_for() loops (nested parallelism). Executes work(i, i +
/// 1) for all i in [0, iterations); iterations are started in this order. Threads for which no iteration is left help
/// with the inner loops of the others. A single iteration has the whole team. An exception thrown by `work` is rethrown
/// here; if several calls throw, only one exception is.
void parallel_for_nested(std::size_t iterations, WorkRef work);

}  // namespace pkm
