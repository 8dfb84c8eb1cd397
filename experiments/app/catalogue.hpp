// The catalogues of mechanisms, objectives, constraints and optimisers as JSON, as text and as Markdown, for
// `pkmopt list`.
#pragma once

#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// @return true if at least one option is required, so that the entry cannot be created from its defaults
bool needs_options(const std::vector<OptionSpec>& specs);

/// Name of the selected mass model; null if the mechanism has no masses.
Json mass_model_json(const Mechanism& mechanism);

/// Full description of one mechanism, which may be read from a file instead of the catalogues.
Json mechanism_json(const Mechanism& mechanism, const Catalogues& catalogues);

/// The four catalogues by their names ("mechanisms", "objectives", "constraints", "optimisers"). Each is a list with
/// one object per entry, which contains `name`, `meaning`, the options and further data of the entry.
Json catalogues_json(const Catalogues& catalogues);

// The following functions convert the JSON of mechanism_json() and catalogues_json() to text that people can read.
/// Full description of one entry: one line for each single value, one table for each list.
std::string entry_text(const Json& entry);
/// All entries of all catalogues in Markdown: the content of docs/reference/catalogue.md.
std::string catalogues_markdown(const Json& catalogues);
/// Text of a value for a table cell: elements of lists are separated by semicolons; "-" for null.
std::string cell_text(const Json& value);

}  // namespace pkm
