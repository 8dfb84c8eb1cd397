#include <algorithm>

#include "engine/mechanisms/crr_cru/inertia_tables.hpp"
#include "engine/mechanisms/crr_cru/links.hpp"
#include "engine/mechanisms/crr_cru/survey.hpp"
#include "engine/mechanisms/crr_cru/voxels.hpp"
#include "engine/survey/share_samples.hpp"

namespace pkm::crr_cru {
namespace {

using Cell = std::array<std::int64_t, 3>;
using Row = std::vector<std::uint64_t>;

/// Storage of one worker.
struct VoxelWorker {
  SectionCells cells;
  InertiaTables tables;
  Row row;
  std::array<std::vector<double>, 4> dci;
};

/// Storage that surveys reuse. Where one phi is held, all workers read the first one's cells and tables.
struct VoxelScratch {
  std::vector<VoxelWorker> workers;
};

/// A clearance limit on one design. Where the elbows are, and so which links meet, depends on the working mode.
struct ClearanceTest {
  LinkRadii<double> radii;
  WorkingMode mode;
  double least;  ///< [m]
  const Obstacles* obstacles;
};

/// A design on its grid.
struct Gridded {
  Design<double> d;
  VoxelGrid grid;
  GridAxes axes;
  bool over_phi;                     ///< sections are of one phi each
  std::array<std::size_t, 3> swept;  ///< the coordinate of each axis of the grid, ascending
  std::size_t held;                  ///< the other one
  double held_at;
  std::optional<ClearanceTest> test;

  Pose<double> pose_of(const Cell& cell) const {
    std::array<double, 4> x{};
    x[held] = held_at;
    for (std::size_t k = 0; k < 3; ++k) x[swept[k]] = grid.centre(k, cell[k]);
    return {x[0], x[1], x[2], x[3]};
  }
  /// Takes out of a column the cells that do not keep clear, one by one. @return  whether any are left
  /// @param cell  any of it
  bool clear(Cell cell, Row& row) const {
    for_each_bit(row, [&](std::size_t v) {
      cell[axes.v] = static_cast<std::int64_t>(v);
      const Limbs<double> limbs = inverse(d.g, pose_of(cell), test->mode);
      if (!keep_clear(links(d.g, test->radii, limbs), test->least, *test->obstacles))
        row[v / 64] &= ~(std::uint64_t{1} << v % 64);
    });
    return std::ranges::any_of(row, [](std::uint64_t word) { return word != 0; });
  }
  /// Whether a column, or one of its cells, is at an end of the grid.
  /// @param cell  any of it
  bool touches(const Cell& cell, const Row& row) const {
    const auto at_end = [&](std::size_t axis) { return cell[axis] == 0 || cell[axis] == grid.cells[axis] - 1; };
    return at_end(axes.outer) || at_end(axes.u) || (row.front() & 1) ||
           (row.back() >> static_cast<std::size_t>((grid.cells[axes.v] - 1) % 64) & 1);
  }
};

/// An outer cell's section, as a worker sees it.
struct Slice {
  std::int64_t k;  ///< the outer cell
  const SectionCells& cells;
  std::size_t n;  ///< plane of `cells`
  VoxelWorker& worker;
  Survey<double>& part;  ///< of the survey: what is found here goes there
};

class OfVoxels final : public VoxelSurveyor {
 public:
  OfVoxels(const Planned& planned, const VoxelOptions& voxels)
      : planned_(planned),
        voxels_(voxels),
        beyond_coupling_(std::ranges::any_of(planned.demand.fields, [](const PoseQuantity* quantity) {
          return quantity->needs_inertia() && quantity != &kCouplingIndex;
        })) {}

  VoxelMap map(std::span<const double> parameters) const override {
    VoxelScratch scratch;
    const Gridded s = gridded(parameters);
    VoxelMap m = s.grid.map();
    Survey<double> none;
    share_sections(s, scratch, none, [&](const Slice& slice) {
      visit_columns(s, slice, [&](Cell cell, const Row& row) {
        for_each_bit(row, [&](std::size_t v) {
          cell[s.axes.v] = static_cast<std::int64_t>(v);
          m.feasible[static_cast<std::size_t>((cell[0] * m.cells[1] + cell[1]) * m.cells[2] + cell[2])] = 1;
        });
      });
    });
    return m;
  }

 private:
  Gridded gridded(std::span<const double> parameters) const {
    const Design<double> d = design(geometry(planned_.platform, parameters), planned_.limits);
    Gridded s{.d = d,
              .grid = {voxels_.cells, voxels_.box ? *voxels_.box : default_box(d, planned_.held)},
              .axes = grid_axes(planned_.held),
              .over_phi = cuts(planned_.held).outer_is_phi,
              .swept = {},
              .held = planned_.held.coordinate,
              .held_at = held_value(d.g, planned_.held),
              .test = {}};
    for (std::size_t k = 0, axis = 0; k < 4; ++k)
      if (k != s.held) s.swept[axis++] = k;
    if (const Limits& l = planned_.limits; l.clearance_min)
      s.test = {link_radii(parameters), planned_.mode, *l.clearance_min, &l.obstacles};
    return s;
  }

  void survey(std::span<const double> parameters, Scratch& room, Survey<double>& survey) const override {
    survey.clear(planned_.demand.fields);
    VoxelScratch& scratch = room.get<VoxelScratch>();
    const Gridded s = gridded(parameters);
    survey.cells = s.grid.count();
    survey.cell_volume = s.grid.cell_volume();
    if (planned_.demand.needs_inertia())
      sample(s, planned_.masses(parameters), scratch, survey);
    else
      count(s, scratch, survey);
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
    if (planned_.with_conditioning && survey.weight.empty())  // one phi for all
      planned_.add_conditioning(s.d.g, s.held_at, survey.volume, survey);
  }

  /// Cells alone, section by section. Where sections are of one phi each, its conditioning is a sample.
  void count(const Gridded& s, VoxelScratch& scratch, Survey<double>& survey) const {
    share_sections(s, scratch, survey, [&, cell_volume = survey.cell_volume](const Slice& slice) {
      PlaneTally plane{};
      if (!s.test) {
        plane = slice.cells.count(slice.n);
        plane.touches = plane.touches || slice.k == 0 || slice.k == s.grid.cells[s.axes.outer] - 1;
      } else {
        visit_columns(s, slice, [&](const Cell& cell, const Row& row) {
          for (const std::uint64_t word : row) plane.cells += std::popcount(word);
          plane.touches = plane.touches || s.touches(cell, row);
        });
      }
      if (plane.cells == 0) return;
      slice.part.feasible_cells += plane.cells;
      slice.part.touches_box = slice.part.touches_box || plane.touches;
      if (planned_.with_conditioning && s.over_phi)
        planned_.add_conditioning(s.d.g, s.grid.centre(s.axes.outer, slice.k),
                                  static_cast<double>(plane.cells) * cell_volume, slice.part);
    });
  }

  /// Every cell, with its inertia.
  void sample(const Gridded& s, const Masses<double>& b, VoxelScratch& scratch, Survey<double>& survey) const {
    const auto fill = [&](InertiaTables& tables, double phi) {
      tables.fill(s.d.g, b, planned_.mode, phi, s.grid, s.swept, s.axes.v, s.held_at);
      return planned_.with_conditioning ? planned_.conditioning_at(s.d.g, phi) : 0.0;
    };
    InertiaTables& common = first_of(scratch).tables;
    const double index_of_all = s.over_phi ? 0.0 : fill(common, s.held_at);
    share_sections(s, scratch, survey, [&, cell_volume = survey.cell_volume](const Slice& slice) {
      InertiaTables& tables = s.over_phi ? slice.worker.tables : common;
      const double index = s.over_phi ? fill(tables, s.grid.centre(s.axes.outer, slice.k)) : index_of_all;
      Survey<double>& part = slice.part;
      auto& dci = slice.worker.dci;
      auto *const conditioning = part.find(kConditioning), *const indices = part.find(kCouplingIndex);
      visit_columns(s, slice, [&](Cell cell, const Row& row) {
        part.touches_box = part.touches_box || s.touches(cell, row);
        if (indices) {
          const auto has = [&row](std::size_t v) { return (row[v / 64] >> v % 64 & 1) != 0; };
          std::size_t first = 0, end = 64 * row.size();
          while (!has(first)) ++first;
          while (!has(end - 1)) --end;
          tables.coupling(cell, first, end, dci);
        }
        for_each_bit(row, [&](std::size_t v) {
          cell[s.axes.v] = static_cast<std::int64_t>(v);
          ++part.feasible_cells;
          part.weight.push_back(cell_volume);
          if (planned_.demand.poses) part.pose.push_back(s.pose_of(cell));
          if (conditioning) conditioning->push_back(index);
          for (std::size_t i = 0; indices && i < 4; ++i) indices[i].push_back(dci[i][v]);
          if (beyond_coupling_) add_inertia(tables.at(cell), part, &kCouplingIndex);
        });
      });
    });
  }

  /// The worker whose storage all may read, with one for each that may work.
  static VoxelWorker& first_of(VoxelScratch& scratch) {
    scratch.workers.resize(std::max(scratch.workers.size(), workers()));
    return scratch.workers.front();
  }

  /// Calls visit(slice) for every outer cell whose section may have cells, as share_samples() does.
  template <class Visit>
  void share_sections(const Gridded& s, VoxelScratch& scratch, Survey<double>& survey, const Visit& visit) const {
    SectionCells& common = first_of(scratch).cells;
    if (!s.over_phi && !common.fill(s.d, planned_.held, s.grid, s.held_at)) return;
    share_samples(static_cast<std::size_t>(s.grid.cells[s.axes.outer]), survey,
                  [&](std::size_t piece, Survey<double>& part, std::size_t number) {
                    const auto k = static_cast<std::int64_t>(piece);
                    VoxelWorker& worker = scratch.workers[number];
                    if (!s.over_phi)
                      visit(Slice{k, common, piece, worker, part});
                    else if (worker.cells.fill(s.d, planned_.held, s.grid, s.grid.centre(s.axes.outer, k)))
                      visit(Slice{k, worker.cells, 0, worker, part});
                  });
  }

  /// Calls visit(cell, row) for the columns of a slice that have cells which pass; cell is the column's first.
  template <class Visit>
  void visit_columns(const Gridded& s, const Slice& slice, const Visit& visit) const {
    slice.cells.visit_columns(slice.n, slice.worker.row, [&](std::int64_t u, Row& row) {
      Cell cell{};
      cell[s.axes.outer] = slice.k;
      cell[s.axes.u] = u;
      if (!s.test || s.clear(cell, row)) visit(cell, row);
    });
  }

  Planned planned_;
  VoxelOptions voxels_;
  bool beyond_coupling_;  ///< fields of inertia are demanded that are not computed side by side
};

}  // namespace

std::unique_ptr<const VoxelSurveyor> make_surveyor(const Planned& planned, const VoxelOptions& voxels) {
  return std::make_unique<OfVoxels>(planned, voxels);
}

}  // namespace pkm::crr_cru
