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
  std::optional<std::int64_t> generation;  ///< from 0, as listed by `pkmopt show`
  std::optional<std::int64_t> individual;  ///< position in the population of `generation`, from 1
  std::optional<std::int64_t> front;       ///< point of a stage's Pareto front, from 1
  std::optional<std::int64_t> stage;       ///< stage of `generation` or `front`, from 1; default: the last that has one
};

struct ChosenDesign {
  std::string words;               ///< description: "individual 3 of generation 12 of stage 1"
  std::string file_name;           ///< the description as part of a file name: "stage-1-generation-12-individual-3"
  std::vector<double> parameters;  ///< all parameters of the mechanism, SI
};

/// Selects the design. Throws ConfigError with the option (--generation ..) and its valid values if the file has no
/// such design, or if the options contradict each other.
/// @param study  the study that was read from the text in `contents`
ChosenDesign chosen_design(const StudyContents& contents, const Study& study, const DesignChoice& choice);

}  // namespace pkm
