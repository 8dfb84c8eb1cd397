#include "engine/survey/plain_voxels.hpp"

#include <stdexcept>

#include "engine/survey/cell_samples.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "engine/survey/share_samples.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm {
namespace {

using Kind = HeldCoordinate::Kind;

/// The cells of one design.
class Cells {
 public:
  Cells(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan,
        const VoxelOptions& voxels)
      : sweep_(sweep_of(mechanism.info(), plan)),
        ranges_(mechanism.ranges(parameters)),
        grid_(voxels.cells, voxels.box ? *voxels.box : box_of(mechanism, parameters, plan)),
        pose_(mechanism.info().coordinates.size()) {
    for (const int coordinate : sweep_.held) {
      const auto at = static_cast<std::size_t>(coordinate);
      const HeldCoordinate held = how_held(plan, coordinate);
      if (held.kind != Kind::integrated) {
        pose_[at] = held_value(mechanism, parameters, plan, coordinate);
        continue;
      }
      const auto range = ranges_ ? std::optional((*ranges_)[at]) : mechanism.reach(parameters, coordinate);
      if (!range) no_ranges(mechanism);
      const auto [lower, upper] = *range;
      held_.push_back({at, lower, (upper - lower) / static_cast<double>(held.cells), held.cells});
      measure_ *= held_.back().step;
      slices_ *= held.cells;
    }
  }

  const VoxelGrid& grid() const { return grid_; }
  std::int64_t slices() const { return slices_; }  ///< grids, one for each combination of the integrated coordinates
  double measure() const { return grid_.cell_volume() * measure_; }  ///< of a cell

  Pose<double> pose(std::int64_t slice, std::int64_t i, std::int64_t j, std::int64_t k) const {
    Pose<double> pose = pose_;
    for (const HeldCells& held : held_) {
      pose[held.coordinate] = held.centre(slice % held.cells);
      slice /= held.cells;
    }
    const std::int64_t cell[3] = {i, j, k};
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      pose[static_cast<std::size_t>(sweep_.swept[axis])] = grid_.centre(axis, cell[axis]);
    return pose;
  }
  /// Whether a cell lies on the outer layer of the box.
  bool touches(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const std::int64_t cell[3] = {i, j, k};
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      if (cell[axis] == 0 || cell[axis] == grid_.cells[axis] - 1) return true;
    return false;
  }

 private:
  [[noreturn]] static void no_ranges(const Mechanism& mechanism) {
    throw std::invalid_argument("mechanism " + mechanism.info().name +
                                " does not say where its workspace is; give a box");
  }
  /// What holds the workspace: the mechanism's ranges, else the box of its own voxels.
  Box box_of(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan) const {
    if (!ranges_ && !mechanism.voxels()) no_ranges(mechanism);
    Box box;
    box.fill({0, 1});
    if (!ranges_) {
      const VoxelMap map = mechanism.voxels()->prepare(plan, VoxelOptions{}, {})->map(parameters);
      for (std::size_t axis = 0; axis < 3; ++axis) box[axis] = {map.lower[axis], map.upper[axis]};
      return box;
    }
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      box[axis] = (*ranges_)[static_cast<std::size_t>(sweep_.swept[axis])];
    return box;
  }

  const Sweep& sweep_;
  std::optional<std::vector<std::array<double, 2>>> ranges_;
  VoxelGrid grid_;
  Pose<double> pose_;
  std::vector<HeldCells> held_;
  std::int64_t slices_ = 1;
  double measure_ = 1;
};

class PlainVoxels final : public VoxelSurveyor {
 public:
  PlainVoxels(const Mechanism& mechanism, const SurveyPlan& plan, const VoxelOptions& voxels, const Demand& demand)
      : mechanism_(mechanism),
        plan_(plan),
        voxels_(voxels),
        demand_(demand),
        mode_(demand.mode.empty() ? mechanism.info().modes.front() : demand.mode) {
    if (demand.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length only; leave out characteristic_length");
  }

  void survey(std::span<const double> parameters, Scratch&, Survey<double>& survey) const override {
    const Cells cells(mechanism_, parameters, plan_, voxels_);
    const VoxelGrid& grid = cells.grid();
    survey.clear(demand_.fields);
    survey.cells = grid.count() * cells.slices();
    survey.cell_volume = cells.measure();
    share_samples(static_cast<std::size_t>(cells.slices() * grid.cells[0]), survey,
                  [&](std::size_t piece, Survey<double>& part, std::size_t) {
                    const auto slice = static_cast<std::int64_t>(piece) / grid.cells[0],
                               i = static_cast<std::int64_t>(piece) % grid.cells[0];
                    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
                      for (std::int64_t k = 0; k < grid.cells[2]; ++k)
                        if (add(parameters, cells.pose(slice, i, j, k), cells.measure(), part))
                          part.touches_box = part.touches_box || cells.touches(i, j, k);
                  });
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
  }
  VoxelMap map(std::span<const double> parameters) const override {
    const Cells cells(mechanism_, parameters, plan_, voxels_);
    VoxelMap map = cells.grid().map();
    std::size_t cell = 0;
    for (std::int64_t i = 0; i < map.cells[0]; ++i)
      for (std::int64_t j = 0; j < map.cells[1]; ++j)
        for (std::int64_t k = 0; k < map.cells[2]; ++k)
          map.feasible[cell++] = mechanism_.inspect(parameters, cells.pose(0, i, j, k), mode_, plan_.limits).feasible;
    return map;
  }

 private:
  /// Whether the pose is feasible: then its sample is added.
  bool add(std::span<const double> parameters, const Pose<double>& pose, double weight, Survey<double>& to) const {
    const PoseReport report = mechanism_.inspect(parameters, pose, mode_, plan_.limits);
    if (!report.feasible) return false;
    ++to.feasible_cells;
    if (!demand_.needs_samples()) return true;
    to.weight.push_back(weight);
    if (demand_.poses) to.pose.push_back(pose);
    add_reported(report, mechanism_.info().joints.size(), to);
    if (demand_.needs_inertia()) {
      const MotionState<double> state{pose, AxisVector<double>(pose.size())};
      PoseDynamics<double> d;
      mechanism_.dynamics()->equations(parameters, mode_, {&state, 1}, {&d, 1});
      add_inertia(joint_inertia(d), to);
    }
    return true;
  }

  const Mechanism& mechanism_;
  SurveyPlan plan_;
  VoxelOptions voxels_;
  Demand demand_;
  std::string mode_;
};

}  // namespace

std::unique_ptr<const VoxelSurveyor> prepare_plain_voxels(const Mechanism& mechanism, const SurveyPlan& plan,
                                                          const VoxelOptions& voxels, const Demand& demand) {
  return std::make_unique<PlainVoxels>(mechanism, plan, voxels, demand);
}

}  // namespace pkm
