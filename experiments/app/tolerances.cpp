// `pkmopt tolerances`: the largest deviations of a design's parameters within which every robot is proved to do a task.

#include <cmath>
#include <optional>
#include <stdexcept>

#include "engine/config/built_in_files.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/core/unit.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/generic/tolerances/certified_tolerances.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/tolerance_report.hpp"

namespace pkm {
namespace {

using generic::CertifiedTolerances, generic::ToleranceProportions;

struct TolerancesArguments : DesignArguments, ModeArguments, TableOutput {
  std::string gap = "2e-2", motion, yield;
  std::vector<std::string> box, of;
  bool copies = false, free = false;
  std::int64_t boxes = 1000000;
  int threads = 0;
};

/// An entry of the value of --of: NAME or NAME=SIZE.
struct Deviation {
  std::string name, size;
};

/// Splits the values of --of, which are lists separated by commas, into entries.
std::vector<Deviation> split_deviations(const std::vector<std::string>& lists) {
  std::vector<Deviation> all;
  for (std::string list : lists) {
    std::erase(list, ' ');
    for (list += ','; !list.empty(); list.erase(0, list.find(',') + 1)) {
      const std::string entry = list.substr(0, list.find(','));
      const auto equals = std::min(entry.find('='), entry.size());
      all.push_back({entry.substr(0, equals), entry.substr(std::min(equals + 1, entry.size()))});
    }
  }
  return all;
}

// Default size of the tolerance of a length [m]; only the ratios of the sizes are relevant.
constexpr double kDefaultSize = 1e-3;

/// The size [SI] of a parameter's tolerance; the ratios of the tolerances are those of their sizes.
double size_of(const Deviation& deviation, const Parameter& parameter) {
  const SourceLocation place{"", 0, "--of"};
  if (deviation.size.empty() && parameter.unit == "m") return kDefaultSize;
  if (deviation.size.empty())
    throw ConfigError(place, "'" + deviation.name + "', which is not a length",
                      "its size for the proportions, where that of lengths is 1 mm: " + deviation.name + "=0.1" +
                          (parameter.unit == "rad" ? "deg" : ""));
  const auto size = parse_quantity(deviation.size, parameter.unit);
  if (!size || !(*size > 0) || !std::isfinite(*size))
    throw ConfigError(place, "'" + deviation.name + "=" + deviation.size + "'",
                      "a size > 0" + (parameter.unit == "1" ? "" : " in " + parameter.unit));
  return *size;
}

/// The text of the target's mechanism file; std::nullopt for a mechanism that is written in C++.
std::optional<SourceText> description_of(const Target& target, const std::string& name) {
  if (target.study) return target.study->description;
  if (auto built_in = find_built_in_file(name)) return built_in;
  if (!looks_like_file(name)) return {};
  return SourceText{read_text_file(name, "a mechanism in TOML"), name};
}

/// For --copies, the parameters of single limbs that deviate independently: of every limb, those of its parameters that
/// --of names, by default all lengths.
std::vector<std::string> copied_parameters(const TolerancesArguments& arguments, const Target& target) {
  const MechanismInfo& info = target.info();
  const std::vector<std::string> given = assigned_names(arguments.of);
  std::vector<std::string> common, copied;
  for (const Parameter& parameter : info.parameters)
    if (parameter.name.find('.') == std::string::npos &&
        (given.empty() ? parameter.unit == "m" : contains(given, parameter.name)))
      common.push_back(parameter.name);
  if (const auto description = description_of(target, arguments.target))
    for (const LimbParameter& copy : limb_copies(description->text, description->file_name, common, {}))
      copied.push_back(copy.name());
  if (copied.empty())
    throw ConfigError({"", 0, "--copies"}, "no limb of " + info.name + " that uses these parameters",
                      "a mechanism file with such limbs, or --of LIMB.NAME without --copies");
  return copied;
}

/// The target of a mechanism in which single limbs have parameters of their own. These have the values of the common
/// parameters, unless the mechanism or --set gives them others.
Target with_limb_parameters(const Session& session, const DesignArguments& given, const Target& common,
                            const std::vector<std::string>& own) {
  DesignArguments arguments = given;
  arguments.changes.limb_parameters = own;
  Target target = find_target(session, arguments);
  const std::vector<Parameter>& known = target.info().parameters;
  const auto value = [&](const std::string& name) -> double& {
    const Parameter* const parameter = find_named(known, name);
    if (!parameter) throw ConfigError({"", 0, "--of"}, "the unknown parameter '" + name + "'");
    return target.parameters[static_cast<std::size_t>(parameter - known.data())];
  };
  const std::vector<std::string> set = assigned_names(arguments.set);
  for (const std::string& name : own)
    if (!contains(set, name) && !find_named(common.info().parameters, name))
      value(name) = value(name.substr(name.find('.') + 1));
  return target;
}

/// The entries of --of and, for --copies, an entry for each parameter of a single limb, with the size of the common
/// parameter.
std::vector<std::string> with_copies(std::vector<std::string> of, const std::vector<std::string>& copied) {
  if (of.empty()) return of;
  const std::vector<Deviation> given = split_deviations(of);
  for (const std::string& name : copied) {
    const Deviation* const common = find_named(given, name.substr(name.find('.') + 1));
    of.push_back(name + (common && !common->size.empty() ? "=" + common->size : ""));
  }
  return of;
}

/// The parameters that deviate, with the sizes of their tolerances: those of --of, by default all lengths; only
/// parameters on which poses depend.
ToleranceProportions proportions_of(const Target& target, const std::vector<std::string>& of) {
  const SourceLocation place{"", 0, "--of"};
  const std::vector<Parameter>& known = target.info().parameters;
  const std::vector<bool> affects = generic::affects_poses(*target.mechanism, target.limits);
  std::vector<Deviation> deviations = split_deviations(of);
  if (of.empty())
    for (const Parameter& parameter : known)
      if (parameter.unit == "m") deviations.push_back({parameter.name, ""});
  ToleranceProportions proportions;
  for (const Deviation& deviation : deviations) {
    const Parameter* const parameter = find_named(known, deviation.name);
    if (!parameter)
      throw ConfigError(place, "the unknown parameter '" + deviation.name + "'", "one of " + join(names_of(known)),
                        nearest_name(deviation.name, names_of(known)));
    const auto index = static_cast<std::size_t>(parameter - known.data());
    if (contains(proportions.parameters, index)) throw ConfigError(place, "'" + deviation.name + "' twice");
    const double size = size_of(deviation, *parameter);
    if (!affects[index]) continue;
    proportions.parameters.push_back(index);
    proportions.sizes.push_back(size);
  }
  if (proportions.parameters.empty())
    throw ConfigError(place, of.empty() ? "no length on which the poses depend" : join(of),
                      "at least one parameter on which the poses depend");
  return proportions;
}

/// Throws ConfigError unless the yield is 1, the only one that a certified tolerance has.
void check_yield(const std::string& text) {
  if (text.empty() || parse_number(text, "--yield", "1") == 1) return;
  throw ConfigError({"", 0, "--yield"}, text,
                    "1, because every robot within certified tolerances does the task; the share of robots within "
                    "given tolerances that do it is sampled by the objective 'yield' of a study");
}

std::string tolerances(const Session& session, const Target& common, TolerancesArguments arguments, Printout& out) {
  check_yield(arguments.yield);
  const double gap = parse_gap(arguments.gap, "--gap");
  if (gap >= 1) throw ConfigError({"", 0, "--gap"}, arguments.gap, "a number between 0 and 1");
  if (arguments.box.empty() == arguments.motion.empty())
    throw ConfigError({"", 0, "--box"}, arguments.box.empty() ? "no task" : "both --box and --motion",
                      "the poses of the task: --box NAME=FROM:TO or --motion MOTION.toml");
  std::vector<std::string> own;
  for (const std::string& name : assigned_names(arguments.of))
    if (name.find('.') != std::string::npos) own.push_back(name);
  if (arguments.copies) {
    const std::vector<std::string> copied = copied_parameters(arguments, common);
    own.insert(own.end(), copied.begin(), copied.end());
    arguments.of = with_copies(arguments.of, copied);
  }
  const Target target = own.empty() ? common : with_limb_parameters(session, arguments, common, own);
  const MechanismInfo& info = target.info();
  require_capability(generic::evaluation_of(*target.mechanism), "tolerances", "formulas for interval arithmetic", info);
  const std::string mode = parse_mode(info, arguments);
  check_outputs({arguments.csv}, target.files, if_forced(arguments.force));
  out.add("mechanism", info.name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.add("design", target.words);
  out.json["parameters"] = values_by_name(info.parameters, target.parameters);
  generic::PoseSet poses;
  std::shared_ptr<const Motion> motion;
  if (arguments.motion.empty()) {
    poses.ranges = parse_pose_box(target, target.plan(), arguments.box);
  } else {
    motion = find_motion(target, arguments.motion);
    poses.motion = motion.get();
    out.add("motion", arguments.motion);
  }
  ToleranceProportions proportions = proportions_of(target, arguments.of);
  const StopRequest request;
  const auto stop = [] { return StopRequest::signal() != 0; };
  const BoundsOptions options{.gap = gap, .max_boxes = static_cast<std::size_t>(arguments.boxes), .stop = stop};
  CertifiedTolerances found;
  try {
    with_team(arguments.threads, [&] {
      if (arguments.free)
        proportions = generic::cheapest_proportions(*target.mechanism, target.parameters, target.limits, mode, poses,
                                                    proportions, stop);
      found = generic::certified_tolerances(*target.mechanism, target.parameters, target.limits, mode, poses,
                                            proportions, options);
    });
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, info.name}, reason.what());
  }
  const ToleranceReport report(target, proportions, found);
  report.add_to(out);
  if (!arguments.csv.empty()) {
    write_table(arguments, report.table());
    out.json["csv"] = arguments.csv;
    out.text += "wrote " + arguments.csv + '\n';
  }
  return report.shortfall(gap, arguments.boxes);
}

}  // namespace

void add_tolerances(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<TolerancesArguments>(
      app, session, "tolerances", "Compute tolerances within which every robot is proved to do a task.",
      "Finds the largest tolerances of a design's parameters such that all robots within them are feasible and not\n"
      "singular at all poses of a box, or at all instants of a motion. The tolerances are certified by interval\n"
      "arithmetic, as by 'pkmopt certify'; a robot slightly beyond them that does not do the task is printed, too.\n"
      "Ctrl-C stops with the tolerances certified so far.\n"
      "Example: pkmopt tolerances experiments/mechanisms/five-bar.toml --box x=-50mm:50mm,y=300mm:400mm",
      [&session](const Target& target, const TolerancesArguments& given, Printout& out) {
        return tolerances(session, target, given, out);
      });
  add_option(command, "--box NAME=FROM:TO", arguments.box, "The task: all poses within these ranges of coordinates")
      ->allow_extra_args(false);
  add_option(command, "--motion MOTION.toml", arguments.motion,
             "The task: all poses of a motion, a TOML file or the name of a [[motion]] of the study");
  add_option(
      command, "--of NAME|NAME=SIZE", arguments.of,
      "Parameters that deviate, with sizes for their proportions, l_a=1mm,l_b=2mm (default: all lengths, equally)")
      ->allow_extra_args(false);
  command.add_flag("--free", arguments.free,
                   "Choose the proportions that minimise the cost, which is the sum of SIZE / tolerance");
  command.add_flag("--copies", arguments.copies, "Let the parameters of each limb deviate independently");
  add_option(command, "--yield 1", arguments.yield, "Share of the robots that do the task: 1, i.e. every one");
  add_option(command, "--gap GAP", arguments.gap,
             "Relative gap to the robot that does not do the task at which to stop (default 0.02)");
  add_integer(command, "--boxes N", arguments.boxes, 1, 100000000, "Maximum number of boxes (default 1000000)");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'; default: the first)");
  add_table_output(command, arguments, "Write the tolerances as a table of comma-separated values");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
