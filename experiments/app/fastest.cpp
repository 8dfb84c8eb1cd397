#include "experiments/app/fastest.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/formatted.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// Sets a limit of the joints from lists of joint=value and all=value; a joint's own value takes precedence.
void set_limits(const std::vector<std::string>& lists, const std::string& option, std::vector<Assignable> known,
                std::vector<JointLimits>& limits, double JointLimits::*limit) {
  if (lists.empty()) return;
  const bool one_unit = std::ranges::all_of(known, [&](const Assignable& a) { return a.unit == known[0].unit; });
  if (one_unit) known.push_back({.name = "all", .unit = known[0].unit});
  for (Assignable& each : known) each.lower = std::numeric_limits<double>::min();
  const std::vector<std::optional<double>> given = parse_assignments(lists, option, known);
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (const auto& value = given[i] || !one_unit ? given[i] : given.back()) limits[i].*limit = *value;
}

double parse_tool_limit(const std::string& text, const std::string& option, const std::string& unit) {
  if (text.empty()) return std::numeric_limits<double>::infinity();
  const double value = parse_number(text, option, unit);
  if (!(value > 0)) throw ConfigError({"", 0, option}, text, "a number > 0 " + unit);
  return value;
}

std::string name_of_limit(const MechanismInfo& info, const LimitOfMotion& limit) {
  return std::string(name_of(limit.kind)) + (is_of_joint(limit.kind) ? " of " + info.joints[limit.joint].name : "");
}

std::string error_text(double seconds) {
  constexpr double kNegligible = 1e-9;
  return seconds < kNegligible ? formatted("discretisation error below %.0e s", kNegligible)
                               : formatted("discretisation error about %.2g s", seconds);
}

struct LimitShare {
  LimitOfMotion limit;
  double time = 0, first = 0, last = 0;
};

/// The limits in the order in which they become active, with the total time of each.
std::vector<LimitShare> shares_of(const std::vector<ActivePeriod>& active) {
  std::vector<LimitShare> shares;
  for (const ActivePeriod& period : active) {
    auto found = std::ranges::find(shares, period.limit, &LimitShare::limit);
    if (found == shares.end()) found = shares.insert(found, {period.limit, 0, period.begin, period.end});
    found->time += period.end - period.begin;
    found->last = period.end;
  }
  return shares;
}

/// Adds a table of the active limits with the shares of the time, which add up to 100 %, or only with the instants if
/// every limit is active at a single instant of a move.
void report_shares(const MechanismInfo& info, const FastestMotion& found, Printout& out) {
  constexpr double kNegligible = 1e-6;  // smaller shares are not listed
  const std::vector<LimitShare> shares = shares_of(found.active);
  if (std::ranges::all_of(shares, [](const LimitShare& share) { return share.time == 0; })) {
    std::vector<Row> rows = {{"", "first at", "last at"}};
    for (const LimitShare& share : shares)
      rows.push_back({name_of_limit(info, share.limit), number(share.first, "s"), number(share.last, "s")});
    return out.add_table("limits that bound the motion, each at one instant of a move", rows);
  }
  std::vector<Row> rows = {{"", "share of the time", "first from", "last until"}};
  const auto percentage = [&](double time) { return digits(100 * time / found.duration) + " %"; };
  double rest = found.duration, pauses = found.duration;
  for (const MovePeriod& move : found.moves) pauses -= move.end - move.begin;
  for (const LimitShare& share : shares) {
    rows.push_back(
        {name_of_limit(info, share.limit), percentage(share.time), number(share.first, "s"), number(share.last, "s")});
    rest -= share.time;
  }
  // A continuous torque is a limit of the whole motion, with its pauses.
  pauses = std::fmin(pauses, rest);
  for (const auto& [name, time] : {std::pair("no limit is fully used", rest - pauses), {"pause", pauses}})
    if (time > kNegligible * found.duration) rows.push_back({name, percentage(time)});
  out.add_table("limits that bound the motion", rows);
}

}  // namespace

void add_fastest_options(CLI::App& command, FastestArguments& arguments) {
  command.add_flag("--fastest", arguments.fastest,
                   "Evaluate the fastest motion along the path of the motion, within the limits of joints, motors and "
                   "tool that the study or the following options give");
  add_option(command, "--law LAW", arguments.law,
             "optimal: time-optimal speed along the path; own: the motion's time law, each move scaled by one factor")
      ->check(CLI::IsMember({"optimal", "own"}))
      ->default_str("optimal");
  add_option(command, "--motor NAME", arguments.motor, "Mount this motor of --motors at every joint");
  add_integer(command, "--nodes N", arguments.nodes, 4, 100'000, "Nodes along each move; even")
      ->default_str(std::to_string(arguments.nodes));
  add_list_option(command, "--peak-speed", arguments.peak_speed, "Maximum speeds of joints, or all=VALUE");
  add_list_option(command, "--peak-acceleration", arguments.peak_acceleration,
                  "Maximum accelerations of joints, or all=VALUE");
  add_list_option(command, "--peak-force", arguments.peak_force, "Maximum forces of joints, or all=VALUE");
  add_option(command, "--tool-speed VALUE", arguments.tool_speed, "Maximum speed of the tool [m/s]");
  add_option(command, "--tool-acceleration VALUE", arguments.tool_acceleration,
             "Maximum acceleration of the tool [m/s^2]");
}

void expect_fastest(const FastestArguments& arguments) {
  if (arguments.fastest) {
    if (arguments.nodes % 2 != 0)
      throw ConfigError({"", 0, "--nodes"}, std::to_string(arguments.nodes), "an even number");
    return;
  }
  const std::pair<const char*, bool> given[] = {{"--law", arguments.law != "optimal"},
                                                {"--motor", !arguments.motor.empty()},
                                                {"--nodes", arguments.nodes != FastestArguments().nodes},
                                                {"--peak-speed", !arguments.peak_speed.empty()},
                                                {"--peak-acceleration", !arguments.peak_acceleration.empty()},
                                                {"--peak-force", !arguments.peak_force.empty()},
                                                {"--tool-speed", !arguments.tool_speed.empty()},
                                                {"--tool-acceleration", !arguments.tool_acceleration.empty()}};
  for (const auto& [option, is_given] : given)
    if (is_given) throw ConfigError({"", 0, option}, "this option needs --fastest");
}

MotionLimits parse_limits(const Mechanism& mechanism, const FastestArguments& arguments,
                          const std::vector<Motor>& motors) {
  const MechanismInfo& info = mechanism.info();
  MotionLimits limits{.joints = joint_limits(mechanism)};
  limits.joints.resize(info.joints.size());
  set_limits(arguments.peak_speed, "--peak-speed", assignable_axes(info.joints, "s"), limits.joints,
             &JointLimits::speed);
  set_limits(arguments.peak_acceleration, "--peak-acceleration", assignable_axes(info.joints, "s^2"), limits.joints,
             &JointLimits::acceleration);
  set_limits(arguments.peak_force, "--peak-force", assignable_forces(info), limits.joints, &JointLimits::force);
  limits.tool_speed = parse_tool_limit(arguments.tool_speed, "--tool-speed", "m/s");
  limits.tool_acceleration = parse_tool_limit(arguments.tool_acceleration, "--tool-acceleration", "m/s^2");
  if (arguments.motor.empty()) return limits;
  const Motor* const motor = find_named(motors, arguments.motor);
  if (motors.empty()) throw ConfigError({"", 0, "--motor"}, "no --motors", "a motor file");
  if (!motor)
    throw ConfigError({"", 0, "--motor"}, "'" + arguments.motor + "'", "one of " + join(names_of(motors)),
                      nearest_name(arguments.motor, names_of(motors)));
  for (JointLimits& joint : limits.joints) joint.motor = *motor;
  return limits;
}

std::shared_ptr<const Mechanism> with_motor(const std::shared_ptr<const Mechanism>& mechanism,
                                            const FastestArguments& arguments, const MotionLimits& limits) {
  if (arguments.motor.empty()) return mechanism;
  DriveTrains trains = *mechanism->drive_trains();
  for (std::size_t i = 0; i < trains.size(); ++i) trains[i].rotor = limits.joints[i].motor->rotor;
  const std::shared_ptr<const Mechanism> bare(mechanism, &without_drive_trains(*mechanism));
  return with_drive_trains(bare, std::move(trains), limits.joints);
}

FastestMotion fastest_motion(const DesignWithLimits& design, const std::shared_ptr<const Motion>& motion,
                             const FastestArguments& arguments, std::size_t samples) {
  try {
    const MovesOfMotion moves(motion, arguments.law == "own" ? FastestLaw::own : FastestLaw::optimal, arguments.nodes);
    return find_fastest_motion(moves, design, samples);
  } catch (const DesignError&) {
    throw;
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, "--fastest"}, reason.what());
  }
}

void report_fastest(const MechanismInfo& info, const FastestMotion& found, const FastestArguments& arguments,
                    Printout& out) {
  const bool own = arguments.law == "own";
  out.head.push_back(
      {"law", own ? "that of the motion" : "time-optimal along the path", own ? "" : error_text(found.error)});
  report_shares(info, found, out);
  out.json["fastest"] = {{"law", arguments.law}, {"discretisation_error", found.error}};
  out.json["fastest"]["moves"] = list_json(found.moves, [](const MovePeriod& move) {
    return Json{{"begin", move.begin}, {"end", move.end}};
  });
  out.json["fastest"]["bounded_by"] = list_json(found.active, [&](const ActivePeriod& period) {
    return Json{{"limit", name_of(period.limit.kind)},
                {"joint", is_of_joint(period.limit.kind) ? Json(info.joints[period.limit.joint].name) : Json()},
                {"begin", period.begin},
                {"end", period.end},
                {"from", axes_json(info.coordinates, period.from)},
                {"to", axes_json(info.coordinates, period.to)}};
  });
}

}  // namespace pkm
