// The one file that knows MPI.
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

constexpr std::size_t kMost = std::size_t{1} << 30;  // bytes of one message: MPI counts by int

/// MPI is asked for threads that come one after the other, which is what every library for it can do.
std::mutex in_mpi;

/// Until it is done; other threads may be in MPI meanwhile.
void wait_for(MPI_Request& request) {
  for (int done = 0; done == 0; std::this_thread::yield()) {
    const std::lock_guard lock(in_mpi);
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
  }
}

/// Numbers that all ranks count up: in memory that they share where they are on one host; else rank 0 has them, and is
/// asked. MPI's own one-sided messages (MPI_Fetch_and_op) would do both, but Open MPI 4.1 aborts where hosts have
/// nothing but TCP between them (MPI_Win_allocate, "invalid window", unless it is told `--mca osc pt2pt`).
class Numbers {
 public:
  Numbers(MPI_Comm group, bool one_host) : one_host_(one_host) {
    const std::lock_guard lock(in_mpi);
    MPI_Comm_dup(group, &group_);
    MPI_Comm_rank(group_, &rank_);
    if (!one_host_) return;
    const MPI_Aint bytes = rank_ == 0 ? MPI_Aint{sizeof own_} : 0;
    MPI_Win_allocate_shared(bytes, static_cast<int>(kApart * sizeof *first_), MPI_INFO_NULL, group_, &first_, &window_);
    MPI_Aint size = 0;
    int unit = 0;
    MPI_Win_shared_query(window_, 0, &size, &unit, &first_);
  }
  ~Numbers() {
    if (one_host_) MPI_Win_free(&window_);
    MPI_Comm_free(&group_);
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  /// A number that is 0 on all ranks when they have it: its place. Collective.
  std::size_t take() {
    place_ = (place_ + 1) % kNumbers;
    if (rank_ == 0) std::atomic_ref(first_[place_ * kApart]).store(0);
    // While rank 0's threads work, nobody of them looks for questions, and evaluations may take long: so
    // a thread of MPI's, not one of the team, does. It takes 3 % of a core while nobody asks, 15 % while one rank does
    // nothing else; an answer takes 0.35 ms (two network namespaces).
    if (open_++ == 0 && rank_ == 0 && !one_host_)
      server_ = std::jthread([this](const std::stop_token& stop) {
        constexpr std::chrono::microseconds kLeast(50), kMost(1000);
        for (auto nap = kLeast; !stop.stop_requested(); nap = std::min(2 * nap, kMost)) {
          if (answer()) nap = kLeast;
          std::this_thread::sleep_for(nap);
        }
      });
    meet();
    return place_;
  }
  /// Nobody asks for the number again. Collective.
  void give_back() {
    // Not where an exception ends the run: not all may come here.
    if (!one_host_ && std::uncaught_exceptions() == 0) meet();
    if (--open_ == 0) server_ = {};
  }
  std::int64_t add(std::size_t place, std::int64_t by) {
    if (one_host_ || rank_ == 0) return std::atomic_ref(first_[place * kApart]).fetch_add(by);
    return ask({static_cast<std::int64_t>(place), by, 0});
  }

 private:
  static constexpr std::size_t kNumbers = 16, kApart = 8;  // a cache line each

  struct Question {
    std::int64_t place, by, tag;
  };
  static constexpr int kQuestion = 0;  ///< tag; answers have that of the thread that has asked

  std::int64_t ask(Question question) {
    static std::atomic<int> askers = kQuestion;
    thread_local const int tag = ++askers;
    question.tag = tag;
    std::int64_t number = 0;
    MPI_Request answered = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(in_mpi);
      MPI_Irecv(&number, 1, MPI_INT64_T, 0, tag, group_, &answered);
      MPI_Send(&question, sizeof question, MPI_BYTE, 0, kQuestion, group_);
    }
    wait_for(answered);
    return number;
  }

  /// Whether there was anyone.
  bool answer() {
    const std::lock_guard lock(in_mpi);
    for (bool any = false;; any = true) {
      int there = 0;
      MPI_Status from;
      MPI_Iprobe(MPI_ANY_SOURCE, kQuestion, group_, &there, &from);
      if (there == 0) return any;
      Question question{};
      MPI_Recv(&question, sizeof question, MPI_BYTE, from.MPI_SOURCE, kQuestion, group_, MPI_STATUS_IGNORE);
      const std::int64_t number = add(static_cast<std::size_t>(question.place), question.by);
      MPI_Send(&number, 1, MPI_INT64_T, from.MPI_SOURCE, static_cast<int>(question.tag), group_);
    }
  }

  /// Rank 0 answers meanwhile.
  void meet() {
    MPI_Request all_here = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(in_mpi);
      MPI_Ibarrier(group_, &all_here);
    }
    wait_for(all_here);
  }

  bool one_host_;
  MPI_Comm group_ = MPI_COMM_NULL;
  int rank_ = 0;
  MPI_Win window_ = MPI_WIN_NULL;
  std::array<std::int64_t, kNumbers * kApart> own_{};
  std::int64_t* first_ = own_.data();
  std::size_t place_ = 0;
  int open_ = 0;
  std::jthread server_;
};

class SharedCounter final : public Counter::Shared {
 public:
  explicit SharedCounter(Numbers& numbers) : numbers_(numbers), place_(numbers.take()) {}
  ~SharedCounter() override { numbers_.give_back(); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  std::int64_t next(std::int64_t count) override { return numbers_.add(place_, count); }

 private:
  Numbers& numbers_;
  std::size_t place_;
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
    one_host_ = here == size;
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
    if (!numbers_) numbers_.emplace(group_, one_host_);
    return std::make_unique<SharedCounter>(*numbers_);
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

  bool ours_ = true, one_host_ = true;
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
