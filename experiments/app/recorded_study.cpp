#include "experiments/app/recorded_study.hpp"

#include <iostream>
#include <new>

#include "engine/core/error.hpp"
#include "engine/runner/records.hpp"

namespace pkm {
namespace {

/// Returns the study. If recorded values differ from those of the study's text, prints a warning before.
Study warn_of_differences(Study study, const std::string& file, const Session& session) {
  if (!study.differences.empty()) {
    const StorageError message(file + ": " + join(study.differences, "; ") + "; the recorded values are used");
    std::cerr << session.program << ": warning: " << message.what() << '\n';
  }
  return study;
}

}  // namespace

Study recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                     const StudyChanges& changes) {
  try {
    return warn_of_differences(study_of(contents, session.catalogues, changes), file, session);
  } catch (const StorageError& error) {
    throw StorageError(file + ": " + error.what());
  }
}

std::optional<Study> find_recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                                         std::string& why) {
  try {
    return warn_of_differences(study_of(contents, session.catalogues), file, session);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    why = message_of(error);
    return {};
  }
}

}  // namespace pkm
