// Quantities with units, as users write them: "200 mm", "30deg", "30°", "0.5", "1e-3 m^2 rad".
//
// The program computes in SI and radians; other units exist only where text comes in. A unit is a product of symbols
// with whole powers ("kg m^2", "m/s", "N m"). The conversion is one multiplication and one division of the number
// written, so that "35 mm" has the same bits as 0.035. Angles count as a dimension of their own: "m^2" is not "m^2
// rad".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pkm {

/// The value of `text` in the SI unit `unit` ("m", "rad", "s", "kg", "N", "kg m^2", ... or "1"). Text without a unit is
/// taken to be in `unit`. Does not depend on the locale. None where `text` is no finite number, has another dimension,
/// an unknown unit or anything behind it: see quantity_hint().
std::optional<double> parse_quantity(std::string_view text, std::string_view unit);

/// What a text is that has a number and a unit: "an angle", "a length", or "a quantity in kg/m"; "" for any other text,
/// also for numbers alone. The same of what is wanted, by its unit: kind_of_unit("rad").
std::string kind_of_quantity(std::string_view text);
std::string kind_of_unit(std::string_view unit);

/// Angles beyond it [rad] are no input: a double holds fewer than 11 digits of what is left of them behind whole turns,
/// and sin and cos are not reduced for them (engine/math/portable.hpp).
inline constexpr double kGreatestAngle = 1e5;

/// Why a number in `unit` is not taken, where it is an angle beyond kGreatestAngle: what is expected. Else "".
std::string angle_hint(double value, std::string_view unit);

/// " (75 deg)" behind a number in rad; "" behind one in another unit, and behind NaN.
std::string in_degrees(double value, std::string_view unit);
/// "1.5 rad (85.9437 deg)", "2 m".
std::string with_degrees(double value, std::string_view unit);
/// "0 .. 2 m", "0 (0 deg) .. 1.5 rad (85.9437 deg)".
std::string from_to(double lower, double upper, std::string_view unit);

/// A whole number in decimal digits, "-12", "0"; none for anything else, such as "010", "1e3", " 1", "+1" or what 64
/// bits do not hold.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// The text without blanks and tabs around it.
std::string_view trimmed(std::string_view text);

/// Whether `unit` is a product of SI units that the program knows, such as "m", "m^2 rad", "N m/rad" or "1".
bool is_si_unit(std::string_view unit);

/// What may be written where a quantity in `unit` is expected, for messages: "a number in m, or text with a unit made
/// of um, mm, cm, dm, m, km, in".
std::string quantity_hint(std::string_view unit);

/// "0.2 m", "0.5" for unit "1": a number with its unit, for messages and listings.
std::string with_unit(double value, std::string_view unit);

}  // namespace pkm
