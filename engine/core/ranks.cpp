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

/// A rank's host, and the cores that it may use.
struct Place {
  std::string host;
  std::set<int> cores;
};

std::unique_ptr<Backend> group;  // null: this process is alone
std::vector<Place> places;       // of each rank
double exchanging = 0;           // s
std::mutex in_mailbox;
std::deque<std::string> mailbox;  // what rank 0 has posted to itself

std::optional<int> number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  if (!text || *text < '0' || *text > '9') return {};
  return std::atoi(text);
}

/// What a launcher has left in the environment.
struct Launcher {
  std::string name;
  std::optional<int> size, rank;
};

/// The first one counts: mpirun may itself be started by srun. What a batch script is given (SLURM_NTASKS) says
/// nothing: it is one process.
std::optional<Launcher> launcher() {
  struct Words {
    const char *name, *size, *rank;
  };
  constexpr std::array<Words, 4> known{{{"mpirun", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                        {"mpiexec", "PMI_SIZE", "PMI_RANK"},
                                        {"srun", "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"},
                                        {"the launcher", nullptr, "PMIX_RANK"}}};
  for (const Words& each : known) {
    const std::optional<int> rank = number_in(each.rank), size = each.size ? number_in(each.size) : std::nullopt;
    if (each.size ? size.has_value() : rank.has_value()) return Launcher{each.name, size, rank};
  }
  return {};
}

Place own_place() {
  Place place;
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  place.host = name.data();
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) == 0)
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(static_cast<std::size_t>(core), &cores)) place.cores.insert(core);
  return place;
}

std::vector<Place> exchange_places() {
  const Place own = own_place();
  std::string message = own.host;
  for (const int core : own.cores) message += ' ' + std::to_string(core);
  std::vector<Place> all;
  for (const std::string& each : all_gather(message)) {
    Place place{each.substr(0, each.find(' ')), {}};
    for (std::size_t at = each.find(' '); at != std::string::npos; at = each.find(' ', at + 1))
      place.cores.insert(std::atoi(each.c_str() + at));
    all.push_back(std::move(place));
  }
  return all;
}

/// Cores of a rank, each divided by the ranks that may use it.
int threads_of(const Place& place) {
  double share = 0;
  for (const int core : place.cores)
    share += 1.0 / static_cast<double>(std::ranges::count_if(places, [&](const Place& other) {
               return other.host == place.host && other.cores.contains(core);
             }));
  return std::max(1, static_cast<int>(share + 1e-6));
}

/// Counts the time spent here.
class Exchange {
 public:
  ~Exchange() { exchanging += std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

/// The beginning of a message, of a fixed size: short ones need no other.
struct Envelope {
  std::uint64_t size;
  std::array<char, 120> beginning;
};

Envelope envelope_of(const std::string& bytes) {
  Envelope envelope{bytes.size(), {}};
  bytes.copy(envelope.beginning.data(), envelope.beginning.size());
  return envelope;
}

}  // namespace

bool launched_first() {
  const auto by = launcher();
  return !by || by->rank.value_or(0) == 0;
}

Group::Group() {
  const std::optional<Launcher> by = launcher();
  if (!by || by->size == 1) return;
  const std::string promise =
      by->size ? by->name + " has started " + std::to_string(*by->size) + " processes" : by->name + " has started this";
  if (library().empty()) {
    if (!by->size) return;
    throw std::runtime_error(promise +
                             ", but this program was built without MPI, so each would do all the work: start " +
                             "one process (it has threads), or build with -DPKM_MPI=ON");
  }
  std::unique_ptr<Backend> joined = join();
  if (by->size && joined->size != *by->size)
    throw std::runtime_error(
        promise + ", but " + library() + " sees " + std::to_string(joined->size) +
        (joined->size == 1 ? ", so each would do all the work" : "") +
        ": use the mpirun of this MPI, or `srun --mpi=pmix` (`srun --mpi=list` shows what is there)");
  if (joined->size == 1) return;
  group = std::move(joined);
  places = exchange_places();
}

Group::~Group() {
  group.reset();
  places.clear();
}

int rank() { return group ? group->rank : 0; }
int size() { return group ? group->size : 1; }

void broadcast(std::string& bytes) {
  if (!group) return;
  const Exchange timed;
  Envelope envelope = envelope_of(bytes);
  group->broadcast(reinterpret_cast<char*>(&envelope), sizeof envelope);
  const std::size_t beginning = std::min<std::size_t>(envelope.size, envelope.beginning.size());
  bytes.resize(envelope.size);
  std::copy_n(envelope.beginning.data(), beginning, bytes.data());
  if (bytes.size() > beginning) group->broadcast(bytes.data() + beginning, bytes.size() - beginning);
}

std::vector<std::string> all_gather(const std::string& mine) {
  if (!group) return {mine};
  const Exchange timed;
  const auto ranks = static_cast<std::size_t>(group->size);
  const Envelope envelope = envelope_of(mine);
  std::vector<Envelope> envelopes(ranks);
  group->all_gather(reinterpret_cast<const char*>(&envelope), std::vector(ranks, sizeof envelope),
                    reinterpret_cast<char*>(envelopes.data()));
  std::vector<std::size_t> rests;
  std::size_t sum = 0;
  for (const Envelope& each : envelopes) {
    rests.push_back(each.size - std::min<std::size_t>(each.size, each.beginning.size()));
    sum += rests.back();
  }
  std::string rest(sum, '\0');
  if (sum > 0) group->all_gather(mine.data() + std::min(mine.size(), envelope.beginning.size()), rests, rest.data());
  std::vector<std::string> all;
  std::size_t at = 0;
  for (std::size_t i = 0; i < ranks; ++i) {
    all.emplace_back(envelopes[i].beginning.data(), envelopes[i].size - rests[i]);
    all.back().append(rest, at, rests[i]);
    at += rests[i];
  }
  return all;
}

double seconds_in_exchange() { return exchanging; }

Counter::Counter() {
  if (group) shared_ = group->counter();
}

Counter::~Counter() = default;

std::int64_t Counter::next(std::int64_t count) { return shared_ ? shared_->next(count) : own_.fetch_add(count); }

void post(const std::string& message) {
  if (rank() > 0) return group->post(message);
  const std::lock_guard lock(in_mailbox);
  mailbox.push_back(message);
}

std::optional<std::string> poll() {
  {
    const std::lock_guard lock(in_mailbox);
    if (!mailbox.empty()) {
      std::optional<std::string> message = std::move(mailbox.front());
      mailbox.pop_front();
      return message;
    }
  }
  return group ? group->poll() : std::nullopt;
}

const std::string& host(int rank) {
  if (places.empty()) {
    static const std::string own = own_place().host;
    return own;
  }
  return places.at(static_cast<std::size_t>(rank)).host;
}

std::string name(int rank) { return "rank " + std::to_string(rank) + " on " + host(rank); }

int threads() {
  if (!group || std::getenv("OMP_NUM_THREADS")) return 0;
  return threads_of(places[static_cast<std::size_t>(group->rank)]);
}

std::optional<std::string> crowded(int threads) {
  std::map<std::string, std::pair<int, std::set<int>>> hosts;  // ranks and cores
  for (const Place& place : places) {
    auto& [ranks, cores] = hosts[place.host];
    ++ranks;
    cores.insert(place.cores.begin(), place.cores.end());
  }
  for (const auto& [host, has] : hosts) {
    const auto& [ranks, cores] = has;
    if (ranks * threads > std::ssize(cores))
      return host + " has " + std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks") + " of " +
             std::to_string(threads) + (threads == 1 ? " thread" : " threads") + " on " + std::to_string(cores.size()) +
             (cores.size() == 1 ? " core" : " cores") + ", which are slower than fewer";
  }
  return {};
}

void abandon(std::string_view sentence) {
  std::fprintf(stderr, "%s: %.*s\n", name(rank()).c_str(), static_cast<int>(sentence.size()), sentence.data());
  std::fflush(stderr);
  if (group) group->abort(EXIT_FAILURE);
  std::_Exit(EXIT_FAILURE);
}

}  // namespace pkm::ranks
