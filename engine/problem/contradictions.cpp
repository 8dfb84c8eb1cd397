// What a study asks for that cannot be, told from its text and its mechanism without a survey of any design.
#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/verdict.hpp"
#include "engine/survey/picture_plan.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {
namespace {

using Kind = HeldCoordinate::Kind;
using Ends = std::array<double, 2>;

constexpr std::size_t kMostVariables = 10;  // whose 2^n corners are looked at; studies with more are not
constexpr double kBeyond = 0.1;             // of its size: by how much a box has to miss what corners reach

const std::string kContradiction = "contradiction";

/// What is certain, and what is only most likely not meant.
struct Findings {
  std::vector<Reason> contradictions;
  std::vector<std::string> doubts;

  void add(bool certain, const std::string& name, const std::string& sentence) {
    if (certain)
      contradictions.push_back({kContradiction, {name}, sentence});
    else
      doubts.push_back(sentence);
  }
};

std::string range_words(const Ends& ends, const std::string& unit) {
  return shortest(ends[0]) + " .. " + with_unit(ends[1], unit);
}

/// The designs at the corners of the bounds that the mechanism takes; none where there are too many.
std::vector<std::vector<double>> corners(const ProblemParts& parts) {
  const std::size_t n = parts.varies.size();
  if (n > kMostVariables) return {};
  std::vector<std::vector<double>> designs;
  for (std::size_t bits = 0; bits < std::size_t{1} << n; ++bits) {
    std::vector<double>& design = designs.emplace_back(parts.parameters);
    for (std::size_t v = 0; v < n; ++v)
      design[parts.varies[v]] = bits >> v & 1 ? parts.space[v].upper : parts.space[v].lower;
    if (parts.mechanism->refuse(design)) designs.pop_back();
  }
  return designs;
}

void widen(Ends& hull, const Ends& by) { hull = {std::min(hull[0], by[0]), std::max(hull[1], by[1])}; }

constexpr Ends kNothing = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

/// "s_max_1" for "s_min_1"; "" for a name that has no "min".
std::string upper_name(std::string name) {
  const auto at = name.find("_min");
  if (at == std::string::npos || (at + 4 < name.size() && name[at + 4] != '_')) return "";
  return name.replace(at, 4, "_max");
}

/// Thresholds of one thing that leave nothing between them.
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
                                        " leaves nothing below " + limits[high].name + " = " +
                                        with_unit(values[high], limits[high].unit) + ": no pose keeps both"});
  }
}

/// Values of held coordinates that are out of every design's reach.
void check_held(const ProblemParts& parts, const std::vector<std::vector<double>>& designs, const SurveyPlan& plan,
                const std::string& section, bool certain, Findings& found) {
  for (const HeldCoordinate& held : plan.held) {
    if (held.kind != Kind::value && held.kind != Kind::listed) continue;
    Ends hull = kNothing;
    for (const auto& design : designs)
      if (const auto reach = parts.mechanism->reach(design, held.coordinate)) widen(hull, *reach);
    if (hull == kNothing) continue;
    const std::vector<double> values = held.kind == Kind::listed ? held.values : std::vector{held.value};
    std::vector<double> outside;
    for (const double value : values)
      if (value < hull[0] || value > hull[1]) outside.push_back(value);
    if (outside.empty()) continue;
    const AxisInfo& axis = parts.mechanism->info().coordinates[static_cast<std::size_t>(held.coordinate)];
    found.add(certain && outside.size() == values.size(), axis.name,
              section + "." + axis.name + " = " +
                  join_of(outside, [&](double value) { return with_unit(value, axis.unit); }) +
                  " lies outside what designs within the bounds reach, " + range_words(hull, axis.unit));
  }
}

/// Widens the hull by what the swept coordinates of the designs can be: the box that surveys without one derive.
void widen_by_reach(const Mechanism& mechanism, const std::vector<std::vector<double>>& designs, SurveyPlan plan,
                    Box& hull) {
  std::visit([](auto& method) { method.box.reset(); }, plan.method);
  SurveyPlan picture = picture_plan(mechanism.info(), plan, {1, 1, 1});
  std::get<VoxelOptions>(picture.method).cells = {1, 1, 1};
  try {
    const auto surveyor = prepare_map(mechanism, picture);
    for (const auto& design : designs) {
      const VoxelMap map = surveyor->map(design);
      for (std::size_t axis = 0; axis < 3; ++axis) widen(hull[axis], {map.lower[axis], map.upper[axis]});
    }
  } catch (const std::invalid_argument&) {
    // the mechanism does not say where its workspace is
  }
}

/// A box that no design reaches.
void check_box(const ProblemParts& parts, const std::vector<std::vector<double>>& designs, const SurveyPlan& plan,
               const std::string& section, bool certain, Findings& found) {
  if (!plan.box()) return;
  std::vector<SurveyPlan> plans = {plan};
  for (std::size_t h = 0; h < plan.held.size(); ++h)
    for (const double value : plan.held[h].values) {
      plans.push_back(plan);
      plans.back().held[h] = {plan.held[h].coordinate, Kind::value, value};
    }
  Box hull;
  hull.fill(kNothing);
  for (const SurveyPlan& one : plans) widen_by_reach(*parts.mechanism, designs, one, hull);
  const MechanismInfo& info = parts.mechanism->info();
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  for (std::size_t axis = 0; axis < swept.size(); ++axis) {
    const Ends &box = (*plan.box())[axis], &reached = hull[axis];
    const double beyond = kBeyond * (reached[1] - reached[0]);
    if (!(box[0] > reached[1] + beyond || box[1] < reached[0] - beyond) || reached == kNothing) continue;
    const AxisInfo& coordinate = info.coordinates[static_cast<std::size_t>(swept[axis])];
    found.add(certain, coordinate.name,
              section + ".box." + coordinate.name + " = " + range_words(box, coordinate.unit) +
                  " lies outside what designs within the bounds reach, " + range_words(reached, coordinate.unit));
  }
}

/// Bounds that no design can keep, or that every design keeps.
void check_bounds(const ProblemParts& parts, Findings& found) {
  for (const auto* const list : {&parts.design_margins, &parts.survey_margins})
    for (const NamedQuantity& q : *list) {
      const auto& [least, greatest] = q.range;
      const std::string what = "constraint " + q.name + (q.least ? " >= " + with_unit(*q.least, q.unit) : "") +
                               (q.greatest ? " <= " + with_unit(*q.greatest, q.unit) : "");
      const std::string always = ", because its values are never ";
      const std::string below = always + "below " + with_unit(least, q.unit),
                        above = always + "above " + with_unit(greatest, q.unit);
      if (q.least && *q.least > greatest) found.add(true, q.name, what + " holds for no design" + above);
      if (q.greatest && *q.greatest < least) found.add(true, q.name, what + " holds for no design" + below);
      if (q.least && *q.least < least) found.add(false, q.name, what + " holds for every design" + below);
      if (q.greatest && *q.greatest > greatest) found.add(false, q.name, what + " holds for every design" + above);
    }
}

/// Whether what makes a design good or feasible is read from a survey: 0 the workspace's, k the k-th region's.
bool decides(const ProblemParts& parts, std::size_t survey) {
  const auto reads = [survey](const NamedQuantity& q) { return q.reads_survey && q.survey == survey; };
  return std::ranges::any_of(parts.objectives, reads) || std::ranges::any_of(parts.survey_margins, reads);
}

Findings findings(const ProblemParts& parts) {
  Findings found;
  const auto designs = corners(parts);
  compare_limits(parts, designs, found);
  const auto check_plan = [&](const SurveyPlan& plan, const std::string& section, std::size_t survey) {
    check_held(parts, designs, plan, section, decides(parts, survey), found);
    check_box(parts, designs, plan, section, decides(parts, survey), found);
  };
  check_plan(parts.plan, "workspace", 0);
  for (std::size_t k = 0; k < parts.regions.size(); ++k)
    check_plan(parts.regions[k].plan, "region " + parts.regions[k].name, k + 1);
  check_bounds(parts, found);
  return found;
}

}  // namespace

std::vector<Reason> contradictions(const ProblemParts& parts) { return findings(parts).contradictions; }
std::vector<std::string> doubts(const ProblemParts& parts) { return findings(parts).doubts; }

}  // namespace pkm
