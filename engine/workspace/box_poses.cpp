#include "engine/workspace/box_poses.hpp"

#include <stdexcept>

#include "engine/geometry/pose_product.hpp"

namespace pkm {

std::vector<Pose<double>> poses_of_box(const WorkspacePlan& plan, const MechanismInfo& info, int points,
                                       const std::string& where) {
  if (!plan.box()) throw std::invalid_argument("task-workspace needs a box, and " + where + " has none");
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Pose<double>> poses = {Pose<double>(info.coordinates.size())};
  for (const int coordinate : sweep.fixed) {
    const FixedCoordinate how = how_fixed(plan, coordinate);
    using Kind = FixedCoordinate::Kind;
    if (how.kind != Kind::value && how.kind != Kind::listed)
      throw std::invalid_argument("task-workspace needs a number or a list of them for each fixed coordinate of " +
                                  where);
    poses = with_each(poses, coordinate, how.kind == Kind::listed ? how.values : std::vector{how.value});
  }
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
    const auto& [lower, upper] = (*plan.box())[axis];
    std::vector<double> values;
    for (int k = 0; k + 1 < points; ++k) values.push_back(lower + (upper - lower) * k / (points - 1));
    values.push_back(upper);
    poses = with_each(poses, sweep.swept[axis], values);
  }
  return poses;
}

}  // namespace pkm
