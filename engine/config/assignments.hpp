// The command line's lists of numbers: `--at x=0.3,y=200mm`, `--set a=0.2 --set b=800mm`.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A name that a list may give a value to.
struct Assignable {
  std::string name;
  std::string unit;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// The mechanism's parameters as assignable names.
std::vector<Assignable> assignable_parameters(const MechanismInfo& info);
/// Its limits of a pose as assignable names.
std::vector<Assignable> assignable_limits(const MechanismInfo& info);
/// Coordinates or joints as assignable names, or as names of their rates, per "s" or "s^2".
std::vector<Assignable> assignable_axes(const std::vector<AxisInfo>& axes, const std::string& per = "");
/// Rates of the pose coordinates, and behind them of the auxiliary chain's input where there is one.
std::vector<Assignable> assignable_rates(const Mechanism& mechanism, const std::string& per);
/// The joints as names of their forces.
std::vector<Assignable> assignable_forces(const MechanismInfo& info);

/// What stands before each `=` in such lists.
std::vector<std::string> assigned_names(const std::vector<std::string>& lists);

/// The value [SI] of an option that takes one number. Throws ConfigError.
double parse_number(const std::string& text, const std::string& option, const std::string& unit);

/// Values [SI] of comma-separated `name=value` lists, in the order of `known`; absent where a name is not given.
/// `option` ("--set") is named in messages. Throws ConfigError for anything unknown, malformed, out of range or twice.
std::vector<std::optional<double>> parse_assignments(const std::vector<std::string>& lists, const std::string& option,
                                                     const std::vector<Assignable>& known);

/// The same, when every name must be given.
std::vector<double> parse_all_assignments(const std::vector<std::string>& lists, const std::string& option,
                                          const std::vector<Assignable>& known);

/// The same, names that are not given being 0.
std::vector<double> parse_some_assignments(const std::vector<std::string>& lists, const std::string& option,
                                           const std::vector<Assignable>& known);

/// Force and moment on the platform of `--wrench`; 0 where not given.
Wrench<double> parse_wrench(const std::vector<std::string>& lists);

/// Values [SI] of `0,30deg`, or `-60deg:60deg:5` (from : to : how many).
std::vector<double> parse_values(const std::string& text, const std::string& option, const Assignable& what);

/// Numbers of cells of `--cells x=20,z=20`, or of `--cells 40` along each, in the order of `names`.
std::vector<std::int64_t> parse_cells(const std::vector<std::string>& lists, const std::vector<std::string>& names);

/// Ranges [SI] of comma-separated `name=from:to` or `name=from..to` lists, in the order of `known`; absent where a name
/// is not given.
std::vector<std::optional<std::array<double, 2>>> parse_some_ranges(const std::vector<std::string>& lists,
                                                                    const std::string& option,
                                                                    const std::vector<Assignable>& known);

/// The same, when every name must be given.
std::vector<std::array<double, 2>> parse_ranges(const std::vector<std::string>& lists, const std::string& option,
                                                const std::vector<Assignable>& known);

}  // namespace pkm
