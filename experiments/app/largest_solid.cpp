#include "experiments/app/largest_solid.hpp"

#include <cmath>
#include <map>

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/rounding.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/problem/largest_solid_options.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

std::string option_of(SolidKind kind) {
  if (kind == SolidKind::box) return "--largest-box";
  return kind == SolidKind::cylinder ? "--largest-cylinder" : "--largest-sphere";
}

/// The requirements of --least as margins: value of a quantity minus its required minimum.
std::vector<ReportMargin> minimum_values(const SolidArguments& arguments, const Mechanism& mechanism) {
  std::vector<const PoseQuantity*> quantities;
  std::vector<Assignable> known;
  for (const PoseQuantity* const quantity : pose_quantities(mechanism.info())) {
    if (quantity->needs_inertia()) continue;
    quantities.push_back(quantity);
    known.push_back({quantity->name, quantity->unit});
  }
  const auto least = parse_assignments(arguments.least, "--least", known);
  std::vector<ReportMargin> margins;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!least[i]) continue;
    const PoseQuantity& quantity = *quantities[i];
    if (const Unsupported reason = why_unavailable(mechanism, quantity)) throw ConfigError({"", 0, "--least"}, *reason);
    const std::size_t count = quantity.per_joint ? mechanism.info().joints.size() : 1;
    const std::string name = quantity.name;
    margins.push_back(
        {name + " >= " + shortest(*least[i]), [&quantity, count, minimum = *least[i]](const PoseReport& report) {
           std::array<double, kMaxJoints> values{};
           quantity.evaluate(report, values.data());
           double margin = values[0] - minimum;
           for (std::size_t k = 1; k < count; ++k) margin = std::fmin(margin, values[k] - minimum);
           return margin;
         }});
  }
  return margins;
}

/// The values of --ratio, --axis and --centre as options of an objective.
Options options_of(SolidKind kind, const SolidArguments& arguments, const Target& target, const WorkspacePlan& plan) {
  Options options = default_options(largest_solid_options(kind));
  options.set("regular", !arguments.singular);
  if (!arguments.ratio.empty() && kind != SolidKind::sphere) options.set("ratio", arguments.ratio);
  if (!arguments.axis.empty() && kind == SolidKind::cylinder) options.set("axis", arguments.axis);
  const std::vector<Assignable> swept = assignable_coordinates(target.info(), sweep_of(target.info(), plan));
  const auto given = parse_assignments(arguments.centre, "--centre", swept);
  NamedNumbers centre;
  for (std::size_t i = 0; i < swept.size(); ++i)
    if (given[i]) centre[swept[i].name] = *given[i];
  options.set("centre", centre);
  return options;
}

/// Fixes sliced coordinates of a voxel plan instead of sweeping them.
void fix_slices(WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices) {
  if (slices.empty()) return;
  const std::vector<int> swept = sweep_of(info, plan).swept;
  const VoxelOptions voxels = *plan.voxels();
  VoxelOptions kept;
  if (voxels.box) kept.box = Box{{{0, 1}, {0, 1}, {0, 1}}};
  plan.swept.clear();
  for (std::size_t axis = 0; axis < swept.size(); ++axis) {
    if (const auto slice = slices.find(swept[axis]); slice != slices.end()) {
      plan.fixed.push_back({swept[axis], FixedCoordinate::Kind::value, slice->second});
      continue;
    }
    if (voxels.box) (*kept.box)[plan.swept.size()] = (*voxels.box)[axis];
    kept.cells[plan.swept.size()] = voxels.cells[axis];
    plan.swept.push_back(swept[axis]);
  }
  plan.method = kept;
}

}  // namespace

void add_solid_options(CLI::App& command, SolidArguments& arguments) {
  command.add_flag("--largest-box", arguments.box,
                   "Find the largest box in the workspace (rectangle, if two lengths are swept)");
  command.add_flag("--largest-cylinder", arguments.cylinder, "Find the largest cylinder");
  command.add_flag("--largest-sphere", arguments.sphere, "Find the largest sphere (circle, if two lengths are swept)");
  add_option(command, "--ratio A:B[:C]", arguments.ratio,
             "Proportions of the edges of the box, or diameter:height of the cylinder; default: free");
  add_option(command, "--axis NAME", arguments.axis,
             "Coordinate along which the cylinder extends; default: the last swept one");
  add_list_option(command, "--centre", arguments.centre, "Given coordinates of the centre; default: free");
  add_option(command, "--least QUANTITY=VALUE", arguments.least,
             "Minimum of a quantity in the whole solid, such as conditioning=0.3 (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--singular", arguments.singular, "Allow parallel singularities (det G = 0) in the solid");
}

std::vector<RequestedSolid> requested_solids(const SolidArguments& arguments, const Target& target, WorkspacePlan plan,
                                             const Slices& slices) {
  std::vector<SolidKind> kinds;
  if (arguments.box) kinds.push_back(SolidKind::box);
  if (arguments.cylinder) kinds.push_back(SolidKind::cylinder);
  if (arguments.sphere) kinds.push_back(SolidKind::sphere);
  if (kinds.empty()) {
    const std::pair<const char*, bool> needing[] = {{"--ratio", !arguments.ratio.empty()},
                                                    {"--axis", !arguments.axis.empty()},
                                                    {"--centre", !arguments.centre.empty()},
                                                    {"--least", !arguments.least.empty()},
                                                    {"--singular", arguments.singular}};
    for (const auto& [option, is_given] : needing)
      if (is_given)
        throw ConfigError({"", 0, option}, "no solid", "--largest-box, --largest-cylinder or --largest-sphere");
    return {};
  }
  fix_slices(plan, target.info(), slices);
  const std::vector<ReportMargin> least = minimum_values(arguments, *target.mechanism);
  std::vector<RequestedSolid> requested;
  for (const SolidKind kind : kinds) {
    const Options options = options_of(kind, arguments, target, plan);
    try {
      SolidSpec spec = solid_spec(kind, target.info(), plan, options);
      const std::string name = spec.shape.name();
      requested.push_back({name, std::make_unique<LargestSolidFinder>(*target.mechanism, plan, std::move(spec),
                                                                      options.flag("regular"), least)});
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, option_of(kind)}, reason.what());
    }
  }
  return requested;
}

void report_solids(const std::vector<RequestedSolid>& requested, const Target& target, Printout& out) {
  for (const auto& [name, finder] : requested) {
    const LargestSolid found = finder->find(target.parameters);
    Json& json = out.json["largest"][name];
    json = nullptr;
    if (!(found.volume > 0)) {
      out.text += "\nlargest " + name + ": none, no cell satisfies the constraints\n";
      continue;
    }
    json = Json::object();
    std::vector<Row> rows;
    const std::string unit = finder->sweep().swept.size() == 2 ? "m^2" : "m^3";
    const std::vector<std::string> dimensions = finder->dimension_names();
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
      json["dimensions"][dimensions[i]] = found.solid.dimensions[i];
      rows.push_back({dimensions[i], number(found.solid.dimensions[i], "m")});
    }
    json["volume"] = found.volume;
    json["unit"] = unit;
    rows.push_back({measure_name(finder->sweep().swept.size()), number(found.volume, unit)});
    // centre: list of "coordinate=value"; places: arguments for the option of `pkmopt certify` that certifies the solid
    std::vector<std::string> centre, places;
    const SolidShape& shape = finder->spec().shape;
    for (std::size_t axis = 0; axis < shape.axes(); ++axis) {
      const std::string& coordinate =
          target.info().coordinates[static_cast<std::size_t>(finder->sweep().swept[axis])].name;
      const double half = found.solid.dimensions[shape.ball_of(axis)] / 2,
                   at = zero_if_rounding_error(found.solid.centre[axis], found.solid.dimensions.front());
      json["centre"][coordinate] = at;
      json["box"][coordinate] = {at - half, at + half};
      centre.push_back(coordinate + "=" + formatted("%.9g", at));
      const bool is_round = shape.axes_of(shape.ball_of(axis)).size() > 1;
      places.push_back(is_round ? centre.back()
                                : coordinate + "=" + formatted("%.9g", at - half) + ":" + formatted("%.9g", at + half));
    }
    rows.push_back({"centre", join(centre, ",")});
    const bool is_box = shape.balls() == shape.axes();
    if (!is_box) places.push_back("diameter=" + formatted("%.9g", found.solid.dimensions.front()));
    rows.push_back({is_box ? "box" : shape.balls() == 2 ? "cylinder" : "sphere", join(places, ",")});
    json["residual"] = found.residual;
    rows.push_back({"accuracy", formatted("%.1e", found.residual) + " of the size, local maximum"});
    json["samples"] = found.samples;
    json["regular"] = found.is_regular;
    json["contacts"] = Json::array();
    std::map<std::string, int> faces;
    for (const Contact& contact : found.contacts) {
      json["contacts"].push_back({{"constraint", contact.constraint},
                                  {"multiplier", contact.multiplier},
                                  {"pose", axes_json(target.info().coordinates, contact.pose)}});
      if (contact.multiplier > 0) ++faces[contact.constraint];
    }
    std::string heading = "bounded by";
    for (const auto& [constraint, count] : faces) {
      rows.push_back({heading, constraint + (count > 1 ? " (" + std::to_string(count) + " points)" : "")});
      heading.clear();
    }
    if (!found.is_regular) rows.push_back({"warning", "a parallel singularity (det G = 0) lies in it"});
    out.add_table("largest " + name + ", tested at " + std::to_string(found.samples) + " poses", rows);
  }
}

}  // namespace pkm
