#include "engine/config/motor_table.hpp"

#include "engine/config/sections.hpp"
#include "engine/config/text_file.hpp"
#include "engine/config/toml.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

std::vector<Motor> load_motors_toml(const std::string& path) {
  const TomlValue document = parse_toml(read_text_file(path, "motors in TOML"), path, "motors in TOML");
  const ConfigValue root(document, path, "");
  root.allow({"motor"});
  std::vector<Motor> motors;
  for (const ConfigValue& table : tables_of(root, "motor")) {
    table.allow({"name", "continuous_torque", "peak_torque", "speed", "rotor_inertia"});
    const double continuous = table.at("continuous_torque", "the torque that it can hold").positive("N m");
    const ConfigValue peak = table.at("peak_torque", "the torque of short times");
    if (peak.positive("N m") < continuous)
      throw peak.error("at least continuous_torque = " + with_unit(continuous, "N m"));
    motors.push_back({.name = new_name(table, "motor", motors, "the motor's name"),
                      .continuous_torque = continuous,
                      .peak_torque = peak.positive("N m"),
                      .speed = table.at("speed", "the greatest speed").positive("rad/s"),
                      .rotor = table.at("rotor_inertia", "the rotor's inertia").number("kg m^2", 0)});
  }
  if (motors.empty()) throw ConfigError({path, 0, ""}, "no [[motor]]", "motors in TOML: [[motor]] with name, ..");
  return motors;
}

}  // namespace pkm
