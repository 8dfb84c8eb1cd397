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

bool switched_off() {
  const char* value = std::getenv("PKMOPT_LOCK");
  return value && std::string_view(value) == "off";
}

constexpr std::string_view kLockMark = "pkmopt-lock ";
constexpr std::size_t kMostBytes = 256;

/// At most kMostBytes.
std::string text_of(int fd) {
  char text[kMostBytes];
  const ssize_t n = ::pread(fd, text, sizeof text, 0);
  return n > 0 ? std::string(text, static_cast<std::size_t>(n)) : "";
}

/// Made by pkmopt, as far as can be seen, and by no other name that of another file.
bool is_lock_file(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink > 1) return false;
  if (status.st_size > static_cast<off_t>(kMostBytes)) return false;
  const std::string text = text_of(fd);
  return text.starts_with(kLockMark) || kLockMark.starts_with(text);  // a full disk may have kept it from its mark
}

std::string holder_of(int fd) {
  const std::string text = text_of(fd);
  return text.starts_with(kLockMark) ? "process " + text.substr(kLockMark.size()) : "another process";
}

std::string own_name() {
  char host[128] = {};
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  return std::to_string(::getpid()) + (host[0] ? " on " + std::string(host) : "");
}

/// The file behind `fd` still carries the name: its last holder may have removed it between our open and our lock.
bool still_named(int fd, const std::string& path) {
  struct stat ours {
  }, named{};
  return ::fstat(fd, &ours) == 0 && ::lstat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace

StudyLock::StudyLock(const std::string& study_path) : lock_path_(link_target(study_path) + ".lock") {
  if (switched_off()) return;
  for (bool again = true;;) {
    const int fd = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0 ? errno == ELOOP : !is_lock_file(fd)) {
      if (fd >= 0) ::close(fd);
      throw StorageError(study_path + ": cannot be locked: " + lock_path_ +
                         " is no lock of pkmopt and is left alone; give the study another name");
    }
    if (fd < 0)
      throw StorageError(study_path + ": the lock file " + lock_path_ + " cannot be created (" + std::strerror(errno) +
                         ")");
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string by = holder_of(fd);
      ::close(fd);
      if (error == EINTR) continue;
      if (error == EWOULDBLOCK && std::exchange(again, false)) {  // one that only asks holds it for some microseconds
        ::usleep(10000);
        continue;
      }
      if (error == EWOULDBLOCK) throw StorageError(study_path + ": in use by " + by + " (it holds " + lock_path_ + ")");
      throw StorageError(study_path + ": cannot be locked (" + std::strerror(error) +
                         "); on a file system without locks set PKMOPT_LOCK=off");
    }
    if (still_named(fd, lock_path_)) {
      fd_ = fd;
      break;
    }
    ::close(fd);
  }
  // The name of the holder serves messages only, so failing to write it (a full disk) does no harm.
  const std::string name = (std::string(kLockMark) + own_name()).substr(0, kMostBytes);
  if (::ftruncate(fd_, 0) == 0) static_cast<void>(!::pwrite(fd_, name.data(), name.size(), 0));
}

std::optional<std::string> StudyLock::holder(const std::string& study_path) {
  if (switched_off()) return "another process, perhaps (PKMOPT_LOCK=off),";
  const std::string lock = link_target(study_path) + ".lock";
  const int fd = ::open(lock.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return {};
  std::optional<std::string> holder;
  // A lock of ours, if we get one, ends with the descriptor.
  if (is_lock_file(fd) && ::flock(fd, LOCK_SH | LOCK_NB) != 0) holder = holder_of(fd);
  ::close(fd);
  return holder;
}

bool StudyLock::held() const { return fd_ < 0 || still_named(fd_, lock_path_); }

StudyLock::~StudyLock() {
  if (fd_ < 0) return;
  if (held()) ::unlink(lock_path_.c_str());
  ::close(fd_);
}

}  // namespace pkm
