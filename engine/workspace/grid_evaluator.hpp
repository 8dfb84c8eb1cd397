// Voxel analysis for any method that finds feasible cells: of one grid, or of one grid for each combination of cells of
// the coordinates that are integrated over. Grids are divided into blocks, which the threads of a team share.
#pragma once

#include <span>
#include <vector>

#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"
#include "engine/workspace/fixed_cells.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// A design and its grids of equal size, one for each combination of cells of the coordinates that are integrated over.
struct GriddedDesign {
  VoxelGrid grid;
  std::size_t blocks;  ///< number of blocks of each grid
  double cell_volume;  ///< volume of a cell, multiplied by the cell sizes of the coordinates that are integrated over
  /// Number of grids, i.e. of combinations of cells of the coordinates that are integrated over.
  std::size_t grids = 1;

  GriddedDesign(const VoxelGrid& voxels, std::size_t blocks_of_grid, std::span<const FixedCells> integrated = {})
      : grid(voxels), blocks(blocks_of_grid), cell_volume(voxels.cell_volume()) {
    for (const FixedCells& each : integrated) {
      cell_volume *= each.step;
      grids *= static_cast<std::size_t>(each.cells);
    }
  }
};

/// Scratch memory of an analysis: one part that all blocks share, and one part for each worker thread.
template <class Shared, class PerWorker>
struct GridBuffers {
  Shared shared;
  std::vector<PerWorker> per_worker;

  void prepare() {
    if (per_worker.size() < workers()) per_worker.resize(workers());
  }
};

/// CRTP base class of voxel analyses. Self defines, accessible to this class,
///   Buffers                            its GridBuffers
///   start(parameters, buffers)         returns the design, a GriddedDesign or a class derived from it
///   find(design, number, block, buffer, result)
///                                      adds to the result the feasible cells of a block of the grid `number`, their
///                                      samples, and whether they touch the box
///   visit_cells(design, buffers, visit)
///                                      calls visit(cell) for the feasible cells of the first grid
template <class Self>
class GridEvaluator : public VoxelEvaluator {
 public:
  explicit GridEvaluator(const FieldRequest& request) : fields_(request.fields) {}

  void evaluate(std::span<const double> parameters, Scratch& scratch, WorkspaceResult<double>& result) const override {
    auto& buffers = scratch.get<typename Self::Buffers>();
    buffers.prepare();
    const auto design = self().start(parameters, buffers);
    result.clear(fields_);
    result.cells = design.grid.count() * static_cast<std::int64_t>(design.grids);
    result.cell_volume = design.cell_volume;
    if (has_team())
      evaluate_in_parallel(design, buffers.per_worker, result);
    else
      for (std::size_t number = 0; number < design.grids; ++number)
        for (std::size_t block = 0; block < design.blocks; ++block) {
          check_stop();
          self().find(design, number, block, buffers.per_worker[0], result);
        }
    result.volume = static_cast<double>(result.feasible_cells) * result.cell_volume;
  }
  VoxelMap map(std::span<const double> parameters) const final {
    typename Self::Buffers buffers;
    buffers.prepare();
    const auto design = self().start(parameters, buffers);
    VoxelMap map = design.grid.map();
    self().visit_cells(design, buffers, [&](const Cell& cell) { map.feasible[design.grid.index(cell)] = 1; });
    return map;
  }

 private:
  const Self& self() const { return static_cast<const Self&>(*this); }

  /// Merges the results of the blocks in their order, so that samples have the same order as in a serial evaluation.
  template <class Design, class PerWorker>
  void evaluate_in_parallel(const Design& design, std::vector<PerWorker>& buffers,
                            WorkspaceResult<double>& result) const {
    std::vector<WorkspaceResult<double>> parts(design.blocks * design.grids);
    parallel_for(parts.size(), [&](std::size_t i, std::size_t end, std::size_t worker) {
      for (; i < end; ++i) {
        check_stop();
        parts[i].clear(fields_);
        self().find(design, i / design.blocks, i % design.blocks, buffers[worker], parts[i]);
      }
    });
    for (const WorkspaceResult<double>& part : parts) {
      append_samples(part, result);
      result.feasible_cells += part.feasible_cells;
      result.touches_box = result.touches_box || part.touches_box;
    }
  }

  std::vector<const PoseQuantity*> fields_;
};

}  // namespace pkm
