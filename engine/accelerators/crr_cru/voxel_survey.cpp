#include <algorithm>

#include "engine/accelerators/crr_cru/inertia_tables.hpp"
#include "engine/accelerators/crr_cru/planned.hpp"
#include "engine/accelerators/crr_cru/voxels.hpp"
#include "engine/workspace/grid_surveyor.hpp"

namespace pkm::crr_cru {
namespace {

/// The cells at one phi, with their inertia where it counts.
struct CellsAtPhi {
  SectionCells cells;
  InertiaTables tables;
  double conditioning = 0;
};

/// Storage of one worker.
struct VoxelWorker {
  CellsAtPhi own;
  std::vector<std::uint64_t> row;
  std::array<std::vector<double>, 4> dci;
};

/// A design on its grid, whose pieces are the outer cells.
struct GriddedSections : Gridded {
  Design<double> d;
  Masses<double> masses;
  GridAxes axes;
  bool over_phi;                     ///< sections are of one phi each
  std::array<std::size_t, 3> swept;  ///< the coordinate of each axis of the grid, ascending
  double held_at;
  const CellsAtPhi& common;  ///< where one phi is held

  Pose<double> pose_of(const Cell& cell, const Held& held) const {
    std::array<double, 4> x{};
    x[held.coordinate] = held_at;
    for (std::size_t k = 0; k < 3; ++k) x[swept[k]] = grid.centre(k, cell[k]);
    return {x[0], x[1], x[2], x[3]};
  }
};

class OfVoxels final : public GridEvaluator<OfVoxels> {
 public:
  OfVoxels(const Planned& planned, const VoxelOptions& voxels)
      : GridEvaluator(planned.demand),
        planned_(planned),
        voxels_(voxels),
        beyond_coupling_(std::ranges::any_of(planned.demand.fields, [](const PoseQuantity* quantity) {
          return quantity->needs_inertia() && quantity != &kCouplingIndex;
        })) {}

 private:
  friend GridEvaluator;
  using Rooms = GridRooms<CellsAtPhi, VoxelWorker>;

  void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const override {
    GridEvaluator::survey(parameters, scratch, survey);
    if (!planned_.with_conditioning || !survey.weight.empty()) return;
    const Geometry<double> g = geometry(planned_.platform, parameters);  // one phi for all
    planned_.add_conditioning(g, fixed_value(g, planned_.held), survey.volume, survey);
  }

  GriddedSections start(std::span<const double> parameters, Rooms& rooms) const {
    const Held& held = planned_.held;
    const Design<double> d = design(geometry(planned_.platform, parameters), planned_.limits);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(d, held));
    GriddedSections s{{grid, 0},
                      d,
                      planned_.demand.needs_inertia() ? planned_.masses(parameters) : Masses<double>{},
                      grid_axes(held),
                      cuts(held).outer_is_phi,
                      {},
                      fixed_value(d.g, held),
                      rooms.common};
    for (std::size_t k = 0, axis = 0; k < 4; ++k)
      if (k != held.coordinate) s.swept[axis++] = k;
    if (s.over_phi || fill(s, s.held_at, rooms.common)) s.pieces = static_cast<std::size_t>(grid.cells[s.axes.outer]);
    return s;
  }

  /// false: there are no cells.
  bool fill(const GriddedSections& s, double phi, CellsAtPhi& to) const {
    if (!to.cells.fill(s.d, planned_.held, s.grid, phi)) return false;
    if (!planned_.demand.needs_inertia()) return true;
    to.tables.fill(s.d.g, s.masses, planned_.mode, phi, s.grid, s.swept, s.axes.v, s.held_at);
    if (planned_.with_conditioning) to.conditioning = planned_.conditioning_at(s.d.g, phi);
    return true;
  }

  void find(const GriddedSections& s, std::size_t, std::size_t piece, VoxelWorker& worker, Survey<double>& to) const {
    const auto k = static_cast<std::int64_t>(piece);
    const double phi = s.grid.centre(s.axes.outer, k);  // where sections are of one phi each
    if (s.over_phi && !fill(s, phi, worker.own)) return;
    const CellsAtPhi& at = s.over_phi ? worker.own : s.common;
    const std::int64_t before = to.feasible_cells;
    if (planned_.demand.needs_inertia()) {
      visit_runs(s, at, k, worker.row, [&](const CellRun& run) { sample(s, at, run, worker.dci, to); });
      return;
    }
    if (const PlaneTally plane = at.cells.count(s.over_phi ? 0 : piece); plane.cells > 0) {
      to.feasible_cells += plane.cells;
      to.touches_box = to.touches_box || plane.touches || s.grid.at_end(s.axes.outer, k);
    }
    if (planned_.with_conditioning && s.over_phi)
      planned_.add_conditioning(s.d.g, phi, static_cast<double>(to.feasible_cells - before) * s.cell_volume, to);
  }

  /// A run's cells, with their inertia.
  void sample(const GriddedSections& s, const CellsAtPhi& at, const CellRun& run,
              std::array<std::vector<double>, 4>& dci, Survey<double>& to) const {
    count_cells(s.grid, run, to);
    auto *const conditioning = to.find(kConditioning), *const indices = to.find(kCouplingIndex);
    const std::int64_t first = run.first[s.axes.v];
    if (indices) {
      Cell row = run.first;
      row[s.axes.v] = 0;
      at.tables.coupling(row, static_cast<std::size_t>(first), static_cast<std::size_t>(run.end), dci);
    }
    for_each_cell(run, [&](const Cell& cell) {
      to.weight.push_back(s.cell_volume);
      if (planned_.demand.poses) to.pose.push_back(s.pose_of(cell, planned_.held));
      if (conditioning) conditioning->push_back(at.conditioning);
      for (std::size_t i = 0; indices && i < 4; ++i)
        indices[i].push_back(dci[i][static_cast<std::size_t>(cell[s.axes.v])]);
      if (beyond_coupling_) add_inertia(at.tables.at(cell), to, &kCouplingIndex);
    });
  }

  template <class Visit>
  void visit_cells(const GriddedSections& s, Rooms& rooms, const Visit& visit) const {
    VoxelWorker& worker = rooms.of[0];
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(s.pieces); ++k)
      if (!s.over_phi || fill(s, s.grid.centre(s.axes.outer, k), worker.own))
        visit_runs(s, s.over_phi ? worker.own : s.common, k, worker.row,
                   [&](const CellRun& run) { for_each_cell(run, visit); });
  }

  /// Calls visit(run) for the runs of an outer cell's section, by u.
  /// @param row  storage
  template <class Visit>
  void visit_runs(const GriddedSections& s, const CellsAtPhi& at, std::int64_t k, std::vector<std::uint64_t>& row,
                  const Visit& visit) const {
    CellRun run{{}, s.axes.v, 0};
    run.first[s.axes.outer] = k;
    at.cells.visit_columns(s.over_phi ? 0 : static_cast<std::size_t>(k), row, [&](std::int64_t u) {
      run.first[s.axes.u] = u;
      for_each_run(row, [&](std::size_t first, std::size_t end) {
        run.first[s.axes.v] = static_cast<std::int64_t>(first);
        run.end = static_cast<std::int64_t>(end);
        visit(run);
      });
    });
  }

  Planned planned_;
  VoxelOptions voxels_;
  bool beyond_coupling_;  ///< fields of inertia are demanded that are not computed side by side
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> make_surveyor(const Planned& planned, const VoxelOptions& voxels) {
  return std::make_unique<OfVoxels>(planned, voxels);
}

}  // namespace pkm::crr_cru
