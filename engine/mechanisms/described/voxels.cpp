#include "engine/mechanisms/described/voxels.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "engine/mechanisms/described/cells.hpp"
#include "engine/mechanisms/described/clearance.hpp"
#include "engine/mechanisms/described/dynamics.hpp"
#include "engine/mechanisms/described/inertia_rows.hpp"
#include "engine/mechanisms/described/kinematics.hpp"
#include "engine/survey/cell_samples.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "engine/survey/share_samples.hpp"

namespace pkm::described {
namespace {

using Kind = HeldCoordinate::Kind;

class DescribedVoxels final : public VoxelSurveyor {
 public:
  DescribedVoxels(const Mechanism& mechanism, const Evaluation& evaluation, const SurveyPlan& plan,
                  const VoxelOptions& voxels, const Demand& demand)
      : mechanism_(mechanism),
        e_(evaluation),
        plan_(plan),
        voxels_(voxels),
        demand_(demand),
        sweep_(sweep_of(mechanism.info(), plan)),
        mode_(number_of_mode(mechanism.info(), demand.mode)),
        test_(CellPlan::fastest(evaluation, sweep_.swept, voxels.cells, mode_)) {
    if (demand.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length only; leave out characteristic_length");
    if (demand.needs_inertia()) inertia_.emplace(evaluation, sweep_.swept, mode_, demand.rotors);
    if (const auto least = clearance_of(evaluation.model, plan.limits))
      clearance_.emplace(evaluation, sweep_.swept, mode_, *least, plan.limits.obstacles);
  }

  void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const override {
    if (inertia_) check_masses(e_, parameters);
    const VoxelGrid grid = grid_of(parameters);
    Rooms& all = scratch.get<Rooms>();
    integrated(parameters, all.held);
    const std::vector<HeldCells>& held = all.held;
    std::int64_t repeats = 1;
    double measure = grid.cell_volume();
    for (const HeldCells& each : held) {
      repeats *= each.cells;
      measure *= each.step;
    }
    survey.clear(demand_.fields);
    survey.cells = grid.count() * repeats;
    survey.cell_volume = measure;
    const std::size_t slices = test_.shape(grid)[0];
    std::vector<Room>& rooms = all.of;
    if (rooms.size() < workers()) rooms.resize(workers());
    for (Room& room : rooms) room.repeat.reset();
    fill_inputs(parameters, all.inputs);
    const std::vector<double>& inputs = all.inputs;
    share_samples(slices * static_cast<std::size_t>(repeats), survey,
                  [&](std::size_t piece, Survey<double>& part, std::size_t worker) {
                    Room& room = rooms[worker];
                    if (room.repeat != piece / slices) start(inputs, held, piece / slices, room);
                    const CellTally tally = find_cells(grid, piece % slices, demand_.needs_samples(), room);
                    part.feasible_cells += tally.cells;
                    part.touches_box = part.touches_box || tally.touches_box;
                    if (demand_.needs_samples()) add_slice(parameters, grid, piece % slices, measure, room, part);
                  });
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
  }

  VoxelMap map(std::span<const double> parameters) const override {
    const VoxelGrid grid = grid_of(parameters);
    VoxelMap map = grid.map();
    Room room;
    std::vector<double> inputs;
    fill_inputs(parameters, inputs);
    start(inputs, {}, 0, room);
    const auto [slices, columns, cells] = test_.shape(grid);
    for (std::size_t slice = 0; slice < slices; ++slice) {
      find_cells(grid, slice, true, room);
      for_each_cell(room.cells, columns, cells, [&](std::size_t j, std::size_t k) {
        const auto cell = test_.cell(slice, j, k);
        map.feasible[static_cast<std::size_t>((cell[0] * map.cells[1] + cell[1]) * map.cells[2] + cell[2])] = 1;
      });
    }
    return map;
  }

 private:
  struct Room {
    std::optional<std::size_t> repeat;  ///< that it is ready for
    std::vector<double> inputs;
    CellRoom cells;
    InertiaRoom inertia;
    ClearanceRows::Room clearance;
    std::array<std::size_t, graph::kRow> waiting;  ///< bits of the cells whose clearance is looked at next
  };
  struct Rooms {
    std::vector<Room> of;  ///< by worker
    std::vector<double> inputs;
    std::vector<HeldCells> held;
  };

  /// With integrated coordinates in the middle of their cells.
  void start(const std::vector<double>& inputs, const std::vector<HeldCells>& held, std::size_t repeat,
             Room& room) const {
    room.repeat = repeat;
    room.inputs = inputs;
    for (const HeldCells& each : held) {
      const auto cells = static_cast<std::size_t>(each.cells);
      room.inputs[e_.model.inputs.coordinate(each.coordinate)] = each.centre(static_cast<std::int64_t>(repeat % cells));
      repeat /= cells;
    }
    test_.start(room.inputs, room.cells);
    if (inertia_) inertia_->start(room.inputs, room.inertia);
    if (clearance_) clearance_->start(room.inputs, room.clearance);
  }

  VoxelGrid grid_of(std::span<const double> parameters) const {
    return {voxels_.cells, e_.survey_box(parameters, voxels_.box, sweep_.swept)};
  }
  void integrated(std::span<const double> parameters, std::vector<HeldCells>& all) const {
    all.clear();
    for (const int coordinate : sweep_.held) {
      const HeldCoordinate held = how_held(plan_, coordinate);
      if (held.kind != Kind::integrated) continue;
      const auto [lower, upper] = e_.needed_range(parameters, static_cast<std::size_t>(coordinate));
      all.push_back(
          {static_cast<std::size_t>(coordinate), lower, (upper - lower) / static_cast<double>(held.cells), held.cells});
    }
  }
  /// With the held coordinates where they are held; those that are integrated over in the middle of their first cell.
  void fill_inputs(std::span<const double> parameters, std::vector<double>& inputs) const {
    inputs.resize(e_.model.inputs.count());
    e_.fill_inputs<double>(parameters, plan_.limits, mode_, inputs);
    for (const int coordinate : sweep_.held) {
      const auto at = static_cast<std::size_t>(coordinate);
      const HeldCoordinate held = how_held(plan_, coordinate);
      const bool sums = held.kind == Kind::integrated;
      const auto range = sums ? e_.needed_range(parameters, at) : std::array{0.0, 0.0};
      inputs[e_.model.inputs.coordinate(at)] =
          sums ? range[0] + 0.5 * (range[1] - range[0]) / static_cast<double>(held.cells)
               : held_value(mechanism_, parameters, plan_, coordinate);
    }
  }

  /// Calls visit(column, cell) for the feasible cells of a slice, in order.
  template <class Visit>
  static void for_each_cell(const CellRoom& room, std::size_t columns, std::size_t cells, const Visit& visit) {
    const std::size_t words = CellTest::words(cells);
    for (std::size_t j = 0; j < columns; ++j)
      for (std::size_t word = 0; word < words; ++word)
        for (std::uint64_t bits = room.bits[j * words + word]; bits != 0; bits &= bits - 1)
          visit(j, word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
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
  SurveyPlan plan_;
  VoxelOptions voxels_;
  Demand demand_;
  const Sweep& sweep_;
  std::size_t mode_;
  CellTest test_;
  std::optional<InertiaRows> inertia_;      ///< where fields of inertia are demanded
  std::optional<ClearanceRows> clearance_;  ///< where a clearance is asked for
};

}  // namespace

std::unique_ptr<const VoxelSurveyor> prepare_voxels(const Mechanism& mechanism, const Evaluation& evaluation,
                                                    const SurveyPlan& plan, const VoxelOptions& voxels,
                                                    const Demand& demand) {
  return std::make_unique<DescribedVoxels>(mechanism, evaluation, plan, voxels, demand);
}

}  // namespace pkm::described
