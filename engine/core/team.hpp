// Work that is shared out among OpenMP's threads: one parallel region around a whole run, whose threads wait in it for
// pieces of whatever comes.
//
// The thread that has the work takes part in it and never waits for one that has no piece. A region around each
// generation would: its end waits for threads that other programs have pushed off their core.
#pragma once

#include <cstddef>
#include <type_traits>

namespace pkm {

/// A reference to a function object that works on the pieces [begin, end), and may ask which worker does it: two pieces
/// that are worked on at once have different workers, so what belongs to a worker needs no lock. Work that is one whole
/// takes no argument.
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

/// How many threads are meant: the number itself, or for 0 as many as OpenMP would take (OMP_NUM_THREADS, else as many
/// as the process has cores); at most OMP_THREAD_LIMIT. Throws ConfigError where OMP_NUM_THREADS is out of range.
int team_size(int threads);

/// Runs body() on this thread, beside a team of so many threads, this one included, as for team_size(): share_pieces()
/// in it uses them. What it throws is thrown here. One region serves all: within a region, ours or another's, body()
/// keeps the team that it has. Throws std::runtime_error where so many threads cannot be started.
void with_team(int threads, WorkRef body);

/// While it lives, this thread has no team.
class WithoutTeam {
 public:
  WithoutTeam();
  ~WithoutTeam();
  WithoutTeam(const WithoutTeam&) = delete;
  WithoutTeam& operator=(const WithoutTeam&) = delete;

 private:
  std::size_t before_;
};

/// Whether share_pieces() has more than this thread here.
bool has_team();

/// How many workers share_pieces() has here, at most: what each needs of its own can be prepared.
std::size_t workers();
/// This thread's number among them, < workers().
std::size_t worker();

/// Has work(begin, end), or work(begin, end, worker) with worker < workers(), done for all of [0, pieces), each piece
/// once, in any order and on any thread; returns when all are done. Whoever is free takes a share of what is left, so
/// shares get smaller towards the end. What a piece computes must not depend on which thread does it. Within one of
/// several pieces there is no team, and the StopScope is the caller's. What the work throws is thrown here; of several
/// exceptions one. Without a team: work(0, pieces, 0) on this thread.
void share_pieces(std::size_t pieces, WorkRef work);

/// Has work(begin, end) done for all of [0, pieces), one piece at a time, for few pieces that take long: they are begun
/// in their order, and threads that find none left help with what the others' pieces have shared out in turn. A single
/// piece has the whole team. Throws as share_pieces() does.
void share_long_pieces(std::size_t pieces, WorkRef work);

}  // namespace pkm
