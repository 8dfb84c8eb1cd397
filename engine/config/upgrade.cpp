#include "engine/config/upgrade.hpp"

#include <algorithm>

#include "engine/config/study.hpp"
#include "engine/config/toml.hpp"
#include "engine/config/toml_keys.hpp"

namespace pkm {

UpgradedText upgraded(const std::string& text, TextKind kind) {
  UpgradedText result;
  std::size_t copied = 0;
  for (const TomlKey& key : find_toml_keys(text)) {
    const auto renamed = std::ranges::find_if(
        renamed_keys(), [&](const RenamedKey& each) { return each.kind == kind && each.path == key.path; });
    if (renamed == renamed_keys().end()) continue;
    result.text.append(text, copied, key.begin - copied).append(renamed->name);
    copied = key.begin + key.size;
    result.replaced.push_back({key.line, join(key.path, "."), renamed->name});
  }
  result.text.append(text, copied);
  return result;
}

UpgradedText upgraded_file(const std::string& text, const std::string& file_name) {
  const std::string expected = "a study or a mechanism in TOML";
  const TomlValue document = parse_toml(text, file_name, expected);
  UpgradedText result = upgraded(text, describes_mechanism(document) ? TextKind::mechanism : TextKind::study);
  if (result.replaced.empty()) return result;
  try {
    parse_toml(result.text, file_name, expected);
  } catch (const ConfigError&) {
    const ReplacedKey& first = result.replaced.front();
    throw ConfigError({file_name, first.line, first.old_path},
                      "the table also has the key under its present name " + first.name + "; remove one of them");
  }
  return result;
}

}  // namespace pkm
