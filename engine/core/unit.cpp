#include "engine/core/unit.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "engine/core/catalogue.hpp"
#include "engine/core/options.hpp"

namespace pkm {
namespace {

constexpr double kPi = 3.141592653589793238462643383279502884;

using Dimension = std::array<int, 4>;  // exponents of the base units m, kg, s, rad

/// A unit. A number in this unit is converted to SI by multiplying it by `multiply` and dividing it by `divide`.
struct Unit {
  Dimension dimension{};
  double multiply = 1;
  double divide = 1;
};

struct Symbol {
  std::string_view name;
  Unit unit;
};

constexpr Dimension kNone{0, 0, 0, 0}, kLength{1, 0, 0, 0}, kMass{0, 1, 0, 0}, kTime{0, 0, 1, 0}, kAngle{0, 0, 0, 1},
    kForce{1, 1, -2, 0}, kEnergy{2, 1, -2, 0}, kPower{2, 1, -3, 0}, kAngularSpeed{0, 0, -1, 1}, kPressure{-1, 1, -2, 0},
    kFrequency{0, 0, -1, 0}, kSolidAngle{0, 0, 0, 2};

constexpr Symbol kSymbols[] = {
    {"%", {kNone, 1, 100}},
    {"um", {kLength, 1, 1e6}},
    {"mm", {kLength, 1, 1e3}},
    {"cm", {kLength, 1, 100}},
    {"dm", {kLength, 1, 10}},
    {"m", {kLength, 1, 1}},
    {"km", {kLength, 1e3, 1}},
    {"in", {kLength, 254, 1e4}},
    {"inch", {kLength, 254, 1e4}},
    {"ft", {kLength, 3048, 1e4}},
    {"mrad", {kAngle, 1, 1e3}},
    {"rad", {kAngle, 1, 1}},
    {"deg", {kAngle, kPi, 180}},
    {"\u00b0", {kAngle, kPi, 180}},
    {"us", {kTime, 1, 1e6}},
    {"ms", {kTime, 1, 1e3}},
    {"s", {kTime, 1, 1}},
    {"min", {kTime, 60, 1}},
    {"h", {kTime, 3600, 1}},
    {"g", {kMass, 1, 1e3}},
    {"kg", {kMass, 1, 1}},
    {"t", {kMass, 1e3, 1}},
    {"mN", {kForce, 1, 1e3}},
    {"N", {kForce, 1, 1}},
    {"kN", {kForce, 1e3, 1}},
    {"J", {kEnergy, 1, 1}},
    {"W", {kPower, 1, 1}},
    {"kW", {kPower, 1e3, 1}},
    {"rpm", {kAngularSpeed, kPi, 30}},
    {"Pa", {kPressure, 1, 1}},
    {"MPa", {kPressure, 1e6, 1}},
    {"GPa", {kPressure, 1e9, 1}},
    {"Hz", {kFrequency, 1, 1}},
    {"sr", {kSolidAngle, 1, 1}},
};

/// Returns true if a byte may be part of a unit symbol. This includes all bytes of non-ASCII characters, such as the
/// degree sign.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}

/// Parses a product of units such as "kg m^2/s" and calls visit(symbol, power) for each factor.
/// @return false if the text is not a product of known units
template <class Visit>
bool read_unit(std::string_view text, Visit visit) {
  int sign = 1;
  bool need_factor = true;
  while (true) {
    text = trimmed(text);
    if (text.empty()) return !need_factor;
    if (!need_factor && (text[0] == '/' || text[0] == '*')) {
      sign = text[0] == '/' ? -1 : 1;
      need_factor = true;
      text.remove_prefix(1);
      continue;
    }
    if (text[0] == '1') {  // a unit that begins with 1: "1" or "1/s"
      text.remove_prefix(1);
    } else {
      std::size_t length = 0;
      while (length < text.size() && is_letter(text[length])) ++length;
      const Symbol* symbol = find_named(kSymbols, text.substr(0, length));
      if (!symbol) return false;
      text.remove_prefix(length);
      int power = 1;
      if (!text.empty() && text[0] == '^') {
        const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), power);
        if (error != std::errc{} || power == 0 || std::abs(power) > 9) return false;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
      }
      visit(*symbol, sign * power);
    }
    sign = 1;
    need_factor = false;
  }
}

std::optional<Unit> unit_of(std::string_view text) {
  Unit product;
  const bool known = read_unit(text, [&product](const Symbol& symbol, int power) {
    for (std::size_t i = 0; i < product.dimension.size(); ++i) product.dimension[i] += power * symbol.unit.dimension[i];
    for (int k = 0; k < std::abs(power); ++k) {
      (power > 0 ? product.multiply : product.divide) *= symbol.unit.multiply;
      (power > 0 ? product.divide : product.multiply) *= symbol.unit.divide;
    }
  });
  return known ? std::optional(product) : std::nullopt;
}

/// Splits a text into a finite number and the rest of the text without leading and trailing blanks; std::nullopt if the
/// text does not begin with a number.
std::optional<std::pair<double, std::string_view>> split_quantity(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return {};
  return std::pair(number, trimmed(rest.substr(static_cast<std::size_t>(end - rest.data()))));
}

/// All unit symbols that have the dimension of a factor of `unit`: for "m^2 rad", all units of length followed by all
/// units of angle.
std::vector<std::string> related_units(std::string_view unit) {
  std::vector<std::string> names;
  std::vector<Dimension> listed;
  const auto list = [&](const Dimension& dimension) {
    if (contains(listed, dimension)) return;
    listed.push_back(dimension);
    for (const auto& symbol : kSymbols)
      if (symbol.unit.dimension == dimension) names.emplace_back(symbol.name);
  };
  if (const auto whole = unit_of(unit)) list(whole->dimension);
  read_unit(unit, [&](const Symbol& symbol, int) { list(symbol.unit.dimension); });
  return names;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

bool is_si_unit(std::string_view text) {
  const auto unit = unit_of(text);
  return unit && unit->multiply == unit->divide;
}

std::string quantity_hint(std::string_view unit) {
  if (unit == "1") return "a number, or text such as \"5 %\"";
  return "a number in " + std::string(unit) + ", or text with a unit made of " + join(related_units(unit));
}

std::string kind_of_unit(std::string_view unit) {
  constexpr std::pair<Dimension, const char*> kKinds[] = {{kNone, "a plain number"}, {kLength, "a length"},
                                                          {kMass, "a mass"},         {kTime, "a time"},
                                                          {kAngle, "an angle"},      {kForce, "a force"}};
  const auto known = unit_of(unit);
  for (const auto& [dimension, kind] : kKinds)
    if (known && known->dimension == dimension) return kind;
  return "a quantity in " + std::string(unit);
}

std::string kind_of_quantity(std::string_view text) {
  const auto parts = split_quantity(text);
  return parts && !parts->second.starts_with('1') && unit_of(parts->second) ? kind_of_unit(parts->second) : "";
}

std::string with_unit(double value, std::string_view unit) {
  return unit == "1" || unit.empty() ? shortest(value) : shortest(value) + " " + std::string(unit);
}

std::string angle_hint(double value, std::string_view unit) {
  if (unit != "rad" || std::fabs(value) <= kMaxAngle) return "";
  return "an angle within " + shortest(kMaxAngle) +
         " rad, because larger angles lose digits; subtract whole revolutions";
}

std::string in_degrees(double value, std::string_view unit) {
  if (unit != "rad" || std::isnan(value)) return "";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), " (%.6g deg)", value * 180 / kPi);
  return text.data();
}

std::string with_degrees(double value, std::string_view unit) {
  return with_unit(value, unit) + in_degrees(value, unit);
}

std::string format_range(double lower, double upper, std::string_view unit) {
  return shortest(lower) + in_degrees(lower, unit) + " .. " + with_degrees(upper, unit);
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  const char* const end = text.data() + text.size();
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  const bool padded = digits.starts_with('0') && text != "0";
  return error == std::errc() && stop == end && !padded ? std::optional(number) : std::nullopt;
}

std::optional<double> parse_quantity(std::string_view text, std::string_view unit) {
  const auto parts = split_quantity(text);
  if (!parts) return {};
  const auto& [number, suffix] = *parts;
  if (suffix.empty()) return number;
  const auto written = unit_of(suffix), expected = unit_of(unit);
  PKM_EXPECTS(expected.has_value());
  if (!written || suffix[0] == '1' || !expected || written->dimension != expected->dimension) return {};
  const double value = number * written->multiply / written->divide;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace pkm
