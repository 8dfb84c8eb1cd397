#include "engine/generic/voxels.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/stop.hpp"
#include "engine/generic/cells.hpp"
#include "engine/generic/clearance.hpp"
#include "engine/generic/conditioning.hpp"
#include "engine/generic/dynamics.hpp"
#include "engine/generic/inertia_batch.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/generic/sample_formulas.hpp"
#include "engine/math/satisfied.hpp"
#include "engine/workspace/cell_runs.hpp"
#include "engine/workspace/grid_evaluator.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::generic {
namespace {

class GenericVoxels final : public GridEvaluator<GenericVoxels> {
 public:
  GenericVoxels(const Evaluation& evaluation, const WorkspacePlan& plan, const VoxelOptions& voxels,
                const FieldRequest& request, BoxOfDesign default_box)
      : GridEvaluator(request),
        e_(evaluation),
        plan_(plan),
        voxels_(voxels),
        request_(request),
        sweep_(sweep_of(evaluation.model.info, plan)),
        mode_(mode_index(evaluation.model.info, request.mode)),
        default_box_(std::move(default_box)),
        test_(CellPlan::fastest(evaluation, sweep_.swept, voxels.cells, mode_)) {
    if (request.characteristic_length)
      throw std::invalid_argument("mechanism " + evaluation.model.info.name +
                                  " has its own characteristic length; remove characteristic_length");
    if (request.needs_inertia()) inertia_.emplace(evaluation, sweep_.swept, mode_, request.rotors);
    if (request.has_formulas()) formulas_.emplace(evaluation, request.fields, sweep_.swept, mode_);
    if (const auto limit = clearance_of(evaluation.model, plan.limits))
      clearance_.emplace(evaluation, sweep_.swept, mode_, *limit, plan.limits.obstacles);
    for (const ReportLimit& each : evaluation.model.report_limits)
      if (plan.limits.given[each.limit]) limited_.push_back(each.quantity);
  }

 private:
  friend GridEvaluator;
  struct WorkerScratch {
    /// Index of the grid for which this scratch memory is prepared; std::nullopt if it is not prepared.
    std::optional<std::size_t> number;
    std::vector<double> inputs;
    CellScratch cells;
    InertiaScratch inertia;
    FormulaScratch formulas;
    ClearanceScratch clearance;
    /// For each pose in the batch of clearance tests, the index of its cell's bit.
    std::array<std::size_t, expression::kRow> waiting;
  };
  struct Common {
    std::vector<double> inputs;
    std::vector<FixedCells> fixed;
  };
  using Buffers = GridBuffers<Common, WorkerScratch>;

  /// A design and its grids; each block of a grid is a slice, i.e. one value of the outer loop.
  struct GriddedSlices : GriddedDesign {
    std::span<const double> parameters;
    const Common& common;
  };

  GriddedSlices start(std::span<const double> parameters, Buffers& buffers) const {
    if (inertia_) check_masses(e_, parameters);
    if (request_.has(kConditioning)) check_lengths(e_, parameters);
    const bool is_default = !voxels_.box && default_box_;
    const VoxelGrid grid(voxels_.cells,
                         is_default ? default_box_(parameters) : e_.search_box(parameters, plan_, mode_, sweep_.swept));
    Common& common = buffers.shared;
    find_fixed_cells(
        sweep_.fixed, plan_,
        [&](int coordinate) {
          return e_.required_range(parameters, plan_, mode_, static_cast<std::size_t>(coordinate));
        },
        common.fixed);
    e_.fill_inputs<double>(parameters, plan_, mode_, common.inputs);
    for (WorkerScratch& scratch : buffers.per_worker) scratch.number.reset();
    return {{grid, test_.shape(grid)[0], common.fixed}, parameters, common};
  }
  void find(const GriddedSlices& slices, std::size_t number, std::size_t slice, WorkerScratch& scratch,
            WorkspaceResult<double>& to) const {
    prepare(slices.common, number, scratch);
    const CellTally tally = find_cells(slices, slice, request_.needs_samples(), scratch);
    to.feasible_cells += tally.cells;
    to.touches_box = to.touches_box || tally.touches_box;
    if (request_.needs_samples()) add_slice(slices.parameters, slices.grid, slice, slices.cell_volume, scratch, to);
  }
  template <class Visit>
  void visit_cells(const GriddedSlices& slices, Buffers& buffers, const Visit& visit) const {
    WorkerScratch& scratch = buffers.per_worker[0];
    prepare(slices.common, 0, scratch);
    const auto [count, columns, cells] = test_.shape(slices.grid);
    for (std::size_t slice = 0; slice < count; ++slice) {
      find_cells(slices, slice, true, scratch);
      for_each_cell(scratch.cells, columns, cells,
                    [&](std::size_t j, std::size_t k) { visit(test_.cell(slice, j, k)); });
    }
  }

  /// Prepares the scratch memory for the grid with the index `number`.
  void prepare(const Common& common, std::size_t number, WorkerScratch& scratch) const {
    if (scratch.number == number) return;
    scratch.number = number;
    scratch.inputs = common.inputs;
    set_fixed_cells(common.fixed, number, [&](std::size_t coordinate) -> double& {
      return scratch.inputs[e_.model.inputs.coordinate(coordinate)];
    });
    test_.start(scratch.inputs, scratch.cells);
    if (inertia_) inertia_->start(scratch.inputs, scratch.inertia);
    if (formulas_) formulas_->start(scratch.inputs, scratch.formulas);
    if (clearance_) clearance_->start(scratch.inputs, scratch.clearance);
  }

  /// Calls visit(column, cell) for each feasible cell of a slice, in ascending order.
  template <class Visit>
  static void for_each_cell(const CellScratch& scratch, std::size_t columns, std::size_t cells, const Visit& visit) {
    const std::size_t words = CellTest::words(cells);
    for (std::size_t j = 0; j < columns; ++j)
      for_each_bit(std::span(scratch.bits).subspan(j * words, words), [&](std::size_t k) { visit(j, k); });
  }

  Pose<double> pose_of(const VoxelGrid& grid, const std::array<std::int64_t, 3>& cell,
                       const WorkerScratch& scratch) const {
    Pose<double> pose(e_.model.inputs.coordinates);
    std::copy_n(&scratch.inputs[e_.model.inputs.coordinate(0)], pose.size(), pose.begin());
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      pose[static_cast<std::size_t>(sweep_.swept[axis])] = grid.centre(axis, cell[axis]);
    return pose;
  }

  /// Finds the cells of a slice that satisfy all limits.
  /// @param want_bits  true: also fill the bit set scratch.cells.bits
  CellTally find_cells(const GriddedSlices& slices, std::size_t slice, bool want_bits, WorkerScratch& scratch) const {
    const VoxelGrid& grid = slices.grid;
    if (!clearance_ && limited_.empty()) return test_.test(grid, slice, want_bits, scratch.cells);
    test_.test(grid, slice, true, scratch.cells);
    if (clearance_) clear_near_links(grid, slice, scratch);
    if (!limited_.empty()) clear_beyond_limits(slices, slice, scratch);
    const std::array<std::size_t, 3> shape = test_.shape(grid);
    CellTally tally;
    for_each_cell(scratch.cells, shape[1], shape[2], [&](std::size_t j, std::size_t k) {
      ++tally.cells;
      tally.touches_box = tally.touches_box || k == 0 || k + 1 == shape[2] || test_.at_side(grid, slice, j);
    });
    return tally;
  }
  /// Clears the bits of the cells in which the clearance limit is violated.
  void clear_near_links(const VoxelGrid& grid, std::size_t slice, WorkerScratch& scratch) const {
    const std::array<std::size_t, 3> shape = test_.shape(grid);
    const std::size_t columns = shape[1], cells = shape[2], length = CellTest::words(cells) * 64;
    std::vector<std::uint64_t>& bits = scratch.cells.bits;
    const auto test_batch = [&] {
      check_stop();
      clearance_->finish(scratch.clearance, [&](std::size_t k) {
        bits[scratch.waiting[k] / 64] &= ~(std::uint64_t{1} << scratch.waiting[k] % 64);
      });
    };
    for_each_cell(scratch.cells, columns, cells, [&](std::size_t j, std::size_t k) {
      scratch.waiting[scratch.clearance.poses.count] = j * length + k;
      if (clearance_->add(pose_of(grid, test_.cell(slice, j, k), scratch), scratch.clearance)) test_batch();
    });
    test_batch();
  }
  /// Clears the bits of the cells that violate a limit of a pose quantity without a formula.
  void clear_beyond_limits(const GriddedSlices& slices, std::size_t slice, WorkerScratch& scratch) const {
    const std::array<std::size_t, 3> shape = test_.shape(slices.grid);
    const std::size_t length = CellTest::words(shape[2]) * 64;
    for_each_cell(scratch.cells, shape[1], shape[2], [&](std::size_t j, std::size_t k) {
      check_stop();
      const PoseReport report =
          report_at(slices.parameters, pose_of(slices.grid, test_.cell(slice, j, k), scratch), scratch, limited_);
      bool satisfied = true;
      visit_report_margins(e_.model, plan_.limits, report,
                           [&](const std::string&, double margin) { satisfied = satisfied && is_satisfied(margin); });
      const std::size_t bit = j * length + k;
      if (!satisfied) scratch.cells.bits[bit / 64] &= ~(std::uint64_t{1} << bit % 64);
    });
  }
  /// Computes those parts of the report of a feasible pose that the quantities need. The coordinates of the pose are
  /// written to scratch.inputs.
  PoseReport report_at(std::span<const double> parameters, const Pose<double>& pose, WorkerScratch& scratch,
                       const std::vector<const PoseQuantity*>& quantities) const {
    std::ranges::copy(pose, scratch.inputs.begin() + static_cast<std::ptrdiff_t>(e_.model.inputs.coordinate(0)));
    const bool needs_jacobian_only = std::ranges::all_of(
        quantities, [](const PoseQuantity* q) { return q == &kConditioning || !q->needs_report(); });
    return needs_jacobian_only ? inspect_sample(e_, parameters, pose, scratch.inputs)
                               : inspect_pose(e_, parameters, pose, mode_, plan_.limits);
  }

  /// Appends the samples of a slice to the result.
  void add_slice(std::span<const double> parameters, const VoxelGrid& grid, std::size_t slice, double measure,
                 WorkerScratch& scratch, WorkspaceResult<double>& to) const {
    const auto [slices, columns, cells] = test_.shape(grid);
    for_each_cell(scratch.cells, columns, cells, [&](std::size_t j, std::size_t k) {
      add_sample(parameters, pose_of(grid, test_.cell(slice, j, k), scratch), measure, scratch, to);
    });
    if (inertia_) inertia_->finish(scratch.inertia, to);
    if (formulas_) formulas_->finish(scratch.formulas, to);
  }
  /// Appends the sample of a feasible pose to the result, and writes the coordinates of the pose to scratch.inputs.
  void add_sample(std::span<const double> parameters, const Pose<double>& pose, double weight, WorkerScratch& scratch,
                  WorkspaceResult<double>& to) const {
    check_stop();
    to.weight.push_back(weight);
    if (request_.poses) to.pose.push_back(pose);
    if (inertia_) inertia_->add(pose, scratch.inertia, to);
    if (formulas_) formulas_->add(pose, scratch.formulas, to);
    if (!request_.needs_jacobian()) return;
    const PoseReport report = report_at(parameters, pose, scratch, request_.fields);
    add_report(report, e_.model.inputs.joints, to);
  }

  const Evaluation& e_;
  WorkspacePlan plan_;
  VoxelOptions voxels_;
  FieldRequest request_;
  const Sweep& sweep_;
  std::size_t mode_;
  BoxOfDesign default_box_;
  CellTest test_;
  std::optional<InertiaBatch> inertia_;       ///< absent if no fields of inertia are requested
  std::optional<SampleFormulas> formulas_;    ///< absent if no fields given by formulas are requested
  std::optional<ClearanceBatch> clearance_;   ///< absent if there is no clearance limit
  std::vector<const PoseQuantity*> limited_;  ///< quantities without a formula that a limit in force restricts
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> prepare_voxels(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                     const VoxelOptions& voxels, const FieldRequest& request,
                                                     BoxOfDesign default_box) {
  return std::make_unique<GenericVoxels>(evaluation, plan, voxels, request, std::move(default_box));
}

}  // namespace pkm::generic
