#include "engine/storage/subprocess_check.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <new>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/storage/descriptor.hpp"
#include "engine/storage/file_header.hpp"
#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/study_file.hpp"

extern char** environ;

namespace pkm {
namespace {

constexpr int kInvalidExit = 1, kOutOfMemoryExit = 4;  // exit codes of the checking process
constexpr unsigned kMaxSeconds = 20;                   // time limit [s]; a valid file of 100 MB takes 1 s
// Memory limit of the checking process: a base, and an amount per byte of the file.
constexpr rlim_t kBaseMemory = rlim_t{2} << 30, kMemoryPerByte = 32;
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 11;

std::vector<std::string>& check_command() {
  static std::vector<std::string> command;
  return command;
}

[[noreturn]] void cannot_check(const std::string& path, const std::string& what, int error) {
  throw StorageError(path + ": " + what + " (" + std::strerror(error) + ")");
}

/// Sends all bytes and closes the sending direction; stops early if the receiving process has ended.
void send_all(int socket, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::send(socket, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  ::shutdown(socket, SHUT_WR);
}

/// Starts the checking process. It has the given descriptors as standard input and output, and default signal handling.
pid_t spawn(int input, int output, const std::string& path) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> arguments;
  for (std::string& argument : check_command()) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) cannot_check(path, "cannot be checked, because the checking process does not start", error);
  return child;
}

/// Reads a descriptor to its end.
/// @return the first `max_bytes` bytes
std::string read_all(int from, std::size_t max_bytes = std::string::npos) {
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  for (;;) {
    const ssize_t n = ::read(from, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(block.data(), std::min(static_cast<std::size_t>(n), max_bytes - std::min(max_bytes, text.size())));
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return status;
}

/// @return true for signals caused by a fault of the program itself, false for signals from outside such as Ctrl-C
bool is_crash(int signal) {
  constexpr int kCrashes[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS};
  return std::ranges::find(kCrashes, signal) != std::end(kCrashes);
}

/// Sets the soft limit of a resource of this process.
void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  rlimit limits{};
  if (::getrlimit(resource, &limits) != 0) return;
  limits.rlim_cur = std::min(value, limits.rlim_max);
  ::setrlimit(resource, &limits);
}

/// True in sanitizer builds, which need no memory limit: they reserve shadow memory beyond any useful limit.
constexpr bool kSanitized =
#ifdef PKM_SANITIZED
    true;
#else
    false;
#endif

}  // namespace

void set_check_command(std::vector<std::string> command) { check_command() = std::move(command); }

void check_in_subprocess(const std::string& bytes, const std::string& path) {
  if (check_command().empty()) return;
  // Ends of a socket pair and of a pipe: [0] belongs to this process, [1] to the subprocess. Files are not used,
  // because RLIMIT_FSIZE could truncate them.
  int input[2], output[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0) cannot_check(path, "cannot be checked", errno);
  const Descriptor sending(input[0]);
  Descriptor receiving(input[1]);
  if (::pipe2(output, O_CLOEXEC) != 0) cannot_check(path, "cannot be checked", errno);
  const Descriptor reading(output[0]);
  Descriptor writing(output[1]);
  const pid_t child = spawn(receiving.get(), writing.get(), path);
  receiving.close();
  writing.close();
  send_all(sending.get(), bytes);
  const std::string message = read_all(reading.get(), kMaxMessageBytes);
  const int status = wait_for(child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kInvalidExit && !message.empty()) throw ImageError(message);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemoryExit)
    throw StorageError(path + ": is damaged or forged: reading it needs more memory than any study of this size");
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw StorageError(path + ": is damaged or forged: reading it takes longer than " + std::to_string(kMaxSeconds) +
                       " s");
  if (WIFSIGNALED(status) && !is_crash(WTERMSIG(status)))
    throw StorageError(path + ": the checking process was ended by a signal (" + ::strsignal(WTERMSIG(status)) + ")");
  throw StorageError(path + ": is damaged or forged: the HDF5 library crashes on it");
}

int check_study_on_standard_input() {
  ::alarm(kMaxSeconds);
  limit(RLIMIT_CORE, 0);
  try {
    const std::string bytes = read_all(STDIN_FILENO);
    if (!kSanitized) limit(RLIMIT_AS, kBaseMemory + kMemoryPerByte * static_cast<rlim_t>(bytes.size()));
    parse_study(bytes, verify_header(bytes, "standard input", kStudySchema));
    return 0;
  } catch (const std::bad_alloc&) {
    return kOutOfMemoryExit;
  } catch (const std::exception& error) {
    std::fputs(message_of(error).c_str(), stdout);
    return kInvalidExit;
  }
}

}  // namespace pkm
