#include "engine/config/motor_table.hpp"

#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/text_file.hpp"
#include "engine/config/toml.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

std::vector<Motor> load_motors_toml(const std::string& path) {
  const TomlValue document = parse_toml(read_text_file(path, "motors in TOML"), path, "motors in TOML");
  const ConfigValue root = ConfigValue(document, path, "").described_by(motor_file_keys());
  std::vector<Motor> motors;
  for (const ConfigValue& table : root.tables("motor")) {
    const double continuous = table.number_at("continuous_torque");
    const ConfigValue peak = table.at("peak_torque");
    if (peak.number() < continuous) throw peak.error("at least continuous_torque = " + with_unit(continuous, "N m"));
    motors.push_back({.name = new_name(table, "motor", motors, "the motor's name"),
                      .continuous_torque = continuous,
                      .peak_torque = peak.number(),
                      .speed = table.number_at("speed"),
                      .rotor = table.number_at("rotor_inertia")});
  }
  if (motors.empty()) throw ConfigError({path, 0, ""}, "no [[motor]]", "motors in TOML: [[motor]] with name, ..");
  return motors;
}

}  // namespace pkm
