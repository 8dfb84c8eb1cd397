// `pkmopt certify`: rigorous bounds on the workspace volume of one design by interval arithmetic, or a proof that all
// poses of a box, a cylinder, a sphere or a motion are feasible and non-singular.

#include <chrono>
#include <map>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct CertifyArguments : DesignArguments, ModeArguments {
  std::string gap = "1e-2", proof, motion;
  std::vector<std::string> box, cylinder, sphere;
  std::int64_t boxes = 4000000;
  int threads = 0;
  bool force = false;
};

void report_volume(const Target& target, const WorkspacePlan& plan, const VolumeBounds& bounds, double requested_gap,
                   double seconds, Printout& out) {
  const MechanismInfo& info = target.info();
  const std::string unit = volume_unit(info, plan);
  out.json["volume"] = {{"lower", bounds.lower}, {"upper", bounds.upper}, {"unit", unit}};
  const auto [lower, upper] = bounds_text(bounds.lower, bounds.upper, unit);
  out.head.push_back({measure_name(sweep_of(info, plan).swept.size()), "at least", lower});
  out.head.push_back({"", "at most", upper});
  out.add("gap", bounds.gap(), number(bounds.gap()) + ", requested " + number(requested_gap));
  out.add("columns", coordinate_names(info, {bounds.innermost})[0]);
  out.add("boxes", bounds.boxes,
          std::to_string(bounds.boxes) + " in the final partition, " + std::to_string(bounds.examined) + " examined");
  out.add("seconds", seconds, digits(seconds));
}

/// Sentence that explains why the requested relative gap of the bounds was not reached; "" if it was reached.
std::string shortfall(const VolumeBounds& bounds, double requested_gap, std::int64_t max_boxes) {
  if (bounds.gap() <= requested_gap) return "";
  if (bounds.stopped) return "stopped before the requested gap was reached";
  if (bounds.boxes >= static_cast<std::size_t>(max_boxes))
    return "the requested gap needs more than " + std::to_string(max_boxes) + " boxes (--boxes)";
  return "the requested gap cannot be reached: the remaining boxes cannot be decided in double precision";
}

/// The requested solid of poses, in the swept coordinates; the other coordinates have their fixed values.
/// @param kind  "box", "cylinder" or "sphere"
PoseSolid solid_of(const Target& target, const WorkspacePlan& plan, const std::string& kind,
                   const std::vector<std::string>& lists) {
  const MechanismInfo& info = target.info();
  const Sweep& sweep = sweep_of(info, plan);
  const std::vector<Assignable> swept = assignable_coordinates(info, sweep);
  const std::string option = "--" + kind;
  if (kind == "box") return {.ranges = parse_pose_box(target, plan, lists)};
  PoseSolid solid{.ranges = std::vector<std::array<double, 2>>(info.coordinates.size())};
  for (const int coordinate : sweep.fixed)
    solid.ranges[static_cast<std::size_t>(coordinate)].fill(
        fixed_value(*target.mechanism, target.parameters, plan, coordinate));
  // The list is, for example, "x=0,y=0,z=-0.4:-0.2,diameter=0.6": a cylinder extends along the coordinate that has a
  // range.
  std::vector<std::string> ranges, numbers;
  for (const std::string& item : list_items(lists))
    (item.find(':') == std::string::npos && item.find("..") == std::string::npos ? numbers : ranges).push_back(item);
  const bool is_cylinder = kind == "cylinder";
  const std::string expected =
      is_cylinder
          ? "one range, of the coordinate along which the cylinder extends, such as x=0,y=0,z=-0.4:-0.2,diameter=0.6"
          : "no range: the centre and the diameter, such as x=0,y=0,z=-0.3,diameter=0.2";
  if (is_cylinder && swept.size() != 3)
    throw ConfigError({"", 0, option}, "a workspace over " + std::to_string(swept.size()) + " coordinates", "three");
  if (ranges.size() != (is_cylinder ? 1 : 0))
    throw ConfigError({"", 0, option}, std::to_string(ranges.size()) + " ranges", expected);
  const auto heights = parse_some_ranges(ranges, option, swept);
  std::vector<Assignable> round;
  std::vector<std::size_t> ball;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const auto coordinate = static_cast<std::size_t>(sweep.swept[i]);
    if (heights[i]) {
      solid.ranges[coordinate] = *heights[i];
      continue;
    }
    if (info.coordinates[coordinate].turns())
      throw ConfigError({"", 0, option}, "the swept angle " + swept[i].name, "lengths across the " + kind);
    round.push_back(swept[i]);
    ball.push_back(coordinate);
  }
  round.push_back({.name = "diameter", .unit = "m", .lower = 1e-9});
  const std::vector<double> values = parse_all_assignments(numbers, option, round);
  for (std::size_t i = 0; i < ball.size(); ++i)
    solid.ranges[ball[i]] = {values[i] - values.back() / 2, values[i] + values.back() / 2};
  solid.balls = {ball};
  return solid;
}

/// A property to be proven for all poses of a solid or a motion.
struct PosesClaim {
  std::string key;       ///< name of the property in JSON and in the text
  std::string if_holds;  ///< word that is printed if the property is proven
  std::string property;  ///< adjective for the property in the error message
};

/// Adds the result of one proof to the output.
/// @param region  "box", "cylinder", "sphere" or "motion"
/// @return the error message; "" if the property is proven
std::string report_claim(const MechanismInfo& info, const PosesClaim& claim, const PropertyResult& result,
                         const std::string& region, Printout& out) {
  using Kind = PropertyResult::Kind;
  static const std::map<Kind, std::string> kinds = {
      {Kind::holds, "yes"}, {Kind::fails, "no"}, {Kind::undecided, "undecided"}, {Kind::not_examined, "not examined"}};
  out.json[claim.key] = {{"verdict", kinds.at(result.kind)},
                         {"what", text_or_null(result.detail)},
                         {"pose", axes_json(info.coordinates, result.pose)}};
  if (region == "motion") out.json[claim.key]["time"] = json_or_null(result.time);
  const std::string where = !result.pose ? ""
                                         : (result.time ? "t = " + number(*result.time, "s") + ", " : "") +
                                               axes_text(info.coordinates, *result.pose);
  const bool singular = claim.key == "regular";
  switch (result.kind) {
    case Kind::holds:
      out.head.push_back({claim.key, claim.if_holds});
      return "";
    case Kind::fails:
      out.head.push_back({claim.key, singular ? "no, singular at " + where + ": " + result.detail
                                              : "not everywhere: " + result.detail + " is violated at " + where});
      return "the " + region + " is not " + claim.property + " everywhere";
    case Kind::undecided:
      out.head.push_back({claim.key, "undecided: " + result.detail + ", near " + where});
      return "the " + region + " has poses that could not be decided";
    default:
      out.head.push_back({claim.key, "not examined, because " + result.detail});
      return "singularities were not examined";
  }
}

/// Adds the results on feasibility and on singularities to the output. @return the error message on the first property
/// that is not proven; "" if both are proven
std::string report_poses(const MechanismInfo& info, const PoseCertificate& found, const std::string& region,
                         Printout& out) {
  const std::string in = (region == "motion" ? "along the " : "in the ") + region;
  const std::string infeasible =
      report_claim(info, {"feasible", "everywhere " + in, "feasible"}, found.feasible, region, out);
  const std::string singular =
      report_claim(info, {"regular", "no singularity " + in, "regular"}, found.regular, region, out);
  out.add("boxes", found.boxes, std::to_string(found.boxes) + " examined");
  return infeasible.empty() ? singular : infeasible;
}

std::string certify(const Target& target, const CertifyArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const RigorousBounds& bounds =
      require_capability(target.mechanism->bounds(), "certify", "formulas for interval arithmetic", info);
  const double gap = parse_gap(arguments.gap, "--gap");
  std::string region;  // the set of poses to be certified: "box", "cylinder", "sphere" or "motion"
  for (const auto& [kind, is_given] : {std::pair("box", !arguments.box.empty()),
                                       {"cylinder", !arguments.cylinder.empty()},
                                       {"sphere", !arguments.sphere.empty()},
                                       {"motion", !arguments.motion.empty()}}) {
    if (!is_given) continue;
    const std::string option = std::string("--") + kind;
    if (!arguments.proof.empty())
      throw ConfigError({"", 0, "--proof"}, "proofs are written for volumes only, not for " + option);
    if (!region.empty()) throw ConfigError({"", 0, option}, "cannot be combined with --" + region);
    region = kind;
  }
  const Existing existing = if_forced(arguments.force);
  const auto motion = arguments.motion.empty() ? nullptr : find_motion(target, arguments.motion);
  const WorkspacePlan plan = target.plan();
  const std::string mode = parse_mode(info, arguments);
  check_outputs({arguments.proof}, target.files, existing);
  out.add("mechanism", info.name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.add("design", target.words);
  out.json["parameters"] = values_by_name(info.parameters, target.parameters);

  const StopRequest stop;
  std::string proof;
  const BoundsOptions options{.gap = gap,
                              .max_boxes = static_cast<std::size_t>(arguments.boxes),
                              .proof = arguments.proof.empty() ? nullptr : &proof,
                              .stop = [] { return StopRequest::signal() != 0; }};
  std::string error;
  try {
    with_team(arguments.threads, [&] {
      if (!region.empty() && !motion) {
        const auto& lists = region == "box"        ? arguments.box
                            : region == "cylinder" ? arguments.cylinder
                                                   : arguments.sphere;
        const PoseSolid solid = solid_of(target, plan, region, lists);
        error = report_poses(info, bounds.solid(target.parameters, plan, mode, solid, options), region, out);
        return;
      }
      if (motion) {
        out.add("motion", arguments.motion);
        out.add("duration", motion->duration(), number(motion->duration(), "s"));
        error =
            report_poses(info, bounds.motion(target.parameters, plan.limits, mode, *motion, options), "motion", out);
        return;
      }
      const auto start = std::chrono::steady_clock::now();
      const VolumeBounds found = bounds.volume(target.parameters, plan, mode, options);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      report_volume(target, plan, found, gap, seconds.count(), out);
      error = shortfall(found, gap, arguments.boxes);
    });
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, info.name}, reason.what());
  }
  if (arguments.proof.empty()) return error;
  write_file(arguments.proof, proof, existing);
  out.json["proof"] = arguments.proof;
  out.text += "wrote " + arguments.proof + '\n';
  return error;
}

}  // namespace

void add_certify(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<CertifyArguments>(
      app, session, "certify", "Compute guaranteed bounds on a design's workspace volume (interval arithmetic).",
      "Evaluates the formulas of a mechanism file in interval arithmetic with outward rounding, so that the volume is\n"
      "guaranteed to lie within the bounds. Parameters are taken as exact double-precision numbers. Ctrl-C stops with\n"
      "the bounds reached so far. With --box, --cylinder or --sphere, proves instead that every pose of the solid is\n"
      "feasible and not singular, or prints a counterexample; with --motion, does the same for every instant of a\n"
      "motion, or prints the first infeasible instant.\n"
      "Example: pkmopt certify experiments/mechanisms/orthoglide.toml --gap 1e-3 --proof orthoglide.proof",
      certify);
  add_option(command, "--gap GAP", arguments.gap,
             "Relative gap (upper - lower) / mean at which to stop (default 0.01)");
  add_option(command, "--box NAME=FROM:TO", arguments.box,
             "Certify all poses within these ranges of the swept coordinates")
      ->allow_extra_args(false);
  add_option(command, "--cylinder NAME=VALUE", arguments.cylinder,
             "Certify all poses of a cylinder: its centre, its diameter, and a range along its axis, such as "
             "x=0,y=0,z=-0.4:-0.2,diameter=0.6")
      ->allow_extra_args(false);
  add_option(
      command, "--sphere NAME=VALUE", arguments.sphere,
      "Certify all poses of a sphere or circle: its centre and its diameter, such as x=0,y=0,z=-0.3,diameter=0.2")
      ->allow_extra_args(false);
  add_option(command, "--motion MOTION.toml", arguments.motion,
             "Certify all poses of a motion: a TOML file, or the name of a [[motion]] of the study");
  add_option(command, "-o,--proof FILE", arguments.proof, "Write a proof of the bounds, for pkmopt-check-proof");
  command.add_flag("--force", arguments.force, "Overwrite an existing proof");
  add_integer(command, "--boxes N", arguments.boxes, 1, 100000000, "Maximum number of boxes (default 4000000)");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'; default: the first)");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
