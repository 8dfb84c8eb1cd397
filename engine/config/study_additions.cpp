#include "engine/config/study_additions.hpp"

#include <sstream>

#include "engine/config/config_value.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {

StudyAdditions study_additions(const TomlValue& study, const std::string& file_name) {
  struct Document {
    TomlValue toml;
    ConfigValue root;
  };
  const auto document = std::make_shared<Document>(Document{study, ConfigValue(study, file_name, "")});
  document->root = ConfigValue(document->toml, file_name, "").described_by(study_keys());
  return {document, &document->root};
}

StudyAdditions joint_error_addition(const std::vector<std::string>& lists) {
  if (lists.empty()) return nullptr;
  const std::string all = join(lists, ","), option = "--joint-error";
  if (all.find_first_of("\"\\\n") != std::string::npos)
    throw ConfigError({"", 0, option}, all, "errors without quotes");
  std::string value;
  if (all.find('=') == std::string::npos) {
    value = '"' + all + '"';
  } else {
    std::istringstream entries(all);
    for (std::string entry; std::getline(entries, entry, ',');) {
      const std::size_t equals = entry.find('=');
      if (equals == std::string::npos)
        throw ConfigError({"", 0, option}, "'" + entry + "'", "one error for all joints, or NAME=ERROR for each");
      value += (value.empty() ? "{ " : ", ") + entry.substr(0, equals) + " = \"" + entry.substr(equals + 1) + '"';
    }
    value += " }";
  }
  return study_additions(parse_toml("[accuracy]\njoint_error = " + value + '\n', option), option);
}

}  // namespace pkm
