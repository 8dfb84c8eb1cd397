// Selects one design of a study file: the best one, the baseline, an individual of a generation, or a point of a Pareto
// front.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Which design to select. At most one of `baseline`, `generation` with `individual`, and `front` may be set; if none
/// is set, the best design is selected.
struct DesignChoice {
  bool baseline = false;
  std::optional<std::int64_t> generation;  ///< number of the generation, from 0, as listed by `pkmopt show`
  std::optional<std::int64_t> individual;  ///< position of the design in the population of `generation`, from 1
  std::optional<std::int64_t> front;       ///< number of a point of a stage's Pareto front, from 1
  std::optional<std::int64_t> stage;       ///< number of the stage to which `generation` or `front` refers, from 1;
                                           ///< default: the last stage that has one
};

struct ChosenDesign {
  std::string words;               ///< description of the design, such as "individual 3 of generation 12 of stage 1"
  std::string file_name;           ///< the description in a form for file names, such as
                                   ///< "stage-1-generation-12-individual-3"
  std::vector<double> parameters;  ///< values of all parameters of the mechanism [SI]
};

/// Selects the design. Throws ConfigError with the option (--generation ..) and its valid values if the file has no
/// such design, or if the options contradict each other.
/// @param study  the study that was read from the text in `contents`
ChosenDesign chosen_design(const StudyContents& contents, const Study& study, const DesignChoice& choice);

}  // namespace pkm
