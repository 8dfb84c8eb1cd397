// The one file that knows MPI.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <list>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "engine/core/ranks_backend.hpp"

namespace pkm::ranks {
namespace {

constexpr std::size_t kMost = std::size_t{1} << 30;  // bytes of one message: MPI counts by int

/// MPI is asked for threads that come one after the other, which is what every library for it can do.
std::mutex in_mpi;

/// Numbers in rank 0's memory: made once, because that takes MPI long, and used in turn.
class Numbers {
 public:
  explicit Numbers(MPI_Comm group, int rank) : group_(group) {
    const std::lock_guard lock(in_mpi);
    std::int64_t* first = nullptr;
    MPI_Win_allocate(rank == 0 ? MPI_Aint{kNumbers * sizeof *first} : 0, sizeof *first, MPI_INFO_NULL, group, &first,
                     &window_);
    MPI_Win_lock_all(0, window_);
  }
  ~Numbers() {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  /// A number that is 0 on all ranks when they have it: its place. Collective.
  MPI_Aint take(int rank) {
    place_ = (place_ + 1) % kNumbers;
    if (rank == 0) change(place_, 0, MPI_REPLACE);
    const std::lock_guard lock(in_mpi);
    MPI_Barrier(group_);
    return place_;
  }
  std::int64_t change(MPI_Aint place, std::int64_t by, MPI_Op how) {
    const std::lock_guard lock(in_mpi);
    std::int64_t before = 0;
    MPI_Fetch_and_op(&by, &before, MPI_INT64_T, 0, place, how, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

 private:
  static constexpr MPI_Aint kNumbers = 16;
  MPI_Comm group_;
  MPI_Win window_ = MPI_WIN_NULL;
  MPI_Aint place_ = 0;
};

class SharedCounter final : public Counter::Shared {
 public:
  /// @param tended  others reach this rank's memory only while it is in MPI, so a thread of it looks in
  SharedCounter(Numbers& numbers, MPI_Comm group, int rank, bool tended)
      : numbers_(numbers), place_(numbers.take(rank)) {
    if (tended)
      tender_ = std::jthread([group](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          std::this_thread::sleep_for(std::chrono::microseconds(200));
          const std::lock_guard looking(in_mpi);
          int there = 0;
          MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, group, &there, MPI_STATUS_IGNORE);
        }
      });
  }
  std::int64_t next(std::int64_t count) override { return numbers_.change(place_, count, MPI_SUM); }

 private:
  Numbers& numbers_;
  MPI_Aint place_;
  std::jthread tender_;
};

class Mpi final : public Backend {
 public:
  Mpi() {
    int begun = 0, given = 0;
    MPI_Initialized(&begun);
    ours_ = begun == 0;
    if (ours_) MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given);
    MPI_Query_thread(&given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size > 1 && given < MPI_THREAD_SERIALIZED) {
      if (ours_) MPI_Finalize();
      throw std::runtime_error(library() + " was built without threads (MPI_THREAD_SERIALIZED): use another MPI");
    }
    MPI_Comm_dup(MPI_COMM_WORLD, &group_);
    MPI_Comm_dup(MPI_COMM_WORLD, &mail_);
    MPI_Comm host = MPI_COMM_NULL;
    MPI_Comm_split_type(group_, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &host);
    int here = 1;
    MPI_Comm_size(host, &here);
    MPI_Comm_free(&host);
    several_hosts_ = here < size;
  }

  /// Messages that are under way arrive before the ranks part.
  ~Mpi() override {
    const auto waiting = [this] {
      const std::lock_guard lock(in_mpi);
      forget_sent();
      return !sent_.empty();
    };
    while (waiting()) std::this_thread::yield();
    MPI_Request all_sent = MPI_REQUEST_NULL;
    MPI_Ibarrier(mail_, &all_sent);
    for (int there = 0; there == 0;) {
      if (rank == 0) poll();
      MPI_Test(&all_sent, &there, MPI_STATUS_IGNORE);
    }
    numbers_.reset();
    MPI_Comm_free(&mail_);
    MPI_Comm_free(&group_);
    if (ours_) MPI_Finalize();
  }

  void broadcast(char* bytes, std::size_t count) override {
    const std::lock_guard lock(in_mpi);
    share(bytes, count, 0);
  }

  void all_gather(const char* mine, const std::vector<std::size_t>& sizes, char* all) override {
    const std::lock_guard lock(in_mpi);
    std::vector<int> counts, begins;
    std::size_t begin = 0;
    for (const std::size_t each : sizes) {
      counts.push_back(static_cast<int>(each));
      begins.push_back(static_cast<int>(begin));
      begin += each;
    }
    if (begin < kMost) {
      const int count = counts[static_cast<std::size_t>(rank)];
      if (std::ranges::count(counts, count) == size)
        MPI_Allgather(mine, count, MPI_BYTE, all, count, MPI_BYTE, group_);
      else
        MPI_Allgatherv(mine, count, MPI_BYTE, all, counts.data(), begins.data(), MPI_BYTE, group_);
      return;
    }
    for (int from = 0; from < size; ++from) {
      const std::size_t each = sizes[static_cast<std::size_t>(from)];
      if (from == rank) std::copy_n(mine, each, all);
      share(all, each, from);
      all += each;
    }
  }

  std::unique_ptr<Counter::Shared> counter() override {
    if (!numbers_) numbers_.emplace(group_, rank);
    return std::make_unique<SharedCounter>(*numbers_, group_, rank, several_hosts_ && rank == 0);
  }

  void post(const std::string& message) override {
    const std::lock_guard lock(in_mpi);
    forget_sent();
    Sent& sent = sent_.emplace_back();
    sent.message = message;
    MPI_Isend(sent.message.data(), static_cast<int>(sent.message.size()), MPI_BYTE, 0, 0, mail_, &sent.request);
  }

  std::optional<std::string> poll() override {
    const std::lock_guard lock(in_mpi);
    int there = 0, bytes = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, 0, mail_, &there, &message, &status);
    if (there == 0) return {};
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    std::string text(static_cast<std::size_t>(bytes), '\0');
    MPI_Mrecv(text.data(), bytes, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    return text;
  }

  [[noreturn]] void abort(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);  // not under the lock: another thread may wait in MPI for what never comes
    std::_Exit(exit_code);
  }

 private:
  struct Sent {
    std::string message;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  /// Broadcasts, in pieces.
  void share(char* bytes, std::size_t count, int from) {
    for (std::size_t piece = 0; count > 0; bytes += piece, count -= piece) {
      piece = std::min(count, kMost);
      MPI_Bcast(bytes, static_cast<int>(piece), MPI_BYTE, from, group_);
    }
  }

  void forget_sent() {
    std::erase_if(sent_, [](Sent& each) {
      int done = 0;
      MPI_Test(&each.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }

  bool ours_ = true, several_hosts_ = false;
  MPI_Comm group_ = MPI_COMM_NULL, mail_ = MPI_COMM_NULL;
  std::optional<Numbers> numbers_;
  std::list<Sent> sent_;  ///< whose bytes MPI may still read
};

}  // namespace

std::string library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string version(text, static_cast<std::size_t>(length));
  // "Open MPI v4.1.4, package: ..", "MPICH Version:\t4.0.2\nMPICH Release date: .."
  return version.substr(0, version.find_first_of(",\n"));
}

std::unique_ptr<Backend> join() { return std::make_unique<Mpi>(); }

}  // namespace pkm::ranks
