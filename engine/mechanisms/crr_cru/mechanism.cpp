// (3CRR/R)&CRU and Quadrupteron as mechanisms of the catalogue.
#include <stdexcept>

#include "engine/core/options.hpp"
#include "engine/mechanism/both_scalars.hpp"
#include "engine/mechanism/with_abilities.hpp"
#include "engine/mechanisms/crr_cru/bodies.hpp"
#include "engine/mechanisms/crr_cru/dynamics.hpp"
#include "engine/mechanisms/crr_cru/forward.hpp"
#include "engine/mechanisms/crr_cru/inspect.hpp"
#include "engine/mechanisms/crr_cru/margins.hpp"
#include "engine/mechanisms/crr_cru/survey.hpp"
#include "engine/mechanisms/list.hpp"

namespace pkm {
namespace {

using namespace crr_cru;

/// All 16, the nominal one first.
std::vector<std::string> all_modes() {
  std::vector<std::string> modes = {"-,-,+,-"};
  for (int bits = 0; bits < 16; ++bits) {
    std::string mode = "-,-,-,-";
    for (std::size_t i = 0; i < 4; ++i)
      if (bits & 8 >> i) mode[2 * i] = '+';
    if (mode != modes.front()) modes.push_back(mode);
  }
  return modes;
}

/// Names of the mass models, in the order of MassModel.
const std::vector<std::string> kMassModels = {"table", "geometry"};

MechanismInfo make_info(Platform platform, MassModel mass_model) {
  const bool jointed = platform == Platform::jointed;
  MechanismInfo i;
  i.name = jointed ? "3crr-r-cru" : "quadrupteron";
  i.title = jointed ? "(3CRR/R)&CRU: three CRR limbs on a middle platform, a CRU limb turns the moving one"
                    : "Quadrupteron: three CRU limbs and a CRR limb on one platform";
  i.source =
      "Transactions of the Chinese Society for Agricultural Machinery 54 (9), 2023, 448-458 ((3CRR/R)&CRU and the "
      "Quadrupteron that it is derived from)";
  const double rods[4][2] = {{0.170, 0.225}, {0.237, 0.208}, {0.223, 0.179}, {0.166, 0.223}};
  for (std::size_t limb = 0; limb < 4; ++limb)
    for (std::size_t rod = 0; rod < 2; ++rod)
      i.parameters.push_back(
          {"l_" + std::to_string(limb + 1) + std::to_string(rod + 1), "m", rods[limb][rod], 1e-3, 100,
           "length of limb " + std::to_string(limb + 1) + "'s rod next to the " + (rod == 0 ? "slide" : "platform")});
  const char* const angle = "angle of limb ";
  i.parameters.insert(
      i.parameters.end(),
      {{"r", "m", 0.040, 0, 100, "radius of the circle of the platform joints of limbs 1 to 3"},
       {"h", "m", 0.020, -100, 100, "height of D above the circle's centre N"},
       {"l", "m", 0.067, 1e-3, 100, "arm from D to the platform joint of limb 4"},
       {"L", "m", 0.400, 1e-3, 100, "spacing of the rails"},
       {"beta_1", "rad", kPi / 3, -4 * kPi, 4 * kPi, angle + std::string("1's joint on the circle")},
       {"beta_2", "rad", kPi, -4 * kPi, 4 * kPi, angle + std::string("2's joint on the circle")},
       {"beta_3", "rad", 5 * kPi / 3, -4 * kPi, 4 * kPi, angle + std::string("3's joint on the circle")},
       {"rho_min", "m", 0, -100, 100, "where the slides' range begins"},
       {"rho_max", "m", 0.400, -100, 100, "where the slides' range ends"}});
  for (Parameter& parameter : mass_parameters(mass_model)) i.parameters.push_back(std::move(parameter));
  i.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"phi", "rad"}};
  i.joints = {{"rho1", "m"}, {"rho2", "m"}, {"rho3", "m"}, {"rho4", "m"}};
  i.modes = all_modes();
  i.sweeps = {{.swept = {0, 1, 2}, .held = {3}, .column = 2},
              {.swept = {1, 2, 3}, .held = {0}, .column = 2},
              {.swept = {0, 2, 3}, .held = {1}, .column = 2},
              {.swept = {0, 1, 3}, .held = {2}, .column = 1}};
  i.limits = {
      {"s_min", "1", 0, 0, 1, "singularity-margin", "", "least |sin(theta_i2)|: distance from limbs' singularities"},
      {"c_min", "1", 0, 0, 1, "singularity-margin", "", "least kappa_p: distance from the parallel singularity"},
      {"clearance_min", "m", kNoClearance, kNoClearance, 100, "clearance", "",
       "least distance of rods of different limbs, platforms and rails; < 0: they may overlap that far"},
  };
  i.characteristic_length = jointed ? "l" : "l + r";
  return i;
}

class CrrCru final : public MechanismWith<Voxels, Columns, PoseMarginsOf<CrrCru>, Velocities, ForwardKinematics,
                                          pkm::Links, DynamicsOf<CrrCru>, JointReactions> {
 public:
  explicit CrrCru(Platform platform, MassModel mass_model = MassModel::table)
      : platform_(platform), mass_model_(mass_model), info_(make_info(platform, mass_model)) {}

  const MechanismInfo& info() const override { return info_; }
  std::optional<double> middle(std::span<const double> p, int coordinate) const override {
    return held_value(geometry(platform_, p), Held{static_cast<std::size_t>(coordinate)});
  }
  NamedValues facts(std::span<const double> p, const LimitSpec&) const override {
    const auto y = yaw(geometry(platform_, p));
    return {{"R", y.R}, {"delta", offset(y)}};
  }
  Refusal refuse(std::span<const double> p) const override {
    if (Refusal outside = Mechanism::refuse(p)) return outside;
    if (!(p[kRhoMin] < p[kRhoMax]))
      return "rho_min = " + shortest(p[kRhoMin]) +
             " m leaves the slides no range below rho_max = " + shortest(p[kRhoMax]) + " m";
    const auto g = geometry(platform_, p);
    if (!(yaw(g).R > 1e-9 * g.l)) return "with r = l and beta_2 = 0 no slide controls the yaw";
    return {};
  }
  PoseReport inspect(std::span<const double> p, const pkm::Pose<double>& pose, const std::string& mode,
                     const LimitSpec& spec) const override {
    return crr_cru::inspect(geometry(platform_, p), link_radii(p), limits(spec), schoenflies(pose), mode_called(mode));
  }

 private:
  friend PoseMarginsOf<CrrCru>;
  static constexpr const char* kMarginUnit = "m";
  friend DynamicsOf<CrrCru>;

  std::unique_ptr<const VoxelSurveyor> prepare(const SurveyPlan& plan, const VoxelOptions& voxels,
                                               const Demand& demand) const override {
    if (asks_clearance(plan, kClearanceMin) && mode_called(demand.mode) != mode_called(""))
      throw std::invalid_argument("mechanism " + info_.name + " surveys a clearance (clearance_min) in the mode " +
                                  info_.modes.front() + " only, so inertia is not surveyed in the mode " + demand.mode +
                                  " beside it");
    return make_surveyor(planned(plan, demand), voxels);
  }
  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const ColumnOptions& columns,
                                          const Demand& demand) const override {
    if (asks_clearance(plan, kClearanceMin))
      throw std::invalid_argument("mechanism " + info_.name +
                                  " has no column surveys under a clearance (clearance_min), because rods that meet "
                                  "end columns where no formula says; take workspace.method = \"voxels\"");
    return make_surveyor(planned(plan, demand), columns);
  }
  bool take_box() const override { return true; }
  bool take_rotors() const override { return true; }
  bool take_obstacles() const override { return true; }

  std::optional<pkm::Influence<double>> influence(std::span<const double> p, const pkm::Pose<double>& pose,
                                                  const std::string& mode) const override {
    const Limbs<double> limbs = inverse(geometry(platform_, p), schoenflies(pose), mode_called(mode));
    if (!limbs.assembles) return std::nullopt;
    return crr_cru::influence(limbs.arm);
  }
  std::vector<PlacedLink> place(std::span<const double> p, const pkm::Pose<double>& pose,
                                const std::string& mode) const override {
    return placed_links(geometry(platform_, p), link_radii(p), schoenflies(pose), mode_called(mode));
  }
  std::vector<AssemblyMode> assemblies(std::span<const double> p, const AxisVector<double>& rho) const override {
    return crr_cru::forward(geometry(platform_, p), rho);
  }
  Reactions find(std::span<const double> p, const std::string& mode, const pkm::MotionState<double>& state,
                 const AxisVector<double>& acceleration, const Wrench<double>& wrench) const override {
    const auto g = geometry(platform_, p);
    const auto b = masses(mass_model_, p);
    const Limbs<double> limbs = inverse(g, schoenflies(state.pose), mode_called(mode));
    if (limbs.assembles) return pkm::reactions(newton_euler(g, b, limbs, state, fixed<4>(acceleration), wrench));
    Reactions none;
    none.reason = inspect(p, state.pose, mode, no_limits(info_)).reason;
    return none;
  }
  const std::vector<std::string>& mass_models() const override { return kMassModels; }
  const std::string& mass_model() const override { return kMassModels[static_cast<std::size_t>(mass_model_)]; }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    for (std::size_t k = 0; k < kMassModels.size(); ++k)
      if (kMassModels[k] == model) return std::make_shared<CrrCru>(platform_, static_cast<MassModel>(k));
    return nullptr;
  }

  Planned planned(const SurveyPlan& plan, const Demand& demand) const {
    const HeldCoordinate held = how_held(plan, sweep_of(info_, plan).held.front());
    return {.platform = platform_,
            .mass_model = mass_model_,
            .mode = mode_called(demand.mode),
            .held = {static_cast<std::size_t>(held.coordinate), held.kind == HeldCoordinate::Kind::middle, held.value},
            .limits = limits(plan.limits),
            .demand = demand};
  }
  WorkingMode mode_called(const std::string& name) const {
    const std::string& signs = info_.modes[number_of_mode(info_, name)];
    WorkingMode mode;
    for (std::size_t i = 0; i < 4; ++i) mode[i] = signs[2 * i] == '+' ? 1 : -1;
    return mode;
  }
  template <class S>
  void find_margins(std::span<const S> p, const std::string& mode, const LimitSpec& spec,
                    std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) const {
    const auto g = geometry(platform_, p);
    const Limits l = limits(spec);
    add_margins(design(g, l), poses, margins);
    if (l.clearance_min) add_clearances(g, link_radii(p), l, mode_called(mode), poses, margins);
  }
  template <class S>
  void find_dynamics(std::span<const S> p, const std::string& mode, std::span<const pkm::MotionState<S>> states,
                     std::span<pkm::PoseDynamics<S>> out) const {
    const WorkingMode signs = mode_called(mode);
    const auto g = geometry(platform_, p);
    const auto b = masses(mass_model_, p);
    for (std::size_t i = 0; i < states.size(); ++i) out[i] = pose_dynamics<S>(g, b, states[i], signs);
  }

  Platform platform_;
  MassModel mass_model_;
  MechanismInfo info_;
};

}  // namespace

std::shared_ptr<const Mechanism> make_three_crr_r_cru() { return std::make_shared<CrrCru>(Platform::jointed); }
std::shared_ptr<const Mechanism> make_quadrupteron() { return std::make_shared<CrrCru>(Platform::rigid); }

}  // namespace pkm
