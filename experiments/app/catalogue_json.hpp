// Everything that the catalogues know of an entry, as JSON: what `pkmopt list` shows, as text or as it is.
#pragma once

#include <string>
#include <vector>

#include "engine/setup/study.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// True when at least one option must be given: then the entry cannot be made from its defaults.
bool needs_options(const std::vector<OptionSpec>& specs);

/// The mass model in force; null: no masses.
Json mass_model_json(const Mechanism& mechanism);

/// The four catalogues by their names ("mechanisms", "objectives", "constraints", "optimisers"), each a list of
/// objects with `name`, `meaning` and all the rest.
Json catalogues_json(const Catalogues& catalogues);

}  // namespace pkm
