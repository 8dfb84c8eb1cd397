#include "engine/report/workspace_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/survey/picture_plan.hpp"

namespace pkm {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

WorkspaceAxis axis_of(const MechanismInfo& info, int coordinate) {
  WorkspaceAxis axis;
  axis.coordinate = coordinate;
  axis.name = info.coordinates[static_cast<std::size_t>(coordinate)];
  axis.unit = coordinate == 3 ? "rad" : "m";
  return axis;
}

/// Fills fields in, one row of cells along the last axis after the other.
class Rows {
 public:
  Rows(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
       WorkspaceFields& found)
      : mechanism_(mechanism),
        info_(mechanism.info()),
        parameters_(parameters),
        limits_(limits),
        margin_(mechanism, parameters, limits),
        mode_(mode.empty() ? info_.modes.front() : mode),
        found_(found),
        size_(static_cast<std::size_t>(found.axes[2].cells)) {
    const std::size_t cells = found_.fields[kFeasible].values.size();
    const auto add = [&](std::string name, std::string unit, std::string meaning) {
      found_.fields.push_back({std::move(name), std::move(unit), std::move(meaning), {}});
      found_.fields.back().values.assign(cells, kNone);
    };
    const bool mixed = info_.margin_unit.empty();
    add("margin", mixed ? "mixed" : info_.margin_unit,
        std::string("least margin of the pose, > 0 where it is feasible") + (mixed ? ", in m, rad or 1" : ""));
    add("conditioning", "1",
        "inverse condition number of the Jacobian" + (info_.characteristic_length.empty()
                                                          ? std::string()
                                                          : ", characteristic length " + info_.characteristic_length));
    for (const std::string& joint : info_.joints) add(joint, "m", "position of joint " + joint);
    if (!info_.has_dynamics) return;
    for (int limb = 1; limb <= 4; ++limb)
      add("dci_" + std::to_string(limb), "1", "dynamic coupling index of limb " + std::to_string(limb));
    add("dci_worst", "1", "largest dynamic coupling index of the limbs");
    add("inertia_condition", "1", "inverse condition number of the joint-space inertia");
  }

  static constexpr std::size_t kFeasible = 0;  ///< the field that is there before

  void fill(std::size_t row) const {
    const std::size_t first = row * size_;
    for (std::size_t cell = first; cell < first + size_; ++cell) fill_pose(cell);
    if (info_.has_dynamics) fill_inertia(first);
  }

 private:
  enum Field : std::size_t { kMargin = 1, kConditioning, kJoints, kDci = kJoints + 4, kWorst = kDci + 4, kInertia };

  double& at(std::size_t field, std::size_t cell) const { return found_.fields[field].values[cell]; }
  bool feasible(std::size_t cell) const { return at(kFeasible, cell) > 0; }

  void fill_pose(std::size_t cell) const {
    const Pose<double> pose = found_.pose(cell);
    at(kMargin, cell) = on_its_side(margin_(pose), feasible(cell));
    if (!feasible(cell)) return;
    const PoseReport report = mechanism_.inspect(parameters_, pose, info_.modes.front(), limits_);
    at(kConditioning, cell) = report.conditioning.value_or(kNone);
    for (std::size_t i = 0; report.joints && i < 4; ++i) at(kJoints + i, cell) = (*report.joints)[i];
  }

  /// Rounding, or a pose without margins, must not put a cell on the other side of the surface.
  static double on_its_side(double margin, bool feasible) {
    constexpr double kLeast = 1e-12;
    if (!std::isfinite(margin)) return feasible ? 1 : -1;
    return feasible ? std::fmax(margin, kLeast) : std::fmin(margin, -kLeast);
  }

  void fill_inertia(std::size_t first) const {
    thread_local std::vector<MotionState<double>> states;
    thread_local std::vector<PoseDynamics<double>> dynamics;
    thread_local std::vector<std::size_t> cells;
    states.clear();
    cells.clear();
    for (std::size_t cell = first; cell < first + size_; ++cell) {
      if (!feasible(cell)) continue;
      cells.push_back(cell);
      states.push_back({found_.pose(cell), {}});
    }
    dynamics.resize(states.size());
    mechanism_.dynamics(parameters_, mode_, states, dynamics);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (!dynamics[k].assembles) continue;
      const Matrix<double, 4, 4> inertia = joint_inertia(dynamics[k]);
      const Vector<double, 4> index = coupling_indices(inertia);
      for (std::size_t i = 0; i < 4; ++i) at(kDci + i, cells[k]) = index[i];
      at(kWorst, cells[k]) = *std::ranges::max_element(index.m);
      at(kInertia, cells[k]) = inertia_condition(inertia);
    }
  }

  const Mechanism& mechanism_;
  const MechanismInfo& info_;
  std::span<const double> parameters_;
  const LimitSpec& limits_;
  PoseMargin margin_;
  std::string mode_;
  WorkspaceFields& found_;
  std::size_t size_;
};

}  // namespace

VoxelGrid WorkspaceFields::grid() const {
  Box box;
  for (std::size_t i = 0; i < 3; ++i) box[i] = {axes[i].lower, axes[i].upper};
  return {{axes[0].cells, axes[1].cells, axes[2].cells}, box};
}

Pose<double> WorkspaceFields::pose(std::size_t cell) const {
  const VoxelGrid all = grid();
  auto rest = static_cast<std::int64_t>(cell);
  std::array<double, 3> at{};
  for (std::size_t i = 3; i-- > 0; rest /= axes[i].cells) at[i] = all.centre(i, rest % axes[i].cells);
  return pose(at);
}

Pose<double> WorkspaceFields::pose(const std::array<double, 3>& at) const {
  std::array<double, 4> all{};
  all[static_cast<std::size_t>(held.coordinate)] = held.lower;
  for (std::size_t i = 0; i < 3; ++i) all[static_cast<std::size_t>(axes[i].coordinate)] = at[i];
  return {all[0], all[1], all[2], all[3]};
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

double PoseMargin::operator()(const Pose<double>& pose) const {
  double least = std::numeric_limits<double>::infinity();
  if (mechanism_.info().margin_unit.empty()) {  // what exists of them, also where the pose does not assemble
    const auto report = mechanism_.inspect(parameters_, pose, mechanism_.info().modes.front(), limits_);
    for (const auto& named : report.margins) least = std::fmin(least, named.second);
    return report.feasible || least < 0 ? least : -1;
  }
  thread_local std::vector<double> margins;
  margins.clear();
  mechanism_.pose_margins(parameters_, limits_, {&pose, 1}, margins);
  for (const double margin : margins) least = std::fmin(least, margin);
  return least;
}

WorkspaceFields workspace_fields(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan,
                                 const std::string& mode) {
  const MechanismInfo& info = mechanism.info();
  if (const std::string reason = mechanism.refuse(parameters); !reason.empty()) throw std::invalid_argument(reason);
  const SurveyPlan picture = picture_plan(plan, {kPictureCells, kPictureCells, kPictureCells});
  const Sweep sweep = sweep_of(info, picture);
  const VoxelMap map = mechanism.voxel_map(parameters, picture);

  WorkspaceFields found;
  found.mechanism = info.name;
  for (std::size_t i = 0; i < 3; ++i) {
    found.axes[i] = axis_of(info, sweep.swept[i]);
    found.axes[i].lower = map.lower[i];
    found.axes[i].upper = map.upper[i];
    found.axes[i].cells = map.cells[i];
  }
  found.held = axis_of(info, sweep.held);
  found.held.lower = found.held.upper = held_value(mechanism, parameters, picture);
  found.held_note = plan.held.kind == HeldCoordinate::Kind::value    ? "as given"
                    : plan.held.kind == HeldCoordinate::Kind::middle ? "the middle of the design"
                                                                     : "the middle of what the plan integrates over";
  found.fields.push_back({"feasible",
                          "1",
                          "1 where the pose at the cell's centre is feasible, else 0",
                          {map.feasible.begin(), map.feasible.end()}});
  const VoxelGrid grid = found.grid();
  Survey<double> summary;
  summarise(grid, map, summary);
  found.volume = summary.volume;
  found.volume_unit = sweep.volume_unit;
  found.touches_box = picture.box && summary.touches_box;

  const Rows rows(mechanism, parameters, picture.limits, mode, found);
  share_pieces(static_cast<std::size_t>(grid.cells[0] * grid.cells[1]), [&](std::size_t row, std::size_t end) {
    for (; row < end; ++row) rows.fill(row);
  });
  return found;
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
