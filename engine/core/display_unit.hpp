// Units in which people read quantities: mm, deg, N, ms, with larger and smaller ones for other magnitudes. Files and
// JSON have SI units.
#pragma once

#include <string>
#include <string_view>

namespace pkm {

/// Unit in which people read a quantity.
struct DisplayUnit {
  double size;  ///< value of the unit in SI
  std::string name;
};
/// The display unit for values of any magnitude: mm for m, deg for rad, otherwise the SI unit itself.
DisplayUnit display_unit(std::string_view si_unit);
/// The unit that suits a value of a given magnitude: "mm", or "um" for 2e-5 m and "m" for 12 m; "m^3" or "cm^3"; "N" or
/// "kN". Values that are printed in one unit, such as those of a table row, share the unit of the largest.
DisplayUnit display_unit(std::string_view si_unit, double magnitude);

/// A text followed by a space and the name of the unit, if the unit has a name.
std::string with_name(const std::string& text, const DisplayUnit& unit);
/// Formats a given value, which is not rounded, in its display unit: "200 mm", "75 deg", "2 kg".
std::string display_text(double value, std::string_view si_unit);
/// Formats a given range in its display unit: "0 .. 2000 mm".
std::string display_range(double lower, double upper, std::string_view si_unit);

}  // namespace pkm
