// (3CRR/R)&CRU and Quadrupteron as mechanisms of the catalogue.
#include <stdexcept>

#include "engine/core/options.hpp"
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

/// Links overlap by the sum of their radii at most, and no radius is greater than 1 m.
constexpr double kNoClearance = -2;

/// "-,-,+,-"
std::string name_of(const WorkingMode& mode) {
  std::string name;
  for (const int sign : mode) name += (name.empty() ? "" : ",") + std::string(sign > 0 ? "+" : "-");
  return name;
}

/// All 16, the nominal one first.
std::vector<WorkingMode> all_modes() {
  const WorkingMode nominal = {-1, -1, 1, -1};
  std::vector<WorkingMode> modes = {nominal};
  for (int bits = 0; bits < 16; ++bits) {
    const WorkingMode mode = {bits & 8 ? 1 : -1, bits & 4 ? 1 : -1, bits & 2 ? 1 : -1, bits & 1 ? 1 : -1};
    if (mode != nominal) modes.push_back(mode);
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
  i.margin_unit = "m";
  i.columns_take_box = true;
  i.has_influence = true;
  i.has_dynamics = true;
  i.has_reactions = true;
  i.has_links = true;
  i.mass_models = kMassModels;
  i.mass_model = kMassModels[static_cast<std::size_t>(mass_model)];
  i.coordinates = {"x", "y", "z", "phi"};
  i.joints = {"rho1", "rho2", "rho3", "rho4"};
  for (const WorkingMode& mode : all_modes()) i.modes.push_back(name_of(mode));
  i.swept = {0, 1, 2};
  i.held = 3;
  i.column = 2;
  i.volume_unit = "m^3";
  i.more_sweeps = {{{1, 2, 3}, 0, 2, "m^2 rad"}, {{0, 2, 3}, 1, 2, "m^2 rad"}, {{0, 1, 3}, 2, 1, "m^2 rad"}};
  i.limits = {
      {"s_min", "1", 0, 0, 1, "singularity-margin", "", "least |sin(theta_i2)|: distance from limbs' singularities"},
      {"c_min", "1", 0, 0, 1, "singularity-margin", "", "least kappa_p: distance from the parallel singularity"},
      {"clearance_min", "m", kNoClearance, kNoClearance, 100, "clearance", "",
       "least distance of rods of different limbs, platforms and rails; < 0: they may overlap that far"},
  };
  i.characteristic_length = jointed ? "l" : "l + r";
  return i;
}

class CrrCru final : public Mechanism {
 public:
  explicit CrrCru(Platform platform, MassModel mass_model = MassModel::table)
      : platform_(platform), mass_model_(mass_model), info_(make_info(platform, mass_model)) {}

  const MechanismInfo& info() const override { return info_; }

  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const Demand& demand) const override {
    const WorkingMode& mode = demand.mode.empty() ? modes_.front() : mode_called(demand.mode);
    const int held = sweep_of(info_, plan).held;
    if (plan.limits.given[kClearanceMin].value_or(kNoClearance) > kNoClearance) {
      if (plan.method == Method::columns)
        throw std::invalid_argument("mechanism " + info_.name +
                                    " has no column surveys under a clearance (clearance_min), because rods that meet "
                                    "end columns where no formula says; take workspace.method = \"voxels\"");
      if (mode != modes_.front())
        throw std::invalid_argument("mechanism " + info_.name + " surveys a clearance (clearance_min) in the mode " +
                                    name_of(modes_.front()) + " only, so inertia is not surveyed in the mode " +
                                    demand.mode + " beside it");
    }
    const auto make = plan.method == Method::columns ? make_column_surveyor : make_voxel_surveyor;
    return make(platform_, mass_model_, mode, held, plan, demand);
  }
  VoxelMap voxel_map(std::span<const double> p, const SurveyPlan& plan) const override {
    return crr_cru::voxel_map(platform_, modes_.front(), sweep_of(info_, plan).held, p, plan);
  }
  double middle(std::span<const double> p, int coordinate) const override {
    return held_value(geometry(platform_, p), Held{static_cast<std::size_t>(coordinate)});
  }
  void design_margins(std::span<const double>, const LimitSpec&, std::span<double>) const override {}
  void design_margins(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const override {}
  double size(std::span<const double>) const override { return 1; }
  Dual4 size(std::span<const Dual4>) const override { return 1; }
  using Mechanism::thresholds;
  void thresholds(std::span<const Dual4>, const LimitSpec& spec, std::span<Dual4> values) const override {
    const Limits l = limits(spec);
    values[kSMin] = l.s_min;
    values[kCMin] = l.c_min;
    values[kClearanceMin] = l.clearance_min.value_or(kNoClearance);
  }
  NamedValues facts(std::span<const double> p, const LimitSpec&) const override {
    const auto y = yaw(geometry(platform_, p));
    return {{"R", y.R}, {"delta", offset(y)}};
  }
  std::string refuse(std::span<const double> p) const override {
    for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
      const Parameter& parameter = info_.parameters[i];
      if (!(p[i] >= parameter.lower && p[i] <= parameter.upper))
        return parameter.name + " = " + shortest(p[i]) + " is outside the model's range " + shortest(parameter.lower) +
               " to " + shortest(parameter.upper) + " " + parameter.unit;
    }
    if (!(p[kRhoMin] < p[kRhoMax]))
      return "rho_min = " + shortest(p[kRhoMin]) +
             " m leaves the slides no range below rho_max = " + shortest(p[kRhoMax]) + " m";
    const auto g = geometry(platform_, p);
    if (!(yaw(g).R > 1e-9 * g.l)) return "with r = l and beta_2 = 0 no slide controls the yaw";
    return {};
  }
  PoseReport inspect(std::span<const double> p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& spec) const override {
    return crr_cru::inspect(geometry(platform_, p), link_radii(p), limits(spec), pose, mode_called(mode));
  }
  std::optional<Influence<double>> influence(std::span<const double> p, const Pose<double>& pose,
                                             const std::string& mode) const override {
    const Limbs<double> limbs = inverse(geometry(platform_, p), pose, mode_called(mode));
    if (!limbs.assembles) return std::nullopt;
    return crr_cru::influence(limbs.arm);
  }
  std::vector<PlacedLink> links(std::span<const double> p, const Pose<double>& pose,
                                const std::string& mode) const override {
    return placed_links(geometry(platform_, p), link_radii(p), pose, mode_called(mode));
  }
  std::vector<AssemblyMode> forward(std::span<const double> p, const std::array<double, 4>& rho) const override {
    return crr_cru::forward(geometry(platform_, p), rho);
  }

  void pose_margins(std::span<const double> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<double>& margins) const override {
    find_margins(p, spec, poses, margins);
  }
  void pose_margins(std::span<const Dual4> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<Dual4>& margins) const override {
    find_margins(p, spec, poses, margins);
  }

  void dynamics(std::span<const double> p, const std::string& mode, std::span<const MotionState<double>> states,
                std::span<PoseDynamics<double>> out) const override {
    find_dynamics(p, mode, states, out);
  }
  void dynamics(std::span<const Dual4> p, const std::string& mode, std::span<const MotionState<Dual4>> states,
                std::span<PoseDynamics<Dual4>> out) const override {
    find_dynamics(p, mode, states, out);
  }
  Reactions reactions(std::span<const double> p, const std::string& mode, const MotionState<double>& state,
                      const Vector<double, 4>& acceleration, const Wrench<double>& wrench) const override {
    return crr_cru::reactions(geometry(platform_, p), masses(mass_model_, p), mode_called(mode), state, acceleration,
                              wrench);
  }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    for (std::size_t k = 0; k < kMassModels.size(); ++k)
      if (kMassModels[k] == model) return std::make_shared<CrrCru>(platform_, static_cast<MassModel>(k));
    return nullptr;
  }

 private:
  const WorkingMode& mode_called(const std::string& name) const {
    for (const WorkingMode& known : modes_)
      if (name == name_of(known)) return known;
    throw std::invalid_argument("unknown working mode " + name);
  }
  template <class S>
  void find_margins(std::span<const S> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<S>& margins) const {
    const auto g = geometry(platform_, p);
    const Limits l = limits(spec);
    add_margins(design(g, l), poses, margins);
    if (l.clearance_min) add_clearances(g, link_radii(p), *l.clearance_min, modes_.front(), poses, margins);
  }
  template <class S>
  void find_dynamics(std::span<const S> p, const std::string& mode, std::span<const MotionState<S>> states,
                     std::span<PoseDynamics<S>> out) const {
    const WorkingMode& signs = mode_called(mode);
    const auto g = geometry(platform_, p);
    const auto b = masses(mass_model_, p);
    for (std::size_t i = 0; i < states.size(); ++i) out[i] = pose_dynamics(g, b, states[i], signs);
  }

  Platform platform_;
  MassModel mass_model_;
  MechanismInfo info_;
  std::vector<WorkingMode> modes_ = all_modes();
};

}  // namespace

std::shared_ptr<const Mechanism> make_three_crr_r_cru() { return std::make_shared<CrrCru>(Platform::jointed); }
std::shared_ptr<const Mechanism> make_quadrupteron() { return std::make_shared<CrrCru>(Platform::rigid); }

}  // namespace pkm
