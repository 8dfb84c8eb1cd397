#include "engine/mechanism/with_drive_trains.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/mechanism/abilities/sided_columns.hpp"
#include "engine/mechanism/scalar_dispatch.hpp"

namespace pkm {
namespace {

class MechanismWithDriveTrains final : public Mechanism,
                                       public Columns,
                                       public SidedColumns,
                                       Voxels,
                                       DynamicsDispatch<MechanismWithDriveTrains> {
 public:
  MechanismWithDriveTrains(std::shared_ptr<const Mechanism> bare, DriveTrains trains, std::vector<JointLimits> limits)
      : bare_(std::move(bare)),
        trains_(std::move(trains)),
        limits_(std::move(limits)),
        rotors_(trains_.empty() ? std::vector<double>(bare_->info().joints.size()) : reflected(trains_)) {
    PKM_EXPECTS(rotors_.size() == bare_->info().joints.size());
    PKM_EXPECTS(limits_.empty() || limits_.size() == rotors_.size());
  }

  const Mechanism& bare() const { return *bare_; }
  const std::vector<JointLimits>& limits() const { return limits_; }

  const MechanismInfo& info() const override { return bare_->info(); }
  Unsupported refuse(std::span<const double> parameters) const override { return bare_->refuse(parameters); }
  PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const override {
    return bare_->inspect(parameters, pose, mode, limits);
  }
  std::optional<std::vector<std::array<double, 2>>> ranges(std::span<const double> parameters) const override {
    return bare_->ranges(parameters);
  }
  std::optional<std::array<double, 2>> reach(std::span<const double> parameters, int coordinate) const override {
    return bare_->reach(parameters, coordinate);
  }
  std::optional<double> default_value(std::span<const double> parameters, int coordinate) const override {
    return bare_->default_value(parameters, coordinate);
  }
  void thresholds(std::span<const double> parameters, const LimitSpec& limits,
                  std::span<double> values) const override {
    bare_->thresholds(parameters, limits, values);
  }
  void thresholds(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> values) const override {
    bare_->thresholds(parameters, limits, values);
  }
  std::vector<double> quantities(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                                 const MotionSample& at) const override {
    return bare_->quantities(parameters, mode, limits, at);
  }

  /// The voxel analysis of the mechanism; null if it does not support rotors, so that every cell is tested by inverse
  /// kinematics.
  const Voxels* voxels() const override {
    return bare_->voxels() && (!has_inertia() || bare_->voxels()->supports_rotors()) ? this : nullptr;
  }
  const Columns* columns() const override { return bare_->columns() ? this : nullptr; }
  std::string why_no_columns() const override { return bare_->why_no_columns(); }
  const RigorousBounds* bounds() const override { return bare_->bounds(); }
  const Size* size() const override { return bare_->size(); }
  const DesignTests* design_tests() const override { return bare_->design_tests(); }
  const PoseMargins* pose_margins() const override { return bare_->pose_margins(); }
  const Velocities* velocities() const override { return bare_->velocities(); }
  const ForwardKinematics* forward() const override { return bare_->forward(); }
  const Links* links() const override { return bare_->links(); }
  const Dynamics* dynamics() const override { return bare_->dynamics() ? this : nullptr; }
  const JointReactions* reactions() const override { return bare_->reactions(); }
  std::string why_no_reactions() const override { return bare_->why_no_reactions(); }
  const Elasticity* elasticity() const override { return bare_->elasticity(); }
  std::string why_no_elasticity() const override { return bare_->why_no_elasticity(); }
  const DriveTrains* drive_trains() const override { return trains_.empty() ? nullptr : &trains_; }

 private:
  friend DynamicsDispatch<MechanismWithDriveTrains>;

  bool has_inertia() const {
    return std::ranges::any_of(rotors_, [](double rotor) { return rotor > 0; });
  }
  FieldRequest add_rotors(FieldRequest request) const {
    request.rotors = rotors_;
    return request;
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const FieldRequest& request) const override {
    return bare_->voxels()->prepare(plan, voxels, add_rotors(request));
  }
  std::unique_ptr<const PoseSides> prepare_sides(const WorkspacePlan& plan, const std::string& mode) const override {
    return bare_->voxels()->prepare_sides(plan, mode);
  }
  bool supports_rotors() const override { return true; }
  bool supports_obstacles() const override { return bare_->voxels()->supports_obstacles(); }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const FieldRequest& request) const override {
    if (request.needs_inertia() && has_inertia() && !bare_->columns()->supports_rotors())
      throw std::invalid_argument("columns of mechanism " + info().name +
                                  " do not support the inertia of drive trains; set workspace.method = \"voxels\"");
    return bare_->columns()->prepare(plan, columns, add_rotors(request));
  }
  bool supports_box() const override { return bare_->columns()->supports_box(); }
  std::shared_ptr<const Mechanism> on_side(std::int8_t side) const override {
    auto other = columns_on_side(*bare_->columns(), side);
    return other ? with_drive_trains(std::move(other), trains_, limits_) : nullptr;
  }

  const std::vector<std::string>& mass_models() const override { return bare_->dynamics()->mass_models(); }
  const std::string& mass_model() const override { return bare_->dynamics()->mass_model(); }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    auto other = bare_->dynamics()->with_masses(model);
    return other ? with_drive_trains(std::move(other), trains_, limits_) : nullptr;
  }

  /// The kinetic energy of a rotor of inertia I at gear ratio g is I (g qdot)^2 / 2. With D = diag(I g^2) and
  /// qdot = J Xdot, the rotors add J^T D J to the inertia matrix M_X and J^T D Jdot Xdot to the velocity terms h_X of
  /// the equations of motion.
  template <class S>
  void find_dynamics(std::span<const S> parameters, const std::string& mode, std::span<const MotionState<S>> states,
                     std::span<PoseDynamics<S>> found) const {
    bare_->dynamics()->equations(parameters, mode, states, found);
    if (!has_inertia()) return;
    for (PoseDynamics<S>& d : found) {
      if (!d.assembles) continue;
      AxisMatrix<S> weighted = d.J;
      for (std::size_t i = 0; i < weighted.rows(); ++i)
        for (std::size_t j = 0; j < weighted.cols(); ++j) weighted(i, j) = weighted(i, j) * rotors_[i];
      d.M_X += transpose(weighted) * d.J;
      d.h_X += transpose(weighted) * d.J_rate_X;
    }
  }

  std::shared_ptr<const Mechanism> bare_;
  DriveTrains trains_;
  std::vector<JointLimits> limits_;
  std::vector<double> rotors_;
};

}  // namespace

std::shared_ptr<const Mechanism> with_drive_trains(std::shared_ptr<const Mechanism> mechanism, DriveTrains trains,
                                                   std::vector<JointLimits> limits) {
  return std::make_shared<MechanismWithDriveTrains>(std::move(mechanism), std::move(trains), std::move(limits));
}

std::vector<JointLimits> joint_limits(const Mechanism& mechanism) {
  const auto* const decorated = dynamic_cast<const MechanismWithDriveTrains*>(&mechanism);
  return decorated ? decorated->limits() : std::vector<JointLimits>();
}

const Mechanism& without_drive_trains(const Mechanism& mechanism) {
  const auto* const decorated = dynamic_cast<const MechanismWithDriveTrains*>(&mechanism);
  return decorated ? decorated->bare() : mechanism;
}

}  // namespace pkm
