// Message passing between the processes (MPI ranks) of one run, which mpirun or srun has started on one or several
// hosts. Without a launcher, the run has one process and these functions work locally.
//
// Messages are byte strings. A function marked "collective" must be called by every rank, in the same order, and by one
// thread of a rank at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pkm::ranks {

/// Initialises MPI and connects this process to the others that the launcher has started, until it is destroyed; does
/// nothing without a launcher. Collective. There may be one instance at a time, which must be constructed before any
/// other function of this file is called.
class Group {
 public:
  /// Throws std::runtime_error if a launcher has started several processes that cannot communicate (for example,
  /// because it belongs to another MPI library); otherwise each process would do all the work. The message suggests a
  /// remedy.
  Group();
  ~Group();
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
};

/// Returns true if this process is rank 0 according to the environment variables of the launcher. This works before a
/// Group exists: if the processes cannot communicate, only rank 0 reports the error.
bool is_launched_as_rank_zero();

/// Number of this rank; 0 without a Group or a launcher.
int rank();
/// Number of ranks; 1 without a Group or a launcher.
int size();

/// Copies `bytes` of rank 0 to all ranks. Collective.
void broadcast(std::string& bytes);
/// Collects the bytes of all ranks, in the order of their numbers, on every rank. Collective.
std::vector<std::string> all_gather(const std::string& mine);
/// Time in s that this rank has spent in broadcast() and all_gather(), including waiting for other ranks.
double communication_seconds();

/// A counter shared by all ranks and threads, for dynamic load balancing. Construction and destruction are collective;
/// no broadcast() or all_gather() is allowed in between. At most 16 counters at a time.
class Counter {
 public:
  Counter();
  ~Counter();
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;
  /// Atomic fetch-and-add: reserves `count` consecutive numbers and returns the first. The counter starts at 0. May be
  /// called by any thread of any rank.
  std::int64_t next(std::int64_t count = 1);

  /// The implementation of the counter for several ranks.
  class Shared {
   public:
    virtual ~Shared() = default;
    virtual std::int64_t next(std::int64_t count) = 0;
  };

 private:
  std::atomic<std::int64_t> local_ = 0;  ///< the counter if there is only one rank
  std::unique_ptr<Shared> shared_;
};

/// Sends a message to rank 0 and returns without waiting for its receipt. May be called by any thread.
void post(const std::string& message);
/// On rank 0, returns the next message received; std::nullopt if there is none. The messages of a rank arrive in the
/// order in which they were posted. May be called by any thread.
std::optional<std::string> poll();

/// Host name of a rank.
const std::string& host(int rank);
/// Text for messages, for example "rank 3 on node7".
std::string name(int rank);
/// Number of threads for this rank, as the argument of team_size(): the number of cores in its affinity mask, where a
/// core that k ranks may use counts 1/k. 0 (leave the choice to OpenMP) if there is only one rank or OMP_NUM_THREADS is
/// set.
int threads();
/// A warning if a host has fewer cores than threads when every rank uses `threads` threads; otherwise std::nullopt.
std::optional<std::string> oversubscription_warning(int threads);

/// Prints the sentence to stderr and terminates all ranks, because this one cannot continue and the others would wait
/// for it forever.
[[noreturn]] void abort_all_ranks(std::string_view sentence);

}  // namespace pkm::ranks
