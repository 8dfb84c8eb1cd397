#include "engine/core/display_unit.hpp"

#include <cmath>
#include <numbers>

#include "engine/core/formatted.hpp"

namespace pkm {
namespace {

/// A unit in which people read values of the SI unit `si_unit`. For one SI unit, units are listed in decreasing order
/// of `from`.
struct UnitChoice {
  std::string_view si_unit;
  double from;  ///< smallest magnitude [SI] for which this unit is used
  double size;
  std::string_view name;
};
constexpr UnitChoice kUnitChoices[] = {
    {"m", 10, 1, "m"},
    {"m", 1e-4, 1e-3, "mm"},
    {"m", 1e-9, 1e-6, "um"},
    {"s", 1, 1, "s"},
    {"s", 1e-3, 1e-3, "ms"},
    {"s", 1e-6, 1e-6, "us"},
    {"m^2", 1e-3, 1, "m^2"},
    {"m^2", 1e-9, 1e-6, "mm^2"},
    {"m^3", 1e-3, 1, "m^3"},
    {"m^3", 1e-6, 1e-6, "cm^3"},
    {"m^3", 1e-12, 1e-9, "mm^3"},
    {"m rad", 1e-3, 1, "m rad"},
    {"m rad", 1e-6, 1e-3, "mm rad"},
    {"m^2 rad", 1e-3, 1, "m^2 rad"},
    {"m^2 rad", 1e-9, 1e-6, "mm^2 rad"},
    {"kg", 1e-2, 1, "kg"},
    {"kg", 1e-6, 1e-3, "g"},
    {"N", 1e4, 1e3, "kN"},
    {"W", 1e4, 1e3, "kW"},
    {"N/m", 1e3, 1e3, "N/mm"},
    {"Pa", 1e9, 1e9, "GPa"},
    {"Pa", 1e5, 1e6, "MPa"},
};

/// Text of a number in a unit. Twelve digits drop the rounding error of the conversion.
std::string text_in(const DisplayUnit& unit, double value) { return formatted("%.12g", value / unit.size); }

}  // namespace

DisplayUnit display_unit(std::string_view si_unit) {
  if (si_unit == "m") return {1e-3, "mm"};
  if (si_unit == "rad") return {std::numbers::pi / 180, "deg"};
  return {1, std::string(si_unit)};
}

DisplayUnit display_unit(std::string_view si_unit, double magnitude) {
  for (const UnitChoice& choice : kUnitChoices)
    if (choice.si_unit == si_unit && std::fabs(magnitude) >= choice.from)
      return {choice.size, std::string(choice.name)};
  return display_unit(si_unit);
}

std::string with_name(const std::string& text, const DisplayUnit& unit) {
  return unit.name.empty() || unit.name == "1" ? text : text + " " + unit.name;
}

std::string display_text(double value, std::string_view si_unit) {
  const DisplayUnit unit = display_unit(si_unit);
  return with_name(text_in(unit, value), unit);
}

std::string display_range(double lower, double upper, std::string_view si_unit) {
  return text_in(display_unit(si_unit), lower) + " .. " + display_text(upper, si_unit);
}

}  // namespace pkm
