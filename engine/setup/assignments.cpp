#include "engine/setup/assignments.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/setup/config_value.hpp"

namespace pkm {
namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

double parse_value(const std::string& text, const SourcePlace& place, const Assignable& target) {
  const std::string found = target.name + "=" + text;
  double value = 0;
  try {
    value = parse_quantity(text, target.unit);
  } catch (const std::invalid_argument&) {
    throw ConfigError(place, found, quantity_hint(target.unit));
  }
  if (!(value >= target.lower && value <= target.upper))
    throw ConfigError(place, found, range_text("a number", target.lower, target.upper, target.unit));
  return value;
}

}  // namespace

std::vector<Assignable> assignable_parameters(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const auto& p : info.parameters) known.push_back({p.name, p.unit, p.lower, p.upper});
  return known;
}

std::vector<Assignable> assignable_coordinates(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (std::size_t i = 0; i < info.coordinates.size(); ++i)
    known.push_back({info.coordinates[i], i == 3 ? "rad" : "m"});  // x, y, z, rotation
  return known;
}

std::vector<Assignable> assignable_joints(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const auto& joint : info.joints) known.push_back({joint, "m"});
  return known;
}

std::vector<std::optional<double>> parse_assignments(const std::vector<std::string>& lists, const std::string& option,
                                                     const std::vector<Assignable>& known) {
  const SourcePlace place{"", 0, option};
  const auto names = names_of(known);
  std::vector<std::optional<double>> values(known.size());
  for (const auto& list : lists) {
    std::string_view rest = list;
    for (bool more = true; more;) {
      const auto comma = rest.find(',');
      more = comma != std::string_view::npos;
      const std::string_view item = rest.substr(0, comma);
      if (more) rest.remove_prefix(comma + 1);
      const auto equals = item.find('=');
      if (equals == std::string_view::npos)
        throw ConfigError(place, '"' + trimmed(item) + '"', "name=value, with names out of " + join(names));
      const std::string name = trimmed(item.substr(0, equals));
      const auto target = std::find(names.begin(), names.end(), name);
      if (target == names.end())
        throw ConfigError(place, "the unknown name '" + name + "'", "one of " + join(names), nearest_name(name, names));
      const auto i = static_cast<std::size_t>(target - names.begin());
      if (values[i]) throw ConfigError(place, name + " twice", "each name once");
      values[i] = parse_value(trimmed(item.substr(equals + 1)), place, known[i]);
    }
  }
  return values;
}

std::vector<double> parse_all_assignments(const std::vector<std::string>& lists, const std::string& option,
                                          const std::vector<Assignable>& known) {
  const auto given = parse_assignments(lists, option, known);
  std::vector<std::string> missing;
  std::vector<double> values;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!given[i]) missing.push_back(known[i].name);
    values.push_back(given[i].value_or(0));
  }
  if (!missing.empty())
    throw ConfigError({"", 0, option}, "no value for " + join(missing), "values for " + join(names_of(known)));
  return values;
}

}  // namespace pkm
