#include "engine/workspace/workspace_fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/core/team.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"

namespace pkm {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

WorkspaceAxis axis_of(const MechanismInfo& info, int coordinate, double lower, double upper, std::int64_t cells) {
  const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
  return {coordinate, axis.name, axis.unit, lower, upper, cells};
}

/// Origin of the value of a fixed coordinate, as a phrase for the report.
std::string note_of(const FixedCoordinate& fixed) {
  using Kind = FixedCoordinate::Kind;
  if (fixed.kind == Kind::value) return "as given";
  if (fixed.kind == Kind::default_value) return "default value of the design";
  return fixed.kind == Kind::listed ? "the first of the listed values" : "default value; the study integrates over it";
}

/// Evaluates the fields of a sequence of poses in parallel, in blocks of consecutive poses. The first field,
/// `feasible`, must exist already; it marks the feasible poses.
class Evaluator {
 public:
  using Poses = std::function<Pose<double>(std::size_t)>;

  /// Appends all fields but `feasible` to `fields`; their values are NaN until they are evaluated.
  /// @param poses  poses(i) is the i-th pose
  /// @param block  number of poses per block
  Evaluator(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
            const std::string& mode, std::vector<WorkspaceField>& fields, const Poses& poses, std::size_t block)
      : mechanism_(mechanism),
        info_(mechanism.info()),
        all_(pose_quantities(mechanism.info())),
        parameters_(parameters),
        limits_(limits),
        margin_(mechanism, parameters, limits),
        mode_(mode.empty() ? info_.modes.front() : mode),
        fields_(fields),
        poses_(poses),
        block_(block) {
    const PoseMargins* const margins = mechanism.pose_margins();
    const bool mixed = !margins || margins->margin_unit().empty();
    add("margin", mixed ? "mixed" : margins->margin_unit(),
        std::string("minimum margin of the pose, > 0 where it is feasible") + (mixed ? ", in m, rad or 1" : ""));
    add_quantities(false);
    joints_ = fields_.size();
    for (const AxisInfo& joint : info_.joints) add(joint.name, joint.unit, "position of joint " + joint.name);
    if (!why_no_joint_forces(mechanism)) add_quantities(true);
  }

  static constexpr std::size_t kFeasible = 0;  ///< index of the field `feasible`, which exists already

  /// Scratch memory of a thread.
  struct FieldScratch {
    Scratch margins;
    std::vector<MotionState<double>> states;
    std::vector<PoseDynamics<double>> dynamics;
    std::vector<std::size_t> cells;
  };

  std::size_t block_count() const { return (fields_[kFeasible].values.size() + block_ - 1) / block_; }

  void evaluate_block(std::size_t number, FieldScratch& scratch) const {
    const std::size_t first = number * block_, end = std::min(first + block_, fields_[kFeasible].values.size());
    for (std::size_t cell = first; cell < end; ++cell) evaluate_pose(cell, scratch);
    if (!why_no_joint_forces(mechanism_)) evaluate_inertia_fields(first, end, scratch);
  }

  void evaluate_all() const {
    std::vector<FieldScratch> scratch(workers());
    parallel_for(block_count(), [&](std::size_t number, std::size_t end, std::size_t worker) {
      for (; number < end; ++number) evaluate_block(number, scratch[worker]);
    });
  }

 private:
  /// Index of the field `margin`, and index of the first field of a pose quantity.
  static constexpr std::size_t kMargin = 1, kQuantities = 2;

  void add(std::string name, std::string unit, std::string meaning) {
    fields_.push_back({std::move(name), std::move(unit), std::move(meaning), {}});
    fields_.back().values.assign(fields_[kFeasible].values.size(), kUndefined);
  }
  void add_quantities(bool from_inertia) {
    const std::string& length = info_.characteristic_length;
    for (const PoseQuantity* const quantity : all_) {
      if (quantity->needs_inertia() != from_inertia) continue;
      const std::string name = quantity->name, meaning = quantity->meaning;
      if (!quantity->per_joint) {
        add(name, quantity->unit,
            meaning + (!quantity->needs_report() || length.empty() ? "" : ", characteristic length " + length));
        continue;
      }
      for (std::size_t limb = 1; limb <= info_.joints.size(); ++limb)
        add(name + "_" + std::to_string(limb), quantity->unit, meaning + " of limb " + std::to_string(limb));
      add(name + "_worst", quantity->unit,
          (min_is_worst(*quantity) ? "minimum " : "maximum ") + meaning + " of the limbs");
    }
  }
  static bool min_is_worst(const PoseQuantity& quantity) { return quantity.worst == PoseQuantity::Worst::minimum; }

  /// Stores, at one cell, the values of either all quantities of the joint-space inertia or all other quantities.
  /// @param field     index of the field of the first of these quantities; the others follow in the order of
  ///                  add_quantities()
  /// @param evaluate  evaluate(quantity, values) computes the values of a quantity, one per joint if it has several
  template <class Evaluate>
  void store(std::size_t field, std::size_t cell, bool from_inertia, const Evaluate& evaluate) const {
    std::array<double, kMaxJoints> values;
    for (const PoseQuantity* const quantity : all_) {
      if (quantity->needs_inertia() != from_inertia) continue;
      evaluate(*quantity, values.data());
      const std::size_t count = quantity->per_joint ? info_.joints.size() : 1;
      for (std::size_t i = 0; i < count; ++i) at(field++, cell) = values[i];
      if (!quantity->per_joint) continue;
      const auto end = values.begin() + info_.joints.size();
      at(field++, cell) =
          *(min_is_worst(*quantity) ? std::min_element(values.begin(), end) : std::max_element(values.begin(), end));
    }
  }

  double& at(std::size_t field, std::size_t cell) const { return fields_[field].values[cell]; }
  bool feasible(std::size_t cell) const { return at(kFeasible, cell) > 0; }

  void evaluate_pose(std::size_t cell, FieldScratch& scratch) const {
    const Pose<double> pose = poses_(cell);
    at(kMargin, cell) = with_sign(margin_(pose, scratch.margins), feasible(cell));
    if (!feasible(cell)) return;
    const PoseReport report = mechanism_.inspect(parameters_, pose, info_.modes.front(), limits_);
    store(kQuantities, cell, false,
          [&](const PoseQuantity& quantity, double* values) { quantity.evaluate(report, values); });
    for (std::size_t i = 0; report.joints && i < info_.joints.size(); ++i) at(joints_ + i, cell) = (*report.joints)[i];
  }

  /// Adjusts the sign of a margin to the field `feasible`: > 0 if feasible, otherwise < 0. Rounding errors can give the
  /// opposite sign, some poses have no margin, and poses of components that do not count as workspace need a negative
  /// one.
  static double with_sign(double margin, bool feasible) {
    constexpr double kMinMagnitude = 1e-12;
    if (!std::isfinite(margin)) return feasible ? 1 : -1;
    return feasible ? std::fmax(margin, kMinMagnitude) : -std::fmax(std::fabs(margin), kMinMagnitude);
  }

  void evaluate_inertia_fields(std::size_t first, std::size_t end, FieldScratch& scratch) const {
    auto& [margins, states, dynamics, cells] = scratch;
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
      store(joints_ + info_.joints.size(), cells[k], true,
            [&](const PoseQuantity& quantity, double* values) { quantity.from_inertia(inertia, values); });
    }
  }

  const Mechanism& mechanism_;
  const MechanismInfo& info_;
  std::vector<const PoseQuantity*> all_;
  std::span<const double> parameters_;
  const LimitSpec& limits_;
  PoseMargin margin_;
  std::string mode_;
  std::vector<WorkspaceField>& fields_;
  const Poses& poses_;
  std::size_t block_;       ///< number of consecutive poses that one task evaluates
  std::size_t joints_ = 0;  ///< index of the field that holds the position of the first joint
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
  Pose<double> all(axes.size() + fixed.size());
  for (const WorkspaceAxis& axis : fixed) all[static_cast<std::size_t>(axis.coordinate)] = axis.lower;
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
      limits_(workspace_limits(mechanism.info(), limits)) {}

double PoseMargin::operator()(const Pose<double>& pose, Scratch& scratch) const {
  double min_margin = std::numeric_limits<double>::infinity();
  const PoseMargins* const capability = mechanism_.pose_margins();
  // The mechanism does not provide PoseMargins: use the margins of the pose report, which has some even if the
  // mechanism cannot be assembled.
  if (!capability) {
    const auto report = mechanism_.inspect(parameters_, pose, mechanism_.info().modes.front(), limits_);
    for (const auto& named : report.margins) min_margin = std::fmin(min_margin, named.second);
    return report.feasible || min_margin < 0 ? min_margin : -1;
  }
  std::vector<double>& margins = scratch.get<std::vector<double>>();
  margins.clear();
  capability->append(parameters_, mechanism_.info().modes.front(), limits_, {&pose, 1}, scratch, margins);
  for (const double margin : margins) min_margin = std::fmin(min_margin, margin);
  return min_margin;
}

WorkspaceFields workspace_fields(const Mechanism& mechanism, std::span<const double> parameters,
                                 const WorkspacePlan& plan, const std::string& mode) {
  const MechanismInfo& info = mechanism.info();
  if (const Unsupported reason = mechanism.refuse(parameters)) throw DesignError(*reason);
  const WorkspacePlan picture = visualisation_plan(info, plan, {kPictureCells, kPictureCells, kPictureCells});
  const Sweep& sweep = sweep_of(info, picture);
  const VoxelMap map = voxel_map(mechanism, parameters, picture);

  WorkspaceFields found;
  found.mechanism = info.name;
  for (std::size_t i = 0; i < sweep.swept.size(); ++i)
    found.axes.push_back(axis_of(info, sweep.swept[i], map.lower[i], map.upper[i], map.cells[i]));
  for (const int coordinate : sweep.fixed) {
    const double value = fixed_value(mechanism, parameters, picture, coordinate);
    found.fixed.push_back(axis_of(info, coordinate, value, value, 0));
    found.fixed_note.push_back(note_of(how_fixed(plan, coordinate)));
  }
  found.fields.push_back({"feasible",
                          "1",
                          "1 where the pose at the cell's centre is feasible, else 0",
                          {map.feasible.begin(), map.feasible.end()}});
  const VoxelGrid grid = found.grid();
  WorkspaceResult<double> summary;
  summarise(grid, map, summary, found.axes.size());
  found.volume = summary.volume;
  found.volume_unit = volume_unit(info, picture);
  found.touches_box = picture.box() && summary.touches_box;

  const Evaluator::Poses poses = [&](std::size_t cell) { return found.pose(cell); };
  Evaluator(mechanism, parameters, picture.limits, mode, found.fields, poses, static_cast<std::size_t>(grid.cells[2]))
      .evaluate_all();
  return found;
}

std::vector<WorkspaceField> fields_at(const Mechanism& mechanism, std::span<const double> parameters,
                                      const LimitSpec& limits, const std::string& mode,
                                      const std::vector<Pose<double>>& poses) {
  constexpr std::size_t kBlock = 64;
  std::vector<WorkspaceField> fields = {{"feasible", "1", "", std::vector<double>(poses.size(), 1.0)}};
  const Evaluator::Poses pose = [&](std::size_t i) { return poses[i]; };
  Evaluator(mechanism, parameters, limits, mode, fields, pose, kBlock).evaluate_all();
  fields.erase(fields.begin());
  return fields;
}

LimitSpec workspace_limits(const MechanismInfo& info, LimitSpec limits) {
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

std::optional<std::vector<std::array<double, 2>>> feasible_extents(const WorkspaceFields& workspace) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::optional<std::vector<std::array<double, 2>>> extents;
  const VoxelGrid grid = workspace.grid();
  const std::vector<double>& feasible = workspace.field("feasible").values;
  for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
    if (!(feasible[cell] > 0)) continue;
    if (!extents) extents.emplace(workspace.axes.size(), std::array{kInfinity, -kInfinity});
    const Pose<double> pose = workspace.pose(cell);
    for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
      const double centre = pose[static_cast<std::size_t>(workspace.axes[i].coordinate)], half = grid.step[i] / 2;
      auto& [min, max] = (*extents)[i];
      min = std::min(min, centre - half);
      max = std::max(max, centre + half);
    }
  }
  return extents;
}

}  // namespace pkm
