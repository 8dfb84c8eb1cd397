// Replaces old names of keys in the text of a study or of a mechanism file by the present ones (renamed_keys.hpp). All
// other text, including comments and layout, is unchanged.
#pragma once

#include <string>
#include <vector>

#include "engine/config/renamed_keys.hpp"

namespace pkm {

struct ReplacedKey {
  int line = 0;          ///< number of the line, from 1
  std::string old_path;  ///< path of the replaced key, for example "workspace.certain"
  std::string name;      ///< present name of the replaced key, for example "certified"
};

struct UpgradedText {
  std::string text;
  std::vector<ReplacedKey> replaced;  ///< the replaced keys in the order of the text; empty: `text` is unchanged
};

/// Upgrades a text without checking that it is valid TOML: invalid text may be changed, but does not become valid.
UpgradedText upgraded(const std::string& text, TextKind kind);

/// Upgrades the text of a file on disk, whose kind is recognised from its contents. Throws ConfigError if the text is
/// not TOML, or if a table contains both the old and the present name of a key.
UpgradedText upgraded_file(const std::string& text, const std::string& file_name);

}  // namespace pkm
