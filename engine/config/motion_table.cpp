#include "engine/config/motion_table.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/csv_columns.hpp"
#include "engine/config/motion_formulas.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/unit.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

using Coordinates = std::vector<AxisInfo>;
using Names = std::vector<std::string>;

constexpr double kLongestMotion = 1e9;  // maximum duration of a motion [s], about 30 years

TimeLaw law_of(const ConfigValue& table) {
  const std::string law = table.word_at("law");
  if (law == "trapezoid") return TimeLaw::trapezoid;
  return law == "cycloid" ? TimeLaw::cycloid : TimeLaw::quintic;
}

/// Descriptions of the keys that give the values of the coordinates at a point of a motion.
std::vector<OptionSpec> coordinate_keys(const ConfigValue& point, const Coordinates& names) {
  return named_keys(point.table_spec(), names_of(names));
}

/// Reads a pose: a value for every coordinate.
Pose<double> pose_at(const ConfigValue& table, const Coordinates& names) {
  Pose<double> pose(names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    pose[i] = table.at(names[i].name, quantity_hint(names[i].unit)).number(names[i].unit);
  return pose;
}

/// The data that determine the duration of a move: `time`, or peak accelerations and speeds.
struct Pace {
  std::optional<double> time;
  PeakRates most = {};
};

/// The pace of the move to a point: it is given by the table of the point or, if this table does not give it, by
/// `general`, the pace of the whole motion.
Pace pace_of(const ConfigValue& table, const Pace& general) {
  const auto peak = [&table](const char* key) { return table.find_number(key).value_or(kUnbounded); };
  const Pace pace{table.find_number("time"),
                  {.acceleration = peak("acceleration"),
                   .angular_acceleration = peak("angular_acceleration"),
                   .speed = peak("speed"),
                   .angular_speed = peak("angular_speed")}};
  const auto& [acceleration, angular_acceleration, speed, angular_speed] = pace.most;
  const bool accelerates = std::min(acceleration, angular_acceleration) < kUnbounded,
             bounded = accelerates || std::min(speed, angular_speed) < kUnbounded;
  if (pace.time && bounded)
    throw table.find("time")->refusal(std::string("the time of the move also follows from the peak ") +
                                      (accelerates ? "acceleration" : "speed") + "; give one of them");
  return pace.time || bounded ? pace : general;
}

/// Duration of a move. Throws ConfigError if the pace does not determine it.
double time_of(const ConfigValue& point, const Coordinates& names, const Pose<double>& from, const Pose<double>& to,
               const Pace& pace, TimeLaw law) {
  if (pace.time) return *pace.time;
  bool moves = false, turns = false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (to[i] - from[i] != 0) (names[i].turns() ? turns : moves) = true;
  const PeakRates& most = pace.most;
  if (!moves && !turns)
    throw point.refusal("this point equals the previous one; to stay there, give the previous point a wait = ..");
  if (moves && std::min(most.acceleration, most.speed) == kUnbounded)
    throw point.refusal(
        "the duration of the move to this point is not determined; give time = .., acceleration = .. or speed = ..");
  if (turns && !moves && std::min(most.angular_acceleration, most.angular_speed) == kUnbounded)
    throw point.refusal(
        "the duration of the rotation to this point is not determined; give time = .., angular_acceleration = .. or "
        "angular_speed = ..");
  return min_move_duration(law, names, from, to, most);
}

std::shared_ptr<const Motion> read_points(const ConfigValue& table, const Coordinates& names) {
  const std::string expected = "a list of points, [{ " + names[0].name + " = .., " +
                               (names.size() > 1 ? names[1].name + " = .., " : "") + "... }, ...]";
  const ConfigValue list = table.at("points", expected);
  std::vector<ConfigValue> points;
  for (const ConfigValue& point : list.elements(expected)) points.push_back(point.table(coordinate_keys(point, names)));
  if (points.size() < 2) throw list.error("at least two points");
  const TimeLaw law = law_of(table);
  const Pace general = pace_of(table, {});
  Names of_start = names_of(names);
  of_start.emplace_back("wait");
  points[0].allow(of_start);
  const Pose<double> start = pose_at(points[0], names);
  double wait = points[0].number_at("wait");
  std::vector<Move> moves;
  Pose<double> at = start;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const ConfigValue& point = points[k];
    Pose<double> to = at;
    for (std::size_t i = 0; i < names.size(); ++i)
      to[i] = point.find_number(names[i].name, names[i].unit).value_or(at[i]);
    moves.push_back({wait, to, time_of(point, names, at, to, pace_of(point, general), law)});
    wait = point.number_at("wait");
    at = to;
  }
  if (table.flag_at("back"))
    for (std::size_t k = points.size() - 1; k > 0; --k) {
      moves.push_back({points[k].number_at("wait"), k == 1 ? start : moves[k - 2].to, moves[k - 1].duration});
      wait = 0;
    }
  return point_to_point(start, moves, wait, law);
}

std::shared_ptr<const Motion> read_oscillation(const ConfigValue& table, const Coordinates& names) {
  const SpaceAxes axes = space_axes(names);
  if (!axes.x && !axes.y && !axes.z)
    throw table.refusal("an oscillation needs a coordinate x, y or z, and the mechanism has none of them");
  return oscillation(axes, pose_at(table, names), table.number_at("amplitude"), table.number_at("period"),
                     table.number_at("cycles"));
}

std::shared_ptr<const Motion> read_pick_and_place(const ConfigValue& table, const Coordinates& names) {
  PickAndPlace cycle;
  cycle.start = pose_at(table, names);
  cycle.lift = table.number_at("lift");
  cycle.reach = table.number_at("reach");
  cycle.lift_time = table.number_at("lift_time");
  cycle.reach_time = table.number_at("reach_time");
  cycle.overlap = table.find_number("overlap", "s", 0, std::fmin(cycle.lift_time, cycle.reach_time)).value_or(0);
  cycle.direction = table.number_at("direction");
  cycle.turn = table.number_at("turn");
  cycle.wait = table.number_at("wait");
  cycle.back = table.word_at("cycle") == "whole";
  cycle.law = law_of(table);
  cycle.axes = space_axes(names);
  const auto expect = [&table](const std::optional<std::size_t>& axis, const std::string& name, double way) {
    if (!axis && way != 0)
      throw table.refusal("this pick-and-place changes " + name + ", but the mechanism has no such coordinate");
  };
  const auto [sine, cosine] = sincos(cycle.direction);
  expect(cycle.axes.z, "z", cycle.lift);
  expect(cycle.axes.x, "x", cycle.reach * cosine);
  expect(cycle.axes.y, "y", cycle.reach * sine);
  expect(cycle.axes.turn, "an angle", cycle.turn);
  return pick_and_place(cycle);
}

/// Reads the value of a coordinate: a number, text with a unit, or a formula of the time.
Formula coordinate_formula(const ConfigValue& value, const std::string& unit) {
  if (!value.is_text()) return Formula(shortest(value.number(unit)), time_name());
  const std::string& text = value.text("text");
  if (const auto number = parse_quantity(text, unit)) return Formula(shortest(*number), time_name());
  return value.explained([&text] { return Formula(text, time_name()); });
}

std::shared_ptr<const Motion> read_formulas(const ConfigValue& table, const Coordinates& names) {
  const double duration = table.number_at("duration");
  std::vector<Formula> formulas;
  for (const AxisInfo& axis : names)
    formulas.push_back(coordinate_formula(
        table.at(axis.name, "a formula of the time t [s], such as \"0.1*sin(2*pi*t)\", or a number in " + axis.unit),
        axis.unit));
  return motion_from_formulas(formulas, duration);
}

struct MotionKind {
  const char* name;
  std::shared_ptr<const Motion> (*read)(const ConfigValue&, const Coordinates&);
};

constexpr MotionKind kMotionKinds[] = {{"points", read_points},
                                       {"pick-and-place", read_pick_and_place},
                                       {"oscillation", read_oscillation},
                                       {"formulas", read_formulas}};

/// The table of a motion, checked by the description of its keys.
ConfigValue motion_described_by(const TableSpec& spec, const ConfigValue& value, const MotionNames& names) {
  const bool has_points = value.expect_table().choice("type", names_of(kMotionKinds)) == "points";
  // If the motion has `points`, the coordinates are keys of each point.
  Names keys = has_points ? Names() : names_of(names.coordinates);
  for (const InputInfo& input : names.inputs) keys.push_back(input.name);
  return value.described_by(spec, named_keys(spec, keys));
}

std::shared_ptr<const Motion> read_motion(const ConfigValue& table, const MotionNames& names) {
  const std::vector<AxisInfo>& coordinates = names.coordinates;
  const std::vector<InputInfo>& inputs = names.inputs;
  const auto motion = find_named(kMotionKinds, table.at("type").word())->read(table, coordinates);
  if (!(motion->duration() <= kLongestMotion))
    throw table.refusal("the motion takes " + shortest(motion->duration()) + " s; expected at most " +
                        shortest(kLongestMotion) + " s");
  bool moves = false;
  std::vector<Formula> formulas;
  for (const InputInfo& input : inputs) {
    const auto given = table.find(input.name);
    moves = moves || given;
    formulas.push_back(given ? coordinate_formula(*given, input.unit) : Formula(shortest(input.value), time_name()));
  }
  return moves ? with_inputs(motion, formulas) : motion;
}

/// Reads the table of a motion for the given values of the parameters.
std::shared_ptr<const Motion> read_motion(const TableSpec& spec, const MotionFormulas& formulas,
                                          const SourceLocation& place, const MotionNames& names,
                                          std::span<const double> parameters) {
  const TomlValue table = formulas.table_of(parameters);
  return read_motion(motion_described_by(spec, ConfigValue(table, place.file, place.key), names), names);
}

/// Function that returns the motion of a design, for a table whose values are formulas of parameters.
std::function<std::shared_ptr<const Motion>(std::span<const double>)> motion_of_designs(const std::string& name,
                                                                                        const MotionFormulas& formulas,
                                                                                        const SourceLocation& place,
                                                                                        const MotionNames& names) {
  return [=](std::span<const double> parameters) {
    try {
      return read_motion(motion_keys(), formulas, place, names, parameters);
    } catch (const ConfigError& error) {
      throw DesignError("the design has no motion " + name + ": " + message_of(error));
    }
  };
}

}  // namespace

MotionNames motion_names(const Mechanism& mechanism, std::span<const double> parameters) {
  const MechanismInfo& info = mechanism.info();
  return {info.coordinates, info.inputs, info.parameters, {parameters.begin(), parameters.end()}};
}

std::shared_ptr<const Motion> read_motion_toml(const std::string& text, const std::string& file_name,
                                               const MotionNames& names) {
  const TomlValue document = parse_toml(text, file_name);
  if (document.keys.empty())
    throw ConfigError({file_name, 0, ""}, "an empty file",
                      "a motion in TOML, with type = one of " + join(names_of(kMotionKinds)));
  const ConfigValue root(document, file_name, "");
  motion_described_by(motion_file_keys(), root, names);  // throws ConfigError for unknown keys
  const MotionFormulas formulas(root, names.parameters, names_of(names.inputs));
  return read_motion(motion_file_keys(), formulas, {file_name, 0, ""}, names, names.values);
}

std::shared_ptr<const Motion> read_motion_csv(const std::string& text, const std::string& file_name,
                                              const MotionNames& names) {
  constexpr std::size_t kFewestRows = 4;
  std::vector<Assignable> known = {{.name = "time", .unit = "s", .lower = 0, .upper = kLongestMotion}};
  for (const AxisInfo& axis : names.coordinates) known.push_back({.name = axis.name, .unit = axis.unit});
  const CsvColumns table = read_csv_columns(text, file_name, known);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!table.values[i])
      throw ConfigError({file_name, 1, ""}, "no column " + known[i].name, "time, " + join(names_of(names.coordinates)));
  if (table.rows < kFewestRows)
    throw ConfigError({file_name, 0, ""}, std::to_string(table.rows) + " rows",
                      "at least " + std::to_string(kFewestRows));
  const std::vector<double>& times = *table.values[0];
  if (times[0] != 0) throw ConfigError({file_name, 2, "time"}, shortest(times[0]) + " s", "0 s in the first row");
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1]))
      throw ConfigError({file_name, static_cast<int>(k) + 2, "time"}, shortest(times[k]) + " s",
                        "more than that of the previous row, " + shortest(times[k - 1]) + " s");
  std::vector<std::vector<double>> coordinates;
  for (std::size_t i = 1; i < known.size(); ++i) coordinates.push_back(*table.values[i]);
  return motion_from_table(times, coordinates);
}

std::shared_ptr<const Motion> load_motion(const std::string& path, const MotionNames& names) {
  if (path.ends_with(".csv")) return read_motion_csv(read_text_file(path, "a motion in CSV"), path, names);
  return read_motion_toml(read_text_file(path, "a motion in TOML"), path, names);
}

void read_motions(const ConfigValue& root, StudyDraft& draft) {
  const MotionNames names = motion_names(*draft.parts.mechanism, draft.parts.parameters);
  const std::string expected = "a list of tables, each written [[motion]]";
  const auto list = root.find("motion");
  for (const auto& each : list ? list->elements(expected) : std::vector<ConfigValue>()) {
    const ConfigValue table = motion_described_by(motion_keys(), each.expect_table(expected), names);
    const MotionFormulas formulas(each, names.parameters, names_of(names.inputs));
    const std::string name = new_name(table, "motion", draft.study.motions, "a name for objectives to refer to");
    DesignMotion motion{{name, read_motion(motion_keys(), formulas, each.place(), names, names.values)},
                        formulas.used()};
    if (!motion.parameters.empty()) motion.of_design = motion_of_designs(name, formulas, each.place(), names);
    if (const TomlValue* const law = each.toml().find("law"); law && law->text == "trapezoid")
      motion.why_no_derivatives = "the accelerations of the motion " + name +
                                  ", whose law is trapezoid, are discontinuous; use the law quintic or cycloid";
    draft.study.motions.push_back(std::move(motion));
    if (!table.flag_at("follow")) draft.study.unfollowed_motions.push_back(name);
  }
}

}  // namespace pkm
