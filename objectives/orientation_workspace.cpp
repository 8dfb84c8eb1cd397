// Orientation workspace: Haar measure of the orientations that are feasible at a point, or at all points of a box
// (total orientation workspace). Every orientation counts once, whatever angles describe it.
//
// Reference: J.-P. Merlet, "Parallel Robots", 2nd ed., Springer, 2006, chapter 7.
#include <algorithm>
#include <functional>
#include <numbers>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/orientations.hpp"
#include "engine/workspace/box_poses.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

constexpr double kAllOrientations = 8 * std::numbers::pi * std::numbers::pi;  // [sr rad]

bool is_share(const Options& options) { return options.word("measure") == "share"; }

/// The points at which orientations are examined, as values of the coordinates that are no angles. Throws
/// std::invalid_argument if an option does not fit the mechanism.
std::vector<std::vector<FixedCoordinate>> points_of(const EntryContext& context, const std::vector<int>& angles) {
  using Kind = FixedCoordinate::Kind;
  const MechanismInfo& info = context.mechanism.info();
  std::vector<int> others;
  std::vector<std::string> names;
  for (int i = 0; i < static_cast<int>(info.coordinates.size()); ++i)
    if (!contains(angles, i)) {
      others.push_back(i);
      names.push_back(info.coordinates[static_cast<std::size_t>(i)].name);
    }
  std::vector<std::vector<FixedCoordinate>> points;
  if (context.options.has("points")) {
    if (context.options.has("at"))
      throw std::invalid_argument("at: there is one point, but `points` stands for those of a box; give one of them");
    const auto count = static_cast<int>(context.options.integer("points"));
    for (const int coordinate : sweep_of(info, context.plan).swept)
      if (contains(angles, coordinate))
        throw std::invalid_argument("points: the box is over " +
                                    info.coordinates[static_cast<std::size_t>(coordinate)].name +
                                    ", an angle; expected a box over " + join(names) + ": use a [[region]]");
    if (!context.plan.box())
      throw std::invalid_argument("points: the workspace has no box; expected a [[region]] with a box over " +
                                  join(names));
    WorkspacePlan plan = context.plan;
    for (const int angle : angles) {  // their values do not matter
      std::erase_if(plan.fixed, [angle](const FixedCoordinate& fixed) { return fixed.coordinate == angle; });
      plan.fixed.push_back({angle, Kind::value, 0});
    }
    for (const Pose<double>& pose : poses_of_box(plan, info, count, "the workspace or region")) {
      std::vector<FixedCoordinate>& point = points.emplace_back();
      for (const int i : others) point.push_back({i, Kind::value, pose[static_cast<std::size_t>(i)]});
    }
    return points;
  }
  std::vector<FixedCoordinate>& point = points.emplace_back();
  const NamedNumbers given = context.options.has("at") ? context.options.numbers("at") : NamedNumbers();
  for (const auto& [name, value] : given)
    if (!contains(names, name))
      throw std::invalid_argument("at: found the coordinate '" + name + "'; expected one of " + join(names) +
                                  did_you_mean(name, names));
  for (const int i : others) {
    const auto value = given.find(info.coordinates[static_cast<std::size_t>(i)].name);
    if (value != given.end()) {
      point.push_back({i, Kind::value, value->second});
      continue;
    }
    const FixedCoordinate fixed = how_fixed(context.plan, i);
    if (fixed.kind == Kind::value) point.push_back(fixed);
  }
  return points;
}

class OrientationWorkspace final : public Quantity {
 public:
  explicit OrientationWorkspace(const EntryContext& context)
      : orientations_(orientations_of(context.mechanism)),
        factor_(is_share(context.options) ? 1 / kAllOrientations : 1) {
    const std::int64_t cells = context.options.integer("cells");
    for (std::vector<FixedCoordinate>& point : points_of(context, orientations_->angles())) {
      const WorkspacePlan plan{
          .method = VoxelOptions{.cells = {2 * cells, cells, 2 * cells}, .box = orientations_->principal_ranges()},
          .swept = orientations_->angles(),
          .fixed = std::move(point),
          .limits = context.plan.limits};
      maps_.push_back(prepare_voxel_map(context.mechanism, plan));
    }
  }

  double value(const DesignView<double>& design) const override {
    VoxelMap common = maps_.front()->map(design.parameters);
    for (std::size_t k = 1; k < maps_.size(); ++k) {
      const VoxelMap map = maps_[k]->map(design.parameters);
      std::ranges::transform(common.feasible, map.feasible, common.feasible.begin(), std::bit_and<std::uint8_t>());
    }
    return factor_ * orientations_->measure(common);
  }
  Dual4 smooth(const DesignView<Dual4>&) const override { throw std::logic_error(*why_no_derivatives()); }
  Unsupported why_no_derivatives() const override { return "the orientation workspace counts cells"; }

 private:
  std::unique_ptr<const Orientations> orientations_;
  double factor_;
  std::vector<std::unique_ptr<const VoxelEvaluator>> maps_;  ///< for each point, evaluator of its feasible orientations
};

}  // namespace

ObjectiveEntry orientation_workspace() {
  return {
      .name = "orientation-workspace",
      .meaning = "measure of the orientations that are feasible at a point, or at all points of a box",
      .direction = Direction::maximise,
      .options = {{.name = "at",
                   .kind = OptionKind::named_numbers,
                   .unit = "m",
                   .meaning = "coordinates of the point, such as { x = 0, y = 0, z = 0.5 }; default: the values at "
                              "which the workspace fixes them, or those of the design"},
                  {.name = "points",
                   .kind = OptionKind::integer,
                   .lower = 2,
                   .upper = 65,
                   .meaning = "instead of one point, a grid with this number of points along each edge of the box of "
                              "the workspace or region, all of which the orientations have to reach"},
                  {.name = "cells",
                   .kind = OptionKind::integer,
                   .initial = std::int64_t{18},
                   .lower = 2,
                   .upper = 360,
                   .meaning = "number of cells along the second angle, over half a revolution; twice as many along the "
                              "first and the third"},
                  {.name = "measure",
                   .kind = OptionKind::word,
                   .initial = std::string("haar"),
                   .choices = {"haar", "share"},
                   .meaning = "haar: solid angle times angle, 8 pi^2 sr rad for all orientations; share: divided by "
                              "this"}},
      .unit = [](const EntryContext& context) -> std::string {
        return is_share(context.options) ? "1" : kOrientationUnit;
      },
      .refusal = [](const Mechanism& mechanism) -> Unsupported {
        const Unsupported reason = why_no_orientations(mechanism);
        return reason ? "objective orientation-workspace: " + *reason : reason;
      },
      .make = [](const EntryContext& context) { return std::make_unique<OrientationWorkspace>(context); },
      .range = [](const EntryContext& context) -> Range {
        return {.lower = 0, .upper = is_share(context.options) ? 1 : kAllOrientations};
      },
      .needs_workspace = [](const EntryContext&) { return false; },  // it evaluates voxels of its own
  };
}

}  // namespace pkm
