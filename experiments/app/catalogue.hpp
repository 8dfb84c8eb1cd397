// Everything that the catalogues know of an entry: what `pkmopt list` shows, as JSON, as text or as Markdown.
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

/// Everything known of one mechanism, which need not be in the catalogues.
Json mechanism_json(const Mechanism& mechanism, const Catalogues& catalogues);

/// The four catalogues by their names ("mechanisms", "objectives", "constraints", "optimisers"), each a list of
/// objects with `name`, `meaning` and all the rest.
Json catalogues_json(const Catalogues& catalogues);

// As people read the JSON:
/// Everything known of one entry: a value per line, a table per list.
std::string entry_text(const Json& entry);
/// Every entry of every catalogue, for experiments/catalogue.md, which a test compares with it.
std::string catalogues_markdown(const Json& catalogues);
/// A value in a word or a list of words; "-" for none.
std::string cell_text(const Json& value);

}  // namespace pkm
