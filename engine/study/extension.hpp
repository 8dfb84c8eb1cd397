// Finished and stopped studies can be given higher limits for their last stage. The file keeps them, because its TOML
// text stays as it is.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// How a study file is to be extended.
struct ExtensionRequest {
  std::optional<std::int64_t> generations, evaluations;  ///< new limits of the last stage, totals
};

/// Adds the limits asked for to those that the file has. They must not lie below what is done already. More evaluations
/// alone also lift the limit on generations. Throws ConfigError.
void request_extension(const Study& study, StudyContents& contents, const ExtensionRequest& request);

/// Gives the study's stages the limits that a file's extensions name.
void apply_extensions(Study& study, const std::vector<Extension>& extensions);

}  // namespace pkm
