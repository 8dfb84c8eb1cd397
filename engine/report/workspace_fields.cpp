#include "engine/report/workspace_fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/survey/picture_plan.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

WorkspaceAxis axis_of(const MechanismInfo& info, int coordinate, double lower, double upper, std::int64_t cells) {
  const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
  return {coordinate, axis.name, axis.unit, lower, upper, cells};
}

std::string note_of(const HeldCoordinate& held) {
  using Kind = HeldCoordinate::Kind;
  if (held.kind == Kind::value) return "as given";
  if (held.kind == Kind::middle) return "the middle of the design";
  return held.kind == Kind::listed ? "the first of those listed" : "the middle of what the plan integrates over";
}

/// Fills fields in, one row of poses after the other; the first field says which are feasible.
class Rows {
 public:
  using Poses = std::function<Pose<double>(std::size_t)>;

  /// @param size  of a row
  Rows(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
       std::vector<WorkspaceField>& fields, const Poses& poses, std::size_t size)
      : mechanism_(mechanism),
        info_(mechanism.info()),
        parameters_(parameters),
        limits_(limits),
        margin_(mechanism, parameters, limits),
        mode_(mode.empty() ? info_.modes.front() : mode),
        fields_(fields),
        poses_(poses),
        size_(size) {
    const PoseMargins* const margins = mechanism.pose_margins();
    const bool mixed = !margins || margins->margin_unit().empty();
    add("margin", mixed ? "mixed" : margins->margin_unit(),
        std::string("least margin of the pose, > 0 where it is feasible") + (mixed ? ", in m, rad or 1" : ""));
    add_quantities(false);
    joints_ = fields_.size();
    for (const AxisInfo& joint : info_.joints) add(joint.name, joint.unit, "position of joint " + joint.name);
    if (!no_joint_forces(mechanism)) add_quantities(true);
  }

  static constexpr std::size_t kFeasible = 0;  ///< the field that is there before

  /// What each thread overwrites.
  struct Room {
    std::vector<double> margins;
    std::vector<MotionState<double>> states;
    std::vector<PoseDynamics<double>> dynamics;
    std::vector<std::size_t> cells;
  };

  std::size_t count() const { return (fields_[kFeasible].values.size() + size_ - 1) / size_; }

  void fill(std::size_t row, Room& room) const {
    const std::size_t first = row * size_, end = std::min(first + size_, fields_[kFeasible].values.size());
    for (std::size_t cell = first; cell < end; ++cell) fill_pose(cell, room);
    if (!no_joint_forces(mechanism_)) fill_inertia(first, end, room);
  }

  void fill_all() const {
    std::vector<Room> rooms(workers());
    share_pieces(count(), [&](std::size_t row, std::size_t end, std::size_t worker) {
      for (; row < end; ++row) fill(row, rooms[worker]);
    });
  }

 private:
  static constexpr std::size_t kMargin = 1, kQuantities = 2;  ///< fields; those of inertia come behind the joints

  void add(std::string name, std::string unit, std::string meaning) {
    fields_.push_back({std::move(name), std::move(unit), std::move(meaning), {}});
    fields_.back().values.assign(fields_[kFeasible].values.size(), kNone);
  }
  void add_quantities(bool of_inertia) {
    const std::string& length = info_.characteristic_length;
    for (const PoseQuantity* const quantity : pose_quantities()) {
      if (quantity->needs_inertia() != of_inertia) continue;
      const std::string name = quantity->name, meaning = quantity->meaning;
      if (!quantity->per_joint) {
        add(name, quantity->unit, meaning + (of_inertia || length.empty() ? "" : ", characteristic length " + length));
        continue;
      }
      for (std::size_t limb = 1; limb <= info_.joints.size(); ++limb)
        add(name + "_" + std::to_string(limb), quantity->unit, meaning + " of limb " + std::to_string(limb));
      add(name + "_worst", quantity->unit, (is_least(*quantity) ? "least " : "largest ") + meaning + " of the limbs");
    }
  }
  static bool is_least(const PoseQuantity& quantity) { return quantity.worst == PoseQuantity::Worst::least; }

  /// Fills a cell of the fields from `field` on, in the order in which they were added.
  /// @param evaluate  (quantity, values) computes them
  template <class Evaluate>
  void put(std::size_t field, std::size_t cell, bool of_inertia, const Evaluate& evaluate) const {
    std::array<double, kMostJoints> values;
    for (const PoseQuantity* const quantity : pose_quantities()) {
      if (quantity->needs_inertia() != of_inertia) continue;
      evaluate(*quantity, values.data());
      const std::size_t count = quantity->per_joint ? info_.joints.size() : 1;
      for (std::size_t i = 0; i < count; ++i) at(field++, cell) = values[i];
      if (!quantity->per_joint) continue;
      const auto end = values.begin() + info_.joints.size();
      at(field++, cell) =
          *(is_least(*quantity) ? std::min_element(values.begin(), end) : std::max_element(values.begin(), end));
    }
  }

  double& at(std::size_t field, std::size_t cell) const { return fields_[field].values[cell]; }
  bool feasible(std::size_t cell) const { return at(kFeasible, cell) > 0; }

  void fill_pose(std::size_t cell, Room& room) const {
    const Pose<double> pose = poses_(cell);
    at(kMargin, cell) = on_its_side(margin_(pose, room.margins), feasible(cell));
    if (!feasible(cell)) return;
    const PoseReport report = mechanism_.inspect(parameters_, pose, info_.modes.front(), limits_);
    put(kQuantities, cell, false,
        [&](const PoseQuantity& quantity, double* values) { quantity.of_report(report, values); });
    for (std::size_t i = 0; report.joints && i < info_.joints.size(); ++i) at(joints_ + i, cell) = (*report.joints)[i];
  }

  /// Rounding, or a pose without margins, must not put a cell on the other side of the surface.
  static double on_its_side(double margin, bool feasible) {
    constexpr double kLeast = 1e-12;
    if (!std::isfinite(margin)) return feasible ? 1 : -1;
    return feasible ? std::fmax(margin, kLeast) : std::fmin(margin, -kLeast);
  }

  void fill_inertia(std::size_t first, std::size_t end, Room& room) const {
    auto& [margins, states, dynamics, cells] = room;
    const AxisVector<double> at_rest(info_.coordinates.size());
    states.clear();
    cells.clear();
    for (std::size_t cell = first; cell < end; ++cell) {
      if (!feasible(cell)) continue;
      cells.push_back(cell);
      states.push_back({poses_(cell), at_rest});
    }
    dynamics.resize(states.size());
    mechanism_.dynamics()->equations(parameters_, mode_, states, dynamics);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (!dynamics[k].assembles) continue;
      const AxisMatrix<double> inertia = joint_inertia(dynamics[k]);
      put(joints_ + info_.joints.size(), cells[k], true,
          [&](const PoseQuantity& quantity, double* values) { quantity.of_inertia(inertia, values); });
    }
  }

  const Mechanism& mechanism_;
  const MechanismInfo& info_;
  std::span<const double> parameters_;
  const LimitSpec& limits_;
  PoseMargin margin_;
  std::string mode_;
  std::vector<WorkspaceField>& fields_;
  const Poses& poses_;
  std::size_t size_;
  std::size_t joints_ = 0;  ///< field of the first
};

}  // namespace

std::vector<std::size_t> WorkspaceFields::feasible_cells() const {
  const std::vector<double>& feasible = field("feasible").values;
  std::vector<std::size_t> list;
  for (std::size_t cell = 0; cell < feasible.size(); ++cell)
    if (feasible[cell] > 0) list.push_back(cell);
  return list;
}

VoxelGrid WorkspaceFields::grid() const {
  std::array<std::int64_t, 3> n = {1, 1, 1};
  Box box;
  box.fill({0, 1});
  for (std::size_t i = 0; i < axes.size(); ++i) {
    n[i] = axes[i].cells;
    box[i] = {axes[i].lower, axes[i].upper};
  }
  return {n, box};
}

Pose<double> WorkspaceFields::pose(std::size_t cell) const {
  const VoxelGrid all = grid();
  auto rest = static_cast<std::int64_t>(cell);
  std::array<double, 3> at{};
  for (std::size_t i = 3; i-- > 0; rest /= all.cells[i]) at[i] = all.centre(i, rest % all.cells[i]);
  return pose(at);
}

Pose<double> WorkspaceFields::pose(const std::array<double, 3>& at) const {
  Pose<double> all(axes.size() + held.size());
  for (const WorkspaceAxis& fixed : held) all[static_cast<std::size_t>(fixed.coordinate)] = fixed.lower;
  for (std::size_t i = 0; i < axes.size(); ++i) all[static_cast<std::size_t>(axes[i].coordinate)] = at[i];
  return all;
}

const WorkspaceField* WorkspaceFields::find(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &WorkspaceField::name);
  return found == fields.end() ? nullptr : &*found;
}

const WorkspaceField& WorkspaceFields::field(std::string_view name) const {
  if (const WorkspaceField* const found = find(name)) return *found;
  throw std::out_of_range("workspaces of mechanism " + mechanism + " have no field " + std::string(name));
}

PoseMargin::PoseMargin(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits)
    : mechanism_(mechanism),
      parameters_(parameters.begin(), parameters.end()),
      limits_(survey_limits(mechanism.info(), limits)) {}

double PoseMargin::operator()(const Pose<double>& pose, std::vector<double>& scratch) const {
  double least = std::numeric_limits<double>::infinity();
  const PoseMargins* const ability = mechanism_.pose_margins();
  if (!ability) {  // what exists of them, also where the pose does not assemble
    const auto report = mechanism_.inspect(parameters_, pose, mechanism_.info().modes.front(), limits_);
    for (const auto& named : report.margins) least = std::fmin(least, named.second);
    return report.feasible || least < 0 ? least : -1;
  }
  scratch.clear();
  ability->append(parameters_, mechanism_.info().modes.front(), limits_, {&pose, 1}, scratch);
  for (const double margin : scratch) least = std::fmin(least, margin);
  return least;
}

WorkspaceFields workspace_fields(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan,
                                 const std::string& mode) {
  const MechanismInfo& info = mechanism.info();
  if (const Refusal reason = mechanism.refuse(parameters)) throw std::invalid_argument(*reason);
  const SurveyPlan picture = picture_plan(info, plan, {kPictureCells, kPictureCells, kPictureCells});
  const Sweep& sweep = sweep_of(info, picture);
  const VoxelMap map = voxel_map(mechanism, parameters, picture);

  WorkspaceFields found;
  found.mechanism = info.name;
  for (std::size_t i = 0; i < sweep.swept.size(); ++i)
    found.axes.push_back(axis_of(info, sweep.swept[i], map.lower[i], map.upper[i], map.cells[i]));
  for (const int coordinate : sweep.held) {
    const double value = held_value(mechanism, parameters, picture, coordinate);
    found.held.push_back(axis_of(info, coordinate, value, value, 0));
    found.held_note.push_back(note_of(how_held(plan, coordinate)));
  }
  found.fields.push_back({"feasible",
                          "1",
                          "1 where the pose at the cell's centre is feasible, else 0",
                          {map.feasible.begin(), map.feasible.end()}});
  const VoxelGrid grid = found.grid();
  Survey<double> summary;
  summarise(grid, map, summary, found.axes.size());
  found.volume = summary.volume;
  found.volume_unit = volume_unit(info, picture);
  found.touches_box = picture.box() && summary.touches_box;

  const Rows::Poses poses = [&](std::size_t cell) { return found.pose(cell); };
  Rows(mechanism, parameters, picture.limits, mode, found.fields, poses, static_cast<std::size_t>(grid.cells[2]))
      .fill_all();
  return found;
}

std::vector<WorkspaceField> fields_at(const Mechanism& mechanism, std::span<const double> parameters,
                                      const LimitSpec& limits, const std::string& mode,
                                      const std::vector<Pose<double>>& poses) {
  constexpr std::size_t kRow = 64;
  std::vector<WorkspaceField> fields = {{"feasible", "1", "", std::vector<double>(poses.size(), 1.0)}};
  const Rows::Poses of = [&](std::size_t i) { return poses[i]; };
  Rows(mechanism, parameters, limits, mode, fields, of, kRow).fill_all();
  fields.erase(fields.begin());
  return fields;
}

LimitSpec survey_limits(const MechanismInfo& info, LimitSpec limits) {
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (info.limits[i].group == "clearance" && !limits.given[i]) limits.given[i] = info.limits[i].inactive;
  return limits;
}

std::optional<FieldRange> range_of(const WorkspaceField& field) {
  std::optional<FieldRange> range;
  for (const double value : field.values) {
    if (std::isnan(value)) continue;
    if (!range) range = FieldRange{value, value};
    range->least = std::fmin(range->least, value);
    range->greatest = std::fmax(range->greatest, value);
  }
  return range;
}

}  // namespace pkm
