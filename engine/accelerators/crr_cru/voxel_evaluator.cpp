#include <algorithm>

#include "engine/accelerators/crr_cru/analysis.hpp"
#include "engine/accelerators/crr_cru/inertia_tables.hpp"
#include "engine/accelerators/crr_cru/voxels.hpp"
#include "engine/workspace/grid_evaluator.hpp"

namespace pkm::crr_cru {
namespace {

/// The feasible cells at one phi, with tables of the inertia if it is requested.
struct CellsAtPhi {
  SliceCells cells;
  InertiaTables tables;
  double conditioning = 0;
};

/// Scratch memory of one thread, used for one slice at a time.
struct VoxelWorker {
  CellsAtPhi own;
  std::vector<std::uint64_t> row;
  std::array<std::vector<double>, 4> dci;
};

/// A design on its voxel grid. The grid is divided into slices, one for each cell along the outer coordinate.
struct GriddedSlices : GriddedDesign {
  Design<double> d;
  Masses<double> masses;
  GridAxes axes;
  bool over_phi;  ///< true: phi is the outer coordinate, and each slice has its own phi; false: phi is fixed
  std::array<std::size_t, 3> swept;  ///< the index of the coordinate of each axis of the grid, ascending
  double fixed;                      ///< value of the fixed coordinate
  const CellsAtPhi& common;          ///< if phi is fixed: the feasible cells that all slices share
};

class ClosedFormVoxels final : public GridEvaluator<ClosedFormVoxels> {
 public:
  ClosedFormVoxels(const AnalysisSettings& settings, const VoxelOptions& voxels)
      : GridEvaluator(settings.request),
        settings_(settings),
        voxels_(voxels),
        beyond_coupling_(std::ranges::any_of(settings.request.fields, [](const PoseQuantity* quantity) {
          return quantity->needs_inertia() && quantity != &kCouplingIndex;
        })) {}

 private:
  friend GridEvaluator;
  using Buffers = GridBuffers<CellsAtPhi, VoxelWorker>;

  void evaluate(std::span<const double> parameters, Scratch& scratch,
                WorkspaceResult<double>& workspace) const override {
    GridEvaluator::evaluate(parameters, scratch, workspace);
    if (!settings_.with_conditioning || !workspace.weight.empty()) return;
    // If phi is fixed, the conditioning is the same in all cells, and one sample represents them all.
    const Geometry<double> g = geometry(settings_.platform, parameters);
    settings_.add_conditioning(g, fixed_value(g, settings_.fixed), workspace.volume, workspace);
  }

  GriddedSlices start(std::span<const double> parameters, Buffers& buffers) const {
    const FixedCoordinate& fixed = settings_.fixed;
    const Design<double> d = design(geometry(settings_.platform, parameters), settings_.limits);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(d, fixed));
    GriddedSlices s{{grid, 0},
                    d,
                    settings_.request.needs_inertia() ? settings_.masses(parameters) : Masses<double>{},
                    grid_axes(fixed),
                    slice_axes(fixed).outer_is_phi,
                    {},
                    fixed_value(d.g, fixed),
                    buffers.shared};
    for (std::size_t k = 0, axis = 0; k < 4; ++k)
      if (static_cast<int>(k) != fixed.coordinate) s.swept[axis++] = k;
    if (s.over_phi || fill(s, s.fixed, buffers.shared)) s.blocks = static_cast<std::size_t>(grid.cells[s.axes.outer]);
    return s;
  }

  /// Finds the feasible cells at one value of phi, and writes them to `to`.
  /// @return false if no cell is feasible
  bool fill(const GriddedSlices& s, double phi, CellsAtPhi& to) const {
    if (!to.cells.fill(s.d, settings_.fixed, s.grid, phi)) return false;
    if (!settings_.request.needs_inertia()) return true;
    to.tables.fill(s.d.g, s.masses, settings_.mode, phi, s.grid, s.swept, s.axes.v, s.fixed);
    if (settings_.with_conditioning) to.conditioning = settings_.conditioning_at(s.d.g, phi);
    return true;
  }
  /// The feasible cells of a slice; null if there are none.
  const CellsAtPhi* cells_of(const GriddedSlices& s, std::size_t block, VoxelWorker& worker) const {
    if (!s.over_phi) return &s.common;
    return fill(s, s.grid.centre(s.axes.outer, static_cast<std::int64_t>(block)), worker.own) ? &worker.own : nullptr;
  }

  void find(const GriddedSlices& s, std::size_t, std::size_t block, VoxelWorker& worker,
            WorkspaceResult<double>& to) const {
    const CellsAtPhi* const at = cells_of(s, block, worker);
    if (!at) return;
    const auto k = static_cast<std::int64_t>(block);
    if (settings_.request.needs_inertia()) {
      visit_runs(s, *at, k, worker.row, [&](const CellRun& run) { sample(s, *at, run, worker.dci, to); });
      return;
    }
    const PlaneTally plane = at->cells.count(s.over_phi ? 0 : block);
    to.feasible_cells += plane.cells;
    to.touches_box = to.touches_box || (plane.cells > 0 && (plane.touches || s.grid.at_end(s.axes.outer, k)));
    if (settings_.with_conditioning && s.over_phi)
      settings_.add_conditioning(s.d.g, s.grid.centre(s.axes.outer, k),
                                 static_cast<double>(plane.cells) * s.cell_volume, to);
  }

  /// Adds each cell of a run of feasible cells as a sample with its inertia.
  void sample(const GriddedSlices& s, const CellsAtPhi& at, const CellRun& run, std::array<std::vector<double>, 4>& dci,
              WorkspaceResult<double>& to) const {
    count_cells(s.grid, run, to);
    auto *const conditioning = to.find(kConditioning), *const indices = to.find(kCouplingIndex);
    const std::size_t v = s.axes.v;
    if (indices) {
      Cell row = run.first;
      row[v] = 0;
      at.tables.coupling(row, static_cast<std::size_t>(run.first[v]), static_cast<std::size_t>(run.end), dci);
    }
    for_each_cell(run, [&](const Cell& cell) {
      to.weight.push_back(s.cell_volume);
      if (settings_.request.poses) {
        auto& pose = to.pose.emplace_back(4);
        pose[static_cast<std::size_t>(settings_.fixed.coordinate)] = s.fixed;
        for (std::size_t k = 0; k < 3; ++k) pose[s.swept[k]] = s.grid.centre(k, cell[k]);
      }
      if (conditioning) conditioning->push_back(at.conditioning);
      for (std::size_t i = 0; indices && i < 4; ++i) indices[i].push_back(dci[i][static_cast<std::size_t>(cell[v])]);
      if (beyond_coupling_) add_inertia(at.tables.at(cell), to, &kCouplingIndex);
    });
  }

  template <class Visit>
  void visit_cells(const GriddedSlices& s, Buffers& buffers, const Visit& visit) const {
    VoxelWorker& worker = buffers.per_worker[0];
    for (std::size_t block = 0; block < s.blocks; ++block)
      if (const CellsAtPhi* const at = cells_of(s, block, worker))
        visit_runs(s, *at, static_cast<std::int64_t>(block), worker.row,
                   [&](const CellRun& run) { for_each_cell(run, visit); });
  }

  /// Calls visit(run) for each run of feasible cells along v in slice number k, in the order of ascending u.
  /// @param row  scratch memory
  template <class Visit>
  void visit_runs(const GriddedSlices& s, const CellsAtPhi& at, std::int64_t k, std::vector<std::uint64_t>& row,
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

  AnalysisSettings settings_;
  VoxelOptions voxels_;
  bool beyond_coupling_;  ///< true if fields of the inertia other than the coupling indices are requested
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> make_evaluator(const AnalysisSettings& settings, const VoxelOptions& voxels) {
  return std::make_unique<ClosedFormVoxels>(settings, voxels);
}

}  // namespace pkm::crr_cru
