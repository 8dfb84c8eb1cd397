#include "engine/runner/study_output.hpp"

#include <unistd.h>

#include <filesystem>

#include "engine/core/error.hpp"

namespace pkm {

void StudyOutput::write(const StudyContents& contents) {
  if (!lock_.owns_lock()) write_to_other_file(contents);
  write_study(path_, contents, existing_);
  existing_ = Existing::replaced;
}

void StudyOutput::write_to_other_file(const StudyContents& contents) const {
  const std::filesystem::path path(path_);
  const std::string name = path.stem().string() + "-kept-" + std::to_string(::getpid()) + path.extension().string();
  const std::string other = (path.parent_path() / name).string();
  write_study(other, contents, Existing::refused);
  throw StorageError(path_ + ": its lock file was removed during the run, so that another process may use the study; " +
                     "the results of this run are in " + other + ", which can be resumed");
}

}  // namespace pkm
