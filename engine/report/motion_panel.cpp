// Computes the data of the panel "Motions": joints, forces and power of each design along the motions of the study.
#include <algorithm>
#include <limits>

#include "engine/mechanism/motor_demand.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"

namespace pkm {
namespace {

using JointQuantity = std::optional<AxisVector<double>> TrajectoryPoint::*;

constexpr std::size_t kSamples = 201;  // number of samples of each motion, both ends included

/// `count` packed columns with one element for each sample; NaN where a sample has no values.
/// @param values_of  values_of(point): pointer to the `count` values of a sample, or null
template <class ValuesOf>
Json packed_columns(const Trajectory& trajectory, std::size_t count, const ValuesOf& values_of) {
  Json packed = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> column;
    for (const TrajectoryPoint& point : trajectory.points) {
      const AxisVector<double>* const values = values_of(point);
      column.push_back(values ? (*values)[i] : std::nan(""));
    }
    packed.push_back(packed_floats(column));
  }
  return packed;
}

/// Packed columns of an optional quantity of the joints, one for each joint; null if no sample has it.
Json joint_columns(const Trajectory& trajectory, std::size_t joints, JointQuantity quantity) {
  if (std::ranges::none_of(trajectory.points, [&](const auto& point) { return (point.*quantity).has_value(); }))
    return Json();
  return packed_columns(trajectory, joints,
                        [&](const TrajectoryPoint& point) { return point.*quantity ? &*(point.*quantity) : nullptr; });
}

std::vector<double> to_list(const AxisVector<double>& values) { return {values.begin(), values.end()}; }

/// Indices, in MechanismInfo::quantities, of the quantities that are plotted along motions: those that depend on inputs
/// or on rates.
std::vector<std::size_t> plotted_quantities(const MechanismInfo& info) {
  std::vector<std::size_t> plotted;
  for (std::size_t i = 0; i < info.quantities.size(); ++i)
    if (info.quantities[i].of_motion) plotted.push_back(i);
  return plotted;
}

/// Packed columns of the plotted quantities, one for each; NaN where a sample has no quantities.
Json quantity_columns(const Trajectory& trajectory, const std::vector<std::size_t>& plotted) {
  Json columns = Json::array();
  for (const std::size_t i : plotted) {
    std::vector<double> values;
    for (const TrajectoryPoint& point : trajectory.points)
      values.push_back(point.quantities.empty() ? std::nan("") : point.quantities[i]);
    columns.push_back(packed_floats(values));
  }
  return columns;
}

/// Peak values and energies. The peak speed is null if no sample has speeds; forces, powers and energies are absent
/// unless all samples have forces.
Json motion_summary(const TrajectorySummary& s, bool has_drive_trains) {
  Json json = {{"infeasible", s.infeasible}, {"peak_speed", s.peak_speed ? Json(to_list(*s.peak_speed)) : Json()}};
  if (s.has_forces)
    json.update({{"peak_force", to_list(s.peak_force)},
                 {"rms_force", to_list(s.rms_force)},
                 {"peak_power", to_list(s.peak_power)},
                 {"peak_total_power", s.peak_total_power},
                 {"energy", s.energy},
                 {"energy_drawn", s.energy_drawn}});
  if (s.has_forces && has_drive_trains)
    json.update({{"peak_motor_torque", to_list(s.peak_torque)},
                 {"rms_motor_torque", to_list(s.rms_torque)},
                 {"peak_motor_speed", to_list(s.peak_motor_speed)}});
  return json;
}

/// Whether the drives can perform a motion: the smallest ratio of a rating to its demand, the rating and the joint that
/// have it, and the motor of this joint. Null if the study gives no ratings, or a sample has no forces.
Json drive_check(const Mechanism& mechanism, const Trajectory& trajectory) {
  const std::vector<JointLimits> limits = joint_limits(mechanism);
  const TrajectorySummary& s = trajectory.summary;
  if (limits.empty() || !s.has_forces) return Json();
  Json worst;
  double least = std::numeric_limits<double>::infinity();
  const auto& joints = mechanism.info().joints;
  const DriveTrains* const trains = mechanism.drive_trains();
  const auto loads = trains ? joint_loads(*trains, trajectory) : std::vector<std::vector<JointLoad>>();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto compare = [&](double reserve, const std::string& rating) {
      if (!(reserve < least)) return;
      least = reserve;
      worst = {{"reserve", reserve}, {"rating", rating}, {"joint", joints[i].name}};
      if (limits[i].motor) worst["motor"] = limits[i].motor->name;
    };
    compare(limits[i].force / s.peak_force[i], joints[i].turns() ? "joint torque" : "joint force");
    if (s.peak_speed) compare(limits[i].speed / (*s.peak_speed)[i], "joint speed");
    if (limits[i].motor && trains) {
      const MotorFit motor = fit(*limits[i].motor, (*trains)[i], loads[i]);
      compare(motor.reserve, motor.bounded_by);
    }
  }
  return worst;
}

Json design_along(const ShownDesigns& shown, const ShownDesign& design, const Motion& motion) {
  const Trajectory found =
      compute_trajectory(shown.mechanism, design.parameters, shown.mode, shown.limits, motion, kSamples);
  const MechanismInfo& info = shown.mechanism.info();
  const std::size_t joints = info.joints.size();
  std::vector<double> conditioning;
  std::vector<std::string> reasons;
  for (const TrajectoryPoint& point : found.points) {
    conditioning.push_back(point.conditioning.value_or(std::nan("")));
    reasons.push_back(point.reason);
  }
  return {
      {"name", design.name},
      {"poses", packed_columns(found, info.coordinates.size(), [](const auto& point) { return &point.motion.pose; })},
      {"positions", joint_columns(found, joints, &TrajectoryPoint::joints)},
      {"speeds", joint_columns(found, joints, &TrajectoryPoint::speeds)},
      {"forces", joint_columns(found, joints, &TrajectoryPoint::forces)},
      {"power", joint_columns(found, joints, &TrajectoryPoint::power)},
      {"quantities", quantity_columns(found, plotted_quantities(info))},
      {"conditioning", packed_floats(conditioning)},
      {"reasons", reasons},
      {"summary", motion_summary(found.summary, shown.mechanism.drive_trains() != nullptr)},
      {"drives", drive_check(shown.mechanism, found)}};
}

}  // namespace

Json motions_data(const ShownDesigns& shown) {
  const MechanismInfo& info = shown.mechanism.info();
  Json motions = Json::array();
  const auto entry = [](const std::string& name, const Motion& motion) {
    return Json{{"name", name}, {"duration", motion.duration()}, {"samples", kSamples}, {"designs", Json::array()}};
  };
  for (const DesignMotion& named : shown.motions) {
    Json json = entry(named.name, *named.motion);
    for (const ShownDesign& design : shown.designs) {
      if (!design.workspace) continue;
      const auto motion = named.at(design.parameters);
      Json of_design = design_along(shown, design, *motion);
      // A motion that depends on the design gets an entry for each design: its durations differ, and an entry has one
      // time axis.
      if (named.of_design) motions.push_back(entry(named.name + " of " + design.name, *motion));
      (named.of_design ? motions.back() : json)["designs"].push_back(std::move(of_design));
    }
    if (!json["designs"].empty()) motions.push_back(std::move(json));
  }
  if (motions.empty()) return {};
  Json quantities = Json::array();
  for (const std::size_t i : plotted_quantities(info))
    quantities.push_back({{"name", info.quantities[i].name}, {"unit", info.quantities[i].unit}});
  return {{"coordinates", axes_data(info.coordinates)},
          {"joints", axes_data(info.joints)},
          {"quantities", quantities},
          {"motions", motions},
          {"omitted", shown.omitted_motions}};
}

}  // namespace pkm
