// Parser of the command line's lists of numbers: `--at x=0.3,y=200mm`, `--set a=0.2 --set b=800mm`.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A name to which a list may assign a value, with the unit and range of the value.
struct Assignable {
  std::string name;
  std::string unit;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// The parameters of a mechanism as assignable names.
std::vector<Assignable> assignable_parameters(const MechanismInfo& info);
/// The limits of poses of a mechanism as assignable names.
std::vector<Assignable> assignable_limits(const MechanismInfo& info);
/// Coordinates or joints as assignable names.
/// @param per  "s" for rates, "s^2" for accelerations
std::vector<Assignable> assignable_axes(const std::vector<AxisInfo>& axes, const std::string& per = "");
/// The rates that can be assigned: those of the coordinates, then those of the mechanism's inputs.
std::vector<Assignable> assignable_rates(const Mechanism& mechanism, const std::string& per);
/// Forces of the joints, under the names of the joints.
std::vector<Assignable> assignable_forces(const MechanismInfo& info);

/// The items of comma-separated lists, without surrounding spaces.
std::vector<std::string> list_items(const std::vector<std::string>& lists);

/// The names before the `=` in comma-separated `name=value` lists.
std::vector<std::string> assigned_names(const std::vector<std::string>& lists);

/// The value [SI] of an option that takes one number. Throws ConfigError.
double parse_number(const std::string& text, const std::string& option, const std::string& unit);

/// Values [SI] of comma-separated `name=value` lists, in the order of `known`; std::nullopt for names that are not
/// given. `option` ("--set") is named in messages. Throws ConfigError for a name that is unknown or occurs twice, and
/// for a value that is malformed or out of range.
std::vector<std::optional<double>> parse_assignments(const std::vector<std::string>& lists, const std::string& option,
                                                     const std::vector<Assignable>& known);

/// Values [SI] of comma-separated `name=value` lists, in the order of `known`; throws ConfigError if a name is not
/// given.
std::vector<double> parse_all_assignments(const std::vector<std::string>& lists, const std::string& option,
                                          const std::vector<Assignable>& known);

/// Values [SI] of comma-separated `name=value` lists, in the order of `known`; 0 for a name that is not given.
std::vector<double> parse_some_assignments(const std::vector<std::string>& lists, const std::string& option,
                                           const std::vector<Assignable>& known);

/// Force and moment of `--wrench` on the platform; components that are not given are 0.
Wrench<double> parse_wrench(const std::vector<std::string>& lists);

/// Values [SI] of a list such as `0,30deg`, or of a range such as `-60deg:60deg:5` (from : to : count).
std::vector<double> parse_values(const std::string& text, const std::string& option, const Assignable& what);

/// Numbers of cells along the axes `names`, from an option such as `--cells x=20,z=20` or, for the same number along
/// all axes, `--cells 40`.
std::vector<std::int64_t> parse_cells(const std::vector<std::string>& lists, const std::vector<std::string>& names);

/// Ranges [SI] of comma-separated `name=from:to` or `name=from..to` lists, in the order of `known`; std::nullopt for
/// names that are not given.
std::vector<std::optional<std::array<double, 2>>> parse_some_ranges(const std::vector<std::string>& lists,
                                                                    const std::string& option,
                                                                    const std::vector<Assignable>& known);

/// Ranges [SI] of comma-separated `name=from:to` lists, in the order of `known`; throws ConfigError if a name is not
/// given.
std::vector<std::array<double, 2>> parse_ranges(const std::vector<std::string>& lists, const std::string& option,
                                                const std::vector<Assignable>& known);

}  // namespace pkm
