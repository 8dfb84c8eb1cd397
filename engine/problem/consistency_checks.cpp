// Consistency checks of a study before it is run: requirements that no design within the bounds can satisfy, or that
// are probably mistakes. They use the study and its mechanism only, without analysing the workspace of any design.
#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/diagnosis.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"

namespace pkm {
namespace {

using Kind = FixedCoordinate::Kind;
using Interval1D = std::array<double, 2>;

// Maximum number n of variables for which the checks use the 2^n vertices of the bounds.
constexpr std::size_t kMaxVariables = 10;
// The box of a workspace is reported if it lies this far outside the range of poses that the designs at the vertices of
// the variables' bounds reach, relative to the size of the range. The tolerance is necessary because designs inside the
// bounds may reach farther.
constexpr double kReachTolerance = 0.1;

const std::string kContradiction = "contradiction";

struct Findings {
  std::vector<Reason> contradictions;
  std::vector<std::string> warnings;  ///< sentences about probable mistakes

  void add(bool is_contradiction, const std::string& name, const std::string& sentence) {
    if (is_contradiction)
      contradictions.push_back({kContradiction, {name}, sentence});
    else
      warnings.push_back(sentence);
  }
};

std::string range_text(const Interval1D& range, const std::string& unit) {
  return shortest(range[0]) + " .. " + with_unit(range[1], unit);
}

/// The designs at the vertices of the variables' bounds that are valid for the mechanism; empty if there are too many
/// variables.
std::vector<std::vector<double>> vertex_designs(const ProblemParts& parts) {
  const std::size_t n = parts.varies.size();
  if (n > kMaxVariables) return {};
  std::vector<std::vector<double>> designs;
  for (std::size_t bits = 0; bits < std::size_t{1} << n; ++bits) {
    std::vector<double>& design = designs.emplace_back(parts.parameters);
    for (std::size_t v = 0; v < n; ++v)
      design[parts.varies[v]] = bits >> v & 1 ? parts.space[v].upper : parts.space[v].lower;
    if (parts.mechanism->refuse(design)) designs.pop_back();
  }
  return designs;
}

void widen(Interval1D& hull, const Interval1D& by) { hull = {std::min(hull[0], by[0]), std::max(hull[1], by[1])}; }

constexpr Interval1D kEmpty = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

/// Name of the upper threshold that belongs to a lower one: "s_max_1" for "s_min_1"; "" for names without "_min".
std::string upper_name(std::string name) {
  const auto at = name.find("_min");
  if (at == std::string::npos || (at + 4 < name.size() && name[at + 4] != '_')) return "";
  return name.replace(at, 4, "_max");
}

/// Finds pairs of thresholds of one quantity in which the lower threshold is not below the upper one.
void compare_limits(const ProblemParts& parts, const std::vector<std::vector<double>>& designs, Findings& found) {
  const auto& limits = parts.mechanism->info().limits;
  std::vector<double> values(limits.size());
  for (std::size_t low = 0; low < limits.size(); ++low) {
    const LimitInfo* const upper = find_named(limits, upper_name(limits[low].name));
    if (!upper || designs.empty()) continue;
    const auto high = static_cast<std::size_t>(upper - limits.data());
    const bool empty = std::ranges::all_of(designs, [&](const std::vector<double>& design) {
      parts.mechanism->thresholds(design, parts.plan.limits, values);
      return values[low] >= values[high];
    });
    if (!empty) continue;
    found.contradictions.push_back({kContradiction,
                                    {limits[low].name, limits[high].name},
                                    limits[low].name + " = " + with_unit(values[low], limits[low].unit) +
                                        " is not below " + limits[high].name + " = " +
                                        with_unit(values[high], limits[high].unit) + "; no pose satisfies both"});
  }
}

/// Finds values of fixed coordinates that no design reaches.
/// @param designs  the designs at the vertices of the variables' bounds
void check_fixed(const ProblemParts& parts, const std::vector<std::vector<double>>& designs, const WorkspacePlan& plan,
                 const std::string& table, bool is_contradiction, Findings& found) {
  for (const FixedCoordinate& fixed : plan.fixed) {
    if (fixed.kind != Kind::value && fixed.kind != Kind::listed) continue;
    Interval1D hull = kEmpty;
    for (const auto& design : designs)
      if (const auto reach = parts.mechanism->reach(design, fixed.coordinate)) widen(hull, *reach);
    if (hull == kEmpty) continue;
    const std::vector<double> values = fixed.kind == Kind::listed ? fixed.values : std::vector{fixed.value};
    std::vector<double> outside;
    for (const double value : values)
      if (value < hull[0] || value > hull[1]) outside.push_back(value);
    if (outside.empty()) continue;
    const AxisInfo& axis = parts.mechanism->info().coordinates[static_cast<std::size_t>(fixed.coordinate)];
    found.add(is_contradiction && outside.size() == values.size(), axis.name,
              table + "." + axis.name + " = " +
                  join_texts(outside, [&](double value) { return with_unit(value, axis.unit); }) +
                  " is out of reach; designs within the bounds reach " + range_text(hull, axis.unit));
  }
}

/// Extends `hull` by the ranges of the swept coordinates for each design: the box of poses that a workspace analysis of
/// the design uses if the plan has no box.
void widen_by_reach(const Mechanism& mechanism, const std::vector<std::vector<double>>& designs, WorkspacePlan plan,
                    Box& hull) {
  std::visit([](auto& method) { method.box.reset(); }, plan.method);
  plan.home.reset();
  WorkspacePlan picture = visualisation_plan(mechanism.info(), plan, {1, 1, 1});
  std::get<VoxelOptions>(picture.method).cells = {1, 1, 1};
  try {
    const auto evaluator = prepare_voxel_map(mechanism, picture);
    for (const auto& design : designs) {
      const VoxelMap map = evaluator->map(design);
      for (std::size_t axis = 0; axis < 3; ++axis) widen(hull[axis], {map.lower[axis], map.upper[axis]});
    }
  } catch (const std::invalid_argument&) {
    // The mechanism does not define a box of its workspace, by which `hull` could be extended.
  }
}

/// Finds coordinates in which the box of a plan lies entirely outside the ranges that the designs reach.
/// @param designs  the designs at the vertices of the variables' bounds
void check_box(const ProblemParts& parts, const std::vector<std::vector<double>>& designs, const WorkspacePlan& plan,
               const std::string& table, bool is_contradiction, Findings& found) {
  if (!plan.box()) return;
  std::vector<WorkspacePlan> plans = {plan};
  for (std::size_t h = 0; h < plan.fixed.size(); ++h)
    for (const double value : plan.fixed[h].values) {
      plans.push_back(plan);
      plans.back().fixed[h] = {plan.fixed[h].coordinate, Kind::value, value};
    }
  Box hull;
  hull.fill(kEmpty);
  for (const WorkspacePlan& one : plans) widen_by_reach(*parts.mechanism, designs, one, hull);
  const MechanismInfo& info = parts.mechanism->info();
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  for (std::size_t axis = 0; axis < swept.size(); ++axis) {
    const Interval1D &box = (*plan.box())[axis], &reached = hull[axis];
    const double tolerance = kReachTolerance * (reached[1] - reached[0]);
    if (!(box[0] > reached[1] + tolerance || box[1] < reached[0] - tolerance) || reached == kEmpty) continue;
    const AxisInfo& coordinate = info.coordinates[static_cast<std::size_t>(swept[axis])];
    found.add(is_contradiction, coordinate.name,
              table + ".box." + coordinate.name + " = " + range_text(box, coordinate.unit) +
                  " is out of reach; designs within the bounds reach " + range_text(reached, coordinate.unit));
  }
}

/// Finds bounds of constraints that no design can satisfy, or that every design satisfies.
void check_bounds(const ProblemParts& parts, Findings& found) {
  for (const auto* const list : {&parts.design_margins, &parts.workspace_margins})
    for (const NamedQuantity& q : *list) {
      const auto& [min, max] = q.range;
      const std::string what = "constraint " + q.name +
                               (q.lower_bound ? " >= " + with_unit(*q.lower_bound, q.unit) : "") +
                               (q.upper_bound ? " <= " + with_unit(*q.upper_bound, q.unit) : "");
      const std::string always = ", because its values are never ";
      const std::string below = always + "below " + with_unit(min, q.unit),
                        above = always + "above " + with_unit(max, q.unit);
      if (q.lower_bound && *q.lower_bound > max) found.add(true, q.name, what + " is satisfied by no design" + above);
      if (q.upper_bound && *q.upper_bound < min) found.add(true, q.name, what + " is satisfied by no design" + below);
      if (q.lower_bound && *q.lower_bound < min)
        found.add(false, q.name, what + " is satisfied by every design" + below);
      if (q.upper_bound && *q.upper_bound > max)
        found.add(false, q.name, what + " is satisfied by every design" + above);
    }
}

/// Whether an objective or a constraint uses a workspace analysis (0: the workspace, k: the k-th region). If so, a
/// design is useless if the result of this analysis is empty.
bool is_essential(const ProblemParts& parts, std::size_t analysis) {
  const auto reads = [analysis](const NamedQuantity& q) { return q.uses_workspace && q.analysis == analysis; };
  return std::ranges::any_of(parts.objectives, reads) || std::ranges::any_of(parts.workspace_margins, reads);
}

Findings findings(const ProblemParts& parts) {
  Findings found;
  const auto designs = vertex_designs(parts);
  compare_limits(parts, designs, found);
  const auto check_plan = [&](const WorkspacePlan& plan, const std::string& table, std::size_t analysis) {
    check_fixed(parts, designs, plan, table, is_essential(parts, analysis), found);
    check_box(parts, designs, plan, table, is_essential(parts, analysis), found);
  };
  check_plan(parts.plan, "workspace", 0);
  for (std::size_t k = 0; k < parts.regions.size(); ++k)
    check_plan(parts.regions[k].plan, "region " + parts.regions[k].name, k + 1);
  check_bounds(parts, found);
  return found;
}

}  // namespace

std::vector<Reason> contradictions(const ProblemParts& parts) { return findings(parts).contradictions; }
std::vector<std::string> consistency_warnings(const ProblemParts& parts) { return findings(parts).warnings; }

}  // namespace pkm
