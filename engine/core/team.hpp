// Threads that share work out among themselves, and live as long as the team.
//
// The thread that has the work takes part in it and never waits for one that sleeps: pieces go to whoever asks next, so
// a thread that wakes up late finds less left, or nothing. Threads without work spin for a moment, because the next
// generation of a search comes within microseconds, and then sleep, because other programs need the cores too.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace pkm {

/// A reference to a function object that works on the pieces [begin, end), and may ask which worker does it: two pieces
/// that are worked on at once have different workers, so what belongs to a worker needs no lock.
class WorkRef {
 public:
  template <class F>
  WorkRef(const F& f)
      : object_(&f), call_([](const void* object, std::size_t begin, std::size_t end, std::size_t worker) {
          if constexpr (std::is_invocable_v<const F&, std::size_t, std::size_t, std::size_t>)
            (*static_cast<const F*>(object))(begin, end, worker);
          else
            (*static_cast<const F*>(object))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end, std::size_t worker) const { call_(object_, begin, end, worker); }

 private:
  friend class Team;
  using Call = void (*)(const void*, std::size_t, std::size_t, std::size_t);
  WorkRef(const void* object, Call call) : object_(object), call_(call) {}
  const void* object_;
  Call call_;
};

/// How many threads are meant: the number itself, or for 0 as many as the machine has cores.
int team_size(int threads);

class Team {
 public:
  /// @param threads  with the one that calls, as for team_size()
  explicit Team(int threads = 0);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Has work(begin, end), or work(begin, end, worker) with worker < threads(), done for all of [0, pieces), each piece
  /// once, in any order and on any thread; returns when all are done. Whoever is free takes a share of what is left, so
  /// shares get smaller towards the end. From one thread at a time, and not from within a piece. What the work throws
  /// is thrown here, once all are done or have failed; of several exceptions one.
  void share(std::size_t pieces, WorkRef work);

 private:
  void help(std::size_t worker);
  void take_pieces(std::size_t worker);

  // The number of the job in the upper half, the next piece in the lower; pieces are taken by counting up, which fails
  // when the job has changed meanwhile. What belongs to a job is written while no piece can be taken; whoever sees a
  // new part of it also sees that, and so takes no piece of the old job with it.
  std::atomic<std::uint64_t> next_;
  std::atomic<const void*> object_ = nullptr;
  std::atomic<WorkRef::Call> call_ = nullptr;
  std::atomic<std::uint32_t> pieces_ = 0;
  alignas(64) std::atomic<std::uint32_t> done_ = 0;  ///< pieces of the job
  alignas(64) std::atomic<std::uint32_t> jobs_ = 0;  ///< what sleepers wait for
  std::atomic<bool> ends_ = false;
  std::mutex failing_;
  std::exception_ptr failure_;  ///< of the job
  std::vector<std::thread> helpers_;
};

/// Lends a team to the calling thread, for as long as it lives: share_pieces() then uses it.
class LentTeam {
 public:
  explicit LentTeam(Team& team);
  ~LentTeam();
  LentTeam(const LentTeam&) = delete;
  LentTeam& operator=(const LentTeam&) = delete;

 private:
  Team* before_;
};

/// Whether a team of more than one thread is lent to the calling thread.
bool has_team();

/// How many workers share_pieces() has here, at most: what each needs of its own can be prepared.
std::size_t workers();

/// Team::share by the team lent to this thread, if there is one; else work(0, pieces, 0) here. What a piece computes
/// must not depend on which thread does it. Within a piece no team is lent.
void share_pieces(std::size_t pieces, WorkRef work);

}  // namespace pkm
