// Which design of a study file is meant.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// At most one of baseline, generation with individual, and front; none: the best design.
struct DesignChoice {
  bool baseline = false;
  std::optional<std::int64_t> generation;  ///< from 0, as `pkmopt show` lists them
  std::optional<std::int64_t> individual;  ///< place in its population, from 1
  std::optional<std::int64_t> front;       ///< point of a stage's front, from 1
  std::optional<std::int64_t> stage;       ///< of generation or front, from 1; none: the last that has any
};

struct ChosenDesign {
  std::string words;               ///< "individual 3 of generation 12 of stage 1"
  std::string file_name;           ///< the same for names of files: "stage-1-generation-12-individual-3"
  std::vector<double> parameters;  ///< all of the mechanism's
};

/// Throws ConfigError, naming the option (--generation ..) and what it may be, where the file has no such design.
/// @param study  that the file holds
ChosenDesign chosen_design(const StudyContents& contents, const Study& study, const DesignChoice& choice);

}  // namespace pkm
