#include "engine/mechanisms/described/mechanism.hpp"

#include <algorithm>

#include "engine/mechanism/both_scalars.hpp"
#include "engine/mechanisms/described/bounds.hpp"
#include "engine/mechanisms/described/clearance.hpp"
#include "engine/mechanisms/described/columns/survey.hpp"
#include "engine/mechanisms/described/dynamics.hpp"
#include "engine/mechanisms/described/equations.hpp"
#include "engine/mechanisms/described/forward.hpp"
#include "engine/mechanisms/described/joints.hpp"
#include "engine/mechanisms/described/kinematics.hpp"
#include "engine/mechanisms/described/mobility.hpp"
#include "engine/mechanisms/described/voxels.hpp"

namespace pkm::described {
namespace {

/// Its abilities are those that the description has what for.
class DescribedMechanism final : public Mechanism,
                                 public std::enable_shared_from_this<DescribedMechanism>,
                                 Voxels,
                                 Columns,
                                 CertainBounds,
                                 Velocities,
                                 ForwardKinematics,
                                 Links,
                                 DesignTests,
                                 Size,
                                 JointReactions,
                                 DynamicsOf<DescribedMechanism> {
 public:
  explicit DescribedMechanism(Model model)
      : e_(std::move(model)), why_no_columns_(described::why_no_columns(*this, e_)) {}

  const Evaluation& evaluation() const { return e_; }

  const MechanismInfo& info() const override { return e_.model.info; }
  PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const override {
    return inspect_pose(e_, parameters, pose, number_of_mode(info(), mode), limits);
  }
  std::optional<std::vector<std::array<double, 2>>> ranges(std::span<const double> parameters) const override {
    std::vector<std::array<double, 2>> all;
    for (std::size_t i = 0; i < e_.model.inputs.coordinates; ++i) {
      const auto range = e_.range(parameters, no_limits(info()), 0, i);
      if (!range) return {};
      all.push_back(*range);
    }
    return all;
  }
  /// The survey's box may be less than what the limbs reach.
  std::optional<std::array<double, 2>> reach(std::span<const double>, int) const override { return {}; }
  std::optional<double> middle(std::span<const double> parameters, int coordinate) const override {
    return e_.of_design<double>(e_.middle[static_cast<std::size_t>(coordinate)], parameters);
  }
  void thresholds(std::span<const double> parameters, const LimitSpec& limits,
                  std::span<double> values) const override {
    e_.thresholds(parameters, limits, values);
  }
  void thresholds(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> values) const override {
    e_.thresholds(parameters, limits, values);
  }

  const Voxels* voxels() const override { return this; }
  const Columns* columns() const override { return why_no_columns_.empty() ? this : nullptr; }
  std::string why_no_columns() const override { return why_no_columns_; }
  const CertainBounds* bounds() const override { return this; }
  const Velocities* velocities() const override { return this; }
  const ForwardKinematics* forward() const override {
    return e_.model.inputs.joints == e_.model.inputs.coordinates ? this : nullptr;
  }
  const Links* links() const override { return e_.model.links.empty() ? nullptr : this; }
  const DesignTests* design_tests() const override { return e_.model.tests.empty() ? nullptr : this; }
  const Size* size() const override { return e_.model.size ? this : nullptr; }
  const Dynamics* dynamics() const override { return e_.model.equations ? this : nullptr; }
  const JointReactions* reactions() const override { return e_.model.why_no_reactions.empty() ? this : nullptr; }
  std::string why_no_reactions() const override { return e_.model.why_no_reactions; }

 private:
  friend DynamicsOf<DescribedMechanism>;

  template <class S>
  void find_dynamics(std::span<const S> parameters, const std::string& mode, std::span<const MotionState<S>> states,
                     std::span<PoseDynamics<S>> found) const {
    described::find_dynamics(e_, parameters, number_of_mode(info(), mode), states, found);
  }
  const std::vector<std::string>& mass_models() const override {
    static const std::vector<std::string> models = {"file"};
    return models;
  }
  const std::string& mass_model() const override { return mass_models().front(); }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    return model == mass_model() ? shared_from_this() : nullptr;
  }

  Reactions find(std::span<const double> parameters, const std::string& mode, const MotionState<double>& state,
                 const AxisVector<double>& acceleration, const Wrench<double>& wrench) const override {
    const PoseReport report = inspect(parameters, state.pose, mode, no_limits(info()));
    if (report.assembles)
      return pkm::reactions(newton_euler(e_, parameters, number_of_mode(info(), mode), state, acceleration, wrench));
    Reactions none;
    none.reason = report.reason;
    return none;
  }

  std::unique_ptr<const VoxelSurveyor> prepare(const SurveyPlan& plan, const VoxelOptions& voxels,
                                               const Demand& demand) const override {
    return prepare_voxels(*this, e_, plan, voxels, demand);
  }
  bool take_rotors() const override { return true; }
  bool take_obstacles() const override { return true; }
  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const ColumnOptions& columns,
                                          const Demand& demand) const override {
    return prepare_columns(*this, e_, plan, columns, demand);
  }
  bool take_box() const override { return true; }
  void refuse_bounds(const SurveyPlan& plan) const override { described::refuse_bounds(e_.model, plan); }
  VolumeBounds volume(std::span<const double> parameters, const SurveyPlan& plan, const std::string& mode,
                      const BoundsOptions& options) const override {
    return bound_volume(*this, e_, parameters, plan, number_of_mode(info(), mode), options);
  }
  PosesCertificate box(std::span<const double> parameters, const SurveyPlan& plan, const std::string& mode,
                       std::span<const std::array<double, 2>> ranges, const BoundsOptions& options) const override {
    return certify_box(e_, parameters, plan, number_of_mode(info(), mode), ranges, options);
  }
  PosesCertificate motion(std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
                          const Motion& motion, const BoundsOptions& options) const override {
    return certify_motion(e_, parameters, limits, number_of_mode(info(), mode), motion, options);
  }
  std::optional<Influence<double>> influence(std::span<const double> parameters, const Pose<double>& pose,
                                             const std::string& mode) const override {
    return influence_at(e_, parameters, pose, number_of_mode(info(), mode));
  }
  std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                       const AxisVector<double>& joints) const override {
    return assemblies_of(e_, parameters, joints);
  }
  std::vector<AssemblyMode> assemblies_near(std::span<const double> parameters, const AxisVector<double>& joints,
                                            const Pose<double>& from) const override {
    return described::assemblies_near(e_, parameters, joints, from);
  }
  ForwardStatus status(std::span<const double>, const AxisVector<double>&,
                       const std::vector<AssemblyMode>& found) const override {
    if (found.empty()) return {"NO_POSE", "no pose was found from any of the starting poses"};
    return {};
  }
  std::vector<PlacedLink> place(std::span<const double> parameters, const Pose<double>& pose,
                                const std::string& mode) const override {
    std::vector<double> inputs = e_.inputs(parameters, no_limits(info()), number_of_mode(info(), mode));
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e_.model.inputs.coordinate(0)));
    if (!assembles_at(e_, inputs)) return {};
    const std::vector<Capsule<double>> capsules = capsules_at(e_, inputs);
    std::vector<PlacedLink> links;
    for (std::size_t i = 0; i < capsules.size(); ++i)
      links.push_back({e_.model.links[i].name, e_.model.links[i].part, capsules[i]});
    return links;
  }

  std::vector<JoinedLinks> joined() const override { return joined_links(e_.model); }

  const std::vector<DesignMarginInfo>& list() const override { return e_.model.tests; }
  void test(std::span<const double> parameters, const LimitSpec& limits, std::span<double> margins) const override {
    find_tests(parameters, limits, margins);
  }
  void test(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> margins) const override {
    find_tests(parameters, limits, margins);
  }
  template <class S>
  void find_tests(std::span<const S> parameters, const LimitSpec& limits, std::span<S> margins) const {
    const std::size_t inputs = e_.model.inputs.count();
    with_room<S>(inputs + e_.tests.registers(), [&](std::span<S> room) {
      e_.fill_inputs<S>(parameters, limits, 0, room.first(inputs));
      const std::span<S> registers = room.subspan(inputs);
      e_.tests.run_all<S>(room.first(inputs), registers);
      for (std::size_t i = 0; i < margins.size(); ++i) margins[i] = registers[e_.tests.outputs()[i]];
    });
  }

  std::string unit() const override { return e_.model.size->unit; }
  std::string meaning() const override { return e_.model.size->meaning; }
  double of(std::span<const double> parameters) const override { return *e_.of_design(e_.size, parameters); }
  Dual4 of(std::span<const Dual4> parameters) const override { return *e_.of_design(e_.size, parameters); }

  Evaluation e_;
  std::string why_no_columns_;
};

}  // namespace

std::optional<PlatformMobility> platform_mobility(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const Pose<double>& pose, const std::string& mode) {
  const auto* const described = dynamic_cast<const DescribedMechanism*>(&mechanism);
  if (!described || !described->evaluation().model.jointed) return {};
  return mobility_at(described->evaluation(), parameters, pose, number_of_mode(mechanism.info(), mode));
}

std::shared_ptr<const Mechanism> make_mechanism(Model model) {
  if (!model.bodies.empty()) model.equations = equations_of(model);
  model.jacobian = model.equations ? model.equations->J : jacobian_of(model);
  return std::make_shared<const DescribedMechanism>(std::move(model));
}

}  // namespace pkm::described
