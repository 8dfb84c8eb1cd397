// Output file of a running study, rewritten at every checkpoint while the study's lock is owned.
#pragma once

#include <string>
#include <utility>

#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"

namespace pkm {

class StudyOutput {
 public:
  /// @param lock  lock of the study at `path`; must outlive this object
  /// @param existing  whether the first write may replace an existing file
  StudyOutput(std::string path, const StudyLock& lock, Existing existing)
      : path_(std::move(path)), lock_(lock), existing_(existing) {}

  const std::string& path() const { return path_; }
  /// Writes the study file. Throws StorageError. If the lock has been lost, another process may use the study file:
  /// the contents are then written to another file, which the error message names.
  void write(const StudyContents& contents);

 private:
  [[noreturn]] void write_to_other_file(const StudyContents& contents) const;

  std::string path_;
  const StudyLock& lock_;
  Existing existing_;
};

}  // namespace pkm
