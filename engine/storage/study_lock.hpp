// Keeps a second process off a running study.
//
// The lock is a file of its own, "<study>.lock", because the study file itself is replaced by rename. The kernel holds
// the lock (flock), so it ends with the process, however that dies; a lock file left behind blocks nobody. Only a file
// that pkmopt has made is taken for one: it begins with our mark, or is empty.
#pragma once

#include <optional>
#include <string>

namespace pkm {

class StudyLock {
 public:
  /// A symbolic link locks what it points to, so all names of a study share a lock.
  /// Throws StorageError naming the process that holds the lock, or a file of another program that has the lock's name,
  /// or the system's reason. With
  /// PKMOPT_LOCK=off in the environment nothing is locked (for file systems without locks).
  explicit StudyLock(const std::string& study_path);
  ~StudyLock();
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;

  /// Which process works on a study: "process 12 on host"; none where no process holds its lock, as after a kill.
  static std::optional<std::string> holder(const std::string& study_path);

  /// False once the lock file was removed or replaced: another process may have locked the study.
  bool held() const;

 private:
  std::string lock_path_;
  int fd_ = -1;
};

}  // namespace pkm
