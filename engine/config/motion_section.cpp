#include "engine/config/motion_section.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/sections.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/unit.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

using Coordinates = std::vector<AxisInfo>;
using Keys = std::vector<std::string>;

constexpr double kLongestMotion = 1e9;  // [s], about 30 years

/// A number > 0 that must be there.
double positive_at(const ConfigValue& table, const std::string& key, const std::string& unit) {
  return table.at(key, "a number > 0 " + unit).positive(unit);
}

std::optional<double> find_positive(const ConfigValue& table, const std::string& key, const std::string& unit) {
  const auto value = table.find(key);
  return value ? std::optional(value->positive(unit)) : std::nullopt;
}

double wait_of(const ConfigValue& table) { return table.find_number("wait", "s", 0).value_or(0); }

double number_at(const ConfigValue& table, const std::string& key, const std::string& unit) {
  return table.at(key, quantity_hint(unit)).number(unit);
}

TimeLaw law_of(const ConfigValue& table) {
  const auto law = table.find("law");
  return law && law->word({"quintic", "cycloid"}) == "cycloid" ? TimeLaw::cycloid : TimeLaw::quintic;
}

/// Refuses keys that are neither `type` nor a coordinate nor in one of the lists.
void allow(const ConfigValue& table, const Coordinates& coordinates, const Keys& keys, const Keys& more_keys) {
  Keys known = more_keys;
  known.push_back("type");
  for (const Keys& more : {names_of(coordinates), keys}) known.insert(known.end(), more.begin(), more.end());
  table.allow(known);
}

/// Every coordinate of a pose.
Pose<double> pose_at(const ConfigValue& table, const Coordinates& names) {
  Pose<double> pose(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) pose[i] = number_at(table, names[i].name, names[i].unit);
  return pose;
}

/// What bounds the time of a move: `time`, or peak accelerations and speeds.
struct Pace {
  std::optional<double> time;
  PeakRates most = {};
};
const Keys kPaceKeys = {"time", "acceleration", "angular_acceleration", "speed", "angular_speed"};

/// The table's own pace, or `general` where it gives none.
Pace pace_of(const ConfigValue& table, const Pace& general) {
  const auto peak = [&table](const char* key, const char* unit) {
    return find_positive(table, key, unit).value_or(kUnbounded);
  };
  const Pace pace{find_positive(table, "time", "s"),
                  {.acceleration = peak("acceleration", "m/s^2"),
                   .angular_acceleration = peak("angular_acceleration", "rad/s^2"),
                   .speed = peak("speed", "m/s"),
                   .angular_speed = peak("angular_speed", "rad/s")}};
  const auto& [acceleration, angular_acceleration, speed, angular_speed] = pace.most;
  const bool accelerates = std::min(acceleration, angular_acceleration) < kUnbounded,
             bounded = accelerates || std::min(speed, angular_speed) < kUnbounded;
  if (pace.time && bounded)
    throw table.find("time")->refusal(std::string("the time follows from the peak ") +
                                      (accelerates ? "acceleration" : "speed") + "; give one of them");
  return pace.time || bounded ? pace : general;
}

/// Throws where the pace says nothing of this move.
double time_of(const ConfigValue& point, const Coordinates& names, const Pose<double>& from, const Pose<double>& to,
               const Pace& pace, TimeLaw law) {
  if (pace.time) return *pace.time;
  bool moves = false, turns = false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (to[i] - from[i] != 0) (names[i].turns() ? turns : moves) = true;
  const PeakRates& most = pace.most;
  if (!moves && !turns) throw point.refusal("it is the point before; give the time to stay there as its wait");
  if (moves && std::min(most.acceleration, most.speed) == kUnbounded)
    throw point.refusal("nothing says how fast to move there; give time = .., acceleration = .. or speed = ..");
  if (turns && !moves && std::min(most.angular_acceleration, most.angular_speed) == kUnbounded)
    throw point.refusal(
        "nothing says how fast to turn there; give time = .., angular_acceleration = .. or angular_speed = ..");
  return min_move_duration(law, names, from, to, most);
}

std::shared_ptr<const Motion> read_points(const ConfigValue& table, const Coordinates& names, const Keys& more_keys) {
  Keys keys = {"points", "law", "back"};
  keys.insert(keys.end(), kPaceKeys.begin(), kPaceKeys.end());
  allow(table, {}, keys, more_keys);
  const std::string expected = "a list of points, [{ " + names[0].name + " = .., " +
                               (names.size() > 1 ? names[1].name + " = .., " : "") + "... }, ...]";
  const ConfigValue list = table.at("points", expected);
  const auto points = list.elements(expected);
  if (points.size() < 2) throw list.error("two points at least");
  const TimeLaw law = law_of(table);
  const Pace general = pace_of(table, {});
  keys = names_of(names);
  keys.emplace_back("wait");
  points[0].expect_table("a table of coordinates, { name = value, ... }").allow(keys);
  keys.insert(keys.end(), kPaceKeys.begin(), kPaceKeys.end());
  const Pose<double> start = pose_at(points[0], names);
  double wait = wait_of(points[0]);
  std::vector<Move> moves;
  Pose<double> at = start;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const ConfigValue& point = points[k];
    point.expect_table("a table of coordinates, { name = value, ... }").allow(keys);
    Pose<double> to = at;
    for (std::size_t i = 0; i < names.size(); ++i)
      to[i] = point.find_number(names[i].name, names[i].unit).value_or(at[i]);
    moves.push_back({wait, to, time_of(point, names, at, to, pace_of(point, general), law)});
    wait = wait_of(point);
    at = to;
  }
  if (const auto back = table.find("back"); back && back->flag())
    for (std::size_t k = points.size() - 1; k > 0; --k) {
      moves.push_back({wait_of(points[k]), k == 1 ? start : moves[k - 2].to, moves[k - 1].duration});
      wait = 0;
    }
  return point_to_point(start, moves, wait, law);
}

std::shared_ptr<const Motion> read_oscillation(const ConfigValue& table, const Coordinates& names,
                                               const Keys& more_keys) {
  allow(table, names, {"amplitude", "period", "cycles"}, more_keys);
  const SpaceAxes axes = space_axes(names);
  if (!axes.x && !axes.y && !axes.z)
    throw table.refusal("an oscillation moves x, y and z, and the mechanism's poses have none of them");
  return oscillation(axes, pose_at(table, names), positive_at(table, "amplitude", "m"),
                     positive_at(table, "period", "s"), find_positive(table, "cycles", "1").value_or(1));
}

std::shared_ptr<const Motion> read_pick_and_place(const ConfigValue& table, const Coordinates& names,
                                                  const Keys& more_keys) {
  allow(table, names,
        {"lift", "reach", "lift_time", "reach_time", "overlap", "direction", "turn", "wait", "cycle", "law"},
        more_keys);
  PickAndPlace cycle;
  cycle.start = pose_at(table, names);
  cycle.lift = number_at(table, "lift", "m");
  cycle.reach = number_at(table, "reach", "m");
  cycle.lift_time = positive_at(table, "lift_time", "s");
  cycle.reach_time = positive_at(table, "reach_time", "s");
  cycle.overlap = table.find_number("overlap", "s", 0, std::fmin(cycle.lift_time, cycle.reach_time)).value_or(0);
  cycle.direction = table.find_number("direction", "rad").value_or(0);
  cycle.turn = table.find_number("turn", "rad").value_or(0);
  cycle.wait = wait_of(table);
  if (const auto kind = table.find("cycle")) cycle.back = kind->word({"half", "whole"}) == "whole";
  cycle.law = law_of(table);
  cycle.axes = space_axes(names);
  const auto expect = [&table](const std::optional<std::size_t>& axis, const std::string& name, double way) {
    if (!axis && way != 0)
      throw table.refusal("this pick-and-place moves " + name + ", which the mechanism's poses lack");
  };
  const auto [sine, cosine] = sincos(cycle.direction);
  expect(cycle.axes.z, "z", cycle.lift);
  expect(cycle.axes.x, "x", cycle.reach * cosine);
  expect(cycle.axes.y, "y", cycle.reach * sine);
  expect(cycle.axes.turn, "an angle", cycle.turn);
  return pick_and_place(cycle);
}

/// A number, text with a unit, or a formula of the time.
Formula coordinate_formula(const ConfigValue& value, const std::string& unit) {
  if (!value.is_text()) return Formula(shortest(value.number(unit)), time_name());
  const std::string& text = value.text("text");
  if (const auto number = parse_quantity(text, unit)) return Formula(shortest(*number), time_name());
  return value.explained([&text] { return Formula(text, time_name()); });
}

std::shared_ptr<const Motion> read_formulas(const ConfigValue& table, const Coordinates& names, const Keys& more_keys) {
  allow(table, names, {"duration"}, more_keys);
  const double duration = positive_at(table, "duration", "s");
  std::vector<Formula> formulas;
  for (const AxisInfo& axis : names)
    formulas.push_back(coordinate_formula(
        table.at(axis.name, "a formula of the time t [s], such as \"0.1*sin(2*pi*t)\", or a number in " + axis.unit),
        axis.unit));
  return motion_from_formulas(formulas, duration);
}

struct MotionKind {
  const char* name;
  std::shared_ptr<const Motion> (*read)(const ConfigValue&, const Coordinates&, const Keys&);
};

constexpr MotionKind kKinds[] = {{"points", read_points},
                                 {"pick-and-place", read_pick_and_place},
                                 {"oscillation", read_oscillation},
                                 {"formulas", read_formulas}};

}  // namespace

MotionNames motion_names(const Mechanism& mechanism) { return {mechanism.info().coordinates, mechanism.info().inputs}; }

std::shared_ptr<const Motion> read_motion(const ConfigValue& table, const MotionNames& names,
                                          const std::vector<std::string>& more_keys) {
  const std::string& type = type_of(table, "type", names_of(kKinds));
  const auto& [coordinates, inputs] = names;
  Keys keys = more_keys;
  for (const InputInfo& input : inputs) keys.push_back(input.name);
  const auto motion = find_named(kKinds, type)->read(table, coordinates, keys);
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

std::shared_ptr<const Motion> load_motion_toml(const std::string& path, const MotionNames& names) {
  const std::string text = read_text_file(path, "a motion in TOML");
  const TomlValue document = parse_toml(text, path);
  if (document.keys.empty())
    throw ConfigError({path, 0, ""}, "an empty file", "a motion in TOML, with type = one of " + join(names_of(kKinds)));
  return read_motion(ConfigValue(document, path, ""), names);
}

void read_motions(const ConfigValue& root, StudyDraft& draft) {
  for (const auto& table : tables_of(root, "motion")) {
    const std::string name = new_name(table, "motion", draft.study.motions, "a name for objectives to refer to");
    auto motion = read_motion(table, motion_names(*draft.parts.mechanism), {"name", "follow"});
    draft.study.motions.push_back({name, std::move(motion)});
    if (const auto follow = table.find("follow"); follow && !follow->flag())
      draft.study.unfollowed_motions.push_back(name);
  }
}

}  // namespace pkm
