// MPI implementation of the message-passing backend. No other file uses MPI.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <climits>
#include <exception>
#include <list>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "engine/core/ranks_backend.hpp"

namespace pkm::ranks {
namespace {

// Maximum size of an MPI message in bytes: MPI counts with int.
constexpr std::size_t kMaxMessage = std::size_t{1} << 30;

/// Serialises all MPI calls. Several threads call MPI, so the constructor requests MPI_THREAD_SERIALIZED, and throws if
/// the implementation provides less and there are several ranks.
std::mutex mpi_mutex;

/// Waits until the request is complete. Other threads may call MPI meanwhile.
void wait_for(MPI_Request& request) {
  for (int done = 0; done == 0; std::this_thread::yield()) {
    const std::lock_guard lock(mpi_mutex);
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
  }
}

/// Counters with an atomic fetch-and-add for all ranks. If all ranks run on one host, the counters are in shared
/// memory; otherwise rank 0 stores them and serves the requests of the others. MPI's one-sided MPI_Fetch_and_op would
/// cover both cases, but Open MPI 4.1 aborts if the hosts are connected by TCP only (MPI_Win_allocate, "invalid
/// window", unless run with `--mca osc pt2pt`).
class SharedCounters {
 public:
  SharedCounters(MPI_Comm group, bool one_host) : one_host_(one_host) {
    const std::lock_guard lock(mpi_mutex);
    MPI_Comm_dup(group, &group_);
    MPI_Comm_rank(group_, &rank_);
    if (!one_host_) return;
    const MPI_Aint bytes = rank_ == 0 ? MPI_Aint{sizeof local_} : 0;
    MPI_Win_allocate_shared(bytes, static_cast<int>(kStride * sizeof *data_), MPI_INFO_NULL, group_, &data_, &window_);
    MPI_Aint size = 0;
    int unit = 0;
    MPI_Win_shared_query(window_, 0, &size, &unit, &data_);
  }
  ~SharedCounters() {
    if (one_host_) MPI_Win_free(&window_);
    MPI_Comm_free(&group_);
  }
  SharedCounters(const SharedCounters&) = delete;
  SharedCounters& operator=(const SharedCounters&) = delete;

  /// Allocates a counter with the value 0, and returns its index. Collective.
  std::size_t allocate() {
    index_ = (index_ + 1) % kMaxCounters;
    if (rank_ == 0) std::atomic_ref(data_[index_ * kStride]).store(0);
    // The worker threads of rank 0 are busy with evaluations, which may take long. Therefore a separate thread serves
    // the requests. It uses 3 % of a core without requests, and 15 % if one rank sends requests continuously; the
    // response time is 0.35 ms (measured with two network namespaces).
    if (open_++ == 0 && rank_ == 0 && !one_host_)
      server_ = std::jthread([this](const std::stop_token& stop) {
        constexpr std::chrono::microseconds kMinNap(50), kMaxNap(1000);
        for (auto nap = kMinNap; !stop.stop_requested(); nap = std::min(2 * nap, kMaxNap)) {
          if (serve_requests()) nap = kMinNap;
          std::this_thread::sleep_for(nap);
        }
      });
    barrier();
    return index_;
  }
  /// Releases one counter, which no rank uses any more. Collective.
  void release() {
    // There is no barrier if an exception ends the run, because other ranks may not reach this point.
    if (!one_host_ && std::uncaught_exceptions() == 0) barrier();
    if (--open_ == 0) server_ = {};
  }
  /// Adds `by` to a counter and returns its previous value, as one atomic operation.
  std::int64_t add(std::size_t index, std::int64_t by) {
    if (one_host_ || rank_ == 0) return std::atomic_ref(data_[index * kStride]).fetch_add(by);
    return request_from_rank_0({static_cast<std::int64_t>(index), by, 0});
  }

 private:
  // Distance of two counters in elements: each has a cache line of its own.
  static constexpr std::size_t kMaxCounters = 16, kStride = 8;

  struct Request {
    std::int64_t index, by, tag;
  };
  static constexpr int kRequestTag = 0;  ///< MPI tag of requests; a response has the tag of the requesting thread

  /// Sends a request to rank 0 and waits for the response.
  std::int64_t request_from_rank_0(Request request) {
    static std::atomic<int> last_tag = kRequestTag;
    thread_local const int tag = ++last_tag;
    request.tag = tag;
    std::int64_t number = 0;
    MPI_Request response = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(mpi_mutex);
      MPI_Irecv(&number, 1, MPI_INT64_T, 0, tag, group_, &response);
      MPI_Send(&request, sizeof request, MPI_BYTE, 0, kRequestTag, group_);
    }
    wait_for(response);
    return number;
  }

  /// On rank 0: serves all pending requests.
  /// @return false if there were none
  bool serve_requests() {
    const std::lock_guard lock(mpi_mutex);
    for (bool any = false;; any = true) {
      int found = 0;
      MPI_Status from;
      MPI_Iprobe(MPI_ANY_SOURCE, kRequestTag, group_, &found, &from);
      if (found == 0) return any;
      Request request{};
      MPI_Recv(&request, sizeof request, MPI_BYTE, from.MPI_SOURCE, kRequestTag, group_, MPI_STATUS_IGNORE);
      const std::int64_t number = add(static_cast<std::size_t>(request.index), request.by);
      MPI_Send(&number, 1, MPI_INT64_T, from.MPI_SOURCE, static_cast<int>(request.tag), group_);
    }
  }

  /// Waits until all ranks have called this function. The barrier is non-blocking, so that the serving thread of rank 0
  /// can call MPI meanwhile.
  void barrier() {
    MPI_Request all_arrived = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(mpi_mutex);
      MPI_Ibarrier(group_, &all_arrived);
    }
    wait_for(all_arrived);
  }

  bool one_host_;
  MPI_Comm group_ = MPI_COMM_NULL;
  int rank_ = 0;
  MPI_Win window_ = MPI_WIN_NULL;
  std::array<std::int64_t, kMaxCounters * kStride> local_{};
  std::int64_t* data_ = local_.data();
  std::size_t index_ = 0;
  int open_ = 0;
  std::jthread server_;
};

class SharedCounter final : public Counter::Shared {
 public:
  explicit SharedCounter(SharedCounters& counters) : counters_(counters), index_(counters.allocate()) {}
  ~SharedCounter() override { counters_.release(); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  std::int64_t next(std::int64_t count) override { return counters_.add(index_, count); }

 private:
  SharedCounters& counters_;
  std::size_t index_;
};

class Mpi final : public Backend {
 public:
  Mpi() {
    int initialized = 0, thread_level = 0;
    MPI_Initialized(&initialized);
    initialized_here_ = initialized == 0;
    if (initialized_here_) MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &thread_level);
    MPI_Query_thread(&thread_level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size > 1 && thread_level < MPI_THREAD_SERIALIZED) {
      if (initialized_here_) MPI_Finalize();
      throw std::runtime_error(library() + " has no thread support (MPI_THREAD_SERIALIZED); use another MPI");
    }
    MPI_Comm_dup(MPI_COMM_WORLD, &group_);
    MPI_Comm_dup(MPI_COMM_WORLD, &mail_);
    MPI_Comm host = MPI_COMM_NULL;
    MPI_Comm_split_type(group_, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &host);
    int here = 1;
    MPI_Comm_size(host, &here);
    MPI_Comm_free(&host);
    one_host_ = here == size;
  }

  /// Delivers all pending messages before the ranks disconnect.
  ~Mpi() override {
    const auto waiting = [this] {
      const std::lock_guard lock(mpi_mutex);
      release_completed();
      return !pending_.empty();
    };
    while (waiting()) std::this_thread::yield();
    MPI_Request all_sent = MPI_REQUEST_NULL;
    MPI_Ibarrier(mail_, &all_sent);
    for (int found = 0; found == 0;) {
      if (rank == 0) poll();
      MPI_Test(&all_sent, &found, MPI_STATUS_IGNORE);
    }
    counters_.reset();
    MPI_Comm_free(&mail_);
    MPI_Comm_free(&group_);
    if (initialized_here_) MPI_Finalize();
  }

  void broadcast(char* bytes, std::size_t count) override {
    const std::lock_guard lock(mpi_mutex);
    broadcast_chunks(bytes, count, 0);
  }

  void all_gather(const char* mine, const std::vector<std::size_t>& sizes, char* all) override {
    const std::lock_guard lock(mpi_mutex);
    std::vector<int> counts, begins;
    std::size_t begin = 0;
    for (const std::size_t each : sizes) {
      counts.push_back(static_cast<int>(each));
      begins.push_back(static_cast<int>(begin));
      begin += each;
    }
    if (begin < kMaxMessage) {
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
      broadcast_chunks(all, each, from);
      all += each;
    }
  }

  std::unique_ptr<Counter::Shared> counter() override {
    if (!counters_) counters_.emplace(group_, one_host_);
    return std::make_unique<SharedCounter>(*counters_);
  }

  void post(const std::string& message) override {
    const std::lock_guard lock(mpi_mutex);
    release_completed();
    PendingSend& send = pending_.emplace_back();
    send.message = message;
    MPI_Isend(send.message.data(), static_cast<int>(send.message.size()), MPI_BYTE, 0, 0, mail_, &send.request);
  }

  std::optional<std::string> poll() override {
    const std::lock_guard lock(mpi_mutex);
    int found = 0, bytes = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, 0, mail_, &found, &message, &status);
    if (found == 0) return {};
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    std::string text(static_cast<std::size_t>(bytes), '\0');
    MPI_Mrecv(text.data(), bytes, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    return text;
  }

  [[noreturn]] void abort(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);  // called without the lock, because another thread may block in MPI for ever
    std::_Exit(exit_code);
  }

 private:
  struct PendingSend {
    std::string message;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  /// Broadcasts `count` bytes of the rank `from`, in messages of at most kMaxMessage bytes.
  void broadcast_chunks(char* bytes, std::size_t count, int from) {
    for (std::size_t chunk = 0; count > 0; bytes += chunk, count -= chunk) {
      chunk = std::min(count, kMaxMessage);
      MPI_Bcast(bytes, static_cast<int>(chunk), MPI_BYTE, from, group_);
    }
  }

  /// Removes those pending messages whose transfer is complete.
  void release_completed() {
    std::erase_if(pending_, [](PendingSend& each) {
      int done = 0;
      MPI_Test(&each.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }

  bool initialized_here_ = true, one_host_ = true;
  MPI_Comm group_ = MPI_COMM_NULL, mail_ = MPI_COMM_NULL;
  std::optional<SharedCounters> counters_;
  std::list<PendingSend> pending_;  ///< messages that are still being sent, so that MPI may read their buffers
};

}  // namespace

std::string library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string version(text, static_cast<std::size_t>(length));
  // The text of the MPI library's version is, for example, "Open MPI v4.1.4, package: .." or "MPICH
  // Version:\t4.0.2\nMPICH Release date: ..".
  return version.substr(0, version.find_first_of(",\n"));
}

std::unique_ptr<Backend> join() { return std::make_unique<Mpi>(); }

}  // namespace pkm::ranks
