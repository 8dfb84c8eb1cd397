// Threads that share work out among themselves, and live as long as the team.
//
// The thread that has the work takes part in it and never waits for one that sleeps: pieces go to whoever asks next, so
// a thread that wakes up late finds less left, or nothing. Threads without work spin for a moment, because the next
// generation of a search comes within microseconds, and then sleep, because other programs need the cores too.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace pkm {

/// A reference to a function object, called with the number of a piece. It must not throw.
class PieceRef {
 public:
  template <class F>
  PieceRef(F& f)
      : object_(const_cast<void*>(static_cast<const void*>(&f))),
        call_([](void* object, std::size_t piece) { (*static_cast<F*>(object))(piece); }) {}
  void operator()(std::size_t piece) const { call_(object_, piece); }

 private:
  friend class Team;
  PieceRef(void* object, void (*call)(void*, std::size_t)) : object_(object), call_(call) {}
  void* object_;
  void (*call_)(void*, std::size_t);
};

class Team {
 public:
  /// @param threads  with the one that calls; 0: as many as the machine has cores
  explicit Team(int threads = 0);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls work(piece) for every piece in [0, pieces), each once, in any order and on any thread; returns when all are
  /// done. From one thread at a time, and not from within a piece.
  void share(std::size_t pieces, PieceRef work);

 private:
  void help();
  void take_pieces();

  // The number of the job in the upper half, the next piece in the lower; a piece is taken by counting up, which fails
  // when the job has changed meanwhile. What belongs to a job is written while no piece can be taken; whoever sees a
  // new part of it also sees that, and so takes no piece of the old job with it.
  std::atomic<std::uint64_t> next_;
  std::atomic<void*> object_ = nullptr;
  std::atomic<void (*)(void*, std::size_t)> call_ = nullptr;
  std::atomic<std::uint32_t> pieces_ = 0;
  alignas(64) std::atomic<std::uint32_t> done_ = 0;  ///< pieces of the job
  alignas(64) std::atomic<std::uint32_t> jobs_ = 0;  ///< what sleepers wait for
  std::atomic<bool> ends_ = false;
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

/// Calls work(piece) for every piece in [0, pieces): by the team lent to this thread, if there is one, else in order.
/// What a piece computes must not depend on which thread does. Within a piece no team is lent.
void share_pieces(std::size_t pieces, PieceRef work);

}  // namespace pkm
