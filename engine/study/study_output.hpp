// The file that a running study is written to, again and again, under its lock.
#pragma once

#include <string>
#include <utility>

#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"

namespace pkm {

class StudyOutput {
 public:
  /// @param lock  of the path; has to outlive this
  /// @param existing  what becomes of a file that is there at the first write
  StudyOutput(std::string path, const StudyLock& lock, Existing existing)
      : path_(std::move(path)), lock_(lock), existing_(existing) {}

  const std::string& path() const { return path_; }
  /// Throws StorageError. Where the lock is lost, another process may have the study by now: its file is left alone,
  /// and the error names the file that holds what this run has found.
  void write(const StudyContents& contents);

 private:
  [[noreturn]] void keep_elsewhere(const StudyContents& contents) const;

  std::string path_;
  const StudyLock& lock_;
  Existing existing_;
};

}  // namespace pkm
