#include "engine/storage/contained_reading.hpp"

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
#include "engine/storage/file_seal.hpp"
#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/study_file.hpp"

extern char** environ;

namespace pkm {
namespace {

constexpr int kRefused = 1, kOutOfMemory = 4;
constexpr unsigned kSeconds = 20;            // intact files of 100 MB take 1 s
constexpr rlim_t kMemory = rlim_t{2} << 30;  // bytes, and 32 for each byte of the file
constexpr std::size_t kMostOfMessage = std::size_t{1} << 11;

std::vector<std::string>& command() {
  static std::vector<std::string> parts;
  return parts;
}

[[noreturn]] void cannot_check(const std::string& path, const std::string& what, int error) {
  throw StorageError(path + ": " + what + " (" + std::strerror(error) + ")");
}

/// Sends all, unless the other side has ended.
void send_all(int socket, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::send(socket, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  ::shutdown(socket, SHUT_WR);
}

/// Starts the command with these as standard input and output, all signals at their defaults.
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
  for (std::string& part : command()) arguments.push_back(part.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) cannot_check(path, "cannot be checked, the process for it does not start", error);
  return child;
}

/// All that comes, of which the first `most` bytes are kept.
std::string read_all(int from, std::size_t most = std::string::npos) {
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  for (;;) {
    const ssize_t n = ::read(from, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(block.data(), std::min(static_cast<std::size_t>(n), most - std::min(most, text.size())));
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return status;
}

/// Not one that came from outside, such as Ctrl-C.
bool is_crash(int signal) {
  constexpr int kCrashes[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS};
  return std::ranges::find(kCrashes, signal) != std::end(kCrashes);
}

void limit(decltype(RLIMIT_AS) resource, rlim_t most) {
  rlimit now{};
  if (::getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min(most, now.rlim_max);
  ::setrlimit(resource, &now);
}

/// A sanitizer's shadow memory alone exceeds every limit.
constexpr bool kSanitized =
#ifdef PKM_SANITIZED
    true;
#else
    false;
#endif

}  // namespace

void use_file_checker(std::vector<std::string> parts) { command() = std::move(parts); }

void check_contained(const std::string& bytes, const std::string& path) {
  if (command().empty()) return;
  int input[2], output[2];  // ours, the helper's; no file, which a limit of file sizes would cut
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
  const std::string message = read_all(reading.get(), kMostOfMessage);
  const int status = wait_for(child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kRefused && !message.empty()) throw ImageError(message);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    throw StorageError(path + ": is damaged or forged: reading it takes more memory than any study of its size");
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw StorageError(path + ": is damaged or forged: reading it does not end within " + std::to_string(kSeconds) +
                       " s");
  if (WIFSIGNALED(status) && !is_crash(WTERMSIG(status)))
    throw StorageError(path + ": its check was ended by a signal (" + ::strsignal(WTERMSIG(status)) + ")");
  throw StorageError(path + ": is damaged or forged: the HDF5 library crashes on it");
}

int check_standard_input() {
  ::alarm(kSeconds);
  limit(RLIMIT_CORE, 0);
  try {
    const std::string bytes = read_all(STDIN_FILENO);
    if (!kSanitized) limit(RLIMIT_AS, kMemory + 32 * static_cast<rlim_t>(bytes.size()));
    parse_study(bytes, verify_seal(bytes, "standard input", kStudySchema));
    return 0;
  } catch (const std::bad_alloc&) {
    return kOutOfMemory;
  } catch (const std::exception& error) {
    std::fputs(message_of(error).c_str(), stdout);
    return kRefused;
  }
}

}  // namespace pkm
