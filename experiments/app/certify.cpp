// `pkmopt certify`: what is certain of one design's workspace, whatever numbers are rounded to.

#include <chrono>
#include <map>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/study/stop_request.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct CertifyArguments : DesignArguments, ModeArguments {
  std::string gap = "1e-2", proof, motion;
  std::vector<std::string> box;
  std::int64_t boxes = 4000000;
  int threads = 0;
  bool force = false;
};

void tell_volume(const Target& target, const SurveyPlan& plan, const VolumeBounds& bounds, double wanted,
                 double seconds, Printout& out) {
  const MechanismInfo& info = target.info();
  const std::string unit = volume_unit(info, plan);
  out.json["volume"] = {{"lower", bounds.lower}, {"upper", bounds.upper}, {"unit", unit}};
  out.head.push_back({"volume", "at least", number(bounds.lower, unit)});
  out.head.push_back({"", "at most", number(bounds.upper, unit)});
  out.say("gap", bounds.gap(), number(bounds.gap()) + ", asked for " + number(wanted));
  out.say("columns", coordinate_names(info, {bounds.innermost})[0]);
  out.say("boxes", bounds.boxes,
          std::to_string(bounds.boxes) + " of " + std::to_string(bounds.examined) + " looked at");
  out.say("seconds", seconds, formatted("%.2f", seconds));
}

/// Why the volume is not bounded as asked for; "": it is.
std::string shortfall(const VolumeBounds& bounds, double wanted, std::int64_t most_boxes) {
  if (bounds.gap() <= wanted) return "";
  if (bounds.stopped) return "stopped before the gap asked for was reached";
  if (bounds.boxes >= static_cast<std::size_t>(most_boxes))
    return "the gap asked for needs more than " + std::to_string(most_boxes) + " boxes (--boxes)";
  return "the gap asked for cannot be reached: what is left is undecided at the last digit";
}

/// Ranges by coordinate: those that --box gives of the swept ones, and what the others are held at.
std::vector<std::array<double, 2>> ranges_of(const Target& target, const SurveyPlan& plan,
                                             const std::vector<std::string>& box) {
  const MechanismInfo& info = target.info();
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Assignable> swept;
  for (const int coordinate : sweep.swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    swept.push_back({axis.name, axis.unit});
  }
  const auto given = parse_ranges(box, "--box", swept);
  std::vector<std::array<double, 2>> ranges(info.coordinates.size());
  for (std::size_t i = 0; i < swept.size(); ++i) ranges[static_cast<std::size_t>(sweep.swept[i])] = given[i];
  for (const int coordinate : sweep.held)
    ranges[static_cast<std::size_t>(coordinate)].fill(
        held_value(*target.mechanism, target.parameters, plan, coordinate));
  return ranges;
}

/// What is shown of all poses of a box or a motion: its key, its words where it holds and where it does not.
struct PosesClaim {
  std::string key, holds, not_shown;
};

/// @param what  "box" or "motion"
/// @return what is wrong; "": nothing
std::string tell_verdict(const MechanismInfo& info, const PosesClaim& claim, const PosesVerdict& verdict,
                         const std::string& what, Printout& out) {
  using Kind = PosesVerdict::Kind;
  static const std::map<Kind, std::string> kinds = {
      {Kind::holds, "yes"}, {Kind::fails, "no"}, {Kind::undecided, "undecided"}, {Kind::not_examined, "not examined"}};
  out.json[claim.key] = {{"verdict", kinds.at(verdict.kind)},
                         {"what", text_or_null(verdict.what)},
                         {"pose", axes_json(info.coordinates, verdict.where)}};
  if (what == "motion") out.json[claim.key]["time"] = json_or_null(verdict.time);
  const std::string where = !verdict.where ? ""
                                           : (verdict.time ? "t = " + number(*verdict.time, "s") + ", " : "") +
                                                 axes_text(info.coordinates, *verdict.where);
  const bool singular = claim.key == "regular";
  switch (verdict.kind) {
    case Kind::holds:
      out.head.push_back({claim.key, claim.holds});
      return "";
    case Kind::fails:
      out.head.push_back({claim.key, singular ? "no, singular at " + where + ": " + verdict.what
                                              : "not everywhere: " + verdict.what + " does not hold at " + where});
      return "the " + what + " is not " + claim.not_shown + " everywhere";
    case Kind::undecided:
      out.head.push_back({claim.key, "undecided: " + verdict.what + ", near " + where});
      return "the " + what + " is not decided everywhere";
    default:
      out.head.push_back({claim.key, "not examined, because " + verdict.what});
      return "singularities are not examined";
  }
}

std::string tell_poses(const MechanismInfo& info, const PosesCertificate& found, const std::string& what,
                       Printout& out) {
  const std::string in = (what == "box" ? "in the " : "along the ") + what;
  const std::string wrong = tell_verdict(info, {"feasible", "everywhere " + in, "feasible"}, found.feasible, what, out);
  const std::string singular =
      tell_verdict(info, {"regular", "no singularity " + in, "regular"}, found.regular, what, out);
  out.say("boxes", found.boxes, std::to_string(found.boxes) + " looked at");
  return wrong.empty() ? singular : wrong;
}

std::string certify(const Target& target, const CertifyArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const CertainBounds& bounds =
      needed(target.mechanism->bounds(), "certify", "formulas that can be computed over intervals", info);
  const double gap = parse_gap(arguments.gap, "--gap");
  const bool of_poses = !arguments.box.empty() || !arguments.motion.empty();
  if (of_poses && !arguments.proof.empty())
    throw ConfigError({"", 0, "--proof"}, arguments.box.empty() ? "--motion" : "--box",
                      "a volume: proofs are of volumes");
  if (!arguments.box.empty() && !arguments.motion.empty())
    throw ConfigError({"", 0, "--motion"}, "--box beside it", "one of them");
  const Existing existing = if_forced(arguments.force);
  const auto motion = arguments.motion.empty() ? nullptr : find_motion(target, arguments.motion);
  const SurveyPlan plan = target.plan();
  const std::string mode = known_mode(info, arguments);
  check_outputs({arguments.proof}, target.files, existing);
  out.say("mechanism", info.name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.say("design", target.words);
  out.json["parameters"] = values_by_name(info.parameters, target.parameters);

  const StopRequest stop;
  std::string proof;
  const BoundsOptions options{.gap = gap,
                              .most_boxes = static_cast<std::size_t>(arguments.boxes),
                              .proof = arguments.proof.empty() ? nullptr : &proof,
                              .stop = [] { return StopRequest::signal() != 0; }};
  std::string wrong;
  try {
    with_team(arguments.threads, [&] {
      if (!arguments.box.empty()) {
        const auto ranges = ranges_of(target, plan, arguments.box);
        wrong = tell_poses(info, bounds.box(target.parameters, plan, mode, ranges, options), "box", out);
        return;
      }
      if (motion) {
        out.say("motion", arguments.motion);
        out.say("duration", motion->duration(), number(motion->duration(), "s"));
        wrong = tell_poses(info, bounds.motion(target.parameters, plan.limits, mode, *motion, options), "motion", out);
        return;
      }
      const auto start = std::chrono::steady_clock::now();
      const VolumeBounds found = bounds.volume(target.parameters, plan, mode, options);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      tell_volume(target, plan, found, gap, seconds.count(), out);
      wrong = shortfall(found, gap, arguments.boxes);
    });
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, info.name}, reason.what());
  }
  if (arguments.proof.empty()) return wrong;
  write_file(arguments.proof, proof, existing);
  out.json["proof"] = arguments.proof;
  out.text += "wrote " + arguments.proof + '\n';
  return wrong;
}

}  // namespace

void add_certify(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<CertifyArguments>(
      app, session, "certify", "Bounds of one design's workspace that rounding cannot make wrong.",
      "The formulas of a mechanism's file are computed over intervals, rounded outward: the volume is certainly "
      "within\n"
      "the bounds. Ctrl-C ends with what is known so far. Numbers are taken as the doubles that they are. With --box,\n"
      "instead: whether every pose of the box is feasible and none is singular, else a pose that is not; with\n"
      "--motion, the same at every instant of a motion, else the first instant that is not.\n"
      "Example: pkmopt certify experiments/mechanisms/orthoglide.toml --gap 1e-3 --proof orthoglide.proof",
      certify);
  add_option(command, "--gap GAP", arguments.gap,
             "Greatest less least volume, relative to their mean, at which to end; default 0.01");
  add_option(command, "--box NAME=FROM:TO", arguments.box,
             "Ranges of the swept coordinates, whose poses are to be certified")
      ->allow_extra_args(false);
  add_option(command, "--motion MOTION.toml", arguments.motion,
             "A motion in TOML, or the name of a [[motion]] of the study, whose poses are to be certified");
  add_option(command, "-o,--proof FILE", arguments.proof, "Write the proof, which pkmopt-check-proof checks");
  command.add_flag("--force", arguments.force, "Overwrite an existing proof");
  add_integer(command, "--boxes N", arguments.boxes, 1, 100000000,
              "Boxes at which to end in any case; default 4000000");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'); default: the first");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
