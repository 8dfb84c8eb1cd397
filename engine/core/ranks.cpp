#include "engine/core/ranks.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "engine/core/ranks_backend.hpp"

namespace pkm::ranks {
namespace {

/// Host of a rank, and the processor cores that it may use according to its affinity mask.
struct Location {
  std::string host;
  std::set<int> cores;
};

std::unique_ptr<Backend> group;     // communication of the MPI processes; null: a single process
std::vector<Location> locations;    // element k: location of rank k
double seconds_in_collectives = 0;  // time spent in collective functions [s]
std::mutex mailbox_mutex;
std::deque<std::string> mailbox;  // messages that rank 0 has posted to itself

/// The integer with which the value of an environment variable begins; std::nullopt if there is none.
std::optional<int> env_integer(const char* variable) {
  const char* const text = std::getenv(variable);
  if (!text || *text < '0' || *text > '9') return {};
  return std::atoi(text);
}

/// The launcher of the processes, as identified by its environment variables.
struct Launcher {
  std::string name;
  std::optional<int> size, rank;
};

/// Finds the launcher. mpirun is tested before srun, because mpirun may itself have been started by srun. SLURM_NTASKS
/// is not used, because it is also set for a batch script, which is a single process.
std::optional<Launcher> launcher() {
  struct Variables {
    const char *name, *size, *rank;
  };
  constexpr std::array<Variables, 4> known{{{"mpirun", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                            {"mpiexec", "PMI_SIZE", "PMI_RANK"},
                                            {"srun", "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"},
                                            {"the launcher", nullptr, "PMIX_RANK"}}};
  for (const Variables& each : known) {
    const std::optional<int> rank = env_integer(each.rank), size = each.size ? env_integer(each.size) : std::nullopt;
    if (each.size ? size.has_value() : rank.has_value()) return Launcher{each.name, size, rank};
  }
  return {};
}

Location own_location() {
  Location location;
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  location.host = name.data();
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) == 0)
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(static_cast<std::size_t>(core), &cores)) location.cores.insert(core);
  return location;
}

/// Collects the locations of all ranks. Collective.
std::vector<Location> gather_locations() {
  const Location own = own_location();
  std::string message = own.host;
  for (const int core : own.cores) message += ' ' + std::to_string(core);
  std::vector<Location> all;
  for (const std::string& each : all_gather(message)) {
    Location location{each.substr(0, each.find(' ')), {}};
    for (std::size_t at = each.find(' '); at != std::string::npos; at = each.find(' ', at + 1))
      location.cores.insert(std::atoi(each.c_str() + at));
    all.push_back(std::move(location));
  }
  return all;
}

/// Number of threads for a rank, at least 1: the number of its cores, where a core that k ranks may use counts 1/k.
int threads_of(const Location& location) {
  double share = 0;
  for (const int core : location.cores)
    share += 1.0 / static_cast<double>(std::ranges::count_if(locations, [&](const Location& other) {
               return other.host == location.host && other.cores.contains(core);
             }));
  return std::max(1, static_cast<int>(share + 1e-6));
}

/// Adds the time between its construction and its destruction to seconds_in_collectives.
class CommunicationTimer {
 public:
  ~CommunicationTimer() { seconds_in_collectives += std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

/// First part of a message, of a fixed size: the length of the message and its first bytes. A message that fits needs
/// no second transfer.
struct Header {
  std::uint64_t size;
  std::array<char, 120> head;
};

Header header_of(const std::string& bytes) {
  Header header{bytes.size(), {}};
  bytes.copy(header.head.data(), header.head.size());
  return header;
}

}  // namespace

bool is_launched_as_rank_zero() {
  const auto by = launcher();
  return !by || by->rank.value_or(0) == 0;
}

Group::Group() {
  const std::optional<Launcher> by = launcher();
  if (!by || by->size == 1) return;
  const std::string situation = by->size ? by->name + " has started " + std::to_string(*by->size) + " processes"
                                         : by->name + " has started this process";
  if (library().empty()) {
    if (!by->size) return;
    throw std::runtime_error(situation +
                             ", but this program was built without MPI, so each would do all the work; start " +
                             "one process (it is multi-threaded), or build with -DPKM_MPI=ON");
  }
  std::unique_ptr<Backend> joined = join();
  if (by->size && joined->size != *by->size)
    throw std::runtime_error(
        situation + ", but " + library() + " sees " + std::to_string(joined->size) +
        (joined->size == 1 ? ", so each would do all the work" : "") +
        "; use the mpirun of this MPI, or `srun --mpi=pmix` (`srun --mpi=list` lists the available types)");
  if (joined->size == 1) return;
  group = std::move(joined);
  locations = gather_locations();
}

Group::~Group() {
  group.reset();
  locations.clear();
}

int rank() { return group ? group->rank : 0; }
int size() { return group ? group->size : 1; }

void broadcast(std::string& bytes) {
  if (!group) return;
  const CommunicationTimer timer;
  Header header = header_of(bytes);
  group->broadcast(reinterpret_cast<char*>(&header), sizeof header);
  const std::size_t head = std::min<std::size_t>(header.size, header.head.size());
  bytes.resize(header.size);
  std::copy_n(header.head.data(), head, bytes.data());
  if (bytes.size() > head) group->broadcast(bytes.data() + head, bytes.size() - head);
}

std::vector<std::string> all_gather(const std::string& mine) {
  if (!group) return {mine};
  const CommunicationTimer timer;
  const auto ranks = static_cast<std::size_t>(group->size);
  const Header header = header_of(mine);
  std::vector<Header> headers(ranks);
  group->all_gather(reinterpret_cast<const char*>(&header), std::vector(ranks, sizeof header),
                    reinterpret_cast<char*>(headers.data()));
  std::vector<std::size_t> tail_sizes;
  std::size_t sum = 0;
  for (const Header& each : headers) {
    tail_sizes.push_back(each.size - std::min<std::size_t>(each.size, each.head.size()));
    sum += tail_sizes.back();
  }
  std::string tail(sum, '\0');
  if (sum > 0) group->all_gather(mine.data() + std::min(mine.size(), header.head.size()), tail_sizes, tail.data());
  std::vector<std::string> all;
  std::size_t at = 0;
  for (std::size_t i = 0; i < ranks; ++i) {
    all.emplace_back(headers[i].head.data(), headers[i].size - tail_sizes[i]);
    all.back().append(tail, at, tail_sizes[i]);
    at += tail_sizes[i];
  }
  return all;
}

double communication_seconds() { return seconds_in_collectives; }

Counter::Counter() {
  if (group) shared_ = group->counter();
}

Counter::~Counter() = default;

std::int64_t Counter::next(std::int64_t count) { return shared_ ? shared_->next(count) : local_.fetch_add(count); }

void post(const std::string& message) {
  if (rank() > 0) return group->post(message);
  const std::lock_guard lock(mailbox_mutex);
  mailbox.push_back(message);
}

std::optional<std::string> poll() {
  {
    const std::lock_guard lock(mailbox_mutex);
    if (!mailbox.empty()) {
      std::optional<std::string> message = std::move(mailbox.front());
      mailbox.pop_front();
      return message;
    }
  }
  return group ? group->poll() : std::nullopt;
}

const std::string& host(int rank) {
  if (locations.empty()) {
    static const std::string own = own_location().host;
    return own;
  }
  return locations.at(static_cast<std::size_t>(rank)).host;
}

std::string name(int rank) { return "rank " + std::to_string(rank) + " on " + host(rank); }

int threads() {
  if (!group || std::getenv("OMP_NUM_THREADS")) return 0;
  return threads_of(locations[static_cast<std::size_t>(group->rank)]);
}

std::optional<std::string> oversubscription_warning(int threads) {
  // For each host, the number of its ranks and the set of cores that they may use.
  std::map<std::string, std::pair<int, std::set<int>>> hosts;
  for (const Location& location : locations) {
    auto& [ranks, cores] = hosts[location.host];
    ++ranks;
    cores.insert(location.cores.begin(), location.cores.end());
  }
  for (const auto& [host, has] : hosts) {
    const auto& [ranks, cores] = has;
    if (ranks * threads > std::ssize(cores))
      return host + " has " + std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks") + " of " +
             std::to_string(threads) + (threads == 1 ? " thread" : " threads") + " on " + std::to_string(cores.size()) +
             (cores.size() == 1 ? " core" : " cores") + "; fewer threads would be faster";
  }
  return {};
}

void abort_all_ranks(std::string_view sentence) {
  std::fprintf(stderr, "%s: %.*s\n", name(rank()).c_str(), static_cast<int>(sentence.size()), sentence.data());
  std::fflush(stderr);
  if (group) group->abort(EXIT_FAILURE);
  std::_Exit(EXIT_FAILURE);
}

}  // namespace pkm::ranks
