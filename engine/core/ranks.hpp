// The processes of one run: as many as mpirun or srun has started, on one host or on several; else this one alone.
//
// What they exchange is bytes. Where all have to take part ("collective"), each rank calls the same function in the
// same order, from one thread at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pkm::ranks {

/// While it lives, this process is one of those that a launcher has started together; without a launcher it costs
/// nothing. Collective. At most one at a time, made before others of these functions are called.
class Group {
 public:
  /// Throws std::runtime_error, with what to do, where a launcher has started several processes that do not find one
  /// another: each would do all the work.
  Group();
  ~Group();
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
};

/// Whether this process is the first of those that a launcher has started, as the environment says: the one to complain
/// where they do not find one another.
bool launched_first();

/// 0 and 1 without a Group, or without a launcher.
int rank();
int size();

/// Collective: rank 0's bytes become everyone's.
void broadcast(std::string& bytes);
/// Collective: everyone's bytes, by rank.
std::vector<std::string> all_gather(const std::string& mine);
/// Seconds that this rank has spent in the two above, waiting for others included.
double seconds_in_exchange();

/// A number that all ranks and threads count up together. Made and ended collectively, without any of the above in
/// between; at most 16 at a time.
class Counter {
 public:
  Counter();
  ~Counter();
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;
  /// The first of `count` numbers that nobody else gets: from 0 on, without gaps. On any thread of any rank.
  std::int64_t next(std::int64_t count = 1);

  /// A counter in memory that other ranks reach.
  class Shared {
   public:
    virtual ~Shared() = default;
    virtual std::int64_t next(std::int64_t count) = 0;
  };

 private:
  std::atomic<std::int64_t> own_ = 0;  ///< of a rank that is alone
  std::unique_ptr<Shared> shared_;
};

/// Sends a message to rank 0 without waiting for it. On any thread.
void post(const std::string& message);
/// On rank 0: a message that has come, if any; those of one rank in the order in which they were posted. On any thread.
std::optional<std::string> poll();

/// The host of a rank.
const std::string& host(int rank);
/// "rank 3 on node7"
std::string name(int rank);
/// How many threads this rank has to itself, as for team_size(): the cores that it may use, shared with the other ranks
/// that may use them. 0, which leaves it to OpenMP, for a rank that is alone, or where OMP_NUM_THREADS says it.
int threads();
/// Where ranks of so many threads each have more threads than cores: a sentence on it.
std::optional<std::string> crowded(int threads);

/// Ends all ranks at once, because this one cannot go on and the others would wait for it. Tells the sentence.
[[noreturn]] void abandon(std::string_view sentence);

}  // namespace pkm::ranks
