#include "engine/config/swept_coordinates.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/math/portable.hpp"

namespace pkm {
namespace {

/// Writes names as a TOML list, such as ["x", "y"].
std::string quoted_list(const std::vector<std::string>& names) { return "[\"" + join(names, "\", \"") + "\"]"; }

/// Reads the value of a fixed coordinate: "middle", "integrated" or a number.
FixedCoordinate read_fixed(const ConfigValue& value, const MechanismInfo& info, int coordinate, bool integrates) {
  using Kind = FixedCoordinate::Kind;
  const AxisInfo& axis = axis_of(info, coordinate);
  const std::string choices = integrates ? "\"middle\", \"integrated\" or a number in " : "\"middle\" or a number in ";
  const std::string expected = choices + axis.unit;
  if (value.is_text()) {
    const std::string& word = value.text(expected);
    if (word == "middle") return {.coordinate = coordinate};
    if (word == "integrated" && integrates) return {.coordinate = coordinate, .kind = Kind::integrated};
    if (word == "integrated")
      throw value.refusal("the mechanism " + info.name + " cannot integrate its workspace over " + axis.name +
                          "; give " + expected);
  }
  double number = 0;
  try {
    number = value.number(axis.unit);
  } catch (const ConfigError&) {
    const std::string word = value.is_text() ? nearest_name(value.text(""), {"middle", "integrated"}) : "";
    throw value.error(expected, word);
  }
  if (axis.turns() && std::fabs(number) > kPi) throw value.error(angle_expectation(value, number));
  return {.coordinate = coordinate, .kind = Kind::value, .value = number};
}

/// Reads a list of values at which a coordinate is fixed.
FixedCoordinate read_fixed_values(const ConfigValue& list, const MechanismInfo& info, int coordinate, bool integrates) {
  const std::string expected = "a list of values of " + axis_of(info, coordinate).name;
  FixedCoordinate fixed{.coordinate = coordinate, .kind = FixedCoordinate::Kind::listed};
  for (const ConfigValue& value : list.elements(expected))
    fixed.values.push_back(read_fixed(value, info, coordinate, integrates).value);
  if (fixed.values.empty()) throw list.error(expected);
  return fixed;
}

/// Whether a sweep fixes all of the given coordinates.
bool fixes(const Sweep& sweep, const std::vector<int>& coordinates) {
  return std::ranges::all_of(coordinates, [&](int c) { return contains(sweep.fixed, c); });
}

}  // namespace

std::string angle_expectation(const ConfigValue& written, double value) {
  const std::string range = "an angle in [-pi, pi] rad";
  return written.is_text() ? range : range + "; write \"" + shortest(value) + " deg\" for degrees";
}

std::vector<std::string> coordinate_names(const MechanismInfo& info, const std::vector<int>& coordinates) {
  std::vector<std::string> names;
  for (const int coordinate : coordinates) names.push_back(axis_of(info, coordinate).name);
  return names;
}

std::vector<int> fixable(const MechanismInfo& info) {
  std::vector<int> coordinates;
  for (const Sweep& sweep : info.sweeps)
    for (const int coordinate : sweep.fixed)
      if (!contains(coordinates, coordinate)) coordinates.push_back(coordinate);
  return coordinates;
}

void read_sweep(const ConfigValue& list, const MechanismInfo& info, WorkspacePlan& plan) {
  const std::string expected =
      "a list of the swept coordinates, such as " + quoted_list(coordinate_names(info, info.sweeps[0].swept));
  for (const ConfigValue& each : list.elements(expected)) {
    const auto known = names_of(info.coordinates);
    const int coordinate = static_cast<int>(std::ranges::find(known, each.word(known)) - known.begin());
    if (contains(plan.swept, coordinate)) throw each.refusal("this coordinate is swept already");
    plan.swept.push_back(coordinate);
  }
  if (plan.swept.empty()) throw list.error(expected);
  const auto same = [&](const Sweep& sweep) { return std::ranges::is_permutation(sweep.swept, plan.swept); };
  if (std::ranges::any_of(info.sweeps, same)) return;
  std::vector<std::string> offered;
  for (const Sweep& sweep : info.sweeps) offered.push_back(quoted_list(coordinate_names(info, sweep.swept)));
  constexpr std::size_t kMostOffered = 8;
  if (offered.size() > kMostOffered) offered = {"one to three coordinates"};
  throw list.error("coordinates that the mechanism " + info.name + " can sweep together: " + join(offered, " or "));
}

void read_fixed_coordinates(const ConfigValue& table, const MechanismInfo& info, bool of_region, WorkspacePlan& plan) {
  std::vector<int> named;
  for (const int coordinate : fixable(info)) {
    const auto value = table.find(axis_of(info, coordinate).name);
    if (!value) continue;
    named.push_back(coordinate);
    if (contains(plan.swept, coordinate))
      throw value->refusal("the coordinate " + axis_of(info, coordinate).name + " is swept (" +
                           table.find("sweep")->line() + "), so it cannot be fixed");
    if (std::ranges::none_of(info.sweeps, [&](const Sweep& sweep) { return fixes(sweep, named); }))
      throw value->refusal("the analysis fixes one coordinate and sweeps the others, but both " +
                           axis_of(info, named.front()).name + " and " + axis_of(info, coordinate).name + " are given");
    const bool integrates = std::ranges::any_of(
        info.sweeps, [&](const Sweep& sweep) { return sweep.integrates && contains(sweep.fixed, coordinate); });
    plan.fixed.push_back(of_region && value->is_list() ? read_fixed_values(*value, info, coordinate, integrates)
                                                       : read_fixed(*value, info, coordinate, integrates));
  }
}

}  // namespace pkm
