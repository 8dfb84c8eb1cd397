// Exclusive lock of a running study: a lock file with an advisory kernel lock (flock).
//
// The lock file "<study>.lock" is separate because the study file itself is replaced by a rename at every checkpoint.
// The kernel releases the lock when the process ends, even if it is killed, so that a remaining lock file does not
// block other processes. Only a file created by pkmopt is accepted as a lock file: it is empty or begins with
// "pkmopt-lock ".
#pragma once

#include <optional>
#include <string>

namespace pkm {

class StudyLock {
 public:
  /// Locks the study. Symbolic links are resolved, so that all paths to a study share one lock. With PKMOPT_LOCK=off in
  /// the environment nothing is locked (for file systems without locks). Throws StorageError if another process holds
  /// the lock (the message names it), if the lock file belongs to another program, or with the operating system's
  /// error.
  explicit StudyLock(const std::string& study_path);
  ~StudyLock();
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;

  /// The process that holds the lock of a study, for example "process 12 on host"; std::nullopt if no process holds it.
  static std::optional<std::string> holder(const std::string& study_path);

  /// @return false if the lock file has been removed or replaced since construction: another process may then hold the
  /// lock of the study
  bool owns_lock() const;

 private:
  std::string lock_path_;
  int fd_ = -1;
};

}  // namespace pkm
