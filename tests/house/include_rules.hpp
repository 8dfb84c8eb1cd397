// Include rules: the layering of the folders, and the files in which external libraries may be used.
//
// A layer depends on lower layers only. Types of an external library appear in the .cpp files of one folder only, so
// that a library can be replaced in one place, and the headers of this project depend on no library but Eigen.
#pragma once

#include <string>
#include <vector>

namespace pkm::house {

/// One sentence for each `#include` in `text` that violates a rule.
/// @param path  of the file, relative to the repository root: "engine/core/error.hpp"
std::vector<std::string> violations(const std::string& path, const std::string& text);

/// Whether the first `#include` of a source file is `header`: then compiling the source shows that the header compiles
/// on its own.
bool includes_first(const std::string& source, const std::string& header);

/// A source file.
struct Source {
  std::string path;  ///< relative to the repository root
  std::string text;
};
/// External headers that the rules allow but no source file includes: "hdf5.h in engine/storage".
std::vector<std::string> unused_rules(const std::vector<Source>& sources);

}  // namespace pkm::house
