#include <utility>

#include "engine/mechanisms/crr_cru/clear_cells.hpp"
#include "engine/mechanisms/crr_cru/inertia_tables.hpp"
#include "engine/mechanisms/crr_cru/samples.hpp"
#include "engine/mechanisms/crr_cru/survey.hpp"
#include "engine/mechanisms/crr_cru/voxels.hpp"

namespace pkm::crr_cru {
namespace {

class VoxelSurveyor final : public Surveyor {
 public:
  VoxelSurveyor(Platform platform, MassModel mass_model, const WorkingMode& mode, int held, const SurveyPlan& plan,
                const VoxelOptions& voxels, const Demand& demand)
      : platform_(platform),
        mass_model_(mass_model),
        mode_(mode),
        held_(held_of(held, plan)),
        voxels_(voxels),
        limits_(limits(plan.limits)),
        demand_(demand) {}

  std::string why_no_slopes() const override { return voxels_have_no_derivatives(); }

  void survey(std::span<const double> parameters, Scratch&, Survey<double>& survey) const override {
    survey.clear();
    const Design<double> d = design(geometry(platform_, parameters), limits_);
    const VoxelGrid grid = grid_of(d);
    survey.cells = grid.count();
    survey.cell_volume = grid.cell_volume();
    if (demand_.dci || demand_.inertia_condition)
      sample(parameters, d, grid, survey);
    else
      count(parameters, d, grid, survey);
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
    if (demand_.conditioning && survey.weight.empty())  // one phi for all
      add_conditioning(d.g, demand_, held_value(d.g, held_), survey.volume, survey);
  }

  VoxelMap map(std::span<const double> parameters) const {
    const Design<double> d = design(geometry(platform_, parameters), limits_);
    const VoxelGrid grid = grid_of(d);
    const GridAxes axes = grid_axes(held_);
    VoxelMap m = grid.map();
    const auto test = clearance_test(parameters, d);
    Survey<double> none;
    share_sections(d, held_, grid, none, [&](std::int64_t k, const SectionCells& cells, std::size_t n, auto&) {
      visit_clear_columns(d, grid, test, k, cells, n, [&](std::array<std::int64_t, 3> cell, const auto& row) {
        for (std::int64_t v = 0; v < grid.cells[axes.v]; ++v) {
          if (!(row[static_cast<std::size_t>(v / 64)] >> static_cast<std::size_t>(v % 64) & 1)) continue;
          cell[axes.v] = v;
          m.feasible[static_cast<std::size_t>((cell[0] * grid.cells[1] + cell[1]) * grid.cells[2] + cell[2])] = 1;
        }
      });
    });
    return m;
  }

 private:
  VoxelGrid grid_of(const Design<double>& d) const {
    return {voxels_.cells, voxels_.box ? *voxels_.box : default_box(d, held_)};
  }
  /// Which coordinate each axis of the grid is: its axes are the swept coordinates in ascending order.
  std::array<int, 3> swept_coordinates() const {
    std::array<int, 3> swept{};
    for (int k = 0, axis = 0; k < 4; ++k)
      if (static_cast<std::size_t>(k) != held_.coordinate) swept[static_cast<std::size_t>(axis++)] = k;
    return swept;
  }
  Pose<double> pose_of(const std::array<std::int64_t, 3>& cell, const VoxelGrid& grid, double held_at) const {
    std::array<double, 4> x{};
    const std::array<int, 3> swept = swept_coordinates();
    x[held_.coordinate] = held_at;
    for (std::size_t k = 0; k < 3; ++k) x[static_cast<std::size_t>(swept[k])] = grid.centre(k, cell[k]);
    return {x[0], x[1], x[2], x[3]};
  }
  /// Cells alone, section by section. Where sections are of one phi each, its conditioning is a sample.
  void count(std::span<const double> parameters, const Design<double>& d, const VoxelGrid& grid,
             Survey<double>& survey) const {
    const GridAxes axes = grid_axes(held_);
    const bool over_phi = cuts(held_).outer_is_phi;
    const auto test = clearance_test(parameters, d);
    share_sections(d, held_, grid, survey,
                   [&, cell_volume = survey.cell_volume](std::int64_t k, const SectionCells& cells, std::size_t n,
                                                         Survey<double>& part) {
                     PlaneTally plane{};
                     if (!test)
                       plane = cells.count(n);
                     else
                       visit_clear_columns(d, grid, test, k, cells, n, [&](const auto& cell, const auto& row) {
                         for (const std::uint64_t word : row) plane.cells += std::popcount(word);
                         plane.touches = plane.touches || touches(cell, row, grid);
                       });
                     if (plane.cells == 0) return;
                     part.feasible_cells += plane.cells;
                     part.touches_box = part.touches_box || plane.touches || k == 0 || k == grid.cells[axes.outer] - 1;
                     if (demand_.conditioning && over_phi)
                       add_conditioning(d.g, demand_, grid.centre(axes.outer, k),
                                        static_cast<double>(plane.cells) * cell_volume, part);
                   });
  }

  /// Every cell, with its inertia.
  void sample(std::span<const double> parameters, const Design<double>& d, const VoxelGrid& grid,
              Survey<double>& survey) const {
    const GridAxes axes = grid_axes(held_);
    const bool over_phi = cuts(held_).outer_is_phi;
    const Masses<double> b = masses(mass_model_, parameters);
    const std::array<int, 3> coordinates = swept_coordinates();
    const double held_at = held_value(d.g, held_);
    const auto test = clearance_test(parameters, d);
    const auto fill = [&](InertiaTables& tables, double phi) {
      tables.fill(d.g, b, mode_, phi, grid, coordinates, axes.v, held_at);
      return demand_.conditioning ? conditioning_at(d.g, demand_, phi) : 0.0;
    };
    const auto own = []() -> InertiaTables& {  // each thread's
      thread_local InertiaTables tables;
      return tables;
    };
    const InertiaTables& common = own();
    const double index_of_all = over_phi ? 0.0 : fill(own(), held_at);
    share_sections(d, held_, grid, survey,
                   [&, cell_volume = survey.cell_volume](std::int64_t k, const SectionCells& cells, std::size_t n,
                                                         Survey<double>& part) {
                     const double index = over_phi ? fill(own(), grid.centre(axes.outer, k)) : index_of_all;
                     const InertiaTables& tables = over_phi ? own() : common;
                     visit_clear_columns(d, grid, test, k, cells, n, [&](const auto& cell, const auto& row) {
                       add_column(tables, cell, row, index, cell_volume, grid, held_at, part);
                       part.touches_box =
                           part.touches_box || k == 0 || k == grid.cells[axes.outer] - 1 || touches(cell, row, grid);
                     });
                   });
  }

  /// Adds the samples of a column, whose cells are the bits of a row.
  /// @param index  conditioning
  void add_column(const InertiaTables& tables, std::array<std::int64_t, 3> cell, const std::vector<std::uint64_t>& row,
                  double index, double cell_volume, const VoxelGrid& grid, double held_at, Survey<double>& part) const {
    const std::size_t along = grid_axes(held_).v;
    thread_local std::array<std::vector<double>, 4> dci;
    if (demand_.dci) {
      std::size_t first = 64 * row.size(), end = 0;
      for (std::size_t w = row.size(); w-- > 0;)
        if (row[w] != 0) {
          first = 64 * w + static_cast<std::size_t>(std::countr_zero(row[w]));
          end = std::max(end, 64 * (w + 1) - static_cast<std::size_t>(std::countl_zero(row[w])));
        }
      tables.coupling(cell, first, end, dci);
    }
    for (std::size_t w = 0; w < row.size(); ++w)
      for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1) {
        const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(bits));
        cell[along] = static_cast<std::int64_t>(v);
        ++part.feasible_cells;
        part.weight.push_back(cell_volume);
        if (demand_.poses) part.pose.push_back(pose_of(cell, grid, held_at));
        if (demand_.conditioning) part.conditioning.push_back(index);
        for (std::size_t i = 0; demand_.dci && i < 4; ++i) part.dci[i].push_back(dci[i][v]);
        if (demand_.inertia_condition) part.inertia_condition.push_back(inertia_condition(tables.at(cell)));
      }
  }

  /// Whether a column is at an end of u or has a cell at an end of v.
  /// @param cell  any of it
  bool touches(const std::array<std::int64_t, 3>& cell, const std::vector<std::uint64_t>& row,
               const VoxelGrid& grid) const {
    const GridAxes axes = grid_axes(held_);
    const std::int64_t u = cell[axes.u], last = grid.cells[axes.v] - 1;
    return u == 0 || u == grid.cells[axes.u] - 1 || (row.front() & 1) ||
           (row.back() >> static_cast<std::size_t>(last % 64) & 1);
  }

  std::optional<ClearanceTest> clearance_test(std::span<const double> parameters, const Design<double>& d) const {
    if (!limits_.clearance_min) return {};
    return ClearanceTest{d.g, link_radii(parameters), mode_, *limits_.clearance_min};
  }

  /// Calls visit(cell, row) for the columns of section k that have cells which pass; cell is the column's first.
  template <class Visit>
  void visit_clear_columns(const Design<double>& d, const VoxelGrid& grid, const std::optional<ClearanceTest>& test,
                           std::int64_t k, const SectionCells& cells, std::size_t n, const Visit& visit) const {
    const GridAxes axes = grid_axes(held_);
    const double held_at = held_value(d.g, held_);
    thread_local std::vector<std::uint64_t> storage;
    cells.visit_columns(n, storage, [&](std::int64_t u, std::vector<std::uint64_t>& row) {
      std::array<std::int64_t, 3> cell{};
      cell[axes.outer] = k;
      cell[axes.u] = u;
      const auto pose = [&](const auto& at) { return pose_of(at, grid, held_at); };
      if (!test || clear_cells(*test, cell, axes.v, pose, row)) visit(cell, row);
    });
  }

  Platform platform_;
  MassModel mass_model_;
  WorkingMode mode_;
  Held held_;
  VoxelOptions voxels_;
  Limits limits_;
  Demand demand_;
};

}  // namespace

std::unique_ptr<const Surveyor> make_voxel_surveyor(Platform platform, MassModel mass_model, const WorkingMode& mode,
                                                    int held, const SurveyPlan& plan, const VoxelOptions& voxels,
                                                    const Demand& demand) {
  return std::make_unique<VoxelSurveyor>(platform, mass_model, mode, held, plan, voxels, demand);
}

VoxelMap voxel_map(Platform platform, const WorkingMode& mode, int held, std::span<const double> parameters,
                   const SurveyPlan& plan, const VoxelOptions& voxels) {
  return VoxelSurveyor(platform, MassModel::table, mode, held, plan, voxels, {}).map(parameters);
}

}  // namespace pkm::crr_cru
