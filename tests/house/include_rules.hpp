// Who may include whom: the order of the folders, and where outside libraries may appear.
//
// Lower layers know nothing of higher ones, and a third-party type stops at the .cpp files of one folder, so that a
// library can be replaced in one place and a header of ours needs nothing but Eigen.
#pragma once

#include <string>
#include <vector>

namespace pkm::house {

/// One sentence per `#include` of `text` that breaks a rule.
/// @param path  of the file from the repository's root: "engine/core/error.hpp"
std::vector<std::string> broken_rules(const std::string& path, const std::string& text);

/// Whether the first `#include` of a source is `header`: then compiling the source shows that the header needs nothing
/// before it.
bool includes_first(const std::string& source, const std::string& header);

struct Source {
  std::string path;  ///< from the repository's root
  std::string text;
};
/// The outside headers that the rules know and none of the sources includes: "hdf5.h in engine/storage".
std::vector<std::string> dead_rules(const std::vector<Source>& sources);

}  // namespace pkm::house
