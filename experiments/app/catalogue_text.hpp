// Entries of the catalogues as people read them: what catalogue_json() tells, as text or Markdown.
#pragma once

#include <string>

#include "experiments/app/print.hpp"

namespace pkm {

/// Everything known of one entry: a value per line, a table per list.
std::string entry_text(const Json& entry);

/// Every entry of every catalogue, for experiments/catalogue.md, which a test compares with it.
std::string catalogues_markdown(const Json& catalogues);

/// A value in a word or a list of words; "-" for none.
std::string cell_text(const Json& value);

}  // namespace pkm
