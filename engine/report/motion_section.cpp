#include <algorithm>

#include <nlohmann/json.hpp>

#include "engine/mechanism/trajectory.hpp"
#include "engine/report/json_text.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

using Json = nlohmann::ordered_json;
using Column = std::optional<Vector<double, 4>> TrajectoryPoint::*;

constexpr std::size_t kSamples = 201;

/// Four columns of something that a sample may lack; null where all do.
Json columns(const Trajectory& trajectory, Column what) {
  std::array<std::vector<double>, 4> values;
  bool any = false;
  for (const TrajectoryPoint& point : trajectory.points) {
    any = any || point.*what;
    for (std::size_t i = 0; i < 4; ++i) values[i].push_back(point.*what ? (*(point.*what))[i] : std::nan(""));
  }
  if (!any) return Json();
  Json packed = Json::array();
  for (const auto& column : values) packed.push_back(packed_floats(column));
  return packed;
}

Json poses(const Trajectory& trajectory) {
  Json packed = Json::array();
  for (std::size_t i = 0; i < 4; ++i) {
    std::vector<double> column;
    for (const TrajectoryPoint& point : trajectory.points) column.push_back(point.motion.pose[i]);
    packed.push_back(packed_floats(column));
  }
  return packed;
}

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

/// Peaks and energies; what needs forces is null where a sample has none.
Json summary(const TrajectorySummary& s) {
  Json json = {{"infeasible", s.infeasible}, {"peak_speed", s.peak_speed.m}};
  if (s.has_forces)
    json.update({{"peak_force", s.peak_force.m},
                 {"rms_force", s.rms_force.m},
                 {"peak_power", s.peak_power.m},
                 {"peak_total_power", s.peak_total_power},
                 {"energy", s.energy},
                 {"energy_drawn", s.energy_drawn}});
  return json;
}

Json along(const Views& views, const View& view, const Motion& motion) {
  const Trajectory found = follow(views.mechanism, view.parameters, views.mode, views.limits, motion, kSamples);
  std::vector<double> conditioning;
  std::vector<std::string> reasons;
  for (const TrajectoryPoint& point : found.points) {
    conditioning.push_back(point.conditioning.value_or(std::nan("")));
    reasons.push_back(point.reason);
  }
  return {{"name", view.name},
          {"poses", poses(found)},
          {"positions", columns(found, &TrajectoryPoint::joints)},
          {"speeds", columns(found, &TrajectoryPoint::speeds)},
          {"forces", columns(found, &TrajectoryPoint::forces)},
          {"power", columns(found, &TrajectoryPoint::power)},
          {"chain", chain(found)},
          {"conditioning", packed_floats(conditioning)},
          {"reasons", reasons},
          {"summary", summary(found.summary)}};
}

}  // namespace

std::string motions_data(const Views& views) {
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
  if (motions.empty()) return "";
  return json_text(Json{{"coordinates", info.coordinates},
                        {"joints", info.joints},
                        {"chain", {info.chain_input, info.chain_output}},
                        {"motions", motions}});
}

}  // namespace pkm
