// Table of the keys and options that were renamed before the first release. It serves to refuse old names, to replace
// them (`pkmopt upgrade`), and to read the text in old study files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// The kinds of TOML files that `pkmopt` reads and whose keys were renamed.
enum class TextKind { study, mechanism };

struct RenamedKey {
  TextKind kind;
  /// Path of the old name: {"workspace", "certain"} for the key `certain` of [workspace]; {"report"} for [[report]].
  std::vector<std::string> path;
  std::string name;  ///< present name of the key or table
};
std::span<const RenamedKey> renamed_keys();

/// The present name of the key with an old path such as "workspace.certain"; "" if the key was not renamed.
std::string present_name(std::string_view path);

/// The present name of an option such as "--held"; "" if it was not renamed.
std::string present_option(std::string_view option);

}  // namespace pkm
