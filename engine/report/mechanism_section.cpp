#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "engine/core/team.hpp"
#include "engine/report/dimensions.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMotionPoses = 121;  // along each motion, both ends included

using Slider = std::vector<double>;

Slider slider(double lower, double upper, std::size_t steps) {
  if (!(upper > lower)) return {lower};
  Slider values;
  for (std::size_t k = 0; k < steps; ++k)
    values.push_back(lower + (upper - lower) * static_cast<double>(k) / static_cast<double>(steps - 1));
  return values;
}

/// One for each coordinate: values that span the feasible cells, and the first held coordinate's range.
using Sliders = std::vector<Slider>;

Sliders sliders_of(const View& view, const PageDetail& detail) {
  const WorkspaceFields& workspace = *view.workspace;
  const std::size_t coordinates = workspace.axes.size() + workspace.held.size();
  std::vector<std::array<double, 2>> range(coordinates, {1e300, -1e300});
  for (const std::size_t cell : workspace.feasible_cells()) {
    const Pose<double> pose = workspace.pose(cell);
    for (std::size_t c = 0; c < coordinates; ++c)
      range[c] = {std::min(range[c][0], pose[c]), std::max(range[c][1], pose[c])};
  }
  Sliders sliders;
  for (const auto& [lower, upper] : range) sliders.push_back(slider(lower, upper, detail.steps));
  if (!workspace.held.empty())
    sliders[static_cast<std::size_t>(workspace.held[0].coordinate)] =
        slider(view.held_range[0][0], view.held_range[0][1], detail.held_steps);
  return sliders;
}

/// Which step of each slider a pose is at: of the poses the last slider runs fastest.
std::vector<std::size_t> steps_of(std::size_t pose, const Sliders& sliders) {
  std::vector<std::size_t> steps(sliders.size());
  for (std::size_t c = sliders.size(); c-- > 0; pose /= sliders[c].size()) steps[c] = pose % sliders[c].size();
  return steps;
}

/// What the page knows of one pose.
struct DrawnPose {
  PoseReport report;
  std::vector<PlacedLink> links;
};

/// Every combination of the sliders' values.
std::vector<Pose<double>> combinations(const Sliders& sliders) {
  std::size_t count = 1;
  for (const Slider& values : sliders) count *= values.size();
  std::vector<Pose<double>> poses(count, Pose<double>(sliders.size()));
  for (std::size_t pose = 0; pose < count; ++pose) {
    const std::vector<std::size_t> steps = steps_of(pose, sliders);
    for (std::size_t c = 0; c < sliders.size(); ++c) poses[pose][c] = sliders[c][steps[c]];
  }
  return poses;
}

/// Appends the poses of a motion.
void add_motion(const Motion& motion, std::vector<Pose<double>>& poses) {
  for (std::size_t k = 0; k < kMotionPoses; ++k)
    poses.push_back(motion.at(motion.duration() * static_cast<double>(k) / (kMotionPoses - 1)).pose);
}

std::vector<DrawnPose> draw(const Views& views, const View& view, const std::vector<Pose<double>>& poses) {
  std::vector<DrawnPose> drawn(poses.size());
  const std::vector<PlacedLink> obstacles = drawn_obstacles(views.limits.obstacles);
  share_pieces(poses.size(), [&](std::size_t pose, std::size_t end) {
    for (; pose < end; ++pose) {
      drawn[pose].report = views.mechanism.inspect(view.parameters, poses[pose], views.mode, views.limits);
      std::vector<PlacedLink>& links = drawn[pose].links;
      links = views.mechanism.links()->place(view.parameters, poses[pose], views.mode);
      if (!links.empty()) links.insert(links.end(), obstacles.begin(), obstacles.end());
    }
  });
  return drawn;
}

/// The motions: which of the drawn poses, and the coordinates there.
Json motions(const Views& views, const std::vector<Pose<double>>& poses, std::size_t first) {
  Json list = Json::array();
  for (const NamedMotion& named : views.motions) {
    Json coordinates = Json::array();
    for (std::size_t c = 0; c < poses.front().size(); ++c) {
      std::vector<double> column;
      for (std::size_t k = 0; k < kMotionPoses; ++k) column.push_back(poses[first + k][c]);
      coordinates.push_back(packed_floats(column));
    }
    list.push_back({{"name", named.name},
                    {"duration", named.motion->duration()},
                    {"first", first},
                    {"count", kMotionPoses},
                    {"coordinates", coordinates}});
    first += kMotionPoses;
  }
  return list;
}

/// The ends of the links, each place once: links that are joined share theirs. `from` and `to` number them.
struct Ends {
  std::size_t count = 0;
  std::vector<std::size_t> from, to;
  std::array<std::vector<double>, 3> at;  ///< x, y, z: all ends of the first drawn pose, then of the next

  explicit Ends(const std::vector<DrawnPose>& poses) {
    std::vector<std::vector<Point3<double>>> places;  // by end of a link, by pose
    for (const DrawnPose& pose : poses) {
      if (places.empty()) places.resize(2 * pose.links.size());
      for (std::size_t k = 0; k < pose.links.size(); ++k) {
        places[2 * k].push_back(pose.links[k].body.axis.from);
        places[2 * k + 1].push_back(pose.links[k].body.axis.to);
      }
    }
    std::map<std::vector<Point3<double>>, std::size_t> known;
    std::vector<const std::vector<Point3<double>>*> kept;
    for (std::size_t end = 0; end < places.size(); ++end) {
      const auto [found, is_new] = known.emplace(places[end], kept.size());
      if (is_new) kept.push_back(&found->first);
      (end % 2 ? to : from).push_back(found->second);
    }
    count = kept.size();
    for (std::size_t pose = 0; count > 0 && pose < kept[0]->size(); ++pose)
      for (const auto* const end : kept)
        for (std::size_t i = 0; i < 3; ++i) at[i].push_back((*end)[pose][i]);
  }
};

/// The feasible pose nearest to the middle of the feasible ones, else the first that is drawn.
/// @param poses  the combinations of the sliders
std::size_t usual_pose(std::span<const DrawnPose> poses, const Sliders& sliders) {
  std::vector<double> middle(sliders.size());
  double count = 0;
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    if (!poses[pose].report.feasible) continue;
    const std::vector<std::size_t> steps = steps_of(pose, sliders);
    for (std::size_t c = 0; c < steps.size(); ++c) middle[c] += static_cast<double>(steps[c]);
    ++count;
  }
  const auto distance = [&](std::size_t pose) {
    if (poses[pose].links.empty() || (count > 0 && !poses[pose].report.feasible)) return 1e300;
    double sum = 0;
    const std::vector<std::size_t> steps = steps_of(pose, sliders);
    for (std::size_t c = 0; c < steps.size(); ++c) {
      const double away = static_cast<double>(steps[c]) - (count > 0 ? middle[c] / count : 0);
      sum += away * away;
    }
    return sum;
  };
  std::size_t best = 0;
  for (std::size_t pose = 1; pose < poses.size(); ++pose)
    if (distance(pose) < distance(best)) best = pose;
  return best;
}

Json mechanism(const Views& views, const View& view) {
  const MechanismInfo& info = views.mechanism.info();
  const Sliders sliders = sliders_of(view, views.detail);
  std::vector<Pose<double>> places = combinations(sliders);
  const std::size_t combined = places.size();
  for (const NamedMotion& named : views.motions) add_motion(*named.motion, places);
  const std::vector<DrawnPose> poses = draw(views, view, places);
  const auto drawn = std::ranges::find_if(poses, [](const DrawnPose& pose) { return !pose.links.empty(); });
  if (drawn == poses.end()) return Json();

  Json json = {{"name", view.name},
               {"coordinates", axes_data(info.coordinates)},
               {"joints", axes_data(info.joints)},
               {"links", Json::array()}};
  for (std::size_t c = 0; c < sliders.size(); ++c) json["coordinates"][c]["values"] = sliders[c];
  const Ends ends(poses);
  for (std::size_t k = 0; k < drawn->links.size(); ++k) {
    const PlacedLink& link = drawn->links[k];
    json["links"].push_back({{"name", link.name},
                             {"part", link.part},
                             {"radius", link.body.radius},
                             {"from", ends.from[k]},
                             {"to", ends.to[k]}});
  }
  // Per pose: whether it is drawn, why it is not feasible; per drawn pose: the ends, joints, conditioning.
  std::vector<std::string> reasons = {""};
  std::vector<std::uint8_t> is_drawn;
  std::vector<std::int64_t> reason;
  std::vector<double> conditioning;
  std::vector<std::vector<double>> joints(info.joints.size());
  for (const DrawnPose& pose : poses) {
    is_drawn.push_back(!pose.links.empty());
    const std::string why = pose.report.feasible ? "" : pose.report.reason;
    const auto known = std::ranges::find(reasons, why);
    reason.push_back(known - reasons.begin());
    if (known == reasons.end()) reasons.push_back(why);
    if (pose.links.empty()) continue;
    conditioning.push_back(pose.report.conditioning.value_or(std::nan("")));
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i].push_back(pose.report.joints ? (*pose.report.joints)[i] : std::nan(""));
  }
  const std::size_t start = usual_pose({poses.data(), combined}, sliders);
  json["start"] = start;
  json["motions"] = motions(views, places, combined);
  json["dimensions"] = Json::array();
  for (const Dimension& d : dimensions_of(views.mechanism, view.parameters, places[start], views.mode)) {
    const auto end = [&](std::size_t e) { return (e % 2 ? ends.to : ends.from)[e / 2]; };
    json["dimensions"].push_back({{"name", info.parameters[d.parameter].name},
                                  {"unit", info.parameters[d.parameter].unit},
                                  {"value", view.parameters[d.parameter]},
                                  {"from", end(d.from)},
                                  {"to", end(d.to)}});
  }
  json["ends"] = ends.count;
  json["drawn"] = packed_bits(is_drawn);
  json["reasons"] = reasons;
  json["reason"] = packed_integers(reason);
  for (const auto& coordinate : ends.at) json["at"].push_back(packed_levels(coordinate));
  for (const auto& joint : joints) json["positions"].push_back(packed_floats(joint));
  json["conditioning"] = packed_floats(conditioning);
  return json;
}

}  // namespace

Json mechanism_data(const Views& views) {
  if (!views.mechanism.links()) return {};
  Json designs = Json::array();
  for (const View& view : views.designs)
    if (view.workspace)
      if (Json json = mechanism(views, view); !json.is_null()) designs.push_back(std::move(json));
  if (designs.empty()) return {};
  return {{"mode", views.mode}, {"designs", designs}};
}

}  // namespace pkm
