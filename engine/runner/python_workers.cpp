#include "engine/runner/python_workers.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/runner/python_worker_text.hpp"

extern char** environ;

namespace pkm {
namespace {

constexpr int kConnection = 3;  // number of the file descriptor that is the connection in a worker process
constexpr int kPollTime = 50;   // interval between checks for a stop request [ms]
// More than one chunk for each worker, so that all workers finish a batch at about the same time.
constexpr std::size_t kChunksPerWorker = 4;

/// Environment variables of a worker process. The hash seed of Python is fixed, because the order of the elements of a
/// set of strings would otherwise differ from run to run.
std::vector<std::string> worker_environment() {
  std::vector<std::string> all;
  for (char** entry = environ; *entry; ++entry) all.emplace_back(*entry);
  if (!::getenv("PYTHONHASHSEED")) all.emplace_back("PYTHONHASHSEED=0");
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return std::string("signal ") + ::strsignal(WTERMSIG(status));
  return "exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

/// Data for starting a worker process: the interpreter, and the first message, which names the functions to load.
struct PythonWorkers::Setup {
  std::string program;
  std::string message;  ///< first message to the process, in JSON
};

/// A worker process and the connection to it.
class PythonWorkers::Process {
 public:
  /// Starts the process, without waiting until it has loaded the functions.
  explicit Process(const Setup& setup) {
    int sockets[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
      throw std::runtime_error(std::string("cannot connect to Python: ") + std::strerror(errno));
    connection_ = sockets[0];
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    // dup2 of a descriptor onto itself would not clear its close-on-exec flag.
    const int end = sockets[1] == kConnection ? ::fcntl(sockets[1], F_DUPFD_CLOEXEC, kConnection + 1) : sockets[1];
    posix_spawn_file_actions_adddup2(&actions, end, kConnection);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    // A separate process group, so that Ctrl-C interrupts pkmopt only, which then ends its workers.
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<std::string> words = {setup.program, "-c", kPythonWorkerText}, environment = worker_environment();
    const int error = ::posix_spawnp(&pid_, setup.program.c_str(), &actions, &attributes, pointers_to(words).data(),
                                     pointers_to(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (end != sockets[1]) ::close(end);
    ::close(sockets[1]);
    if (error != 0) {
      ::close(connection_);
      throw ConfigError({"", 0, "python"}, "the Python interpreter '" + setup.program + "' cannot be started: " +
                                               std::strerror(error) + "; install it, for example the package python3");
    }
    send(setup.message);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    ::close(connection_);
    constexpr int kPatience = 100;  // time after which a process that has not ended is killed, in units of 10 ms
    for (int i = 0; pid_ > 0 && i < kPatience && !is_busy; ++i) {
      if (is_ended()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (pid_ <= 0 || is_ended()) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, &status_, 0);
  }

  int connection() const { return connection_; }
  /// Sends a message. If the process has ended, this is detected only when its answer is received.
  void send(const std::string& bytes) {
    const std::uint64_t size = bytes.size();
    std::string all(reinterpret_cast<const char*>(&size), sizeof size);
    all += bytes;
    for (std::size_t done = 0; done < all.size();) {
      const ssize_t n = ::send(connection_, all.data() + done, all.size() - done, MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return;
      done += static_cast<std::size_t>(n);
    }
  }
  /// Receives a message.
  /// @return std::nullopt if the process has ended
  std::optional<std::string> receive() {
    std::uint64_t size = 0;
    if (!receive_bytes(reinterpret_cast<char*>(&size), sizeof size)) return {};
    std::string bytes(size, '\0');
    if (!receive_bytes(bytes.data(), bytes.size())) return {};
    return bytes;
  }
  /// Waits until the functions are loaded. Throws Stopped, and ConfigError if a function cannot be loaded.
  void await_start() {
    if (is_started_) return;
    pollfd waiting{connection_, POLLIN, 0};
    while (::poll(&waiting, 1, kPollTime) == 0) check_stop();
    const auto answer = receive();
    if (!answer) throw ConfigError({"", 0, "call"}, "Python ended while it loaded a function (" + end_text() + ")");
    if (!answer->empty()) throw ConfigError({"", 0, "call"}, "a function cannot be loaded: " + *answer);
    is_started_ = true;
  }
  /// Describes in words how the process ended. Precondition: receive() has returned std::nullopt.
  std::string end_text() {
    if (pid_ > 0 && ::waitpid(pid_, &status_, 0) == pid_) pid_ = 0;
    return how_it_ended(status_);
  }

  bool is_busy = false;

 private:
  bool is_ended() {
    if (::waitpid(pid_, &status_, WNOHANG) != pid_) return false;
    pid_ = 0;
    return true;
  }
  bool receive_bytes(char* to, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::recv(connection_, to + done, size - done, 0);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }

  int connection_ = -1, status_ = 0;
  pid_t pid_ = 0;
  bool is_started_ = false;
};

/// The calls of a function for a batch of designs, distributed among processes in chunks.
class PythonWorkers::Batch {
 public:
  Batch(std::size_t function, std::span<const double> parameters, std::span<ExternalValue> values, const Setup& setup)
      : function_(function), parameters_(parameters), values_(values), setup_(setup) {}

  /// Evaluates the batch. Starts a process for each element of `processes` that is null and needed. If it throws
  /// Stopped, the processes that were busy have been ended.
  void evaluate(std::vector<std::unique_ptr<Process>>& processes) {
    const std::size_t count = values_.size();
    const std::size_t size = std::max<std::size_t>(1, count / (kChunksPerWorker * processes.size()));
    for (std::size_t begin = 0; begin < count; begin += size)
      waiting_.push_back({begin, std::min(count, begin + size)});
    std::vector<Rows> work(processes.size());
    for (std::size_t left = count; left > 0;) {
      if (stop_requested()) {
        for (auto& process : processes)
          if (is_busy(process)) process.reset();
        throw Stopped();
      }
      std::vector<pollfd> polled;
      for (std::size_t p = 0; p < processes.size(); ++p) {
        if (!is_busy(processes[p]) && !waiting_.empty()) start(processes[p], work[p]);
        polled.push_back({is_busy(processes[p]) ? processes[p]->connection() : -1, POLLIN, 0});
      }
      if (::poll(polled.data(), polled.size(), kPollTime) <= 0) continue;
      for (std::size_t p = 0; p < processes.size(); ++p)
        if (polled[p].revents != 0) left -= finish(processes[p], work[p]);
    }
  }

 private:
  struct Rows {
    std::size_t begin = 0, end = 0;
    std::size_t count() const { return end - begin; }
  };

  static bool is_busy(const std::unique_ptr<Process>& process) { return process && process->is_busy; }

  void start(std::unique_ptr<Process>& process, Rows& rows) {
    rows = waiting_.front();
    waiting_.pop_front();
    const std::size_t width = parameters_.size() / values_.size();
    std::vector<double> numbers = {static_cast<double>(function_)};
    const auto designs = parameters_.subspan(rows.begin * width, rows.count() * width);
    numbers.insert(numbers.end(), designs.begin(), designs.end());
    if (!process) process = std::make_unique<Process>(setup_);
    process->await_start();
    process->is_busy = true;
    process->send({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)});
  }

  /// Receives the values of the designs of a chunk.
  /// @return number of designs that are completed by this
  std::size_t finish(std::unique_ptr<Process>& process, const Rows& rows) {
    const auto answer = process->receive();
    process->is_busy = false;
    const std::size_t bytes = 2 * sizeof(double) * rows.count();
    if (!answer || answer->size() < bytes) {
      const std::string end = process->end_text();
      process.reset();
      return fail(rows, "Python ended during the call (" + end + ")");
    }
    std::vector<double> numbers(2 * rows.count());
    std::memcpy(numbers.data(), answer->data(), bytes);
    for (std::size_t k = 0; k < rows.count(); ++k)
      values_[rows.begin + k] = {.value = numbers[2 * k], .seconds = numbers[2 * k + 1], .is_computed = true};
    const auto failures = nlohmann::json::parse(answer->begin() + static_cast<std::ptrdiff_t>(bytes), answer->end());
    for (const auto& [row, reason] : failures.items())
      values_[rows.begin + std::stoul(row)].failure = reason.get<std::string>();
    return rows.count();
  }

  /// Handles the end of a process while it evaluated a chunk. If the chunk has a single design, the call has failed.
  /// Otherwise each design of the chunk is called again separately, to find the one that ends the process.
  /// @return number of designs that are completed by this
  std::size_t fail(const Rows& rows, const std::string& reason) {
    if (rows.count() == 1) {
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      values_[rows.begin] = {.value = nan, .failure = reason, .is_computed = true};
      return 1;
    }
    for (std::size_t row = rows.begin; row < rows.end; ++row) waiting_.push_back({row, row + 1});
    return 0;
  }

  std::size_t function_;
  std::span<const double> parameters_;
  std::span<ExternalValue> values_;
  const Setup& setup_;
  std::deque<Rows> waiting_;
};

PythonWorkers::PythonWorkers(std::vector<PythonFunction> functions, std::vector<std::string> parameters,
                             const PythonOptions& options, int workers)
    : functions_(std::move(functions)) {
  nlohmann::json message = {{"parameters", parameters}, {"path", options.path}, {"functions", nlohmann::json::array()}};
  for (const PythonFunction& each : functions_) message["functions"].push_back({each.file, each.function});
  setup_ = std::make_unique<const Setup>(Setup{options.program, message.dump()});
  for (int i = 0; i < workers; ++i) idle_.push_back(std::make_unique<Process>(*setup_));
  for (auto& process : idle_) process->await_start();
}

PythonWorkers::~PythonWorkers() = default;

std::vector<std::unique_ptr<PythonWorkers::Process>> PythonWorkers::take_idle(std::size_t count) {
  std::unique_lock lock(mutex_);
  while (!returned_.wait_for(lock, std::chrono::milliseconds(kPollTime), [this] { return !idle_.empty(); }))
    check_stop();
  std::vector<std::unique_ptr<Process>> taken;
  while (taken.size() < count && !idle_.empty()) {
    taken.push_back(std::move(idle_.back()));
    idle_.pop_back();
  }
  return taken;
}

void PythonWorkers::give_back(std::vector<std::unique_ptr<Process>> processes) {
  {
    const std::lock_guard guard(mutex_);
    for (auto& process : processes) idle_.push_back(std::move(process));
  }
  returned_.notify_all();
}

void PythonWorkers::evaluate(const std::string& call, std::span<const double> parameters,
                             std::span<ExternalValue> values) {
  const auto function = std::ranges::find(functions_, call, &PythonFunction::call);
  std::vector<std::unique_ptr<Process>> processes = take_idle(values.size());
  try {
    Batch(static_cast<std::size_t>(function - functions_.begin()), parameters, values, *setup_).evaluate(processes);
  } catch (...) {
    give_back(std::move(processes));
    throw;
  }
  give_back(std::move(processes));
}

std::string PythonWorkers::source_hash(const std::string& call) const {
  return std::ranges::find(functions_, call, &PythonFunction::call)->hash;
}

}  // namespace pkm
