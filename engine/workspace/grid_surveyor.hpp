// Voxel surveys, whatever finds the cells: of one grid, or of one for each combination of the cells of coordinates that
// are integrated over, in pieces that threads share out.
#pragma once

#include <span>
#include <vector>

#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/mechanism/surveyor.hpp"
#include "engine/workspace/cell_samples.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// A design on its grids.
struct Gridded {
  VoxelGrid grid;
  std::size_t pieces;     ///< of a grid: work that is shared out
  double cell_volume;     ///< with the steps of coordinates that are integrated over
  std::size_t grids = 1;  ///< alike but for these coordinates

  Gridded(const VoxelGrid& on, std::size_t pieces_of_grid, std::span<const FixedCells> integrated = {})
      : grid(on), pieces(pieces_of_grid), cell_volume(on.cell_volume()) {
    for (const FixedCells& each : integrated) {
      cell_volume *= each.step;
      grids *= static_cast<std::size_t>(each.cells);
    }
  }
};

/// What surveys overwrite.
template <class Common, class Room>
struct GridRooms {
  Common common;
  std::vector<Room> of;  ///< workers

  void prepare() {
    if (of.size() < workers()) of.resize(workers());
  }
};

/// Self has, for it alone,
///   Rooms                            GridRooms of its own
///   start(parameters, rooms)         a design: Gridded, or what is derived from it
///   find(design, number, piece, room, to)  adds the feasible cells of a piece of the grid with a number, whether they
///                                    touch the box, and their samples
///   visit_cells(design, rooms, visit)  calls visit(cell) for the feasible cells of the first grid
template <class Self>
class GridEvaluator : public VoxelEvaluator {
 public:
  explicit GridEvaluator(const Demand& demand) : fields_(demand.fields) {}

  void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const override {
    auto& rooms = scratch.get<typename Self::Rooms>();
    rooms.prepare();
    const auto design = self().start(parameters, rooms);
    survey.clear(fields_);
    survey.cells = design.grid.count() * static_cast<std::int64_t>(design.grids);
    survey.cell_volume = design.cell_volume;
    if (has_team())
      share_out(design, rooms.of, survey);
    else
      for (std::size_t number = 0; number < design.grids; ++number)
        for (std::size_t piece = 0; piece < design.pieces; ++piece) {
          check_stop();
          self().find(design, number, piece, rooms.of[0], survey);
        }
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
  }
  VoxelMap map(std::span<const double> parameters) const final {
    typename Self::Rooms rooms;
    rooms.prepare();
    const auto design = self().start(parameters, rooms);
    VoxelMap map = design.grid.map();
    self().visit_cells(design, rooms, [&](const Cell& cell) { map.feasible[design.grid.index(cell)] = 1; });
    return map;
  }

 private:
  const Self& self() const { return static_cast<const Self&>(*this); }

  /// The same samples, in the same order, as without a team.
  template <class Design, class Rooms>
  void share_out(const Design& design, Rooms& rooms, Survey<double>& survey) const {
    std::vector<Survey<double>> parts(design.pieces * design.grids);
    parallel_for(parts.size(), [&](std::size_t i, std::size_t end, std::size_t worker) {
      for (; i < end; ++i) {
        check_stop();
        parts[i].clear(fields_);
        self().find(design, i / design.pieces, i % design.pieces, rooms[worker], parts[i]);
      }
    });
    for (const Survey<double>& part : parts) {
      append_samples(part, survey);
      survey.feasible_cells += part.feasible_cells;
      survey.touches_box = survey.touches_box || part.touches_box;
    }
  }

  std::vector<const PoseQuantity*> fields_;
};

}  // namespace pkm
