// The hybrid robot as a mechanism of the catalogue.
#include <algorithm>

#include "engine/core/options.hpp"
#include "engine/mechanism/both_scalars.hpp"
#include "engine/mechanism/with_abilities.hpp"
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
  i.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"beta", "rad"}};
  i.joints = {{"s1", "m"}, {"s2", "m"}, {"s3", "m"}, {"s4", "m"}};
  for (const Mode& mode : all_modes()) i.modes.push_back(name_of(mode));
  i.branches = {"+", "-"};
  i.sweeps = {{.swept = {0, 2, 3}, .held = {1}, .column = 0, .integrates = true}};
  for (const ParameterIndex tau : {kTauS, kTauP, kTauC}) {
    const Parameter& own = i.parameters[tau];
    i.limits.push_back({own.name, own.unit, own.nominal, own.lower, own.upper, "singularity-margin", "", own.meaning});
  }
  i.limits.push_back({"clearance_min", "m", kNoClearance, kNoClearance, 100, "clearance", "",
                      "least distance of links that do not share a joint; < 0: they may overlap that far. Where it is "
                      "not given, poses need 0 and surveys leave the links' thickness out"});
  i.characteristic_length = "e";
  return i;
}

/// The platform and links A and B stretched along their rails, by link C.
template <class S>
S size_of(std::span<const S> p) {
  return (p[kA] * 2.0 + p[kL1] + p[kL2]) * p[kL3];
}

class Hybrid final : public MechanismWith<Voxels, Columns, Size, PoseMarginsOf<Hybrid>, Velocities, ForwardKinematics,
                                          pkm::Links, AuxiliaryChain> {
 public:
  const MechanismInfo& info() const override { return info_; }

  std::optional<double> middle(std::span<const double> p, int) const override {
    return (p[kSMin + 1] + p[kSMax + 1]) / 2;
  }
  std::optional<std::array<double, 2>> reach(std::span<const double> p, int) const override {
    return std::array{p[kSMin + 1], p[kSMax + 1]};  // of y: the carriage's way
  }
  void thresholds(std::span<const double> p, const LimitSpec& spec, std::span<double> values) const override {
    find_thresholds(p, spec, values);
  }
  void thresholds(std::span<const Dual4> p, const LimitSpec& spec, std::span<Dual4> values) const override {
    find_thresholds(p, spec, values);
  }
  Refusal refuse(std::span<const double> p) const override {
    if (Refusal outside = Mechanism::refuse(p)) return outside;
    const auto empty = [&](std::size_t least, std::size_t greatest) -> Refusal {
      const Parameter &low = info_.parameters[least], &high = info_.parameters[greatest];
      if (p[least] < p[greatest]) return {};
      return low.name + " = " + shortest(p[least]) + " " + low.unit + " leaves no range below " + high.name + " = " +
             shortest(p[greatest]) + " " + high.unit;
    };
    Refusal reason;
    for (std::size_t i = 0; i < 4 && !reason; ++i) reason = empty(kSMin + i, kSMax + i);
    if (!reason) reason = empty(kBetaMin, kBetaMax);
    return reason ? reason : empty(kLwMin, kLwMax);
  }
  PoseReport inspect(std::span<const double> p, const pkm::Pose<double>& pose, const std::string& mode,
                     const LimitSpec& spec) const override {
    const Mode& named = mode_called(mode);
    return hybrid::inspect(geometry(p), limits(p, spec), spec.obstacles, schoenflies(pose), named.signs, named.branch);
  }

 private:
  friend PoseMarginsOf<Hybrid>;
  static constexpr const char* kMarginUnit = "m";

  std::unique_ptr<const VoxelSurveyor> prepare(const SurveyPlan& plan, const VoxelOptions& voxels,
                                               const Demand& demand) const override {
    return make_surveyor(planned(plan, demand), voxels);
  }
  std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const ColumnOptions& columns,
                                          const Demand& demand) const override {
    return make_surveyor(planned(plan, demand), columns);
  }

  std::string unit() const override { return "m^2"; }
  std::string meaning() const override { return "(2 a + L1 + L2) L3"; }
  double of(std::span<const double> p) const override { return size_of(p); }
  Dual4 of(std::span<const Dual4> p) const override { return size_of(p); }

  std::optional<pkm::Influence<double>> influence(std::span<const double> p, const pkm::Pose<double>& pose,
                                                  const std::string& mode) const override {
    const auto g = geometry(p);
    const Joints<double> j = inverse(g, schoenflies(pose), mode_called(mode).signs);
    if (!j.assembles() || j.serial) return std::nullopt;
    return hybrid::influence(g, schoenflies(pose), j);
  }
  std::vector<PlacedLink> place(std::span<const double> p, const pkm::Pose<double>& pose,
                                const std::string& mode) const override {
    return placed_links(p, schoenflies(pose), mode_called(mode).signs);
  }
  std::string input() const override { return "theta"; }
  std::string output() const override { return "gamma"; }
  ChainReport report(std::span<const double> p, const MotionSample& at, double phase) const override {
    return inspect_chain(geometry(p), at, phase);
  }
  std::optional<double> input_for(std::span<const double> p, const pkm::Pose<double>& pose, double gamma,
                                  double phase) const override {
    const auto g = geometry(p);
    const Forks<double> k = forks(shaft(g, schoenflies(pose)), pose[3], phase);
    if (!k.turns) return std::nullopt;
    return input_angle(g, k, gamma);
  }
  std::vector<AssemblyMode> assemblies(std::span<const double> p, const AxisVector<double>& s) const override {
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
  ForwardStatus status(std::span<const double> p, const AxisVector<double>& s,
                       const std::vector<AssemblyMode>&) const override {
    static const std::array<ForwardStatus, 5> meanings = {
        {{},
         {"NO_XZ", "the carriages A and B are too far apart, or as far apart as links of different lengths can't be"},
         {"DEGENERATE_XZ", "A'' and B'' are as far apart as A' and B', so that the parallelogram moves freely"},
         {"NO_BETA", "link C does not reach the platform's joint C' for any beta"},
         {"DEGENERATE_BETA", "C' turns about the foot of link C, so that every beta assembles"}}};
    return meanings[static_cast<std::size_t>(hybrid::forward(geometry(p), s).status)];
  }

  Planned planned(const SurveyPlan& plan, const Demand& demand) const {
    const auto& [signs, branch] = mode_called(demand.mode);
    return {signs, branch, plan, demand};
  }
  const Mode& mode_called(const std::string& name) const { return modes_[number_of_mode(info_, name)]; }
  template <class S>
  void find_thresholds(std::span<const S> p, const LimitSpec& spec, std::span<S> values) const {
    const Limits<S> l = limits(p, spec);
    values[kTauSLimit] = l.tau_s;
    values[kTauPLimit] = l.tau_p;
    values[kTauCLimit] = l.tau_c;
    values[kClearanceMin] = l.clearance_min;
  }
  template <class S>
  void find_margins(std::span<const S> p, const std::string& mode_name, const LimitSpec& spec,
                    std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) const {
    const auto g = geometry(p);
    const Limits<S> l = limits(p, spec);
    const Mode& mode = mode_called(mode_name);
    for (const pkm::Pose<double>& at : poses) {
      const SchoenfliesPose<S> pose{S(at[0]), S(at[1]), S(at[2]), S(at[3])};
      const Margins<S> found = hybrid::margins(g, l, pose, mode.signs, mode.branch);
      for (std::size_t i = 0; i < kMargins; ++i)  // in one unit: lengths as they are, angles and ratios at the length e
        margins.push_back(kMarginNames[i].kind == MarginKind::length ? found[i] : S(found[i] * g.e));
      if (spec.obstacles.empty()) continue;
      const Joints<S> j = inverse(g, pose, mode.signs);
      margins.push_back(nearest_obstacle(g, pose, j, shaft(g, pose), spec.obstacles).clearance - l.clearance_min);
    }
  }

  MechanismInfo info_ = make_info();
  std::vector<Mode> modes_ = all_modes();
};

}  // namespace

std::shared_ptr<const Mechanism> make_hybrid() { return std::make_shared<Hybrid>(); }

}  // namespace pkm
