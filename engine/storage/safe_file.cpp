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

/// Transfers `size` bytes by repeated system calls.
/// @param step  step(done), called after `done` bytes, transfers some of the remaining ones and returns their number, 0
///              at the end of the data, or a negative value and errno
/// @return the number of bytes transferred; less than `size` if the data ended early
template <class Step>
std::size_t transfer_all(std::size_t size, const std::string& path, const char* failure, const Step& step) {
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

/// Reads the file again, and throws StorageError if its contents differ from `bytes`.
void verify_written(int fd, const std::string& bytes, const std::string& path) {
  std::string block(std::size_t{1} << 18, '\0');
  const auto same = [&](std::size_t done) {
    const ssize_t n = ::pread(fd, block.data(), std::min(block.size(), bytes.size() - done), static_cast<off_t>(done));
    return n > 0 && std::memcmp(block.data(), bytes.data() + done, static_cast<std::size_t>(n)) != 0 ? 0 : n;
  };
  if (transfer_all(bytes.size(), path, "cannot be verified; any previous file is unchanged", same) < bytes.size())
    throw StorageError(path + ": the written data differ when read back; any previous file is unchanged");
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

/// Syncs the folder of a file, so that the rename of the file survives a crash. File systems that cannot sync a folder
/// report EINVAL or EROFS, which is ignored.
void sync_folder(const std::string& path) {
  const Descriptor fd(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0) return;  // the folder can be written to, but not read
  if (::fsync(fd.get()) != 0 && errno != EINVAL && errno != EROFS) fail(path, "its folder cannot be synced", errno);
}

/// Status of a file, after all symbolic links have been resolved; std::nullopt if it does not exist or is not
/// accessible.
std::optional<struct stat> file_status(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return status;
}

bool same_file(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// Creates a temporary file with an unpredictable name in the folder of `target`.
/// @param replaced  status of the file to be replaced, whose permissions and, if allowed, owner the new file gets
/// @return file descriptor (-1 and errno on failure) and path
std::pair<int, std::string> open_temporary(const std::string& target, const std::optional<struct stat>& replaced) {
  for (std::random_device random;;) {
    char name[32];
    std::snprintf(name, sizeof name, "/.pkmopt-%08x%08x.part", random(), random());
    const std::string temporary = folder_of(target) + name;
    const int fd = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                          replaced ? S_IRUSR | S_IWUSR : 0666);
    if (fd < 0 && errno == EEXIST) continue;
    if (fd >= 0 && replaced) {
      static_cast<void>(!::fchown(fd, replaced->st_uid, replaced->st_gid));
      static_cast<void>(!::fchmod(fd, replaced->st_mode & 0777));
    }
    return {fd, temporary};
  }
}

/// Renames the file `temporary` to `target`.
/// @return 0, or -1 and errno: EEXIST if `target` exists and may not be replaced
int rename_into_place(const std::string& temporary, const std::string& target, Existing existing) {
  if (existing == Existing::replaced) return std::rename(temporary.c_str(), target.c_str());
  const int renamed = ::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE);
  if (renamed == 0 || (errno != EINVAL && errno != ENOSYS)) return renamed;
  // Fallback for file systems that do not support RENAME_NOREPLACE.
  if (::link(temporary.c_str(), target.c_str()) != 0) return -1;
  return ::unlink(temporary.c_str());
}

}  // namespace

std::string link_target(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMaxLinks = 40;  // maximum number of symbolic links, as on Linux
  if (path.find('\0') != std::string::npos)
    throw StorageError(std::string(path.c_str()) + ": the file name contains a NUL character after this point");
  fs::path target = path;
  for (int links = 0; links <= kMaxLinks; ++links) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target.string();
    const fs::path next = fs::read_symlink(target, error);
    if (error) fail(path, "is a symbolic link that cannot be read", error.value());
    target = target.parent_path() / next;  // if `next` is an absolute path, the operator `/` returns `next` itself
  }
  fail(path, "cannot be opened", ELOOP);
}

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, Existing existing) {
  std::set<std::filesystem::path> known;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    std::error_code error;  // ignored here: an inaccessible path is reported when the file is written
    if (!known.insert(std::filesystem::weakly_canonical(link_target(output), error)).second && !error)
      throw ConfigError({output, 0, ""}, "is given for two outputs");
    const auto present = file_status(output);
    if (!present) continue;
    for (const std::string& input : inputs)
      if (const auto read = file_status(input); read && same_file(*present, *read))
        throw ConfigError({output, 0, ""}, "is read by this command, so it is not overwritten");
    if (existing == Existing::refused) throw StorageError(output + " exists already; overwrite it with --force");
  }
}

void write_file(const std::string& path, const std::string& bytes, Existing existing) {
  const std::string target = link_target(path);
  const auto replaced = file_status(target);
  if (replaced && existing == Existing::refused) fail(path, "is not overwritten", EEXIST);
  if (replaced && !S_ISREG(replaced->st_mode))
    throw StorageError(path + ": is " + (S_ISDIR(replaced->st_mode) ? "a folder" : "not a regular file") +
                       " and is not replaced");
  const auto [opened, temporary] = open_temporary(target, replaced);
  Descriptor fd(opened);
  if (fd.get() < 0) fail(path, "cannot be written, because no file can be created in its folder", errno);
  try {
    transfer_all(bytes.size(), path, "cannot be written; any previous file is unchanged",
                 [&](std::size_t done) { return ::write(fd.get(), bytes.data() + done, bytes.size() - done); });
    verify_written(fd.get(), bytes, path);
    if (::fsync(fd.get()) != 0) fail(path, "cannot be synced; any previous file is unchanged", errno);
    if (fd.close() != 0) fail(path, "cannot be closed; any previous file is unchanged", errno);
    if (rename_into_place(temporary, target, existing) != 0)
      fail(path, existing == Existing::replaced ? "cannot be replaced" : "cannot be created", errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_folder(target);
}

std::string read_file(const std::string& path, std::size_t max_bytes) {
  // O_NONBLOCK prevents that opening a pipe blocks.
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) fail(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) fail(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) fail(path, "cannot be read", EISDIR);
  if (!S_ISREG(status.st_mode)) throw StorageError(path + ": is a pipe or a device; expected a regular file");
  std::string bytes(std::min(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)), max_bytes), '\0');
  bytes.resize(transfer_all(bytes.size(), path, "cannot be read", [&](std::size_t done) {
    return ::read(fd.get(), bytes.data() + done, bytes.size() - done);
  }));
  return bytes;
}

}  // namespace pkm
