#include "engine/config/motor_table.hpp"

#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/text_file.hpp"
#include "engine/config/toml.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

namespace {

std::vector<TorqueAtSpeed> read_curve(const ConfigValue& list, const Motor& motor) {
  std::vector<TorqueAtSpeed> curve;
  for (const ConfigValue& each : list.elements()) {
    const ConfigValue point = each.table();
    const ConfigValue speed = point.at("speed"), torque = point.at("torque");
    if (!curve.empty() && !(speed.number() > curve.back().speed))
      throw speed.error("more than that of the previous point, " + with_unit(curve.back().speed, "rad/s"));
    if (torque.number() > motor.peak_torque)
      throw torque.error("at most peak_torque = " + with_unit(motor.peak_torque, "N m"));
    curve.push_back({speed.number(), torque.number()});
  }
  if (curve.size() < 2) throw list.error("at least two points");
  return curve;
}

}  // namespace

std::vector<Motor> read_motors(const ConfigValue& root) {
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
    if (const auto curve = table.find("curve")) motors.back().curve = read_curve(*curve, motors.back());
  }
  return motors;
}

std::vector<Motor> load_motors_toml(const std::string& path) {
  const TomlValue document = parse_toml(read_text_file(path, "motors in TOML"), path, "motors in TOML");
  std::vector<Motor> motors = read_motors(ConfigValue(document, path, "").described_by(motor_file_keys()));
  if (motors.empty()) throw ConfigError({path, 0, ""}, "no [[motor]]", "motors in TOML: [[motor]] with name, ..");
  return motors;
}

}  // namespace pkm
