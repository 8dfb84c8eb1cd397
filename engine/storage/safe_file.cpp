#include "engine/storage/safe_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw StorageError(path + ": " + what + " (" + std::strerror(error) + ")");
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  /// Network file systems report late write errors here.
  int close() {
    const int result = ::close(fd_);
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

void write_all(int fd, const std::string& bytes, const std::string& path) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot be written, the previous state is kept", errno);
    done += static_cast<std::size_t>(n);
  }
}

void verify(int fd, const std::string& bytes, const std::string& path) {
  std::string block(std::size_t{1} << 18, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::pread(fd, block.data(), std::min(block.size(), bytes.size() - done), static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot be verified after writing, the previous state is kept", errno);
    if (n == 0 || std::memcmp(block.data(), bytes.data() + done, static_cast<std::size_t>(n)) != 0)
      throw StorageError(path + ": what was written does not read back, the previous state is kept");
    done += static_cast<std::size_t>(n);
  }
}

/// Makes the rename last. Some file systems cannot sync a folder and say so: nothing more can be done there.
void sync_folder(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0) return;  // a folder that may be written but not read
  if (::fsync(fd.get()) != 0 && errno != EINVAL && errno != EROFS) fail(path, "its folder cannot be synced", errno);
}

}  // namespace

std::string link_target(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // as Linux
  fs::path target = path;
  for (int links = 0; links <= kMostLinks; ++links) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target.string();
    const fs::path next = fs::read_symlink(target, error);
    if (error) fail(path, "is a symbolic link that cannot be read", error.value());
    target = target.parent_path() / next;  // an absolute `next` replaces all
  }
  fail(path, "cannot be opened", ELOOP);
}

void replace_file(const std::string& path, const std::string& bytes) {
  const std::string target = link_target(path), part = target + ".part";
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw StorageError(path + ": is " + (S_ISDIR(status.st_mode) ? "a folder" : "no regular file") +
                       " and is not replaced");
  Descriptor fd(::open(part.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (fd.get() < 0) fail(path, "cannot be written, its folder does not take a new file", errno);
  try {
    write_all(fd.get(), bytes, path);
    verify(fd.get(), bytes, path);
    if (::fsync(fd.get()) != 0) fail(path, "cannot be synced, the previous state is kept", errno);
    if (fd.close() != 0) fail(path, "cannot be closed, the previous state is kept", errno);
    if (std::rename(part.c_str(), target.c_str()) != 0) fail(path, "cannot be replaced", errno);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  sync_folder(target);
}

std::string read_file(const std::string& path) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) fail(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) fail(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) fail(path, "cannot be read", EISDIR);
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot be read", errno);
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace pkm
