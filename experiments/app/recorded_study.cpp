#include "experiments/app/recorded_study.hpp"

#include <iostream>
#include <new>

#include "engine/core/error.hpp"
#include "engine/study/records.hpp"

namespace pkm {
namespace {

Study with_warning(Study study, const std::string& file, const Session& session) {
  if (!study.differences.empty()) {
    const StorageError sentence(file + ": " + join(study.differences, "; ") + "; the recorded values are used");
    std::cerr << session.program << ": warning: " << sentence.what() << '\n';
  }
  return study;
}

}  // namespace

Study recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                     const StudyChanges& changes) {
  try {
    return with_warning(study_of(contents, session.catalogues, changes), file, session);
  } catch (const StorageError& error) {
    throw StorageError(file + ": " + error.what());
  }
}

std::optional<Study> find_recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                                         std::string& why) {
  try {
    return with_warning(study_of(contents, session.catalogues), file, session);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    why = message_of(error);
    return {};
  }
}

}  // namespace pkm
