#include "engine/mechanism/mechanism.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/options.hpp"

namespace pkm {

Unsupported Mechanism::refuse(std::span<const double> parameters) const {
  for (std::size_t i = 0; i < info().parameters.size(); ++i) {
    const Parameter& p = info().parameters[i];
    if (!(parameters[i] >= p.lower && parameters[i] <= p.upper))
      return p.name + " = " + shortest(parameters[i]) + " is outside the model's range " + shortest(p.lower) + " to " +
             shortest(p.upper) + " " + p.unit;
  }
  return {};
}

std::optional<std::array<double, 2>> Mechanism::reach(std::span<const double> parameters, int coordinate) const {
  const auto all = ranges(parameters);
  if (!all) return {};
  return (*all)[static_cast<std::size_t>(coordinate)];
}

void Mechanism::thresholds(std::span<const double>, const LimitSpec& limits, std::span<double> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = limits.given[i].value_or(info().limits[i].inactive);
}
void Mechanism::thresholds(std::span<const Dual4>, const LimitSpec& limits, std::span<Dual4> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = limits.given[i].value_or(info().limits[i].inactive);
}

Unsupported why_no_joint_forces(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  const std::size_t joints = info.joints.size(), coordinates = info.coordinates.size();
  if (!mechanism.dynamics()) return "mechanism " + info.name + " has no masses";
  if (joints == coordinates) return {};
  return "mechanism " + info.name + " has " + std::to_string(joints) + " joints for " + std::to_string(coordinates) +
         " coordinates, not as many of both";
}

NamedValues quantities_of_design(const Mechanism& mechanism, std::span<const double> parameters,
                                 const LimitSpec& limits) {
  const auto& infos = mechanism.info().quantities;
  NamedValues found;
  if (std::ranges::none_of(infos, &QuantityInfo::of_design)) return found;
  const MotionSample any_pose{.pose = Pose<double>(mechanism.info().coordinates.size())};
  const auto values = mechanism.quantities(parameters, mechanism.info().modes.front(), limits, any_pose);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (infos[i].of_design) found.emplace_back(infos[i].name, values[i]);
  return found;
}

const Sweep& sweep_of(const MechanismInfo& info, const WorkspacePlan& plan) {
  for (const Sweep& sweep : info.sweeps)
    if ((plan.swept.empty() || std::ranges::is_permutation(sweep.swept, plan.swept)) &&
        std::ranges::all_of(plan.fixed, [&](const FixedCoordinate& named) {
          return std::ranges::find(sweep.fixed, named.coordinate) != sweep.fixed.end();
        }))
      return sweep;
  const auto name_of = [&info](int coordinate) {
    const bool known = coordinate >= 0 && coordinate < static_cast<int>(info.coordinates.size());
    return known ? info.coordinates[static_cast<std::size_t>(coordinate)].name
                 : "coordinate number " + std::to_string(coordinate + 1);
  };
  std::vector<std::string> swept, fixed;
  for (const int coordinate : plan.swept) swept.push_back(name_of(coordinate));
  for (const FixedCoordinate& named : plan.fixed) fixed.push_back(name_of(named.coordinate));
  throw std::invalid_argument("mechanism " + info.name + " has no sweep" +
                              (swept.empty() ? "" : " over " + join(swept)) +
                              (fixed.empty() ? "" : " with " + join(fixed, " and ") + " fixed"));
}

std::vector<Sweep> all_sweeps(const std::vector<AxisInfo>& coordinates, const std::vector<int>& default_swept) {
  const int n = static_cast<int>(coordinates.size());
  const auto sweep_over = [n](const std::vector<int>& swept) {
    Sweep sweep{.swept = swept, .fixed = {}, .column = swept.back()};
    for (int i = 0; i < n; ++i)
      if (std::ranges::find(swept, i) == swept.end()) sweep.fixed.push_back(i);
    return sweep;
  };
  std::vector<Sweep> sweeps = {sweep_over(default_swept)};
  for (std::size_t count = 3; count >= 1; --count)
    for (int bits = (1 << n) - 1; bits > 0; --bits) {
      std::vector<int> swept;
      for (int i = 0; i < n; ++i)
        if (bits & (1 << (n - 1 - i))) swept.push_back(i);
      if (swept.size() == count && !std::ranges::is_permutation(swept, default_swept))
        sweeps.push_back(sweep_over(swept));
    }
  return sweeps;
}

std::size_t mode_index(const MechanismInfo& info, const std::string& name) {
  if (name.empty()) return 0;
  const auto found = std::ranges::find(info.modes, name);
  if (found == info.modes.end()) throw std::invalid_argument("unknown working mode " + name);
  return static_cast<std::size_t>(found - info.modes.begin());
}

double fixed_value(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan,
                   int coordinate) {
  const FixedCoordinate fixed = how_fixed(plan, coordinate);
  if (fixed.kind == FixedCoordinate::Kind::value) return fixed.value;
  if (fixed.kind == FixedCoordinate::Kind::listed) return fixed.values.front();
  if (const auto value = mechanism.default_value(parameters, coordinate)) return *value;
  throw_no_default_value(mechanism.info(), coordinate);
}

void throw_no_default_value(const MechanismInfo& info, int coordinate) {
  throw std::invalid_argument("mechanism " + info.name + " has no default value of " +
                              info.coordinates[static_cast<std::size_t>(coordinate)].name + "; give a value");
}

bool requires_clearance(const MechanismInfo& info, const WorkspacePlan& plan) {
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (info.limits[i].group == "clearance" && requires_clearance(plan, i)) return true;
  return false;
}

std::string unit_of_product(const MechanismInfo& info, const std::vector<int>& coordinates) {
  const auto power = [](const std::string& unit, std::ptrdiff_t n) {
    return n == 0 ? "" : n == 1 ? unit : unit + "^" + std::to_string(n);
  };
  const auto angles =
      std::ranges::count_if(coordinates, [&](int i) { return info.coordinates[static_cast<std::size_t>(i)].turns(); });
  const std::string lengths = power("m", std::ssize(coordinates) - angles), turns = power("rad", angles);
  return lengths + (lengths.empty() || turns.empty() ? "" : " ") + turns;
}

std::string volume_unit(const MechanismInfo& info, const WorkspacePlan& plan) {
  std::vector<int> measured = sweep_of(info, plan).swept;
  for (const FixedCoordinate& fixed : plan.fixed)
    if (fixed.kind == FixedCoordinate::Kind::integrated) measured.push_back(fixed.coordinate);
  return unit_of_product(info, measured);
}

}  // namespace pkm
