#include "engine/storage/safe_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/storage/descriptor.hpp"

namespace pkm {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw StorageError(path + ": " + what + " (" + std::strerror(error) + ")");
}

/// Calls step(done) for what is left of `size` bytes, which says how many it has done, 0: there are no more, < 0: the
/// system's error.
template <class Step>
std::size_t do_all(std::size_t size, const std::string& path, const char* failure, const Step& step) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n = step(done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, failure, errno);
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

void verify(int fd, const std::string& bytes, const std::string& path) {
  std::string block(std::size_t{1} << 18, '\0');
  const auto same = [&](std::size_t done) {
    const ssize_t n = ::pread(fd, block.data(), std::min(block.size(), bytes.size() - done), static_cast<off_t>(done));
    return n > 0 && std::memcmp(block.data(), bytes.data() + done, static_cast<std::size_t>(n)) != 0 ? 0 : n;
  };
  if (do_all(bytes.size(), path, "cannot be verified after writing, the previous state is kept", same) < bytes.size())
    throw StorageError(path + ": what was written does not read back, the previous state is kept");
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

/// Makes the rename last. Some file systems cannot sync a folder and say so: nothing more can be done there.
void sync_folder(const std::string& path) {
  const Descriptor fd(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0) return;  // a folder that may be written but not read
  if (::fsync(fd.get()) != 0 && errno != EINVAL && errno != EROFS) fail(path, "its folder cannot be synced", errno);
}

/// What is at the end of all links; none: nothing is there, or it cannot be seen.
std::optional<struct stat> status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return status;
}

bool same_file(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// A new file in the folder of `target`, under a name that nobody can foresee, and that name. What it is to replace
/// keeps its permissions and, where the system allows it, its owner.
std::pair<int, std::string> open_temporary(const std::string& target, const std::optional<struct stat>& replaced) {
  for (std::random_device random;;) {
    char name[32];
    std::snprintf(name, sizeof name, "/.pkmopt-%08x%08x.part", random(), random());
    const std::string part = folder_of(target) + name;
    const int fd =
        ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, replaced ? S_IRUSR | S_IWUSR : 0666);
    if (fd < 0 && errno == EEXIST) continue;
    if (fd >= 0 && replaced) {
      static_cast<void>(!::fchown(fd, replaced->st_uid, replaced->st_gid));
      static_cast<void>(!::fchmod(fd, replaced->st_mode & 0777));
    }
    return {fd, part};
  }
}

/// Gives the temporary file its name: 0, or -1 with errno, EEXIST where nothing may be replaced and something is there.
int publish(const std::string& part, const std::string& target, Existing existing) {
  if (existing == Existing::replaced) return std::rename(part.c_str(), target.c_str());
  const int renamed = ::renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE);
  if (renamed == 0 || (errno != EINVAL && errno != ENOSYS)) return renamed;
  if (::link(part.c_str(), target.c_str()) != 0) return -1;  // file systems without that kind of rename
  return ::unlink(part.c_str());
}

}  // namespace

std::string link_target(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // as Linux
  if (path.find('\0') != std::string::npos)
    throw StorageError(std::string(path.c_str()) +
                       ": the file's name goes on after a NUL, which no file name can hold");
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

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, Existing existing) {
  std::set<std::filesystem::path> places;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    std::error_code unseen;  // the attempt to write tells
    if (!places.insert(std::filesystem::weakly_canonical(link_target(output), unseen)).second && !unseen)
      throw ConfigError({output, 0, ""}, "is the name of two outputs");
    const auto there = status_of(output);
    if (!there) continue;
    for (const std::string& input : inputs)
      if (const auto read = status_of(input); read && same_file(*there, *read))
        throw ConfigError({output, 0, ""}, "is read by this command, so it is not overwritten");
    if (existing == Existing::refused) throw StorageError(output + " exists already; overwrite it with --force");
  }
}

void write_file(const std::string& path, const std::string& bytes, Existing existing) {
  const std::string target = link_target(path);
  const auto replaced = status_of(target);
  if (replaced && existing == Existing::refused) fail(path, "is not overwritten", EEXIST);
  if (replaced && !S_ISREG(replaced->st_mode))
    throw StorageError(path + ": is " + (S_ISDIR(replaced->st_mode) ? "a folder" : "no regular file") +
                       " and is not replaced");
  const auto [opened, part] = open_temporary(target, replaced);
  Descriptor fd(opened);
  if (fd.get() < 0) fail(path, "cannot be written, its folder does not take a new file", errno);
  try {
    do_all(bytes.size(), path, "cannot be written, the previous state is kept",
           [&](std::size_t done) { return ::write(fd.get(), bytes.data() + done, bytes.size() - done); });
    verify(fd.get(), bytes, path);
    if (::fsync(fd.get()) != 0) fail(path, "cannot be synced, the previous state is kept", errno);
    if (fd.close() != 0) fail(path, "cannot be closed, the previous state is kept", errno);
    if (publish(part, target, existing) != 0)
      fail(path, existing == Existing::replaced ? "cannot be replaced" : "cannot be given its name", errno);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  sync_folder(target);
}

std::string read_file(const std::string& path, std::size_t most) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe is not waited for
  if (fd.get() < 0) fail(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) fail(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) fail(path, "cannot be read", EISDIR);
  if (!S_ISREG(status.st_mode)) throw StorageError(path + ": is a pipe or a device; a study is read from a file");
  std::string bytes(std::min(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)), most), '\0');
  bytes.resize(do_all(bytes.size(), path, "cannot be read",
                      [&](std::size_t done) { return ::read(fd.get(), bytes.data() + done, bytes.size() - done); }));
  return bytes;
}

}  // namespace pkm
