#include "engine/generic/voxels.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/stop.hpp"
#include "engine/generic/cells.hpp"
#include "engine/generic/clearance.hpp"
#include "engine/generic/dynamics.hpp"
#include "engine/generic/inertia_rows.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/lengths.hpp"
#include "engine/workspace/cell_runs.hpp"
#include "engine/workspace/grid_surveyor.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::generic {
namespace {

class GenericVoxels final : public GridEvaluator<GenericVoxels> {
 public:
  GenericVoxels(const Mechanism& mechanism, const Evaluation& evaluation, const WorkspacePlan& plan,
                const VoxelOptions& voxels, const Demand& demand, BoxOfDesign default_box)
      : GridEvaluator(demand),
        mechanism_(mechanism),
        e_(evaluation),
        plan_(plan),
        voxels_(voxels),
        demand_(demand),
        sweep_(sweep_of(mechanism.info(), plan)),
        mode_(number_of_mode(mechanism.info(), demand.mode)),
        default_box_(std::move(default_box)),
        test_(CellPlan::fastest(evaluation, sweep_.swept, voxels.cells, mode_)) {
    if (demand.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length only; leave out characteristic_length");
    if (demand.needs_inertia()) inertia_.emplace(evaluation, sweep_.swept, mode_, demand.rotors);
    if (const auto least = clearance_of(evaluation.model, plan.limits))
      clearance_.emplace(evaluation, sweep_.swept, mode_, *least, plan.limits.obstacles);
  }

 private:
  friend GridEvaluator;
  struct Room {
    std::optional<std::size_t> number;  ///< of the grid that it is ready for
    std::vector<double> inputs;
    CellRoom cells;
    InertiaRoom inertia;
    ClearanceRows::Room clearance;
    std::array<std::size_t, expression::kRow> waiting;  ///< bits of the cells whose clearance is looked at next
  };
  struct Common {
    std::vector<double> inputs;
    std::vector<FixedCells> held;
  };
  using Rooms = GridRooms<Common, Room>;

  /// A design on its grids, whose pieces are slices of the outer loop.
  struct GriddedSlices : Gridded {
    std::span<const double> parameters;
    const Common& common;
  };

  GriddedSlices start(std::span<const double> parameters, Rooms& rooms) const {
    if (inertia_) check_masses(e_, parameters);
    if (demand_.has(kConditioning)) check_lengths(e_, parameters);
    const bool is_default = !voxels_.box && default_box_;
    const VoxelGrid grid(voxels_.cells,
                         is_default ? default_box_(parameters) : e_.search_box(parameters, plan_, mode_, sweep_.swept));
    Common& common = rooms.common;
    find_fixed_cells(
        sweep_.held, plan_,
        [&](int coordinate) {
          return e_.needed_range(parameters, plan_.limits, mode_, static_cast<std::size_t>(coordinate));
        },
        common.held);
    fill_inputs(parameters, common.inputs);
    for (Room& room : rooms.of) room.number.reset();
    return {{grid, test_.shape(grid)[0], common.held}, parameters, common};
  }
  void find(const GriddedSlices& slices, std::size_t number, std::size_t slice, Room& room, Survey<double>& to) const {
    prepare(slices.common, number, room);
    const CellTally tally = find_cells(slices.grid, slice, demand_.needs_samples(), room);
    to.feasible_cells += tally.cells;
    to.touches_box = to.touches_box || tally.touches_box;
    if (demand_.needs_samples()) add_slice(slices.parameters, slices.grid, slice, slices.cell_volume, room, to);
  }
  template <class Visit>
  void visit_cells(const GriddedSlices& slices, Rooms& rooms, const Visit& visit) const {
    Room& room = rooms.of[0];
    prepare(slices.common, 0, room);
    const auto [count, columns, cells] = test_.shape(slices.grid);
    for (std::size_t slice = 0; slice < count; ++slice) {
      find_cells(slices.grid, slice, true, room);
      for_each_cell(room.cells, columns, cells, [&](std::size_t j, std::size_t k) { visit(test_.cell(slice, j, k)); });
    }
  }

  /// For the grid with a number.
  void prepare(const Common& common, std::size_t number, Room& room) const {
    if (room.number == number) return;
    room.number = number;
    room.inputs = common.inputs;
    set_fixed(common.held, number,
              [&](std::size_t coordinate) -> double& { return room.inputs[e_.model.inputs.coordinate(coordinate)]; });
    test_.start(room.inputs, room.cells);
    if (inertia_) inertia_->start(room.inputs, room.inertia);
    if (clearance_) clearance_->start(room.inputs, room.clearance);
  }
  /// With the held coordinates where they are held.
  void fill_inputs(std::span<const double> parameters, std::vector<double>& inputs) const {
    inputs.resize(e_.model.inputs.count());
    e_.fill_inputs<double>(parameters, plan_.limits, mode_, inputs);
    for (const int coordinate : sweep_.held)
      if (how_fixed(plan_, coordinate).kind != FixedCoordinate::Kind::integrated)
        inputs[e_.model.inputs.coordinate(static_cast<std::size_t>(coordinate))] =
            fixed_value(mechanism_, parameters, plan_, coordinate);
  }

  /// Calls visit(column, cell) for the feasible cells of a slice, in order.
  template <class Visit>
  static void for_each_cell(const CellRoom& room, std::size_t columns, std::size_t cells, const Visit& visit) {
    const std::size_t words = CellTest::words(cells);
    for (std::size_t j = 0; j < columns; ++j)
      for_each_bit(std::span(room.bits).subspan(j * words, words), [&](std::size_t k) { visit(j, k); });
  }

  Pose<double> pose_of(const VoxelGrid& grid, const std::array<std::int64_t, 3>& cell, const Room& room) const {
    Pose<double> pose(e_.model.inputs.coordinates);
    std::copy_n(&room.inputs[e_.model.inputs.coordinate(0)], pose.size(), pose.begin());
    for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
      pose[static_cast<std::size_t>(sweep_.swept[axis])] = grid.centre(axis, cell[axis]);
    return pose;
  }

  /// The feasible cells of a slice. @param want_bits  whether room.cells.bits are asked for
  CellTally find_cells(const VoxelGrid& grid, std::size_t slice, bool want_bits, Room& room) const {
    if (!clearance_) return test_.test(grid, slice, want_bits, room.cells);
    test_.test(grid, slice, true, room.cells);
    const std::array<std::size_t, 3> shape = test_.shape(grid);
    const std::size_t columns = shape[1], cells = shape[2], length = CellTest::words(cells) * 64;
    std::vector<std::uint64_t>& bits = room.cells.bits;
    const auto look = [&] {
      check_stop();
      clearance_->finish(room.clearance, [&](std::size_t k) {
        bits[room.waiting[k] / 64] &= ~(std::uint64_t{1} << room.waiting[k] % 64);
      });
    };
    for_each_cell(room.cells, columns, cells, [&](std::size_t j, std::size_t k) {
      room.waiting[room.clearance.poses.count] = j * length + k;
      if (clearance_->add(pose_of(grid, test_.cell(slice, j, k), room), room.clearance)) look();
    });
    look();
    CellTally tally;
    for_each_cell(room.cells, columns, cells, [&](std::size_t j, std::size_t k) {
      ++tally.cells;
      tally.touches_box = tally.touches_box || k == 0 || k + 1 == cells || test_.at_side(grid, slice, j);
    });
    return tally;
  }

  /// Adds the samples of a slice.
  void add_slice(std::span<const double> parameters, const VoxelGrid& grid, std::size_t slice, double measure,
                 Room& room, Survey<double>& to) const {
    const auto [slices, columns, cells] = test_.shape(grid);
    for_each_cell(room.cells, columns, cells, [&](std::size_t j, std::size_t k) {
      add_sample(parameters, pose_of(grid, test_.cell(slice, j, k), room), measure, room, to);
    });
    if (inertia_) inertia_->finish(room.inertia, to);
  }
  /// @param room  of the slice; the pose's coordinates among its inputs are overwritten
  void add_sample(std::span<const double> parameters, const Pose<double>& pose, double weight, Room& room,
                  Survey<double>& to) const {
    check_stop();
    to.weight.push_back(weight);
    if (demand_.poses) to.pose.push_back(pose);
    if (inertia_) inertia_->add(pose, room.inertia, to);
    if (!demand_.needs_jacobian()) return;
    std::vector<double>& inputs = room.inputs;
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e_.model.inputs.coordinate(0)));
    const PoseReport report =
        std::ranges::all_of(demand_.fields,
                            [](const PoseQuantity* q) { return q == &kConditioning || q->needs_inertia(); })
            ? report_of_sample(e_, parameters, pose, inputs)
            : inspect_pose(e_, parameters, pose, mode_, plan_.limits);
    add_reported(report, e_.model.inputs.joints, to);
  }

  const Mechanism& mechanism_;
  const Evaluation& e_;
  WorkspacePlan plan_;
  VoxelOptions voxels_;
  Demand demand_;
  const Sweep& sweep_;
  std::size_t mode_;
  BoxOfDesign default_box_;
  CellTest test_;
  std::optional<InertiaRows> inertia_;      ///< where fields of inertia are demanded
  std::optional<ClearanceRows> clearance_;  ///< where a clearance is asked for
};

}  // namespace

std::unique_ptr<const VoxelEvaluator> prepare_voxels(const Mechanism& mechanism, const Evaluation& evaluation,
                                                     const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                     const Demand& demand, BoxOfDesign default_box) {
  return std::make_unique<GenericVoxels>(mechanism, evaluation, plan, voxels, demand, std::move(default_box));
}

}  // namespace pkm::generic
