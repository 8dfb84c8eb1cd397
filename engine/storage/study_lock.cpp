#include "engine/storage/study_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {
namespace {

bool locking_disabled() {
  const char* value = std::getenv("PKMOPT_LOCK");
  return value && std::string_view(value) == "off";
}

constexpr std::string_view kLockSignature = "pkmopt-lock ";
constexpr std::size_t kMaxBytes = 256;

/// Reads the first kMaxBytes bytes of the lock file.
std::string read_text(int fd) {
  char text[kMaxBytes];
  const ssize_t n = ::pread(fd, text, sizeof text, 0);
  return n > 0 ? std::string(text, static_cast<std::size_t>(n)) : "";
}

/// @return true if the file looks like one that pkmopt created: a small regular file with a single hard link that is
/// empty or begins with the signature of lock files
bool is_lock_file(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink > 1) return false;
  if (status.st_size > static_cast<off_t>(kMaxBytes)) return false;
  const std::string text = read_text(fd);
  // The text may be a part of the signature only, because a full disk may have truncated it.
  return text.starts_with(kLockSignature) || kLockSignature.starts_with(text);
}

/// Name of the process that holds the lock, as written in the lock file.
std::string holder_of(int fd) {
  const std::string text = read_text(fd);
  return text.starts_with(kLockSignature) ? "process " + text.substr(kLockSignature.size()) : "another process";
}

std::string process_name() {
  char host[128] = {};
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  return std::to_string(::getpid()) + (host[0] ? " on " + std::string(host) : "");
}

/// Returns true if `path` still refers to the file that is open as `fd`. Between our open and our flock, the previous
/// holder may have removed it.
bool is_current_file(int fd, const std::string& path) {
  struct stat ours {
  }, named{};
  return ::fstat(fd, &ours) == 0 && ::lstat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace

StudyLock::StudyLock(const std::string& study_path) : lock_path_(link_target(study_path) + ".lock") {
  if (locking_disabled()) return;
  for (bool retry = true;;) {
    const int fd = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0 ? errno == ELOOP : !is_lock_file(fd)) {
      if (fd >= 0) ::close(fd);
      throw StorageError(study_path + ": cannot be locked: " + lock_path_ +
                         " is not a lock file of pkmopt and is left unchanged; give the study another name");
    }
    if (fd < 0)
      throw StorageError(study_path + ": the lock file " + lock_path_ + " cannot be created (" + std::strerror(errno) +
                         ")");
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string by = holder_of(fd);
      ::close(fd);
      if (error == EINTR) continue;
      // A refused lock is tried once more, because another process that calls holder() locks the file for some
      // microseconds.
      if (error == EWOULDBLOCK && std::exchange(retry, false)) {
        ::usleep(10000);
        continue;
      }
      if (error == EWOULDBLOCK) throw StorageError(study_path + ": in use by " + by + " (it holds " + lock_path_ + ")");
      throw StorageError(study_path + ": cannot be locked (" + std::strerror(error) +
                         "); on a file system without locks set PKMOPT_LOCK=off");
    }
    if (is_current_file(fd, lock_path_)) {
      fd_ = fd;
      break;
    }
    ::close(fd);
  }
  // A failure to write the process name (full disk) is ignored, because it is only used in messages.
  const std::string name = (std::string(kLockSignature) + process_name()).substr(0, kMaxBytes);
  if (::ftruncate(fd_, 0) == 0) static_cast<void>(!::pwrite(fd_, name.data(), name.size(), 0));
}

std::optional<std::string> StudyLock::holder(const std::string& study_path) {
  if (locking_disabled()) return "possibly another process (PKMOPT_LOCK=off)";
  const std::string lock = link_target(study_path) + ".lock";
  const int fd = ::open(lock.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return {};
  std::optional<std::string> holder;
  // If this shared lock succeeds, closing the descriptor releases it.
  if (is_lock_file(fd) && ::flock(fd, LOCK_SH | LOCK_NB) != 0) holder = holder_of(fd);
  ::close(fd);
  return holder;
}

bool StudyLock::owns_lock() const { return fd_ < 0 || is_current_file(fd_, lock_path_); }

StudyLock::~StudyLock() {
  if (fd_ < 0) return;
  if (owns_lock()) ::unlink(lock_path_.c_str());
  ::close(fd_);
}

}  // namespace pkm
