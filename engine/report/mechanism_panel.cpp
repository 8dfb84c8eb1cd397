// Computes the data of the panel "Mechanism": the links of each design at a grid of poses and along the motions.
#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "engine/core/team.hpp"
#include "engine/mechanism/design_facts.hpp"
#include "engine/report/base_and_motors.hpp"
#include "engine/report/dimensions.hpp"
#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMotionPoses = 121;  // number of samples along each motion, both ends included

using Slider = std::vector<double>;  // values of one coordinate, which a slider of the page selects

Slider equidistant_values(double lower, double upper, std::size_t steps) {
  if (!(upper > lower)) return {lower};
  Slider values;
  for (std::size_t k = 0; k < steps; ++k)
    values.push_back(lower + (upper - lower) * static_cast<double>(k) / static_cast<double>(steps - 1));
  return values;
}

/// One slider for each coordinate. The slider of a swept coordinate has values that span the feasible cells, that of
/// the first fixed coordinate has values in its feasible range, and those of all other fixed coordinates have a single
/// value.
using Sliders = std::vector<Slider>;

Sliders make_sliders(const ShownDesign& design, const PageDetail& detail) {
  const WorkspaceFields& workspace = *design.workspace;
  const std::size_t coordinates = workspace.axes.size() + workspace.fixed.size();
  std::vector<std::array<double, 2>> range(coordinates, {1e300, -1e300});
  for (const std::size_t cell : workspace.feasible_cells()) {
    const Pose<double> pose = workspace.pose(cell);
    for (std::size_t c = 0; c < coordinates; ++c)
      range[c] = {std::min(range[c][0], pose[c]), std::max(range[c][1], pose[c])};
  }
  Sliders sliders;
  for (const auto& [lower, upper] : range) sliders.push_back(equidistant_values(lower, upper, detail.steps));
  if (!workspace.fixed.empty())
    sliders[static_cast<std::size_t>(workspace.fixed[0].coordinate)] =
        equidistant_values(design.fixed_range[0][0], design.fixed_range[0][1], detail.fixed_steps);
  return sliders;
}

/// Position of each slider for a pose, given by its number in grid_poses(); the last slider varies fastest.
std::vector<std::size_t> slider_positions(std::size_t pose, const Sliders& sliders) {
  std::vector<std::size_t> steps(sliders.size());
  for (std::size_t c = sliders.size(); c-- > 0; pose /= sliders[c].size()) steps[c] = pose % sliders[c].size();
  return steps;
}

/// A pose with the report of its inverse kinematics and its links; there are no links if it cannot be assembled.
struct DrawnPose {
  PoseReport report;
  std::vector<PlacedLink> links;
};

/// The poses of all combinations of slider positions.
std::vector<Pose<double>> grid_poses(const Sliders& sliders) {
  std::size_t count = 1;
  for (const Slider& values : sliders) count *= values.size();
  std::vector<Pose<double>> poses(count, Pose<double>(sliders.size()));
  for (std::size_t pose = 0; pose < count; ++pose) {
    const std::vector<std::size_t> steps = slider_positions(pose, sliders);
    for (std::size_t c = 0; c < sliders.size(); ++c) poses[pose][c] = sliders[c][steps[c]];
  }
  return poses;
}

/// Appends the sampled poses of a motion.
void add_motion_poses(const Motion& motion, std::vector<Pose<double>>& poses) {
  for (std::size_t k = 0; k < kMotionPoses; ++k)
    poses.push_back(motion.at(motion.duration() * static_cast<double>(k) / (kMotionPoses - 1)).pose);
}

/// Places the links, motors and base and inspects the limits at each pose, in parallel.
std::vector<DrawnPose> draw(const ShownDesigns& shown, const ShownDesign& design,
                            const std::vector<Pose<double>>& poses) {
  std::vector<DrawnPose> drawn(poses.size());
  const std::vector<PlacedLink> obstacles = drawn_obstacles(shown.limits.obstacles);
  const DrawnMotors motors(shown.mechanism, design.parameters, shown.mode);
  parallel_for(poses.size(), [&](std::size_t pose, std::size_t end) {
    for (; pose < end; ++pose) {
      drawn[pose].report = shown.mechanism.inspect(design.parameters, poses[pose], shown.mode, shown.limits);
      std::vector<PlacedLink>& links = drawn[pose].links;
      links = shown.mechanism.links()->place(design.parameters, poses[pose], shown.mode);
      if (links.empty()) continue;
      motors.append(poses[pose], links);
      links.insert(links.end(), obstacles.begin(), obstacles.end());
    }
  });
  std::vector<std::vector<PlacedLink>*> assembled;
  for (DrawnPose& pose : drawn)
    if (!pose.links.empty()) assembled.push_back(&pose.links);
  append_base(assembled);
  return drawn;
}

/// Data of the motions: for each, the index range of its samples among all poses, and the coordinates of its samples.
/// @param first  number of the first pose of the first motion
Json motion_poses(const ShownDesigns& shown, const ShownDesign& design, const std::vector<Pose<double>>& poses,
                  std::size_t first) {
  Json list = Json::array();
  for (const DesignMotion& named : shown.motions) {
    Json coordinates = Json::array();
    for (std::size_t c = 0; c < poses.front().size(); ++c) {
      std::vector<double> column;
      for (std::size_t k = 0; k < kMotionPoses; ++k) column.push_back(poses[first + k][c]);
      coordinates.push_back(packed_floats(column));
    }
    list.push_back({{"name", named.name},
                    {"duration", named.at(design.parameters)->duration()},
                    {"first", first},
                    {"count", kMotionPoses},
                    {"coordinates", coordinates}});
    first += kMotionPoses;
  }
  return list;
}

/// Positions of the ends of all links, without duplicates: ends that coincide at all poses, such as those of links
/// joined by a joint, are stored once.
struct LinkEnds {
  std::size_t count = 0;
  std::vector<std::size_t> from, to;  ///< numbers of the two ends of each link
  /// x, y and z of all link ends at the first pose that can be assembled, followed by those at the next such pose.
  std::array<std::vector<double>, 3> positions;

  explicit LinkEnds(const std::vector<DrawnPose>& poses) {
    // Positions of each link end (first index) at each pose (second index).
    std::vector<std::vector<Point3<double>>> paths;
    for (const DrawnPose& pose : poses) {
      if (paths.empty()) paths.resize(2 * pose.links.size());
      for (std::size_t k = 0; k < pose.links.size(); ++k) {
        paths[2 * k].push_back(pose.links[k].body.axis.from);
        paths[2 * k + 1].push_back(pose.links[k].body.axis.to);
      }
    }
    std::map<std::vector<Point3<double>>, std::size_t> numbers;
    std::vector<const std::vector<Point3<double>>*> unique;
    for (std::size_t end = 0; end < paths.size(); ++end) {
      const auto [found, is_new] = numbers.emplace(paths[end], unique.size());
      if (is_new) unique.push_back(&found->first);
      (end % 2 ? to : from).push_back(found->second);
    }
    count = unique.size();
    for (std::size_t pose = 0; count > 0 && pose < unique[0]->size(); ++pose)
      for (const auto* const end : unique)
        for (std::size_t i = 0; i < 3; ++i) positions[i].push_back((*end)[pose][i]);
  }
};

/// Number of the pose that is shown first: the feasible pose that is nearest, in slider positions, to the mean of the
/// feasible poses. If none is feasible: the pose that can be assembled and is nearest to the first position of every
/// slider.
/// @param poses  one pose for each combination of slider positions, in the order of grid_poses()
std::size_t initial_pose(std::span<const DrawnPose> poses, const Sliders& sliders) {
  std::vector<double> sum_of_steps(sliders.size());
  double count = 0;
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    if (!poses[pose].report.feasible) continue;
    const std::vector<std::size_t> steps = slider_positions(pose, sliders);
    for (std::size_t c = 0; c < steps.size(); ++c) sum_of_steps[c] += static_cast<double>(steps[c]);
    ++count;
  }
  const auto distance = [&](std::size_t pose) {
    if (poses[pose].links.empty() || (count > 0 && !poses[pose].report.feasible)) return 1e300;
    double sum = 0;
    const std::vector<std::size_t> steps = slider_positions(pose, sliders);
    for (std::size_t c = 0; c < steps.size(); ++c) {
      const double offset = static_cast<double>(steps[c]) - (count > 0 ? sum_of_steps[c] / count : 0);
      sum += offset * offset;
    }
    return sum;
  };
  std::size_t best = 0;
  for (std::size_t pose = 1; pose < poses.size(); ++pose)
    if (distance(pose) < distance(best)) best = pose;
  return best;
}

Json drawn_mechanism(const ShownDesigns& shown, const ShownDesign& design) {
  const MechanismInfo& info = shown.mechanism.info();
  const Sliders sliders = make_sliders(design, shown.detail);
  std::vector<Pose<double>> pose_values = grid_poses(sliders);
  const std::size_t grid_size = pose_values.size();
  for (const DesignMotion& named : shown.motions) add_motion_poses(*named.at(design.parameters), pose_values);
  const std::vector<DrawnPose> poses = draw(shown, design, pose_values);
  const auto assembled = std::ranges::find_if(poses, [](const DrawnPose& pose) { return !pose.links.empty(); });
  if (assembled == poses.end()) return Json();

  Json json = {{"name", design.name},
               {"coordinates", axes_data(info.coordinates)},
               {"joints", axes_data(info.joints)},
               {"links", Json::array()}};
  for (std::size_t c = 0; c < sliders.size(); ++c) json["coordinates"][c]["values"] = sliders[c];
  const LinkEnds ends(poses);
  for (std::size_t k = 0; k < assembled->links.size(); ++k) {
    const PlacedLink& link = assembled->links[k];
    json["links"].push_back({{"name", link.name},
                             {"part", link.part},
                             {"radius", link.body.radius},
                             {"from", ends.from[k]},
                             {"to", ends.to[k]}});
  }
  // For each pose: whether it can be assembled, and why it is infeasible. For each pose that can be assembled: ends of
  // links, joints and conditioning.
  std::vector<std::string> reasons = {""};
  std::vector<std::uint8_t> assembles;
  std::vector<std::int64_t> reason_index;
  std::vector<double> conditioning;
  std::vector<std::vector<double>> joints(info.joints.size());
  for (const DrawnPose& pose : poses) {
    assembles.push_back(!pose.links.empty());
    const std::string reason = pose.report.feasible ? "" : pose.report.reason;
    const auto known = std::ranges::find(reasons, reason);
    reason_index.push_back(known - reasons.begin());
    if (known == reasons.end()) reasons.push_back(reason);
    if (pose.links.empty()) continue;
    conditioning.push_back(pose.report.conditioning.value_or(std::nan("")));
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i].push_back(pose.report.joints ? (*pose.report.joints)[i] : std::nan(""));
  }
  const std::size_t start = initial_pose({poses.data(), grid_size}, sliders);
  json["initial_pose"] = start;
  json["motions"] = motion_poses(shown, design, pose_values, grid_size);
  json["dimensions"] = Json::array();
  for (const Dimension& d : dimensions_of(shown.mechanism, design.parameters, pose_values[start], shown.mode)) {
    const auto end = [&](std::size_t e) { return (e % 2 ? ends.to : ends.from)[e / 2]; };
    json["dimensions"].push_back({{"name", info.parameters[d.parameter].name},
                                  {"unit", info.parameters[d.parameter].unit},
                                  {"value", design.parameters[d.parameter]},
                                  {"from", end(d.from)},
                                  {"to", end(d.to)}});
  }
  const DesignFacts* const facts = find_design_facts(shown.mechanism);
  if (facts && (shown.coupling || !shown.motions.empty()))  // the loads along motions depend on the masses
    for (const auto& [name, mass] : facts->body_masses(design.parameters))
      json["masses"].push_back({{"name", name}, {"mass", mass}});
  json["end_count"] = ends.count;
  json["assembles"] = packed_bits(assembles);
  json["reasons"] = reasons;
  json["reason_index"] = packed_integers(reason_index);
  for (const auto& coordinate : ends.positions) json["end_positions"].push_back(packed_quantised(coordinate));
  for (const auto& joint : joints) json["joint_positions"].push_back(packed_floats(joint));
  json["conditioning"] = packed_floats(conditioning);
  return json;
}

}  // namespace

Json mechanism_data(const ShownDesigns& shown) {
  if (!shown.mechanism.links()) return {};
  Json designs = Json::array();
  for (const ShownDesign& design : shown.designs)
    if (design.workspace)
      if (Json json = drawn_mechanism(shown, design); !json.is_null()) designs.push_back(std::move(json));
  if (designs.empty()) return {};
  return {{"mode", shown.mode}, {"designs", designs}};
}

}  // namespace pkm
