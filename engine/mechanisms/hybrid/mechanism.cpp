// The hybrid robot as a mechanism of the catalogue.
#include <algorithm>
#include <stdexcept>

#include "engine/core/options.hpp"
#include "engine/mechanisms/hybrid/forward.hpp"
#include "engine/mechanisms/hybrid/influence.hpp"
#include "engine/mechanisms/hybrid/inspect.hpp"
#include "engine/mechanisms/hybrid/survey.hpp"
#include "engine/mechanisms/list.hpp"

namespace pkm {
namespace {

using namespace hybrid;

/// Signs of n1, n2, n3, and the required one of N2.
struct Mode {
  WorkingMode signs;
  int branch;
};

const char* sign_name(int sign) { return sign > 0 ? "+" : sign < 0 ? "-" : "0"; }

/// "+,-,-"
std::string name_of(const WorkingMode& signs) {
  return std::string(sign_name(signs[0])) + "," + sign_name(signs[1]) + "," + sign_name(signs[2]);
}

/// "+,-,-", or "+,-,-/-" where N2 < 0 is required.
std::string name_of(const Mode& mode) { return name_of(mode.signs) + (mode.branch < 0 ? "/-" : ""); }

/// All 16, those with N2 > 0 first and the nominal one first of all.
std::vector<Mode> all_modes() {
  std::vector<Mode> modes;
  for (const int branch : {1, -1})
    for (const int w1 : {1, -1})
      for (const int w2 : {-1, 1})
        for (const int w3 : {-1, 1}) modes.push_back({{w1, w2, w3}, branch});
  return modes;
}

MechanismInfo make_info() {
  MechanismInfo i;
  i.name = "2t1r-p-hybrid";
  i.title = "two P-R-R-R limbs and a P-U-U limb on a carriage, with an auxiliary chain that turns a tool";
  i.source = "Kinematics Analysis and Dynamic Simulation of a Novel Mixed-connection Manipulator";
  i.parameters = hybrid::parameters();
  i.coordinates = {"x", "y", "z", "beta"};
  i.joints = {"s1", "s2", "s3", "s4"};
  for (const Mode& mode : all_modes()) i.modes.push_back(name_of(mode));
  i.branches = {"+", "-"};
  i.swept = {0, 2, 3};
  i.held = 1;
  i.column = 0;
  i.held_can_integrate = true;
  i.volume_unit = "m^2 rad";
  i.integrated_unit = "m^3 rad";
  i.size_unit = "m^2";
  i.size_meaning = "(2 a + L1 + L2) L3";
  for (const ParameterIndex tau : {kTauS, kTauP, kTauC}) {
    const Parameter& own = i.parameters[tau];
    i.limits.push_back({own.name, own.unit, own.nominal, own.lower, own.upper, "singularity-margin", "", own.meaning});
  }
  i.limits.push_back({"clearance_min", "m", kNoClearance, kNoClearance, 100, "clearance", "",
                      "least distance of links that do not share a joint; < 0: they may overlap that far. Where it is "
                      "not given, poses need 0 and surveys leave the links' thickness out"});
  i.characteristic_length = "e";
  i.margin_unit = "m";
  i.has_influence = true;
  i.has_links = true;
  i.chain_input = "theta";
  i.chain_output = "gamma";
  return i;
}

/// Pose margins in one unit: lengths as they are, angles and ratios at the length e.
bool is_length(std::size_t margin) {
  return (margin >= kStroke1 && margin <= kZClearance) || margin == kCarriageGap || margin >= kAuxLength;
}

/// The platform and links A and B stretched along their rails, by link C.
template <class S>
S size_of(std::span<const S> p) {
  return (p[kA] * 2.0 + p[kL1] + p[kL2]) * p[kL3];
}

class Hybrid final : public Mechanism {
 public:
  const MechanismInfo& info() const override { return info_; }

  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const Demand& demand) const override {
    sweep_of(info_, plan);  // refuses a plan that holds another coordinate than y
    const Mode& mode = demand.mode.empty() ? modes_.front() : mode_called(demand.mode);
    return make_surveyor(mode.signs, mode.branch, plan, demand);
  }
  VoxelMap voxel_map(std::span<const double> p, const SurveyPlan& plan) const override {
    return hybrid::voxel_map(modes_.front().signs, modes_.front().branch, p, plan);
  }
  double middle(std::span<const double> p, int) const override { return (p[kSMin + 1] + p[kSMax + 1]) / 2; }
  void design_margins(std::span<const double>, const LimitSpec&, std::span<double>) const override {}
  void design_margins(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const override {}
  double size(std::span<const double> p) const override { return size_of(p); }
  Dual4 size(std::span<const Dual4> p) const override { return size_of(p); }
  void thresholds(std::span<const double> p, const LimitSpec& spec, std::span<double> values) const override {
    find_thresholds(p, spec, values);
  }
  void thresholds(std::span<const Dual4> p, const LimitSpec& spec, std::span<Dual4> values) const override {
    find_thresholds(p, spec, values);
  }
  NamedValues facts(std::span<const double>, const LimitSpec&) const override { return {}; }
  std::string refuse(std::span<const double> p) const override {
    for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
      const Parameter& parameter = info_.parameters[i];
      if (!(p[i] >= parameter.lower && p[i] <= parameter.upper))
        return parameter.name + " = " + shortest(p[i]) + " is outside the model's range " + shortest(parameter.lower) +
               " to " + shortest(parameter.upper) + " " + parameter.unit;
    }
    const auto empty = [&](std::size_t least, std::size_t greatest) -> std::string {
      const Parameter &low = info_.parameters[least], &high = info_.parameters[greatest];
      if (p[least] < p[greatest]) return {};
      return low.name + " = " + shortest(p[least]) + " " + low.unit + " leaves no range below " + high.name + " = " +
             shortest(p[greatest]) + " " + high.unit;
    };
    std::string reason;
    for (std::size_t i = 0; i < 4 && reason.empty(); ++i) reason = empty(kSMin + i, kSMax + i);
    if (reason.empty()) reason = empty(kBetaMin, kBetaMax);
    return reason.empty() ? empty(kLwMin, kLwMax) : reason;
  }
  PoseReport inspect(std::span<const double> p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& spec) const override {
    const Mode& named = mode_called(mode);
    return hybrid::inspect(geometry(p), limits(p, spec), pose, named.signs, named.branch);
  }
  void pose_margins(std::span<const double> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<double>& margins) const override {
    find_margins(p, spec, poses, margins);
  }
  void pose_margins(std::span<const Dual4> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<Dual4>& margins) const override {
    find_margins(p, spec, poses, margins);
  }
  std::optional<Influence<double>> influence(std::span<const double> p, const Pose<double>& pose,
                                             const std::string& mode) const override {
    const auto g = geometry(p);
    const Joints<double> j = inverse(g, pose, mode_called(mode).signs);
    if (!j.assembles() || j.serial) return std::nullopt;
    return hybrid::influence(g, pose, j);
  }
  std::vector<PlacedLink> links(std::span<const double> p, const Pose<double>& pose,
                                const std::string& mode) const override {
    return placed_links(p, pose, mode_called(mode).signs);
  }
  ChainReport chain(std::span<const double> p, const MotionSample& at, double phase) const override {
    return inspect_chain(geometry(p), at, phase);
  }
  std::optional<double> chain_input(std::span<const double> p, const Pose<double>& pose, double output,
                                    double phase) const override {
    const auto g = geometry(p);
    const Forks<double> k = forks(shaft(g, pose), pose.angle, phase);
    if (!k.turns) return std::nullopt;
    return input_angle(g, k, output);
  }
  std::vector<AssemblyMode> forward(std::span<const double> p, const std::array<double, 4>& s) const override {
    std::vector<AssemblyMode> modes;
    for (const Assembly& found : hybrid::forward(geometry(p), s).assemblies) {
      AssemblyMode mode{found.pose, std::string(sign_name(found.sign_z)) + "," + sign_name(found.sign_N2)};
      mode.working_mode = name_of(found.mode);
      if (found.double_z) mode.double_roots.push_back("z");
      if (found.double_beta) mode.double_roots.push_back("beta");
      modes.push_back(std::move(mode));
    }
    return modes;
  }
  ForwardStatus forward_status(std::span<const double> p, const std::array<double, 4>& s) const override {
    static const std::array<ForwardStatus, 5> meanings = {
        {{},
         {"NO_XZ", "the carriages A and B are too far apart, or as far apart as links of different lengths can't be"},
         {"DEGENERATE_XZ", "A'' and B'' are as far apart as A' and B', so that the parallelogram moves freely"},
         {"NO_BETA", "link C does not reach the platform's joint C' for any beta"},
         {"DEGENERATE_BETA", "C' turns about the foot of link C, so that every beta assembles"}}};
    return meanings[static_cast<std::size_t>(hybrid::forward(geometry(p), s).status)];
  }

 private:
  const Mode& mode_called(const std::string& name) const {
    for (const Mode& known : modes_)
      if (name == name_of(known)) return known;
    throw std::invalid_argument("unknown working mode " + name);
  }
  template <class S>
  void find_thresholds(std::span<const S> p, const LimitSpec& spec, std::span<S> values) const {
    const Limits<S> l = limits(p, spec);
    values[kTauSLimit] = l.tau_s;
    values[kTauPLimit] = l.tau_p;
    values[kTauCLimit] = l.tau_c;
    values[kClearanceMin] = l.clearance_min;
  }
  template <class S>
  void find_margins(std::span<const S> p, const LimitSpec& spec, std::span<const Pose<double>> poses,
                    std::vector<S>& margins) const {
    const auto g = geometry(p);
    const Limits<S> l = limits(p, spec);
    const Mode& mode = modes_.front();
    for (const Pose<double>& at : poses) {
      const Pose<S> pose{S(at.x), S(at.y), S(at.z), S(at.angle)};
      const Margins<S> found = hybrid::margins(g, l, pose, inverse(g, pose, mode.signs), mode.branch);
      for (std::size_t i = 0; i < kMargins; ++i) margins.push_back(is_length(i) ? found[i] : S(found[i] * g.e));
    }
  }

  MechanismInfo info_ = make_info();
  std::vector<Mode> modes_ = all_modes();
};

}  // namespace

std::shared_ptr<const Mechanism> make_hybrid() { return std::make_shared<Hybrid>(); }

}  // namespace pkm
