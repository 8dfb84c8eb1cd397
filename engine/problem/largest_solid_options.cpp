#include "engine/problem/largest_solid_options.hpp"

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

constexpr const char* kSize = "size";

/// Parses a ratio such as "3:1". Throws std::invalid_argument with one sentence if there are not `count` positive ones.
std::vector<double> parse_ratio(const std::string& text, const std::vector<std::string>& dimensions) {
  std::vector<double> ratio;
  bool is_valid = true;
  for (std::size_t begin = 0; is_valid;) {
    const std::size_t end = text.find(':', begin);
    const auto number = parse_quantity(std::string_view(text).substr(begin, end - begin), "1");
    is_valid = number && *number > 0;
    ratio.push_back(number.value_or(0));
    if (end == std::string::npos) break;
    begin = end + 1;
  }
  if (!is_valid || ratio.size() != dimensions.size())
    throw std::invalid_argument("ratio: found '" + text + "'; expected " + std::to_string(dimensions.size()) +
                                " positive numbers separated by colons, of " + join(dimensions, ":"));
  const double first = ratio.front();
  for (double& number : ratio) number /= first;
  return ratio;
}

}  // namespace

std::vector<OptionSpec> largest_solid_options(SolidKind kind) {
  std::vector<OptionSpec> options;
  if (kind != SolidKind::sphere)
    options.push_back({.name = "ratio",
                       .kind = OptionKind::word,
                       .meaning = kind == SolidKind::box
                                      ? "proportions of the edges, in the order of the swept coordinates, such as "
                                        "\"1:1:1\" for a cube; default: free"
                                      : "diameter : height, such as \"3:1\"; default: free"});
  if (kind == SolidKind::cylinder)
    options.push_back({.name = "axis",
                       .kind = OptionKind::word,
                       .meaning = "coordinate along which it extends; default: the last swept one"});
  options.push_back({.name = "centre",
                     .kind = OptionKind::named_numbers,
                     .unit = "m",
                     .meaning = "coordinates of the centre that are given, such as { x = 0, y = 0 }; others are free"});
  options.push_back({.name = "regular",
                     .kind = OptionKind::flag,
                     .initial = true,
                     .meaning = "no parallel singularity (det G = 0) in it, where det G is defined"});
  options.push_back({.name = "measure",
                     .kind = OptionKind::word,
                     .initial = std::string("volume"),
                     .choices = {"volume", kSize},
                     .meaning = "volume (area in the plane), or size: the first edge or the diameter, for given "
                                "proportions"});
  return options;
}

bool measures_size(const Options& options) { return options.word("measure") == kSize; }

SolidSpec solid_spec(SolidKind kind, const MechanismInfo& info, const WorkspacePlan& plan, const Options& options) {
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<std::string> axes;
  for (const int coordinate : sweep.swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    axes.push_back(axis.name);
    if (axis.turns())
      throw std::invalid_argument("the workspace is over " + axis.name +
                                  ", an angle; expected two or three lengths: use a [[region]] that fixes the angle");
  }
  const std::string name = kind == SolidKind::box ? "box" : kind == SolidKind::sphere ? "sphere" : "cylinder";
  const std::size_t required = kind == SolidKind::cylinder ? 3 : 2;
  if (axes.size() < required)
    throw std::invalid_argument("the workspace is over " + join(axes) + "; a " + name + " needs " +
                                (required == 3 ? "three" : "two or three") + " lengths");
  std::size_t along = axes.size() - 1;
  if (options.has("axis")) {
    const auto found = std::ranges::find(axes, options.word("axis"));
    if (found == axes.end())
      throw std::invalid_argument("axis: found '" + options.word("axis") + "'; expected one of " + join(axes));
    along = static_cast<std::size_t>(found - axes.begin());
  }
  SolidSpec spec{SolidShape(kind, axes.size(), along), {}};
  if (kind == SolidKind::sphere) spec.ratio = {1};
  if (options.has("ratio")) spec.ratio = parse_ratio(options.word("ratio"), spec.shape.dimension_names(axes));
  if (measures_size(options) && spec.ratio.empty())
    throw std::invalid_argument("measure = \"size\" needs given proportions; add ratio, such as \"1:1" +
                                std::string(spec.shape.balls() == 3 ? ":1\"" : "\""));
  if (options.has("centre"))
    for (const auto& [coordinate, value] : options.numbers("centre")) {
      const auto found = std::ranges::find(axes, coordinate);
      if (found == axes.end())
        throw std::invalid_argument("centre: found the coordinate '" + coordinate + "'; expected one of " + join(axes) +
                                    did_you_mean(coordinate, axes));
      spec.centre[static_cast<std::size_t>(found - axes.begin())] = value;
    }
  return spec;
}

std::vector<const NamedQuantity*> solid_measures(const ProblemParts& parts) {
  std::vector<const NamedQuantity*> measures;
  for (const auto* const list : {&parts.objectives, &parts.workspace_margins, &parts.design_margins, &parts.reports})
    for (const NamedQuantity& named : *list)
      if (named.quantity->largest_solid()) measures.push_back(&named);
  return measures;
}

LargestSolidFinder solid_finder(SolidKind kind, const EntryContext& context) {
  return {context.mechanism, context.plan, solid_spec(kind, context.mechanism.info(), context.plan, context.options),
          context.options.flag("regular")};
}

}  // namespace pkm
