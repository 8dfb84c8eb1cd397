#include "engine/config/study_additions.hpp"

#include "engine/config/assignments.hpp"
#include "engine/config/config_value.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

constexpr const char* kJointError = "--joint-error";

}  // namespace

StudyAdditions study_additions(const TomlValue& study, const std::string& file_name) {
  struct Document {
    TomlValue toml;
    ConfigValue root;
  };
  const auto document = std::make_shared<Document>(Document{study, ConfigValue(study, file_name, "")});
  document->root = ConfigValue(document->toml, file_name, "").described_by(study_keys());
  return {document, &document->root};
}

std::vector<double> parse_joint_errors(const MechanismInfo& info, const std::vector<std::string>& lists) {
  std::vector<double> errors;
  if (lists.size() == 1 && lists[0].find('=') == std::string::npos)
    for (const AxisInfo& joint : info.joints) errors.push_back(parse_number(lists[0], kJointError, joint.unit));
  else
    errors = parse_some_assignments(lists, kJointError, assignable_axes(info.joints));
  for (const double error : errors)
    if (error < 0) throw ConfigError({"", 0, kJointError}, shortest(error), "an error >= 0");
  return errors;
}

StudyAdditions joint_error_addition(const MechanismInfo& info, const std::vector<std::string>& lists) {
  const std::vector<double> errors = parse_joint_errors(info, lists);
  std::string values;
  for (std::size_t i = 0; i < errors.size(); ++i)
    values += (i ? ", " : "") + info.joints[i].name + " = " + shortest(errors[i]);
  return study_additions(parse_toml("[accuracy]\njoint_error = { " + values + " }\n", kJointError), kJointError);
}

}  // namespace pkm
