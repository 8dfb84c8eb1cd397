#include "engine/study/study_output.hpp"

#include <unistd.h>

#include <filesystem>

#include "engine/core/error.hpp"

namespace pkm {

void StudyOutput::write(const StudyContents& contents) {
  if (!lock_.held()) keep_elsewhere(contents);
  write_study(path_, contents, existing_);
  existing_ = Existing::replaced;
}

void StudyOutput::keep_elsewhere(const StudyContents& contents) const {
  const std::filesystem::path path(path_);
  const std::string name = path.stem().string() + "-kept-" + std::to_string(::getpid()) + path.extension().string();
  const std::string kept = (path.parent_path() / name).string();
  write_study(kept, contents, Existing::refused);
  throw StorageError(path_ + ": its lock was removed while the study ran, so another process may write it; what " +
                     "this run has found is in " + kept + ", and can be resumed there");
}

}  // namespace pkm
