#include <algorithm>

#include "engine/mechanism/trajectory.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

using Column = std::optional<AxisVector<double>> TrajectoryPoint::*;

constexpr std::size_t kSamples = 201;

/// A column for each of `count`. @param of  their values in a sample; null: it lacks them
template <class Of>
Json packed_columns(const Trajectory& trajectory, std::size_t count, const Of& of) {
  Json packed = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> column;
    for (const TrajectoryPoint& point : trajectory.points) {
      const AxisVector<double>* const values = of(point);
      column.push_back(values ? (*values)[i] : std::nan(""));
    }
    packed.push_back(packed_floats(column));
  }
  return packed;
}

/// A column per joint of something that a sample may lack; null where all do.
Json columns(const Trajectory& trajectory, std::size_t joints, Column what) {
  if (std::ranges::none_of(trajectory.points, [&](const auto& point) { return (point.*what).has_value(); }))
    return Json();
  return packed_columns(trajectory, joints,
                        [&](const TrajectoryPoint& point) { return point.*what ? &*(point.*what) : nullptr; });
}

std::vector<double> listed(const AxisVector<double>& values) { return {values.begin(), values.end()}; }

/// Input and output of the auxiliary chain, and their derivatives by time; null where no sample has a chain.
Json chain(const Trajectory& trajectory) {
  if (std::ranges::none_of(trajectory.points, [](const TrajectoryPoint& point) { return point.chain.has_value(); }))
    return Json();
  const auto curves = [&](double Turning::*what) {
    std::vector<double> input, output;
    for (const TrajectoryPoint& point : trajectory.points) {
      input.push_back(point.motion.input.*what);
      output.push_back(point.chain && point.chain->turns ? point.chain->output.*what : std::nan(""));
    }
    return Json{packed_floats(input), packed_floats(output)};
  };
  return {{"angles", curves(&Turning::angle)},
          {"speeds", curves(&Turning::speed)},
          {"accelerations", curves(&Turning::acceleration)}};
}

/// Peaks and energies; those of speeds are null where no sample has any, those of forces absent where a sample has
/// none.
Json summary(const TrajectorySummary& s) {
  Json json = {{"infeasible", s.infeasible}, {"peak_speed", s.peak_speed ? Json(listed(*s.peak_speed)) : Json()}};
  if (s.has_forces)
    json.update({{"peak_force", listed(s.peak_force)},
                 {"rms_force", listed(s.rms_force)},
                 {"peak_power", listed(s.peak_power)},
                 {"peak_total_power", s.peak_total_power},
                 {"energy", s.energy},
                 {"energy_drawn", s.energy_drawn}});
  return json;
}

Json along(const Views& views, const View& view, const Motion& motion) {
  const Trajectory found = follow(views.mechanism, view.parameters, views.mode, views.limits, motion, kSamples);
  const MechanismInfo& info = views.mechanism.info();
  const std::size_t joints = info.joints.size();
  std::vector<double> conditioning;
  std::vector<std::string> reasons;
  for (const TrajectoryPoint& point : found.points) {
    conditioning.push_back(point.conditioning.value_or(std::nan("")));
    reasons.push_back(point.reason);
  }
  return {
      {"name", view.name},
      {"poses", packed_columns(found, info.coordinates.size(), [](const auto& point) { return &point.motion.pose; })},
      {"positions", columns(found, joints, &TrajectoryPoint::joints)},
      {"speeds", columns(found, joints, &TrajectoryPoint::speeds)},
      {"forces", columns(found, joints, &TrajectoryPoint::forces)},
      {"power", columns(found, joints, &TrajectoryPoint::power)},
      {"chain", chain(found)},
      {"conditioning", packed_floats(conditioning)},
      {"reasons", reasons},
      {"summary", summary(found.summary)}};
}

}  // namespace

Json motions_data(const Views& views) {
  const MechanismInfo& info = views.mechanism.info();
  Json motions = Json::array();
  for (const NamedMotion& named : views.motions) {
    Json json = {{"name", named.name},
                 {"duration", named.motion->duration()},
                 {"samples", kSamples},
                 {"designs", Json::array()}};
    for (const View& view : views.designs)
      if (view.workspace) json["designs"].push_back(along(views, view, *named.motion));
    if (!json["designs"].empty()) motions.push_back(std::move(json));
  }
  if (motions.empty()) return {};
  Json chain = Json::array();
  if (const AuxiliaryChain* const shafts = views.mechanism.chain()) chain = {shafts->input(), shafts->output()};
  return {{"coordinates", axes_data(info.coordinates)},
          {"joints", axes_data(info.joints)},
          {"chain", chain},
          {"motions", motions},
          {"left_out", views.motions_left_out}};
}

}  // namespace pkm
