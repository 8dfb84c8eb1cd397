#include "experiments/app/print.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "engine/core/printable.hpp"

namespace pkm {

namespace {

std::optional<int> chosen_digits;  // value of --digits

/// Text of a number with this number of significant digits.
std::string format_digits(double value, int count) {
  if (std::isnan(value)) return "-";
  if (value == 0) return "0";  // also for -0
  if (count >= kFullDigits) return shortest(value);
  constexpr double kLargestWithoutExponent = 1e7;
  const double size = std::fabs(value);
  if (size >= std::pow(10, count) && size < kLargestWithoutExponent) return formatted("%.0f", value);
  return formatted(("%." + std::to_string(count) + "g").c_str(), value);
}

}  // namespace

void use_digits(int count) { chosen_digits = count; }

int significant_digits(int known) { return chosen_digits.value_or(std::min(kDefaultDigits, known)); }

DisplayUnit result_unit(std::string_view si_unit, double magnitude) {
  if (si_unit == "rad") return {1, "rad"};
  return display_unit(si_unit, magnitude);
}

std::string digits(double value, int least) { return format_digits(value, std::max(significant_digits(), least)); }

std::string signed_digits(double value) { return (value > 0 ? "+" : "") + digits(value); }

std::string in_unit(double value, const DisplayUnit& unit, int known) {
  if (std::isnan(value)) return "not computed";
  return with_name(format_digits(value / unit.size, significant_digits(known)), unit);
}

std::string number(double value, std::string_view unit, int known) {
  return in_unit(value, display_unit(unit, value), known);
}

std::string directed_digits(double value, int count, int direction) {
  if (count >= kFullDigits || value == 0) return format_digits(value, count);
  const double digit = std::pow(10, std::floor(std::log10(std::fabs(value))) + 1 - count);
  const auto text_of = [&](double multiple) { return format_digits(multiple * digit, count); };
  const double multiple = direction < 0 ? std::floor(value / digit) : std::ceil(value / digit);
  const std::string text = text_of(multiple);
  // Rounding of the quotient value / digit can give the wrong integer, so that the text lies on the wrong side of the
  // value.
  return (std::stod(text) - value) * direction >= 0 ? text : text_of(multiple + direction);
}

std::array<std::string, 2> bounds_text(double lower, double upper, std::string_view unit) {
  const DisplayUnit shown = display_unit(unit, upper);
  const double gap = std::clamp((upper - lower) / std::fabs(upper), 1e-15, 1.0);
  const int count = std::max(significant_digits(), 2 - static_cast<int>(std::floor(std::log10(gap))));
  return {with_name(directed_digits(lower / shown.size, count, -1), shown),
          with_name(directed_digits(upper / shown.size, count, 1), shown)};
}

std::string range_text(double lower, double upper, std::string_view unit) {
  const DisplayUnit shown = display_unit(unit, std::fmax(std::fabs(lower), std::fabs(upper)));
  return with_name(digits(lower / shown.size) + " .. " + digits(upper / shown.size), shown);
}

int known_digits_of_voxels(std::int64_t feasible_cells, std::size_t dimensions) {
  const double d = static_cast<double>(dimensions),
               digits = (d + 1) / (2 * d) * std::log10(static_cast<double>(std::max<std::int64_t>(1, feasible_cells)));
  return 1 + static_cast<int>(digits);
}

std::string measure_name(std::size_t swept) { return swept == 1 ? "length" : swept == 2 ? "area" : "volume"; }

void print_json(const Json& json) {
  // Names and file names may contain bytes that are not UTF-8, which JSON forbids and which are therefore replaced. If
  // strings contain control characters that JSON permits, all characters outside ASCII are escaped.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
  const bool plain = printable(text, "\n") == text;
  std::cout << (plain ? text : json.dump(2, ' ', true, Json::error_handler_t::replace)) << '\n';
}

void Printout::add(const std::string& name, const Json& value, const std::string& words) {
  json[name] = value;
  head.push_back({name, words});
}

void Printout::add_table(const std::string& title, const std::vector<Row>& rows) {
  if (!rows.empty()) text += '\n' + title + '\n' + aligned(rows);
}

void Printout::print() const {
  if (as_json && !json_lines.empty()) {
    for (const Json& line : json_lines) std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else if (as_json) {
    print_json(json);
  } else {
    std::cout << aligned(head) << text;
  }
}

Json values_by_name(const std::vector<std::pair<std::string, double>>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

Json to_json(const OptionValue& value) {
  const auto convert = [](const auto& item) {
    if constexpr (std::is_same_v<std::decay_t<decltype(item)>, NamedSettings>) {
      Json json = Json::object();
      for (const auto& [name, setting] : item) json[name] = std::visit([](const auto& v) { return Json(v); }, setting);
      return json;
    } else {
      return Json(item);
    }
  };
  return std::visit(convert, value);
}

}  // namespace pkm
