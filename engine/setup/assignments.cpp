#include "engine/setup/assignments.hpp"

#include <algorithm>
#include <charconv>
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

/// What stands after `name=` in comma-separated lists, in the order of `known`.
std::vector<std::optional<std::string>> assigned_texts(const std::vector<std::string>& lists, const SourcePlace& place,
                                                       const std::string& form, const std::vector<Assignable>& known) {
  const auto names = names_of(known);
  std::vector<std::optional<std::string>> texts(known.size());
  for (const auto& list : lists) {
    std::string_view rest = list;
    for (bool more = true; more;) {
      const auto comma = rest.find(',');
      more = comma != std::string_view::npos;
      const std::string_view item = rest.substr(0, comma);
      if (more) rest.remove_prefix(comma + 1);
      const auto equals = item.find('=');
      if (equals == std::string_view::npos)
        throw ConfigError(place, '"' + trimmed(item) + '"', form + ", with names out of " + join(names));
      const std::string name = trimmed(item.substr(0, equals));
      const auto target = std::find(names.begin(), names.end(), name);
      if (target == names.end())
        throw ConfigError(place, "the unknown name '" + name + "'", "one of " + join(names), nearest_name(name, names));
      const auto i = static_cast<std::size_t>(target - names.begin());
      if (texts[i]) throw ConfigError(place, name + " twice", "each name once");
      texts[i] = trimmed(item.substr(equals + 1));
    }
  }
  return texts;
}

/// Throws for the names of `known` that have no text.
void expect_all(const std::vector<std::optional<std::string>>& texts, const SourcePlace& place,
                const std::vector<Assignable>& known) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!texts[i]) missing.push_back(known[i].name);
  if (!missing.empty())
    throw ConfigError(place, "no value for " + join(missing), "values for " + join(names_of(known)));
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t to = text.find(at); to != std::string::npos; to = text.find(at, from)) {
    parts.push_back(trimmed(std::string_view(text).substr(from, to - from)));
    from = to + 1;
  }
  parts.push_back(trimmed(std::string_view(text).substr(from)));
  return parts;
}

}  // namespace

std::vector<Assignable> assignable_parameters(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const auto& p : info.parameters) known.push_back({p.name, p.unit, p.lower, p.upper});
  return known;
}

std::vector<Assignable> assignable_coordinates(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const AxisInfo& coordinate : info.coordinates) known.push_back({coordinate.name, coordinate.unit});
  return known;
}

std::vector<Assignable> assignable_joints(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const auto& joint : info.joints) known.push_back({joint.name, joint.unit});
  return known;
}

std::vector<Assignable> assignable_rates(const Mechanism& mechanism, const std::string& per) {
  std::vector<Assignable> known;
  for (const AxisInfo& axis : mechanism.info().coordinates) known.push_back({axis.name, axis.unit + "/" + per});
  if (const AuxiliaryChain* const chain = mechanism.chain()) known.push_back({chain->input(), "rad/" + per});
  return known;
}

std::vector<Assignable> assignable_joint_rates(const MechanismInfo& info, const std::string& per) {
  std::vector<Assignable> known;
  for (const AxisInfo& joint : info.joints) known.push_back({joint.name, joint.unit + "/" + per});
  return known;
}

std::vector<Assignable> assignable_forces(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const AxisInfo& joint : info.joints) known.push_back({joint.name, joint.turns() ? "N m" : "N"});
  return known;
}

std::vector<Assignable> assignable_wrench() {
  std::vector<Assignable> known;
  for (const auto& name : wrench_names()) known.push_back({name, name[0] == 'F' ? "N" : "N m"});
  return known;
}

double parse_number(const std::string& text, const std::string& option, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const std::invalid_argument&) {
    throw ConfigError({"", 0, option}, text, quantity_hint(unit));
  }
}

std::vector<std::optional<double>> parse_assignments(const std::vector<std::string>& lists, const std::string& option,
                                                     const std::vector<Assignable>& known) {
  std::vector<std::optional<double>> values(known.size());
  const SourcePlace place{"", 0, option};
  const auto texts = assigned_texts(lists, place, "name=value", known);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (texts[i]) values[i] = parse_value(*texts[i], place, known[i]);
  return values;
}

std::vector<double> parse_all_assignments(const std::vector<std::string>& lists, const std::string& option,
                                          const std::vector<Assignable>& known) {
  const SourcePlace place{"", 0, option};
  const auto texts = assigned_texts(lists, place, "name=value", known);
  std::vector<double> values;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (texts[i]) values.push_back(parse_value(*texts[i], place, known[i]));
  expect_all(texts, place, known);
  return values;
}

std::vector<double> parse_some_assignments(const std::vector<std::string>& lists, const std::string& option,
                                           const std::vector<Assignable>& known) {
  std::vector<double> values;
  for (const auto& value : parse_assignments(lists, option, known)) values.push_back(value.value_or(0));
  return values;
}

Wrench<double> parse_wrench(const std::vector<std::string>& lists) {
  const std::vector<double> values = parse_some_assignments(lists, "--wrench", assignable_wrench());
  Wrench<double> wrench;
  std::copy(values.begin(), values.end(), wrench.m.begin());
  return wrench;
}

std::vector<double> parse_values(const std::string& text, const std::string& option, const Assignable& what) {
  constexpr int kMostValues = 10000;
  const SourcePlace place{"", 0, option};
  std::vector<double> values;
  const auto ends = split(text, ':');
  if (ends.size() == 1) {
    for (const std::string& value : split(text, ',')) values.push_back(parse_value(value, place, what));
    return values;
  }
  const std::string form = "values 'a,b,..' or 'from:to:count' with a count of 2 to " + std::to_string(kMostValues);
  if (ends.size() != 3) throw ConfigError(place, '"' + text + '"', form);
  const double from = parse_value(ends[0], place, what), to = parse_value(ends[1], place, what);
  int count = 0;
  const char* const end = ends[2].data() + ends[2].size();
  const auto [stop, error] = std::from_chars(ends[2].data(), end, count);
  if (error != std::errc() || stop != end || count < 2 || count > kMostValues)
    throw ConfigError(place, '"' + text + '"', form);
  for (int k = 0; k < count; ++k) values.push_back(k == count - 1 ? to : from + (to - from) * k / (count - 1));
  return values;
}

std::vector<std::array<double, 2>> parse_ranges(const std::vector<std::string>& lists, const std::string& option,
                                                const std::vector<Assignable>& known) {
  const SourcePlace place{"", 0, option};
  const auto texts = assigned_texts(lists, place, "name=from:to", known);
  expect_all(texts, place, known);
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto ends = split(*texts[i], ':');
    if (ends.size() != 2) throw ConfigError(place, known[i].name + "=" + *texts[i], "name=from:to");
    ranges.push_back({parse_value(ends[0], place, known[i]), parse_value(ends[1], place, known[i])});
    if (!(ranges.back()[0] < ranges.back()[1]))
      throw ConfigError(place, known[i].name + "=" + *texts[i], "a range whose first end is the lower one");
  }
  return ranges;
}

}  // namespace pkm
