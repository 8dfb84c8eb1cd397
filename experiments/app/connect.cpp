// `pkmopt connect`: finds a path between two poses of one design along which no limit is violated and no singularity is
// crossed, and certifies it by interval arithmetic; or proves that there is no such path.

#include <algorithm>
#include <stdexcept>

#include "engine/config/motion_table.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/workspace/components.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct ConnectArguments : DesignArguments, ModeArguments, GridArguments {
  std::vector<std::string> start, end;  ///< coordinates of the two poses: values of --from and --to
  std::string motion;
  std::int64_t boxes = 1000000;
  int threads = 0;
  bool force = false;
};

/// The two poses, and the plan whose swept coordinates vary along the path.
struct PathTask {
  WorkspacePlan plan;
  Pose<double> from, to;

  std::array<double, 3> swept(const Pose<double>& pose, const Sweep& sweep) const {
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < sweep.swept.size(); ++i) values[i] = pose[static_cast<std::size_t>(sweep.swept[i])];
    return values;
  }
};

PathTask read_task(const Target& target, const ConnectArguments& arguments) {
  const MechanismInfo& info = target.info();
  const auto known = assignable_axes(info.coordinates);
  const auto from = parse_assignments(arguments.start, "--from", known),
             to = parse_assignments(arguments.end, "--to", known);
  PathTask task{.plan = visualisation_plan(info, target.plan(), {1, 1, 1}), .from = {}, .to = {}};
  task.plan.method = target.plan().method;
  task.plan.home.reset();
  const Sweep& sweep = sweep_of(info, task.plan);
  const std::vector<std::string> swept = coordinate_names(info, sweep.swept);
  for (const int coordinate : sweep.swept)
    for (const auto& [option, values] : {std::pair("--from", &from), {"--to", &to}})
      if (!(*values)[static_cast<std::size_t>(coordinate)])
        throw ConfigError({"", 0, option}, "no value of " + info.coordinates[static_cast<std::size_t>(coordinate)].name,
                          "values of " + join(swept));
  for (const int coordinate : sweep.fixed) {
    const auto i = static_cast<std::size_t>(coordinate);
    if (!from[i] && !to[i]) continue;
    if (from[i].value_or(*to[i]) != to[i].value_or(*from[i]))
      throw ConfigError({"", 0, "--to"}, "another value of " + info.coordinates[i].name + " than --from",
                        "the same value: paths vary " + join(swept) + " only; a study with [workspace] sweep names " +
                            "other coordinates");
    std::erase_if(task.plan.fixed, [&](const FixedCoordinate& fixed) { return fixed.coordinate == coordinate; });
    task.plan.fixed.push_back({coordinate, FixedCoordinate::Kind::value, from[i] ? *from[i] : *to[i]});
  }
  task.from = task.to = Pose<double>(info.coordinates.size());
  for (std::size_t i = 0; i < info.coordinates.size(); ++i) {
    const bool is_fixed = std::ranges::find(sweep.fixed, static_cast<int>(i)) != sweep.fixed.end();
    task.from[i] =
        is_fixed ? fixed_value(*target.mechanism, target.parameters, task.plan, static_cast<int>(i)) : *from[i];
    task.to[i] = is_fixed ? task.from[i] : *to[i];
  }
  return task;
}

/// Text of a motion file: a motion through the points of a path, with a stop at each.
std::string motion_text(const MechanismInfo& info, const std::vector<Pose<double>>& points) {
  const auto value = [](double x) {
    const std::string digits = formatted("%.17g", x);
    return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
  };
  std::string text =
      "# Path found by pkmopt connect, with a stop at each point; lengths in m, angles in rad.\n"
      "type   = \"points\"\ntime   = \"1 s\"\npoints = [\n";
  for (const Pose<double>& point : points) {
    text += "  { ";
    for (std::size_t i = 0; i < point.size(); ++i)
      text += (i == 0 ? "" : ", ") + info.coordinates[i].name + " = " + value(point[i]);
    text += " },\n";
  }
  return text + "]\n";
}

/// Result for the question whether there is a path between the two poses.
struct Answer {
  std::string verdict;  ///< answer to the question: "yes", "no" or "undecided"
  std::string reason;
  std::vector<Pose<double>> points;  ///< points of the path, if one was found
  std::size_t boxes = 0;             ///< number of boxes that interval arithmetic examined
};

/// Certifies the paths one after the other, until one is proven to be feasible and regular everywhere.
Answer certified(const Target& target, const PathTask& task, const std::string& mode,
                 const std::vector<std::vector<Pose<double>>>& paths, const BoundsOptions& options) {
  Answer answer{.verdict = "undecided", .reason = {}, .points = paths.front()};
  if (!target.mechanism->bounds()) {
    answer.reason = "a path was found by sampling, but a mechanism in C++ has no formulas to certify it with";
    return answer;
  }
  for (const auto& points : paths) {
    const auto motion = read_motion_toml(motion_text(target.info(), points), "path",
                                         motion_names(*target.mechanism, target.parameters));
    PoseCertificate found;
    try {
      found = target.mechanism->bounds()->motion(target.parameters, task.plan.limits, mode, *motion, options);
    } catch (const std::invalid_argument& why) {
      answer.reason = std::string("a path was found by sampling, but cannot be certified: ") + why.what();
      return answer;
    }
    answer.boxes += found.boxes;
    using Kind = PropertyResult::Kind;
    const bool is_regular = found.regular.kind == Kind::holds;
    if (found.feasible.kind == Kind::holds && is_regular)
      return {"yes", "every pose of the path is feasible and not singular (certified)", points, answer.boxes};
    const PropertyResult& open = found.feasible.kind == Kind::holds ? found.regular : found.feasible;
    answer.reason = "a path was found by sampling, but it is not certified: " + open.detail +
                    (open.kind == Kind::fails ? " is violated" : " is undecided");
  }
  return answer;
}

Answer find_path(const Target& target, const PathTask& task, const std::string& mode, const BoundsOptions& options) {
  const MechanismInfo& info = target.info();
  for (const auto& [name, pose] : {std::pair("--from", &task.from), {"--to", &task.to}}) {
    const PoseReport report =
        target.mechanism->inspect(target.parameters, *pose, mode.empty() ? info.modes.front() : mode, task.plan.limits);
    if (!report.feasible) return {"no", std::string("the pose ") + name + " is infeasible: " + report.reason, {}, 0};
  }
  if (std::ranges::equal(task.from, task.to)) return {"yes", "the two poses are the same", {task.from}, 0};
  const Sweep& sweep = sweep_of(info, task.plan);
  const auto from = task.swept(task.from, sweep), to = task.swept(task.to, sweep);
  Scratch scratch;
  const ComponentFinder finder(*target.mechanism, task.plan, mode);
  std::string on_grid;
  try {
    const VoxelMap map = prepare_voxel_map(*target.mechanism, task.plan, mode)->map(target.parameters);
    const ConnectedComponents components = finder.find(target.parameters, map, scratch);
    const std::uint32_t first = finder.holding(target.parameters, map, components, from, "the pose --from", scratch),
                        second = finder.holding(target.parameters, map, components, to, "the pose --to", scratch);
    if (first == second) {
      const auto path = finder.path(target.parameters, map, components, from, to, scratch);
      return certified(target, task, mode, {path.corners, path.cells}, options);
    }
    on_grid = "the cells of the poses are not connected on the grid (components " + std::to_string(first) + " and " +
              std::to_string(second) + ")";
  } catch (const DesignError& why) {
    on_grid = why.what();
  }
  Answer answer{.verdict = "undecided", .reason = on_grid, .points = {}};
  if (!target.mechanism->bounds()) {
    answer.reason += "; a mechanism in C++ has no formulas for a proof";
    return answer;
  }
  try {
    const Separation found =
        target.mechanism->bounds()->separate(target.parameters, task.plan, mode, task.from, task.to, options);
    answer.boxes = found.boxes;
    if (found.kind == Separation::Kind::undecided) {
      answer.reason += "; " + found.detail + "; use more cells (--cells) or boxes (--boxes)";
      return answer;
    }
    answer.verdict = "no";
    answer.reason = found.kind == Separation::Kind::signs
                        ? "the poses are on different sides of " + found.detail + " (proven)"
                        : "poses that are infeasible or beyond a singularity separate the two poses (proven)";
  } catch (const std::invalid_argument& why) {
    answer.reason += std::string("; ") + why.what();
  }
  return answer;
}

std::string connect(const Target& target, const ConnectArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  const Existing existing = if_forced(arguments.force);
  const std::string mode = parse_mode(info, arguments);
  Answer answer;
  with_team(arguments.threads, [&] {
    try {
      PathTask task = read_task(target, arguments);
      set_grid(task.plan, target, arguments, kPictureCells, kMaxFieldCells);
      check_outputs({arguments.motion}, target.files, existing);
      out.add("mechanism", info.name);
      if (target.study) out.head.push_back({"study", target.study->name});
      out.add("design", target.words);
      out.json["parameters"] = values_by_name(info.parameters, target.parameters);
      out.add("from", axes_json(info.coordinates, task.from), axes_text(info.coordinates, task.from));
      out.add("to", axes_json(info.coordinates, task.to), axes_text(info.coordinates, task.to));
      const StopRequest stop;
      answer = find_path(target, task, mode, {.max_boxes = static_cast<std::size_t>(arguments.boxes), .stop = [] {
                                                return StopRequest::signal() != 0;
                                              }});
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, info.name}, reason.what());
    }
  });
  out.json["path"] = answer.verdict;
  out.json["reason"] = answer.reason;
  out.head.push_back({"path", answer.verdict + ", " + answer.reason});
  if (answer.boxes > 0) out.add("boxes", answer.boxes, std::to_string(answer.boxes) + " examined");
  out.json["points"] =
      list_json(answer.points, [&](const Pose<double>& pose) -> Json { return axes_json(info.coordinates, pose); });
  std::vector<Row> rows;
  for (const Pose<double>& pose : answer.points) {
    Row row = {std::to_string(rows.size())};
    for (std::size_t i = 0; i < pose.size(); ++i)
      row.push_back(info.coordinates[i].name + " = " + number(pose[i], info.coordinates[i].unit));
    rows.push_back(std::move(row));
  }
  out.add_table("points of the path, connected by straight lines", rows);
  if (!arguments.motion.empty() && answer.points.size() > 1) {
    write_file(arguments.motion, motion_text(info, answer.points), existing);
    out.json["motion"] = arguments.motion;
    out.text += "wrote " + arguments.motion + '\n';
  }
  if (answer.verdict == "yes") return "";
  return answer.verdict == "no" ? "there is no path" : "it is undecided whether there is a path";
}

}  // namespace

void add_connect(CLI::App& app, Session& session) {
  const auto run = [&session](const ConnectArguments& given) {
    ConnectArguments arguments = given;
    if (arguments.target.ends_with(".h5")) std::swap(arguments.target, arguments.DesignArguments::from);
    Printout out{.as_json = arguments.json};
    const SlowStepNotice slow = announce_slow_step(session, "connect is computing, Ctrl-C ends it");
    const std::string error = connect(find_target(session, arguments), arguments, out);
    out.print();
    if (!error.empty()) throw std::runtime_error(error);
  };
  const auto [command, arguments] = add_command<ConnectArguments>(
      app, "connect", "Find a path between two poses of one design, or prove that there is none.",
      "A path violates no limit of the study and crosses no singularity. The coordinates that the study sweeps vary\n"
      "along it; the others have one value. It is searched on a voxel grid, and certified by interval arithmetic at\n"
      "every pose. If the poses are not connected on the grid, interval arithmetic tries to prove that there is no "
      "path.\n"
      "Exit code 1: there is no path, or it is undecided whether there is one.\n"
      "Example: pkmopt connect five-bar.toml --from x=-50mm,y=300mm --to x=50mm,y=300mm -o path.toml",
      run);
  add_option(command, "MECHANISM|FILE", arguments.target,
             "Name of a mechanism, or path of a mechanism file, a study, or a study file (F.h5), of which the best "
             "design is used");
  add_design_options(command, arguments);
  add_list_option(command, "--from", arguments.start, "The first pose")->required();
  add_list_option(command, "--to", arguments.end, "The last pose")->required();
  add_grid_options(command, arguments, kPictureCells);
  add_option(command, "-o,--motion MOTION.toml", arguments.motion,
             "Write the path as a motion, with a stop at each point, for 'certify --motion' and 'trajectory'");
  command.add_flag("--force", arguments.force, "Overwrite an existing file");
  add_integer(command, "--boxes N", arguments.boxes, 1, 100000000, "Maximum number of boxes (default 1000000)");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'; default: the first)");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
