// Extension of finished or interrupted studies: raises the limits of the last stage. The new limits are stored in the
// study file separately, because its TOML text is never changed.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// New limits of the last stage, counted from the beginning of the stage; std::nullopt: the limit is not changed.
struct ExtensionRequest {
  std::optional<std::int64_t> generations, evaluations;
};

/// Adds the requested limits to the extensions of the study file. If only `evaluations` is given, the limit on
/// generations is raised to its maximum. Throws ConfigError if the last stage lacks a requested limit, or if a value is
/// below the number already completed or above the maximum.
void request_extension(const Study& study, StudyContents& contents, const ExtensionRequest& request);

/// Applies the extensions of a study file to the stages of the study.
void apply_extensions(Study& study, const std::vector<Extension>& extensions);

}  // namespace pkm
