// Parsing and formatting of quantities with units, as users write them: "200 mm", "30deg", "30°", "1e-3 m^2 rad".
//
// The program computes in SI units and radians; other units occur only in input text. A unit is a product of symbols
// with integer powers ("kg m^2", "m/s", "N m"). The conversion is one multiplication and one division of the number, so
// that "35 mm" gives the same bits as 0.035. The angle is a base dimension of its own: "m^2" differs from "m^2 rad".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pkm {

/// Parses a quantity, independently of the locale. A number without a unit is in `unit`.
/// @param unit  SI unit: "m", "rad", "s", "kg", "N", "kg m^2", ... or "1"
/// @return its value in `unit`; std::nullopt if `text` is not a finite number, or has another dimension, an unknown
/// unit or further text. quantity_hint() describes what is expected.
std::optional<double> parse_quantity(std::string_view text, std::string_view unit);

/// Describes the dimension of a text with a number and a unit: "an angle", "a length", or "a quantity in kg/m".
/// @return "" for any other text, including numbers without a unit
std::string kind_of_quantity(std::string_view text);
/// Describes the dimension of a unit in the words of kind_of_quantity(), for example "an angle".
std::string kind_of_unit(std::string_view unit);

/// Maximum magnitude of an angle in the input [rad]. For larger angles, the remainder modulo 2 pi has fewer than 11
/// correct digits in double precision, and the argument reduction of sin and cos is not exact
/// (engine/math/portable.hpp).
inline constexpr double kMaxAngle = 1e5;

/// The allowed range as text for an error message, if `value` is an angle whose magnitude exceeds kMaxAngle; otherwise
/// "".
std::string angle_hint(double value, std::string_view unit);

/// The value in degrees, as text that can follow the number: " (75 deg)". "" if `unit` is not rad, and for NaN.
std::string in_degrees(double value, std::string_view unit);
/// Formats a number with its unit; an angle also in degrees: "1.5 rad (85.9437 deg)", "2 m".
std::string with_degrees(double value, std::string_view unit);
/// Formats a range; angles also in degrees: "0 .. 2 m", "0 (0 deg) .. 1.5 rad (85.9437 deg)".
std::string format_range(double lower, double upper, std::string_view unit);

/// Parses an integer in decimal digits: "-12", "0".
/// @return std::nullopt for any other text, such as "010", "1e3", " 1" or "+1", and for integers that exceed 64 bits
std::optional<std::int64_t> parse_integer(std::string_view text);

/// The text without blanks and tabs at its beginning and end.
std::string_view trimmed(std::string_view text);

/// Returns true if `unit` is a product of known coherent SI units, such as "m", "m^2 rad", "N m/rad" or "1".
bool is_si_unit(std::string_view unit);

/// Describes the valid input for a quantity in `unit`, for messages: "a number in m, or text with a unit made of um,
/// mm, cm, dm, m, km, in".
std::string quantity_hint(std::string_view unit);

/// Formats a number with its unit, for messages and listings: "0.2 m", or "0.5" if the unit is "1".
std::string with_unit(double value, std::string_view unit);

}  // namespace pkm
