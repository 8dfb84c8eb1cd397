// Fault injection for file access: a library for LD_PRELOAD that simulates a failing or slow disk. It intercepts the
// operations on files below DISK_FOLDER (opening for writing, write, pwrite, fsync, fdatasync, ftruncate, rename, link)
// and counts them. Environment variables:
//
//   DISK_FAILS_AT=n      the n-th operation, counted from 1, fails
//   DISK_FAILS_FOR=k     the number of operations that fail from then on (default 1; 0: all)
//   DISK_ERROR=e         errno of the failures (default ENOSPC)
//   DISK_SHORT=1         instead of failing, the n-th write writes its first half, and the next operation fails
//   DISK_DELAY_US=t      delays every operation by t microseconds
//   DISK_COUNT=FILE      writes the number of operations to FILE at exit
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static atomic_long operations;

static long variable(const char* name, long default_value) {
  const char* text = getenv(name);
  return text ? strtol(text, NULL, 10) : default_value;
}

static int is_below(const char* path) {
  const char* folder = getenv("DISK_FOLDER");
  return folder && strncmp(path, folder, strlen(folder)) == 0;
}

/// Relative paths count: the program is run inside the folder.
static int path_counts(const char* path) { return path[0] != '/' || is_below(path); }

static int file_counts(int fd) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n <= 0) return 0;
  path[n] = '\0';
  return is_below(path);
}

/// Outcome of the next operation: 0 success, 1 failure, 2 only the first half is written.
static int next_outcome(void) {
  const long delay = variable("DISK_DELAY_US", 0);
  if (delay > 0) {
    const struct timespec pause = {delay / 1000000, delay % 1000000 * 1000};
    nanosleep(&pause, NULL);
  }
  const long number = atomic_fetch_add(&operations, 1) + 1, first = variable("DISK_FAILS_AT", 0);
  const long times = variable("DISK_FAILS_FOR", 1), half = variable("DISK_SHORT", 0);
  if (first == 0 || number < first) return 0;
  if (half && number == first) return 2;
  if (times > 0 && number >= first + times + half) return 0;
  errno = (int)variable("DISK_ERROR", ENOSPC);
  return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void* bytes, size_t count) {
  const int outcome = file_counts(fd) ? next_outcome() : 0;
  return outcome == 1 ? -1 : REAL(write)(fd, bytes, outcome == 2 ? (count + 1) / 2 : count);
}

ssize_t pwrite(int fd, const void* bytes, size_t count, off_t at) {
  const int outcome = file_counts(fd) ? next_outcome() : 0;
  return outcome == 1 ? -1 : REAL(pwrite)(fd, bytes, outcome == 2 ? (count + 1) / 2 : count, at);
}

int fsync(int fd) { return file_counts(fd) && next_outcome() == 1 ? -1 : REAL(fsync)(fd); }
int fdatasync(int fd) { return file_counts(fd) && next_outcome() == 1 ? -1 : REAL(fdatasync)(fd); }
int ftruncate(int fd, off_t size) { return file_counts(fd) && next_outcome() == 1 ? -1 : REAL(ftruncate)(fd, size); }
int rename(const char* from, const char* to) {
  return path_counts(to) && next_outcome() == 1 ? -1 : REAL(rename)(from, to);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  return path_counts(to) && next_outcome() == 1 ? -1 : REAL(renameat2)(from_folder, from, to_folder, to, flags);
}
int link(const char* from, const char* to) {
  return path_counts(to) && next_outcome() == 1 ? -1 : REAL(link)(from, to);
}

static int open_fails(const char* path, int flags) {
  return (flags & (O_WRONLY | O_RDWR)) != 0 && path_counts(path) && next_outcome() == 1;
}

#define OPEN(name, PLACE, GIVEN)                                               \
  int name(PLACE const char* path, int flags, ...) {                           \
    mode_t mode = 0;                                                           \
    if (flags & (O_CREAT | __O_TMPFILE)) {                                     \
      va_list more;                                                            \
      va_start(more, flags);                                                   \
      mode = va_arg(more, mode_t);                                             \
      va_end(more);                                                            \
    }                                                                          \
    return open_fails(path, flags) ? -1 : REAL(name)(GIVEN path, flags, mode); \
  }
#define NOTHING
#define FOLDER int folder,
#define GIVEN_FOLDER folder,
OPEN(open, NOTHING, NOTHING)
OPEN(open64, NOTHING, NOTHING)
OPEN(openat, FOLDER, GIVEN_FOLDER)
OPEN(openat64, FOLDER, GIVEN_FOLDER)

// Used by C++ streams.
FILE* fopen(const char* path, const char* mode) {
  return (mode[0] != 'r' || strchr(mode, '+')) && path_counts(path) && next_outcome() == 1 ? NULL
                                                                                           : REAL(fopen)(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return (mode[0] != 'r' || strchr(mode, '+')) && path_counts(path) && next_outcome() == 1 ? NULL
                                                                                           : REAL(fopen64)(path, mode);
}
#include <sys/uio.h>
ssize_t writev(int fd, const struct iovec* parts, int count) {
  return file_counts(fd) && next_outcome() == 1 ? -1 : REAL(writev)(fd, parts, count);
}

__attribute__((destructor)) static void write_count(void) {
  const char* path = getenv("DISK_COUNT");
  if (!path) return;
  char text[32];
  const int length = snprintf(text, sizeof text, "%ld\n", atomic_load(&operations));
  const int fd = REAL(open)(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (fd < 0) return;
  if (REAL(write)(fd, text, (size_t)length) != length) abort();
  close(fd);
}
