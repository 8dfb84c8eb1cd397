#include "engine/generic/mechanism.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/expression/term_matrix.hpp"
#include "engine/generic/bounds.hpp"
#include "engine/generic/clearance.hpp"
#include "engine/generic/column_evaluator.hpp"
#include "engine/generic/column_volume.hpp"
#include "engine/generic/design_checks.hpp"
#include "engine/generic/design_facts.hpp"
#include "engine/generic/dynamics.hpp"
#include "engine/generic/elastostatics.hpp"
#include "engine/generic/equations.hpp"
#include "engine/generic/forward.hpp"
#include "engine/generic/haar_measure.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/mobility.hpp"
#include "engine/generic/newton_euler.hpp"
#include "engine/generic/pose_margins.hpp"
#include "engine/generic/pose_sides.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/generic/voxels.hpp"
#include "engine/mechanism/abilities/sided_columns.hpp"
#include "engine/mechanism/ordered_margins.hpp"
#include "engine/mechanism/redundant_drives.hpp"
#include "engine/mechanism/scalar_dispatch.hpp"
#include "engine/mechanism/total_mass.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm::generic {
namespace {

/// A mechanism from a file. Offers those capabilities that the file has data for: links, masses, joints, columns.
class GenericMechanism final : public Mechanism,
                               public TotalMass,
                               public DesignFacts,
                               public WithOrientations,
                               public OrderedMargins,
                               public LimitedDrives,
                               public std::enable_shared_from_this<GenericMechanism>,
                               Voxels,
                               public Columns,
                               public SidedColumns,
                               RigorousBounds,
                               Velocities,
                               ForwardKinematics,
                               Links,
                               DesignTests,
                               Size,
                               JointReactions,
                               Elasticity,
                               PoseMarginsDispatch<GenericMechanism>,
                               DynamicsDispatch<GenericMechanism> {
 public:
  GenericMechanism(Model model, Accelerators accelerators)
      : e_(std::move(model)),
        accelerators_(std::move(accelerators)),
        why_no_columns_(accelerators_.columns ? "" : generic::why_no_columns(e_)) {}

  const Evaluation& evaluation() const { return e_; }

  const MechanismInfo& info() const override { return e_.model.info; }
  Unsupported refuse(std::span<const double> parameters) const override {
    if (Unsupported outside = Mechanism::refuse(parameters)) return outside;
    return refuse_design(e_, parameters);
  }
  std::vector<double> quantities(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                                 const MotionSample& at) const override {
    return quantities_at(e_, parameters, mode_index(info(), mode), limits, at);
  }
  PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const override {
    return inspect_pose(e_, parameters, pose, mode_index(info(), mode), limits);
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
  /// Range of a coordinate that the formulas of the file give as its reach. The search box is not used, because it may
  /// be smaller than the reach of the limbs.
  std::optional<std::array<double, 2>> reach(std::span<const double> parameters, int coordinate) const override {
    const auto i = static_cast<std::size_t>(coordinate);
    const auto from = e_.of_design<double>(e_.reach_lower[i], parameters),
               to = e_.of_design<double>(e_.reach_upper[i], parameters);
    return from && to ? std::optional(std::array{*from, *to}) : std::nullopt;
  }
  std::optional<double> default_value(std::span<const double> parameters, int coordinate) const override {
    return e_.of_design<double>(e_.default_values[static_cast<std::size_t>(coordinate)], parameters);
  }
  void thresholds(std::span<const double> parameters, const LimitSpec& limits,
                  std::span<double> values) const override {
    e_.thresholds(parameters, limits, values);
  }
  void thresholds(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> values) const override {
    e_.thresholds(parameters, limits, values);
  }

  Unsupported why_no_orientations() const override { return HaarMeasure::refusal(e_.model); }
  std::unique_ptr<const Orientations> orientations() const override {
    if (why_no_orientations()) return nullptr;
    return std::make_unique<HaarMeasure>(e_.model);
  }

  const Voxels* voxels() const override { return this; }
  const Columns* columns() const override { return why_no_columns_.empty() ? this : nullptr; }
  std::string why_no_columns() const override { return why_no_columns_; }
  const RigorousBounds* bounds() const override { return this; }
  const Velocities* velocities() const override { return this; }
  const ForwardKinematics* forward() const override {
    if (accelerators_.forward) return accelerators_.forward.get();
    return e_.model.inputs.joints == e_.model.inputs.coordinates ? this : nullptr;
  }
  const Links* links() const override { return e_.model.links.empty() ? nullptr : this; }
  const DesignTests* design_tests() const override { return e_.model.tests.empty() ? nullptr : this; }
  const PoseMargins* pose_margins() const override { return this; }
  const Size* size() const override { return e_.model.size ? this : nullptr; }
  const Dynamics* dynamics() const override { return e_.model.equations ? this : nullptr; }
  const JointReactions* reactions() const override { return e_.model.why_no_reactions.empty() ? this : nullptr; }
  std::string why_no_reactions() const override { return e_.model.why_no_reactions; }
  const Elasticity* elasticity() const override { return e_.model.why_no_elasticity.empty() ? this : nullptr; }
  std::string why_no_elasticity() const override { return e_.model.why_no_elasticity; }

 private:
  friend DynamicsDispatch<GenericMechanism>;
  friend PoseMarginsDispatch<GenericMechanism>;

  std::string margin_unit() const override { return e_.model.margin_unit; }
  Unsupported why_no_derivatives(const LimitSpec& limits) const override {
    const PoseQuantity* const limited = first_report_limit(e_.model, limits);
    if (!limited) return {};
    return "margins have none if " + std::string(limited->name) + " is limited, because it is not given by a formula";
  }
  template <class S>
  void find_margins(std::span<const S> parameters, const std::string& mode, const LimitSpec& limits,
                    std::span<const Pose<double>> poses, Scratch& scratch, std::vector<S>& margins) const {
    append_margins(e_, parameters, mode_index(info(), mode), limits, poses, scratch, margins);
  }
  std::vector<std::string> margin_names(const LimitSpec& limits) const override {
    return ordered_margin_names(e_.model, limits);
  }
  void append_ordered(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<double>> poses, Scratch& scratch,
                      std::vector<double>& margins) const override {
    append_ordered_margins(e_, parameters, mode_index(info(), mode), limits, poses, scratch, margins);
  }
  void append_ordered(std::span<const Dual4> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<Dual4>> poses, Scratch& scratch,
                      std::vector<Dual4>& margins) const override {
    append_ordered_margins(e_, parameters, mode_index(info(), mode), limits, poses, scratch, margins);
  }
  template <class S>
  void find_dynamics(std::span<const S> parameters, const std::string& mode, std::span<const MotionState<S>> states,
                     std::span<PoseDynamics<S>> found) const {
    generic::find_dynamics(e_, parameters, mode_index(info(), mode), states, found);
  }
  double total_mass(std::span<const double> parameters) const override { return generic::total_mass(e_, parameters); }
  Dual4 total_mass(std::span<const Dual4> parameters) const override { return generic::total_mass(e_, parameters); }
  std::vector<std::optional<std::array<double, 2>>> joint_ranges(std::span<const double> parameters) const override {
    return generic::joint_ranges(e_, parameters);
  }
  std::vector<std::pair<std::string, double>> body_masses(std::span<const double> parameters) const override {
    return generic::body_masses(e_, parameters);
  }
  std::function<std::vector<PlacedDrive>(const Pose<double>&)> drives(std::span<const double> parameters,
                                                                      const std::string& mode) const override {
    return DrivePlaces(e_, parameters, mode_index(info(), mode));
  }
  DriveLimits drive_limits(std::span<const double> parameters) const override {
    return generic::drive_limits(e_, parameters);
  }
  std::vector<std::size_t> cables() const override {
    std::vector<std::size_t> joints;
    for (std::size_t i = 0; i < e_.model.tensions.size(); ++i)
      if (e_.model.tensions[i]) joints.push_back(i);
    return joints;
  }
  const std::vector<std::string>& mass_models() const override { return e_.model.mass_models; }
  const std::string& mass_model() const override { return e_.model.mass_model; }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    if (model == mass_model()) return shared_from_this();
    return contains(mass_models(), model) ? e_.model.with_masses(model) : nullptr;
  }

  PlatformCompliance compliance(std::span<const double> parameters, const Pose<double>& pose,
                                const std::string& mode) const override {
    return platform_compliance(e_, parameters, pose, mode_index(info(), mode));
  }
  Reactions find(std::span<const double> parameters, const std::string& mode, const MotionState<double>& state,
                 const AxisVector<double>& acceleration, const Wrench<double>& wrench) const override {
    const PoseReport report = inspect(parameters, state.pose, mode, no_limits(info()));
    if (report.assembles)
      return pkm::reactions(newton_euler(e_, parameters, mode_index(info(), mode), state, acceleration, wrench));
    Reactions none;
    none.reason = report.reason;
    return none;
  }

  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const FieldRequest& request) const override {
    if (const auto of_file = accelerated_plan(plan, request);
        accelerators_.voxels && of_file && accelerators_.voxels->serves(*of_file, voxels, request))
      return accelerators_.voxels->prepare(*of_file, voxels, request);
    return prepare_voxels(e_, plan, voxels, request, accelerated_box(plan, request));
  }
  std::unique_ptr<const PoseSides> prepare_sides(const WorkspacePlan& plan, const std::string& mode) const override {
    return prepare_pose_sides(e_, plan, mode);
  }
  /// The plan without the limits of pose quantities, which accelerators do not support.
  WorkspacePlan without_quantities(WorkspacePlan plan) const {
    for (std::size_t i = info().limits.size(); i-- > 0;)
      if (info().limits[i].group == kQuantityLimit) {
        plan.limits.given.erase(plan.limits.given.begin() + static_cast<std::ptrdiff_t>(i));
        plan.limits.derived.erase(plan.limits.derived.begin() + static_cast<std::ptrdiff_t>(i));
      }
    return plan;
  }
  /// The plan as passed to accelerators; std::nullopt if they do not support the analysis, because the plan limits pose
  /// quantities, or because formulas or the poses of all cells (FieldRequest::every_pose) are requested.
  std::optional<WorkspacePlan> accelerated_plan(const WorkspacePlan& plan, const FieldRequest& request) const {
    if (request.has_formulas() || request.every_pose) return {};
    for (std::size_t i = 0; i < info().limits.size(); ++i)
      if (info().limits[i].group == kQuantityLimit && plan.limits.given[i]) return {};
    return without_quantities(plan);
  }
  /// The search box of the accelerator as a function of the design, so that the generic engine counts the same voxels
  /// as the accelerator; null if there is no accelerator.
  BoxOfDesign accelerated_box(const WorkspacePlan& plan, const FieldRequest& request) const {
    WorkspacePlan unlimited = plan;
    unlimited.limits = no_limits(info());
    const VoxelOptions no_box;
    const FieldRequest of_mode{.mode = request.mode};
    if (!accelerators_.voxels || !accelerators_.voxels->serves(without_quantities(unlimited), no_box, of_mode))
      return {};
    for (std::size_t i = 0; i < unlimited.limits.given.size(); ++i)
      if (i != e_.model.clearance_limit) {
        unlimited.limits.given[i] = plan.limits.given[i];
        unlimited.limits.derived[i] = plan.limits.derived[i];
      }
    const std::shared_ptr<const VoxelEvaluator> voxels =
        accelerators_.voxels->prepare(without_quantities(unlimited), no_box, of_mode);
    return [voxels](std::span<const double> parameters) {
      const VoxelMap map = voxels->map(parameters);
      Box box;
      for (std::size_t axis = 0; axis < 3; ++axis) box[axis] = {map.lower[axis], map.upper[axis]};
      return box;
    };
  }
  bool supports_rotors() const override { return true; }
  bool supports_obstacles() const override { return true; }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const FieldRequest& request) const override {
    if (const auto of_file = accelerated_plan(plan, request);
        accelerators_.columns && of_file && accelerators_.columns->serves(*of_file, columns, request))
      return accelerators_.columns->prepare(*of_file, columns, request);
    return prepare_columns(e_, plan, columns, request);
  }
  bool supports_box() const override { return true; }
  std::shared_ptr<const Mechanism> on_side(std::int8_t side) const override {
    Model model = e_.model;
    const std::size_t n = model.inputs.coordinates;
    if (model.inputs.joints != n) return nullptr;
    expression::TermMatrix J(model.graph, n, n);
    for (std::size_t i = 0; i < n * n; ++i) J(i / n, i % n) = model.term(model.jacobian[i]);
    const expression::Term determinant = expression::inverse_of(J).determinant * static_cast<double>(side);
    model.margins.push_back({.name = "side of the singularities", .unit = "", .node = determinant.node()});
    return std::make_shared<const GenericMechanism>(std::move(model), Accelerators{});
  }
  void require_bounds(const WorkspacePlan& plan) const override { generic::require_bounds(e_.model, plan); }
  VolumeBounds volume(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                      const BoundsOptions& options) const override {
    return bound_volume(*this, e_, parameters, plan, mode_index(info(), mode), options);
  }
  PoseCertificate solid(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                        const PoseSolid& poses, const BoundsOptions& options) const override {
    return certify_solid(e_, parameters, plan, mode_index(info(), mode), poses, options);
  }
  PoseCertificate motion(std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
                         const Motion& motion, const BoundsOptions& options) const override {
    return certify_motion(e_, parameters, limits, mode_index(info(), mode), motion, options);
  }
  Separation separate(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                      const Pose<double>& from, const Pose<double>& to, const BoundsOptions& options) const override {
    return separate_poses(e_, parameters, plan, mode_index(info(), mode), from, to, options);
  }
  std::optional<Influence<double>> influence(std::span<const double> parameters, const Pose<double>& pose,
                                             const std::string& mode) const override {
    return influence_at(e_, parameters, pose, mode_index(info(), mode));
  }
  std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                       const AxisVector<double>& joints) const override {
    return assemblies_of(e_, parameters, joints);
  }
  std::vector<AssemblyMode> assemblies_near(std::span<const double> parameters, const AxisVector<double>& joints,
                                            const Pose<double>& from) const override {
    return generic::assemblies_near(e_, parameters, joints, from);
  }
  ForwardGuarantee guarantee() const override {
    return {false, "found by Newton's method from poses in the search box, until " + std::to_string(kMaxIdleStarts) +
                       " consecutive ones gave no new pose (at most " + std::to_string(kMaxStarts) +
                       "), and from mirror images; there may be others"};
  }
  ForwardStatus status(std::span<const double>, const AxisVector<double>&,
                       const std::vector<AssemblyMode>& found) const override {
    if (found.empty()) return {"NO_POSE", "no pose was found from any of the starting poses"};
    return {};
  }
  std::vector<PlacedLink> place(std::span<const double> parameters, const Pose<double>& pose,
                                const std::string& mode) const override {
    std::vector<double> inputs = e_.inputs(parameters, no_limits(info()), mode_index(info(), mode));
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
    with_scratch<S>(inputs + e_.tests.registers(), [&](std::span<S> memory) {
      e_.fill_inputs<S>(parameters, limits, 0, memory.first(inputs));
      const std::span<S> registers = memory.subspan(inputs);
      e_.tests.run_all<S>(memory.first(inputs), registers);
      for (std::size_t i = 0; i < margins.size(); ++i) margins[i] = registers[e_.tests.outputs()[i]];
    });
  }

  std::string unit() const override { return e_.model.size->unit; }
  std::string meaning() const override { return e_.model.size->meaning; }
  double of(std::span<const double> parameters) const override { return *e_.of_design(e_.size, parameters); }
  Dual4 of(std::span<const Dual4> parameters) const override { return *e_.of_design(e_.size, parameters); }

  Evaluation e_;
  Accelerators accelerators_;
  std::string why_no_columns_;
};

}  // namespace

std::optional<PlatformMobility> platform_mobility(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const Pose<double>& pose, const std::string& mode) {
  const auto* const generic_mechanism = dynamic_cast<const GenericMechanism*>(&mechanism);
  if (!generic_mechanism || !generic_mechanism->evaluation().model.jointed) return {};
  return mobility_at(generic_mechanism->evaluation(), parameters, pose, mode_index(mechanism.info(), mode));
}

const Evaluation* evaluation_of(const Mechanism& mechanism) {
  const auto* const of_file = dynamic_cast<const GenericMechanism*>(&without_drive_trains(mechanism));
  return of_file ? &of_file->evaluation() : nullptr;
}

std::shared_ptr<const Mechanism> make_mechanism(Model model, Accelerators accelerators) {
  if (!model.equations && !model.bodies.empty()) model.equations = equations_of(model);
  model.jacobian = model.equations ? model.equations->J : jacobian_of(model);
  return std::make_shared<const GenericMechanism>(std::move(model), std::move(accelerators));
}

}  // namespace pkm::generic
