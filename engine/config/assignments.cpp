#include "engine/config/assignments.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/config/config_value.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

SourceLocation place_of(const std::string& option) { return {"", 0, option}; }

/// Parses one value of an option. @param target  the quantity that receives the value; its name is empty if the option
/// has a single value
double parse_value(const std::string& text, const std::string& option, const Assignable& target) {
  const std::string found = target.name.empty() ? text : target.name + "=" + text;
  const auto value = parse_quantity(text, target.unit);
  if (!value) throw ConfigError(place_of(option), found, quantity_hint(target.unit));
  if (const std::string hint = angle_hint(*value, target.unit); !hint.empty())
    throw ConfigError(place_of(option), found, hint);
  if (!(*value >= target.lower && *value <= target.upper))
    throw ConfigError(place_of(option), found, range_text("a number", target.lower, target.upper, target.unit));
  return *value;
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (auto end = text.find(at); end != std::string_view::npos; end = text.find(at)) {
    parts.emplace_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  parts.emplace_back(trimmed(text));
  return parts;
}

}  // namespace

std::vector<std::string> list_items(const std::vector<std::string>& lists) {
  std::vector<std::string> items;
  for (const std::string& list : lists) std::ranges::move(split(list, ','), std::back_inserter(items));
  return items;
}

namespace {

/// The texts after `name=` in comma-separated lists, in the order of `known`; std::nullopt for names that are not
/// given.
std::vector<std::optional<std::string>> assigned_texts(const std::vector<std::string>& lists, const std::string& option,
                                                       const std::string& form, const std::vector<Assignable>& known) {
  const SourceLocation place = place_of(option);
  const auto names = names_of(known);
  std::vector<std::optional<std::string>> texts(known.size());
  for (const std::string& item : list_items(lists)) {
    const auto equals = item.find('=');
    if (equals == std::string::npos)
      throw ConfigError(place, '"' + item + '"', form + ", with names out of " + join(names));
    const std::string name{trimmed(std::string_view(item).substr(0, equals))};
    const Assignable* const target = find_named(known, name);
    if (!target && known.empty())
      throw ConfigError(place, "the unknown name '" + name + "'", "no name, because there is nothing to assign");
    if (!target)
      throw ConfigError(place, "the unknown name '" + name + "'", "one of " + join(names), nearest_name(name, names));
    auto& text = texts[static_cast<std::size_t>(target - known.data())];
    if (text) throw ConfigError(place, name + " twice", "each name once");
    text = trimmed(std::string_view(item).substr(equals + 1));
  }
  return texts;
}

/// Throws ConfigError if a name of `known` has no value.
template <class T>
void expect_all(const std::vector<std::optional<T>>& given, const std::string& option,
                const std::vector<Assignable>& known) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!given[i]) missing.push_back(known[i].name);
  if (!missing.empty())
    throw ConfigError(place_of(option), "no value for " + join(missing), "values for " + join(names_of(known)));
}

}  // namespace

std::vector<Assignable> assignable_parameters(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const auto& p : info.parameters) known.push_back({p.name, p.unit, p.lower, p.upper});
  return known;
}

std::vector<Assignable> assignable_limits(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const LimitInfo& limit : info.limits) known.push_back({limit.name, limit.unit, limit.lower, limit.upper});
  return known;
}

std::vector<Assignable> assignable_axes(const std::vector<AxisInfo>& axes, const std::string& per) {
  std::vector<Assignable> known;
  for (const AxisInfo& axis : axes) known.push_back({axis.name, per.empty() ? axis.unit : axis.unit + "/" + per});
  return known;
}

std::vector<Assignable> assignable_rates(const Mechanism& mechanism, const std::string& per) {
  std::vector<Assignable> known = assignable_axes(mechanism.info().coordinates, per);
  for (const InputInfo& input : mechanism.info().inputs)
    known.push_back({input.name, (input.unit == "1" ? "1/" : input.unit + "/") + per});
  return known;
}

std::vector<Assignable> assignable_forces(const MechanismInfo& info) {
  std::vector<Assignable> known;
  for (const AxisInfo& joint : info.joints) known.push_back({joint.name, joint.turns() ? "N m" : "N"});
  return known;
}

std::vector<std::string> assigned_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& item : list_items(lists)) names.emplace_back(trimmed(item.substr(0, item.find('='))));
  return names;
}

double parse_number(const std::string& text, const std::string& option, const std::string& unit) {
  return parse_value(text, option, {"", unit});
}

std::vector<std::optional<double>> parse_assignments(const std::vector<std::string>& lists, const std::string& option,
                                                     const std::vector<Assignable>& known) {
  std::vector<std::optional<double>> values(known.size());
  const auto texts = assigned_texts(lists, option, "name=value", known);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (texts[i]) values[i] = parse_value(*texts[i], option, known[i]);
  return values;
}

std::vector<double> parse_all_assignments(const std::vector<std::string>& lists, const std::string& option,
                                          const std::vector<Assignable>& known) {
  const auto given = parse_assignments(lists, option, known);
  expect_all(given, option, known);
  std::vector<double> values;
  for (const auto& value : given) values.push_back(*value);
  return values;
}

std::vector<double> parse_some_assignments(const std::vector<std::string>& lists, const std::string& option,
                                           const std::vector<Assignable>& known) {
  std::vector<double> values;
  for (const auto& value : parse_assignments(lists, option, known)) values.push_back(value.value_or(0));
  return values;
}

Wrench<double> parse_wrench(const std::vector<std::string>& lists) {
  std::vector<Assignable> known;
  for (const auto& name : wrench_names()) known.push_back({name, name[0] == 'F' ? "N" : "N m"});
  Wrench<double> wrench;
  std::ranges::copy(parse_some_assignments(lists, "--wrench", known), wrench.m.begin());
  return wrench;
}

std::vector<double> parse_values(const std::string& text, const std::string& option, const Assignable& what) {
  constexpr int kMostValues = 10000;
  std::vector<double> values;
  const auto ends = split(text, ':');
  if (ends.size() == 1) {
    for (const std::string& value : split(text, ',')) values.push_back(parse_value(value, option, what));
    return values;
  }
  const ConfigError wrong_form(
      place_of(option), '"' + text + '"',
      "values 'a,b,..' or 'from:to:count' with a count of 2 to " + std::to_string(kMostValues));
  if (ends.size() != 3) throw wrong_form;
  const double from = parse_value(ends[0], option, what), to = parse_value(ends[1], option, what);
  const std::int64_t count = parse_integer(ends[2]).value_or(0);
  if (count < 2 || count > kMostValues) throw wrong_form;
  for (std::int64_t k = 0; k < count; ++k)
    values.push_back(k == count - 1 ? to
                                    : from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1));
  return values;
}

std::vector<std::int64_t> parse_cells(const std::vector<std::string>& lists, const std::vector<std::string>& names) {
  const std::string option = "--cells";
  constexpr std::int64_t kMaxCells = 1'000'000;  // maximum number of cells along one coordinate
  std::vector<std::string> all = lists;
  if (lists.size() == 1 && lists[0].find('=') == std::string::npos) {
    all.clear();
    for (const std::string& name : names) all.push_back(name + "=" + lists[0]);
  }
  std::vector<Assignable> known;
  for (const std::string& name : names) known.push_back({name, "1"});
  const auto texts = assigned_texts(all, option, "one number of cells, or name=cells", known);
  expect_all(texts, option, known);
  std::vector<std::int64_t> cells;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto number = parse_integer(*texts[i]);
    if (!number || *number < 1 || *number > kMaxCells)
      throw ConfigError(place_of(option), known[i].name + "=" + *texts[i],
                        "a whole number of cells, 1 to " + std::to_string(kMaxCells));
    cells.push_back(*number);
  }
  return cells;
}

std::vector<std::optional<std::array<double, 2>>> parse_some_ranges(const std::vector<std::string>& lists,
                                                                    const std::string& option,
                                                                    const std::vector<Assignable>& known) {
  const auto texts = assigned_texts(lists, option, "name=from:to", known);
  std::vector<std::optional<std::array<double, 2>>> ranges(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!texts[i]) continue;
    std::string text = *texts[i];
    // Ranges are also accepted as FROM..TO, the form in which they are printed.
    if (const auto dots = text.find(".."); dots != std::string::npos) text.replace(dots, 2, ":");
    const auto ends = split(text, ':');
    const std::string found = known[i].name + "=" + *texts[i];
    if (ends.size() != 2) throw ConfigError(place_of(option), found, "name=from:to");
    const std::array range = {parse_value(ends[0], option, known[i]), parse_value(ends[1], option, known[i])};
    if (!(range[0] < range[1])) throw ConfigError(place_of(option), found, "a range from:to with from < to");
    ranges[i] = range;
  }
  return ranges;
}

std::vector<std::array<double, 2>> parse_ranges(const std::vector<std::string>& lists, const std::string& option,
                                                const std::vector<Assignable>& known) {
  const auto given = parse_some_ranges(lists, option, known);
  expect_all(given, option, known);
  std::vector<std::array<double, 2>> ranges;
  for (const auto& range : given) ranges.push_back(*range);
  return ranges;
}

}  // namespace pkm
