#include "engine/workspace/plain_voxels.hpp"

#include <stdexcept>

#include "engine/core/stop.hpp"
#include "engine/workspace/grid_surveyor.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

/// A design on its grids, whose pieces are cells of the first axis.
struct GriddedPoses : Gridded {
  std::span<const double> parameters;
  const std::vector<FixedCells>& held;
  Pose<double> pose;  ///< with the held coordinates
  const Sweep& sweep;

  Pose<double> pose_at(std::size_t number, const Cell& cell) const {
    Pose<double> at = pose;
    set_fixed(held, number, [&](std::size_t coordinate) -> double& { return at[coordinate]; });
    for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
      at[static_cast<std::size_t>(sweep.swept[axis])] = grid.centre(axis, cell[axis]);
    return at;
  }
  /// Whether a cell lies on the outer layer of the box.
  bool touches(const Cell& cell) const {
    for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
      if (grid.at_end(axis, cell[axis])) return true;
    return false;
  }
  /// Calls visit(cell) for all cells of a piece.
  template <class Visit>
  void for_each_cell(std::size_t piece, const Visit& visit) const {
    const auto i = static_cast<std::int64_t>(piece);
    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
      for (std::int64_t k = 0; k < grid.cells[2]; ++k) {
        check_stop();
        visit(Cell{i, j, k});
      }
  }
};

class PlainVoxels final : public GridEvaluator<PlainVoxels> {
 public:
  PlainVoxels(const Mechanism& mechanism, const WorkspacePlan& plan, const VoxelOptions& voxels, const Demand& demand)
      : GridEvaluator(demand),
        mechanism_(mechanism),
        plan_(plan),
        voxels_(voxels),
        demand_(demand),
        mode_(demand.mode.empty() ? mechanism.info().modes.front() : demand.mode) {
    if (demand.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length only; leave out characteristic_length");
  }

 private:
  friend GridEvaluator;
  struct Room {};
  using Rooms = GridRooms<std::vector<FixedCells>, Room>;

  GriddedPoses start(std::span<const double> parameters, Rooms& rooms) const {
    const Sweep& sweep = sweep_of(mechanism_.info(), plan_);
    const auto ranges = mechanism_.ranges(parameters);
    std::vector<FixedCells>& held = rooms.common;
    find_fixed_cells(
        sweep.held, plan_,
        [&](int coordinate) {
          const auto range = ranges ? std::optional((*ranges)[static_cast<std::size_t>(coordinate)])
                                    : mechanism_.reach(parameters, coordinate);
          if (!range) no_ranges();
          return *range;
        },
        held);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : box_of(parameters, sweep, ranges));
    GriddedPoses poses{{grid, static_cast<std::size_t>(grid.cells[0]), held},
                       parameters,
                       held,
                       Pose<double>(mechanism_.info().coordinates.size()),
                       sweep};
    for (const int coordinate : sweep.held)
      if (how_fixed(plan_, coordinate).kind != FixedCoordinate::Kind::integrated)
        poses.pose[static_cast<std::size_t>(coordinate)] = fixed_value(mechanism_, parameters, plan_, coordinate);
    return poses;
  }
  void find(const GriddedPoses& poses, std::size_t number, std::size_t piece, Room&, Survey<double>& to) const {
    poses.for_each_cell(piece, [&](const Cell& cell) {
      if (add(poses.parameters, poses.pose_at(number, cell), poses.cell_volume, to))
        to.touches_box = to.touches_box || poses.touches(cell);
    });
  }
  template <class Visit>
  void visit_cells(const GriddedPoses& poses, Rooms&, const Visit& visit) const {
    for (std::size_t piece = 0; piece < poses.pieces; ++piece)
      poses.for_each_cell(piece, [&](const Cell& cell) {
        if (mechanism_.inspect(poses.parameters, poses.pose_at(0, cell), mode_, plan_.limits).feasible) visit(cell);
      });
  }

  [[noreturn]] void no_ranges() const {
    throw std::invalid_argument("mechanism " + mechanism_.info().name +
                                " does not say where its workspace is; give a box");
  }
  /// A box that contains the workspace: that of the mechanism's own voxels, else its ranges.
  Box box_of(std::span<const double> parameters, const Sweep& sweep,
             const std::optional<std::vector<std::array<double, 2>>>& ranges) const {
    if (!ranges && !mechanism_.voxels()) no_ranges();
    Box box;
    box.fill({0, 1});
    if (mechanism_.voxels()) {
      const VoxelMap map = mechanism_.voxels()->prepare(plan_, VoxelOptions{}, {})->map(parameters);
      for (std::size_t axis = 0; axis < 3; ++axis) box[axis] = {map.lower[axis], map.upper[axis]};
      return box;
    }
    for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
      box[axis] = (*ranges)[static_cast<std::size_t>(sweep.swept[axis])];
    return box;
  }

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
  WorkspacePlan plan_;
  VoxelOptions voxels_;
  Demand demand_;
  std::string mode_;
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> prepare_plain_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                           const VoxelOptions& voxels, const Demand& demand) {
  return std::make_unique<PlainVoxels>(mechanism, plan, voxels, demand);
}

}  // namespace pkm
