// 4PPa-2PaR as a mechanism of the catalogue.
#include <stdexcept>

#include "engine/core/options.hpp"
#include "engine/mechanism/both_scalars.hpp"
#include "engine/mechanism/with_abilities.hpp"
#include "engine/mechanisms/four_ppa_two_par/dynamics.hpp"
#include "engine/mechanisms/four_ppa_two_par/links.hpp"
#include "engine/mechanisms/four_ppa_two_par/margins.hpp"
#include "engine/mechanisms/four_ppa_two_par/survey.hpp"
#include "engine/mechanisms/list.hpp"

namespace pkm {
namespace {

using namespace four_ppa_two_par;

/// The one mass model: every mass is a length times a mass per length.
const std::vector<std::string> kMassModels = {"geometry"};

const std::vector<DesignMarginInfo> kDesignTests = {
    {"workspace-shape", "m", "l_d - sqrt(l_u^2 + (b - a cos_theta_min)^2) / 2, eq 21 at the least cos(theta) allowed"},
    {"rail-length", "m", "L0 - 2 l_u cos(alpha_min), eq 18"},
};

MechanismInfo make_info() {
  MechanismInfo i;
  i.name = "4ppa-2par";
  i.title = "two limbs of two sliders each on two parallel rails, parallelograms down to a common platform";
  i.source = "Kinematics analysis and optimal design of a 3T1R parallel mechanism (4PPa-2PaR)";
  i.parameters = {
      {"a", "m", 0.2, 1e-3, 100, "distance of the platform's two revolute joints"},
      {"b", "m", 0.8, 1e-3, 100, "distance of the rails"},
      {"l_u", "m", 0.6, 1e-3, 100, "bar length of the upper parallelograms"},
      {"l_d", "m", 0.55, 1e-3, 100, "bar length of the lower parallelograms"},
      {"d", "m", 0.15, 0, 100, "height of the lower joints above the platform"},
      {"L0", "m", 2.5, 0, 100, "rail length"},
      {"R_u", "m", 0.010, 0, 1, "radius of the upper bars"},
      {"R_d", "m", 0.010, 0, 1, "radius of the lower bars"},
      {"d_u", "m", 0.080, 1e-3, 10, "distance of an upper parallelogram's two bars"},
      {"d_d", "m", 0.080, 1e-3, 10, "distance of the lower parallelogram's two bars"},
      {"d_0", "m", 0.030, 0, 10, "length of a slider beyond its outer joint"},
      {"R_p", "m", 0.020, 0, 1, "radius of the platform as a capsule"},
      {"R_s", "m", 0.020, 0, 1, "radius of the sliders as capsules"},
  };
  for (Parameter& parameter : mass_parameters()) i.parameters.push_back(std::move(parameter));
  i.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"theta", "rad"}};
  i.joints = {{"q1", "m"}, {"q2", "m"}, {"q3", "m"}, {"q4", "m"}};
  i.modes = {"lower,lower", "lower,upper", "upper,lower", "upper,upper"};
  i.sweeps = {{.swept = {0, 2, 3}, .held = {1}, .column = 2, .integrates = true}};
  constexpr double quarter = kPi / 2;
  i.limits = {
      {"alpha_min", "rad", 0, 0, quarter, "interference", "asin(2 R_u / d_u), eq 17",
       "least angle of the upper bars with the rail"},
      {"beta_min", "rad", 0, 0, quarter, "interference", "asin(2 R_d / d_d), eq 17",
       "least angle of the lower bars from the vertical"},
      {"beta_max", "rad", quarter, 0, quarter, "singularity-margin", "",
       "greatest angle of the lower bars from the vertical, eq 20"},
      {"h_min", "m", 0, 0, 100, "singularity-margin", "d_0 + d_u / 2, eq 19", "least half spacing of a limb's sliders"},
      {"sin_par_min", "1", 0, 0, 1, "singularity-margin", "", "least sin(beta_1 + beta_2), eq 15"},
      {"cos_theta_min", "1", 0, 0, 1, "singularity-margin", "", "least cos(theta), eq 15"},
      {"clearance_min", "m", kNoClearance, kNoClearance, 100, "clearance", "",
       "least distance of links of different limbs, platform and sliders; < 0: they may overlap that far"},
  };
  i.characteristic_length = "a / 2";
  return i;
}

/// Distance of the nearest two links, or of a link and an obstacle.
template <class S>
S clearance_of(const Geometry<S>& g, const Limbs<S>& limb, double sin_theta, double y, const Obstacles& obstacles,
               WorkingMode mode) {
  four_ppa_two_par::Links<S> all = links(g, placement(limb, S(sin_theta), mode));
  const S between = nearest_links(all).clearance;
  std::vector<std::size_t> moving;
  for (Capsule<S>& link : all) {  // they are in a frame at the platform's y
    link.axis.from[1] = link.axis.from[1] + y;
    link.axis.to[1] = link.axis.to[1] + y;
    moving.push_back(moving.size());
  }
  return min(between, pkm::nearest_obstacle<S>(all, moving, obstacles).clearance);
}

/// Appends the margins of a pose, each in its own unit; of one that does not assemble, how far its limbs reach.
template <class S>
void add_margins(const Geometry<S>& g, const Limits<S>& l, const Obstacles& obstacles, const pkm::Pose<double>& at,
                 WorkingMode mode, std::vector<S>& all) {
  const auto [sin_theta, cos_theta] = sincos(at[3]);
  const Limbs<S> limb = inverse(g, SchoenfliesPose<S>{S(at[0]), S(at[1]), S(at[2]), S(at[3])}, mode);
  const std::array<S, kMargins> margin = margins(g, l, limb, cos_theta, mode);
  const std::size_t count = limb.assembles ? kFirstLimit + kClearanceMin : kBelowRail;
  all.insert(all.end(), margin.begin(), margin.begin() + count);
  if (limb.assembles && l.clearance_min)
    all.push_back(clearance_of(g, limb, sin_theta, at[1], obstacles, mode) - *l.clearance_min);
}

/// Eq 21, upper and lower part separate at the least cos(theta) allowed; eq 18.
template <class S>
void margins_of(std::span<const S> p, const LimitSpec& spec, std::span<S> margins) {
  const auto g = geometry(p);
  const auto l = limits(g, spec);
  const S w = g.b - g.a * l.cos_theta_min;
  margins[0] = g.l_d - sqrt(S(g.l_u * g.l_u + w * w)) * 0.5;
  margins[1] = g.L0 - 2.0 * g.l_u * l.cos_alpha_min;
}

/// V_mech of table 8.
template <class S>
S size_of(std::span<const S> p) {
  return kPi * p[kB] * (p[kLu] + p[kLd]);
}

template <class S>
void thresholds_of(std::span<const S> p, const LimitSpec& spec, std::span<S> values) {
  const auto g = geometry(p);
  const auto l = limits(g, spec);
  values[kAlphaMin] = asin(l.sin_alpha_min);
  values[kBetaMin] = asin(l.sin_beta_min);
  values[kBetaMax] = atan2(l.sin_beta_max, l.cos_beta_max);
  values[kHMin] = l.h_min;
  values[kSinParMin] = l.sin_par_min;
  values[kCosThetaMin] = l.cos_theta_min;
  values[kClearanceMin] = S(l.clearance_min.value_or(kNoClearance));
}

class FourPpaTwoPar final : public MechanismWith<Voxels, Columns, Size, DesignTests, PoseMarginsOf<FourPpaTwoPar>,
                                                 Velocities, ForwardKinematics, pkm::Links, DynamicsOf<FourPpaTwoPar>> {
 public:
  const MechanismInfo& info() const override { return info_; }

  std::optional<double> middle(std::span<const double> p, int) const override { return middle_plane(geometry(p)); }
  std::optional<std::array<double, 2>> reach(std::span<const double> p, int) const override {
    return std::array{0.0, p[kL0]};  // of y: between the rails' ends
  }
  void thresholds(std::span<const double> p, const LimitSpec& spec, std::span<double> values) const override {
    thresholds_of(p, spec, values);
  }
  void thresholds(std::span<const Dual4> p, const LimitSpec& spec, std::span<Dual4> values) const override {
    thresholds_of(p, spec, values);
  }
  NamedValues facts(std::span<const double> p, const LimitSpec& spec) const override {
    const auto g = geometry(p);
    return {{"shape_type_at_theta_0", section_type(g, 1)},
            {"shape_type_at_greatest_theta", section_type(g, limits(g, spec).cos_theta_min)}};
  }
  PoseReport inspect(std::span<const double> p, const pkm::Pose<double>& pose, const std::string& mode,
                     const LimitSpec& spec) const override {
    const auto g = geometry(p);
    return four_ppa_two_par::inspect(g, limits(g, spec), spec.obstacles, schoenflies(pose), mode_called(mode));
  }

 private:
  friend DynamicsOf<FourPpaTwoPar>;
  friend PoseMarginsOf<FourPpaTwoPar>;
  static constexpr const char* kMarginUnit = "";

  template <class S>
  void find_margins(std::span<const S> p, const std::string& mode, const LimitSpec& spec,
                    std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) const {
    const auto g = geometry(p);
    const Limits<S> l = limits(g, spec);
    for (const pkm::Pose<double>& pose : poses) add_margins(g, l, spec.obstacles, pose, mode_called(mode), margins);
  }
  bool take_rotors() const override { return true; }
  std::unique_ptr<const VoxelSurveyor> prepare(const SurveyPlan& plan, const VoxelOptions& voxels,
                                               const Demand& demand) const override {
    return make_voxel_surveyor(plan, voxels, demand);
  }
  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const ColumnOptions& columns,
                                          const Demand& demand) const override {
    if (asks_clearance(plan, kClearanceMin) && !plan.limits.obstacles.empty())
      throw std::invalid_argument("mechanism " + info_.name +
                                  " has no column surveys under a clearance (clearance_min) from obstacles, because "
                                  "links that meet them end columns where no formula says; take workspace.method = "
                                  "\"voxels\"");
    return make_column_surveyor(plan, columns, demand);
  }

  std::string unit() const override { return "m^2"; }
  std::string meaning() const override { return "pi b (l_u + l_d)"; }
  double of(std::span<const double> p) const override { return size_of(p); }
  Dual4 of(std::span<const Dual4> p) const override { return size_of(p); }
  const std::vector<DesignMarginInfo>& list() const override { return kDesignTests; }
  void test(std::span<const double> p, const LimitSpec& spec, std::span<double> margins) const override {
    margins_of(p, spec, margins);
  }
  void test(std::span<const Dual4> p, const LimitSpec& spec, std::span<Dual4> margins) const override {
    margins_of(p, spec, margins);
  }

  std::optional<pkm::Influence<double>> influence(std::span<const double> p, const pkm::Pose<double>& pose,
                                                  const std::string& mode) const override {
    return four_ppa_two_par::influence(geometry(p), schoenflies(pose), mode_called(mode));
  }
  std::vector<PlacedLink> place(std::span<const double> p, const pkm::Pose<double>& pose,
                                const std::string& mode) const override {
    return placed_links(geometry(p), schoenflies(pose), mode_called(mode));
  }
  std::vector<AssemblyMode> assemblies(std::span<const double> p, const AxisVector<double>& q) const override {
    return four_ppa_two_par::forward(geometry(p), q);
  }
  const std::vector<std::string>& mass_models() const override { return kMassModels; }
  const std::string& mass_model() const override { return kMassModels.front(); }
  std::shared_ptr<const Mechanism> with_masses(const std::string& model) const override {
    return model == kMassModels.front() ? std::make_shared<FourPpaTwoPar>() : nullptr;
  }

  WorkingMode mode_called(const std::string& name) const {
    const std::size_t i = number_of_mode(info_, name);
    return {i & 2 ? Branch::upper : Branch::lower, i & 1 ? Branch::upper : Branch::lower};
  }
  template <class S>
  void find_dynamics(std::span<const S> p, const std::string& mode, std::span<const pkm::MotionState<S>> states,
                     std::span<pkm::PoseDynamics<S>> out) const {
    const WorkingMode branches = mode_called(mode);
    const auto g = geometry(p);
    const auto b = masses(p);
    for (std::size_t i = 0; i < states.size(); ++i) out[i] = pose_dynamics<S>(g, b, states[i], branches);
  }

  MechanismInfo info_ = make_info();
};

}  // namespace

std::shared_ptr<const Mechanism> make_four_ppa_two_par() { return std::make_shared<FourPpaTwoPar>(); }

}  // namespace pkm
