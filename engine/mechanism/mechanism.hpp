// A mechanism as the rest of the program sees it: one virtual call per design, never per pose.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/dynamics/reactions.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/survey.hpp"
#include "engine/model/chain.hpp"
#include "engine/model/influence.hpp"
#include "engine/model/placed_link.hpp"
#include "engine/model/pose.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// A threshold of a pose-level constraint.
struct LimitInfo {
  std::string name;  ///< "beta_max"
  std::string unit;
  double inactive = 0;  ///< value that cuts nothing; the default. Of a limit that is called like a parameter: its
                        ///< nominal value; where no threshold is given, the parameter of the design holds
  double lower = 0;     ///< allowed range of a given threshold
  double upper = 0;
  std::string group;       ///< the constraint that owns it: "interference" or "singularity-margin"
  std::string derivation;  ///< formula from the parameters, "" when there is none
  std::string meaning;
};

/// A test of the design alone.
struct DesignMarginInfo {
  std::string name;  ///< the constraint's name: "rail-length"
  std::string unit;
  std::string meaning;
};

/// Three coordinates that a survey sweeps over, the fourth being held.
struct Sweep {
  std::array<int, 3> swept{};  ///< outermost of a voxel map first
  int held = 1;
  int column = 2;           ///< the swept coordinate that columns run along; the other two, in order, have nodes
  std::string volume_unit;  ///< of the swept set: "m^2 rad"
};

struct MechanismInfo {
  std::string name;    ///< "4ppa-2par"
  std::string title;   ///< one line
  std::string source;  ///< the paper
  std::vector<Parameter> parameters;
  std::array<std::string, 4> coordinates;  ///< names of x, y, z, rotation
  std::array<std::string, 4> joints;       ///< names of the four actuated joints
  std::vector<std::string> modes;          ///< working modes; the first is the default
  std::vector<std::string> branches;  ///< signs that a mode may require behind a "/"; the first goes without saying
  std::array<int, 3> swept{};         ///< the usual sweep, as in Sweep
  int held = 1;                       ///< as in Sweep
  bool held_can_integrate = false;    ///< HeldCoordinate::Kind::integrated is available
  bool columns_take_box = false;      ///< column surveys can be cut by SurveyPlan::box
  std::vector<Sweep> more_sweeps;     ///< those that a study may ask for by holding another coordinate
  std::vector<LimitInfo> limits;
  std::vector<DesignMarginInfo> design_margins;
  std::string volume_unit;      ///< of the swept set: "m^2 rad"
  std::string integrated_unit;  ///< when integrated over the held coordinate: "m^3 rad"
  std::string size_unit;        ///< unit of size(); "" when the mechanism has no size
  std::string size_meaning;
  std::string characteristic_length;  ///< formula of the default characteristic length
  std::string margin_unit;            ///< of Mechanism::pose_margins, which then has derivatives; "": mixed SI units
  bool has_influence = false;         ///< Mechanism::influence answers
  std::string chain_input, chain_output;  ///< angles of the auxiliary chain: Mechanism::chain answers; "": none
  bool has_dynamics = false;              ///< Mechanism::dynamics answers
  bool has_reactions = false;             ///< Mechanism::reactions answers
  bool has_links = false;                 ///< Mechanism::links answers
  std::vector<std::string> mass_models;   ///< where masses can come from; the first is the default; none: no masses
  std::string mass_model;                 ///< the one in force
  int column = 2;                         ///< as in Sweep
};

/// What every voxel surveyor answers when asked for derivatives.
inline std::string voxels_have_no_derivatives() {
  return "the study surveys voxels, whose sums have none; take workspace.method = \"columns\"";
}

/// A survey whose plan is fixed: what does not depend on the design is computed here once. Immutable, shared by
/// threads.
class Surveyor {
 public:
  virtual ~Surveyor() = default;
  /// @param parameters  all parameters of the design, order of MechanismInfo::parameters
  /// @param survey      overwritten; reuse one per thread, so that nothing is allocated per design
  virtual void survey(std::span<const double> parameters, Survey<double>& survey) const = 0;
  /// The same survey with derivatives by up to four variables. Values have the bits of the survey above.
  virtual void survey(std::span<const Dual4>, Survey<Dual4>&) const { throw std::logic_error(no_derivatives()); }
  /// "" or one sentence saying why surveys of this plan have no derivatives.
  virtual std::string no_derivatives() const { return "the mechanism's surveys give no derivatives"; }
};

class Mechanism {
 public:
  virtual ~Mechanism() = default;
  virtual const MechanismInfo& info() const = 0;

  /// Prepares surveys of one plan. Throws std::invalid_argument with a sentence when the mechanism cannot serve it.
  virtual std::unique_ptr<const Surveyor> prepare(const SurveyPlan& plan, const Demand& demand) const = 0;
  /// The cells of a voxel plan for one design (the plan's cells; box as in a survey).
  virtual VoxelMap voxel_map(std::span<const double> parameters, const SurveyPlan& plan) const = 0;
  /// What HeldCoordinate::Kind::middle means for a design: the value at which a map holds that coordinate, unless its
  /// plan says another [m or rad].
  /// @param coordinate  one that a sweep of the mechanism holds
  virtual double middle(std::span<const double>, int coordinate) const {
    throw std::invalid_argument("mechanism " + info().name + " does not say where the middle of " +
                                info().coordinates[static_cast<std::size_t>(coordinate)] + " is; give a value");
  }
  /// Margins of the design-level tests, order of MechanismInfo::design_margins. Limits enter some of them.
  virtual void design_margins(std::span<const double> parameters, const LimitSpec& limits,
                              std::span<double> margins) const = 0;
  /// The mechanism's size, to which workspace-ratio refers, in MechanismInfo::size_unit.
  virtual double size(std::span<const double> parameters) const = 0;
  /// The thresholds in force for a design, order of MechanismInfo::limits. Those that the design derives are the
  /// mechanism's to fill in; this fills in the given and the inactive ones.
  virtual void thresholds(std::span<const double>, const LimitSpec& limits, std::span<double> values) const {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = limits.given[i].value_or(info().limits[i].inactive);
  }
  // The same three with derivatives. A mechanism without them has no surveys with derivatives either.
  virtual void design_margins(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const { throw no_duals(); }
  virtual Dual4 size(std::span<const Dual4>) const { throw no_duals(); }
  virtual void thresholds(std::span<const Dual4>, const LimitSpec&, std::span<Dual4>) const { throw no_duals(); }
  /// Numbers worth knowing of a design, for `pkmopt evaluate`.
  virtual NamedValues facts(std::span<const double> parameters, const LimitSpec& limits) const = 0;
  /// "" or a sentence saying why the parameters describe no mechanism (a length <= 0, ...).
  virtual std::string refuse(std::span<const double> parameters) const = 0;

  /// @param mode  one of MechanismInfo::modes
  virtual PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                             const LimitSpec& limits) const = 0;
  /// Appends the margins of poses: a pose is feasible where all of its margins are >= 0. They exist, finite, also where
  /// a pose does not assemble. Here: those of inspect, NaN counting as broken.
  virtual void pose_margins(std::span<const double> parameters, const LimitSpec& limits,
                            std::span<const Pose<double>> poses, std::vector<double>& margins) const {
    for (const Pose<double>& pose : poses) {
      const PoseReport report = inspect(parameters, pose, info().modes.front(), limits);
      for (const auto& [name, margin] : report.margins) margins.push_back(margin == margin ? margin : -1);
      if (!report.assembles) margins.push_back(-1);
    }
  }
  virtual void pose_margins(std::span<const Dual4>, const LimitSpec&, std::span<const Pose<double>>,
                            std::vector<Dual4>&) const {
    throw no_duals();
  }

  /// First- and second-order influence coefficients of a pose: what speeds and accelerations of the joints it takes.
  /// Absent where the pose does not assemble or they are infinite.
  /// @param mode  one of MechanismInfo::modes
  virtual std::optional<Influence<double>> influence(std::span<const double>, const Pose<double>&,
                                                     const std::string&) const {
    throw std::logic_error("mechanism " + info().name + " has no influence coefficients");
  }
  /// The mechanism as it is drawn at a pose, rails, platform and slides included: the same links in the same order at
  /// every pose. Empty where the pose does not assemble.
  /// @param mode  one of MechanismInfo::modes
  virtual std::vector<PlacedLink> links(std::span<const double>, const Pose<double>&, const std::string&) const {
    throw std::logic_error("mechanism " + info().name + " says nothing of its links");
  }
  /// The auxiliary chain at a pose on its way, with the motion of its input.
  /// @param phase  of the forks of the chain's two universal joints [rad]
  virtual ChainReport chain(std::span<const double>, const MotionSample&, double /*phase*/) const { throw no_chain(); }
  /// The chain's input angle for one of its output [rad]; absent where it does not turn.
  virtual std::optional<double> chain_input(std::span<const double>, const Pose<double>&, double /*output*/,
                                            double /*phase*/) const {
    throw no_chain();
  }

  /// Equations of motion at states of one design, with its masses. Where a state does not assemble,
  /// PoseDynamics::assembles is false. Throws std::domain_error where a mass is not positive.
  /// @param mode  one of MechanismInfo::modes
  virtual void dynamics(std::span<const double>, const std::string&, std::span<const MotionState<double>>,
                        std::span<PoseDynamics<double>>) const {
    throw no_masses();
  }
  virtual void dynamics(std::span<const Dual4>, const std::string&, std::span<const MotionState<Dual4>>,
                        std::span<PoseDynamics<Dual4>>) const {
    throw no_masses();
  }
  /// Forces and couples in every joint, for an acceleration under a wrench on the platform (Newton and Euler).
  virtual Reactions reactions(std::span<const double>, const std::string&, const MotionState<double>&,
                              const Vector<double, 4>&, const Wrench<double>&) const {
    throw no_masses();
  }
  /// The same mechanism with masses from another of MechanismInfo::mass_models; null: it knows no such model.
  virtual std::shared_ptr<const Mechanism> with_masses(const std::string&) const { return nullptr; }

  /// Every assembly mode for joint values [m]; empty when the joints cannot be reached, or reached in infinitely many
  /// ways.
  virtual std::vector<AssemblyMode> forward(std::span<const double> parameters,
                                            const std::array<double, 4>& joints) const = 0;
  /// What forward's answer means.
  virtual ForwardStatus forward_status(std::span<const double> parameters, const std::array<double, 4>& joints) const {
    if (forward(parameters, joints).empty()) return {"NO_POSE", "no pose assembles with these joint values"};
    return {};
  }

 private:
  std::logic_error no_chain() const { return std::logic_error("mechanism " + info().name + " has no auxiliary chain"); }
  std::logic_error no_masses() const { return std::logic_error("mechanism " + info().name + " has no dynamics"); }
  std::logic_error no_duals() const { return std::logic_error("mechanism " + info().name + " has no derivatives"); }
};

/// Every sweep that the mechanism serves, the usual one first.
inline std::vector<Sweep> sweeps_of(const MechanismInfo& info) {
  std::vector<Sweep> all = {{info.swept, info.held, info.column, info.volume_unit}};
  all.insert(all.end(), info.more_sweeps.begin(), info.more_sweeps.end());
  return all;
}

/// The sweep of a plan. Throws std::invalid_argument when the mechanism has none that holds the plan's coordinate.
inline Sweep sweep_of(const MechanismInfo& info, const SurveyPlan& plan) {
  for (const Sweep& sweep : sweeps_of(info))
    if (sweep.held == plan.held.coordinate.value_or(info.held)) return sweep;
  throw std::invalid_argument("mechanism " + info.name + " has no survey that holds coordinate number " +
                              std::to_string(*plan.held.coordinate + 1));
}

/// Where a plan's map holds its coordinate for a design [m or rad]: at the plan's value, else in the middle.
inline double held_value(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan) {
  if (plan.held.kind == HeldCoordinate::Kind::value) return plan.held.value;
  return mechanism.middle(parameters, sweep_of(mechanism.info(), plan).held);
}

/// Unit of the volume that a plan measures.
inline std::string volume_unit(const MechanismInfo& info, const SurveyPlan& plan) {
  return plan.held.kind == HeldCoordinate::Kind::integrated ? info.integrated_unit : sweep_of(info, plan).volume_unit;
}

/// No limit given or derived.
inline LimitSpec no_limits(const MechanismInfo& info) {
  return {std::vector<std::optional<double>>(info.limits.size()), std::vector<bool>(info.limits.size(), false)};
}

}  // namespace pkm
