#include "engine/workspace/cellwise_voxels.hpp"

#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/workspace/grid_evaluator.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

/// A design and its grids; each block of a grid is one layer of cells along the first axis.
struct GriddedPoses : GriddedDesign {
  std::span<const double> parameters;
  const std::vector<FixedCells>& fixed;  ///< cells of the coordinates that are integrated over
  Pose<double> pose;                     ///< values of the fixed coordinates that are not integrated over
  const Sweep& sweep;

  Pose<double> pose_at(std::size_t number, const Cell& cell) const {
    Pose<double> at = pose;
    set_fixed_cells(fixed, number, [&](std::size_t coordinate) -> double& { return at[coordinate]; });
    for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
      at[static_cast<std::size_t>(sweep.swept[axis])] = grid.centre(axis, cell[axis]);
    return at;
  }
  /// Calls visit(cell) for all cells of a block.
  template <class Visit>
  void for_each_cell(std::size_t block, const Visit& visit) const {
    const auto i = static_cast<std::int64_t>(block);
    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
      for (std::int64_t k = 0; k < grid.cells[2]; ++k) {
        check_stop();
        visit(Cell{i, j, k});
      }
  }
};

class CellwiseVoxels final : public GridEvaluator<CellwiseVoxels> {
 public:
  CellwiseVoxels(const Mechanism& mechanism, const WorkspacePlan& plan, const VoxelOptions& voxels,
                 const FieldRequest& request)
      : GridEvaluator(request),
        mechanism_(mechanism),
        plan_(plan),
        voxels_(voxels),
        request_(request),
        mode_(request.mode.empty() ? mechanism.info().modes.front() : request.mode) {
    if (request.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length; remove characteristic_length");
  }

 private:
  friend GridEvaluator;
  struct NoBuffer {};
  using Buffers = GridBuffers<std::vector<FixedCells>, NoBuffer>;

  GriddedPoses start(std::span<const double> parameters, Buffers& buffers) const {
    const Sweep& sweep = sweep_of(mechanism_.info(), plan_);
    const auto ranges = mechanism_.ranges(parameters);
    std::vector<FixedCells>& fixed = buffers.shared;
    find_fixed_cells(
        sweep.fixed, plan_,
        [&](int coordinate) {
          const auto range = ranges ? std::optional((*ranges)[static_cast<std::size_t>(coordinate)])
                                    : mechanism_.reach(parameters, coordinate);
          if (!range) throw_missing_ranges();
          return *range;
        },
        fixed);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : box_of(parameters, sweep, ranges));
    GriddedPoses poses{{grid, static_cast<std::size_t>(grid.cells[0]), fixed},
                       parameters,
                       fixed,
                       Pose<double>(mechanism_.info().coordinates.size()),
                       sweep};
    for (const int coordinate : sweep.fixed)
      if (how_fixed(plan_, coordinate).kind != FixedCoordinate::Kind::integrated)
        poses.pose[static_cast<std::size_t>(coordinate)] = fixed_value(mechanism_, parameters, plan_, coordinate);
    return poses;
  }
  void find(const GriddedPoses& poses, std::size_t number, std::size_t block, NoBuffer&,
            WorkspaceResult<double>& result) const {
    poses.for_each_cell(block, [&](const Cell& cell) {
      if (add(poses.parameters, poses.pose_at(number, cell), poses.cell_volume, result))
        result.touches_box = result.touches_box || poses.grid.is_outermost(cell, poses.sweep.swept.size());
    });
  }
  template <class Visit>
  void visit_cells(const GriddedPoses& poses, Buffers&, const Visit& visit) const {
    for (std::size_t block = 0; block < poses.blocks; ++block)
      poses.for_each_cell(block, [&](const Cell& cell) {
        if (mechanism_.inspect(poses.parameters, poses.pose_at(0, cell), mode_, plan_.limits).feasible) visit(cell);
      });
  }

  [[noreturn]] void throw_missing_ranges() const {
    throw DesignError("mechanism " + mechanism_.info().name + " has no default box; give a box");
  }
  /// A box that contains the workspace: that of the mechanism's own voxels if it has any, otherwise the ranges of the
  /// coordinates.
  Box box_of(std::span<const double> parameters, const Sweep& sweep,
             const std::optional<std::vector<std::array<double, 2>>>& ranges) const {
    if (!ranges && !mechanism_.voxels()) throw_missing_ranges();
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

  /// Counts a pose if it is feasible, and appends its sample if samples are requested. @return true if it is feasible
  bool add(std::span<const double> parameters, const Pose<double>& pose, double weight,
           WorkspaceResult<double>& result) const {
    const PoseReport report = mechanism_.inspect(parameters, pose, mode_, plan_.limits);
    if (!report.feasible) return false;
    ++result.feasible_cells;
    if (!request_.needs_samples()) return true;
    result.weight.push_back(weight);
    if (request_.poses) result.pose.push_back(pose);
    add_report(report, mechanism_.info().joints.size(), result);
    for (auto& [quantity, field] : result.fields)
      if (quantity->formula) field[0].push_back(report.quantities[*quantity->formula]);
    if (request_.needs_inertia()) {
      const MotionState<double> state{pose, AxisVector<double>(pose.size())};
      PoseDynamics<double> d;
      mechanism_.dynamics()->equations(parameters, mode_, {&state, 1}, {&d, 1});
      add_inertia(joint_inertia(d), result);
    }
    return true;
  }

  const Mechanism& mechanism_;
  WorkspacePlan plan_;
  VoxelOptions voxels_;
  FieldRequest request_;
  std::string mode_;
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> prepare_cellwise_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                              const VoxelOptions& voxels, const FieldRequest& request) {
  return std::make_unique<CellwiseVoxels>(mechanism, plan, voxels, request);
}

}  // namespace pkm
