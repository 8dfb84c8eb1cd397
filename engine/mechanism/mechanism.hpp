// A mechanism as the rest of the program sees it: a core that every mechanism has, and abilities that are there or not.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/core/unsupported.hpp"
#include "engine/dynamics/drive_train.hpp"
#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/mechanism/abilities/columns.hpp"
#include "engine/mechanism/abilities/design.hpp"
#include "engine/mechanism/abilities/dynamics.hpp"
#include "engine/mechanism/abilities/kinematics.hpp"
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
  std::string group;       ///< the constraint that owns it: "interference", "singularity-margin" or "clearance"
  std::string derivation;  ///< formula from the parameters, "" when there is none
  std::string meaning;
};

/// One to three coordinates that a survey sweeps over, the others being held.
struct Sweep {
  std::vector<int> swept;   ///< outermost of a voxel map first
  std::vector<int> held;    ///< the others, in their order
  int column = 0;           ///< the swept coordinate that columns run along; the others, in order, have nodes
  bool integrates = false;  ///< FixedCoordinate::Kind::integrated is available
};

/// What quantities depend on beside the pose: the angle of an input shaft, a phase.
struct InputInfo {
  std::string name, unit, meaning;
  double value = 0;  ///< default
};

/// A named number of the design, of the pose or of its motion.
struct QuantityInfo {
  std::string name, unit, meaning;
  bool of_design = false;  ///< depends on parameters and limits alone
  bool of_motion = false;  ///< depends on inputs, or on rates
};

struct MechanismInfo {
  std::string name;    ///< "4ppa-2par"
  std::string title;   ///< one line
  std::string source;  ///< the paper
  std::vector<Parameter> parameters;
  std::vector<AxisInfo> coordinates;  ///< of the pose, 1 to kMaxCoordinates: translations and rotations
  std::vector<AxisInfo> joints;       ///< the actuated ones, 1 to kMaxJoints
  std::vector<std::string> modes;     ///< working modes; the first is the default
  std::vector<std::string> branches;  ///< signs that a mode may require behind a "/"; the first goes without saying
  std::vector<Sweep> sweeps;          ///< those that it can be surveyed by, the usual one first
  std::vector<LimitInfo> limits;
  std::vector<InputInfo> inputs;
  std::vector<QuantityInfo> quantities;
  std::string characteristic_length;      ///< formula of the default one; "": no pose has a conditioning
  std::vector<std::string> closed_forms;  ///< how inverse kinematics finds each joint, for people; or none
};

class Mechanism {
 public:
  virtual ~Mechanism() = default;
  virtual const MechanismInfo& info() const = 0;

  /// Why the parameters describe no mechanism (a length <= 0, ...): here, because one is outside its range.
  virtual Unsupported refuse(std::span<const double> parameters) const;
  /// Inverse kinematics, with named margins.
  /// @param mode  one of MechanismInfo::modes
  virtual PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                             const LimitSpec& limits) const = 0;
  /// Ranges of all coordinates that hold the workspace, for surveys that give no box [m, rad]; none: it does not say.
  virtual std::optional<std::vector<std::array<double, 2>>> ranges(std::span<const double>) const { return {}; }
  /// Where a coordinate that a sweep holds has to lie for any pose to be feasible [m or rad]; none: it does not say.
  /// Here as `ranges` has it. Over a box of parameters its ends are greatest and least at corners of the box.
  /// @param coordinate  one that a sweep of the mechanism holds
  virtual std::optional<std::array<double, 2>> reach(std::span<const double> parameters, int coordinate) const;
  /// What FixedCoordinate::Kind::middle means for a design: the value at which a map holds that coordinate, unless its
  /// plan says another [m or rad]; none: it does not say.
  /// @param coordinate  one that a sweep of the mechanism holds
  virtual std::optional<double> middle(std::span<const double>, int /*coordinate*/) const { return {}; }
  /// The thresholds in force for a design, order of MechanismInfo::limits: here the given and the inactive ones. Those
  /// that the design derives are the mechanism's to fill in, for both scalars.
  virtual void thresholds(std::span<const double> parameters, const LimitSpec& limits, std::span<double> values) const;
  virtual void thresholds(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> values) const;
  /// The values of MechanismInfo::quantities at a pose and motion, NaN where they are undefined.
  /// @param at  MotionSample::inputs are in the order of MechanismInfo::inputs, or empty: the defaults, at rest
  virtual std::vector<double> quantities(std::span<const double> /*parameters*/, const std::string& /*mode*/,
                                         const LimitSpec&, const MotionSample& /*at*/) const {
    return {};
  }

  // Abilities; null: the mechanism has it not.
  virtual const Voxels* voxels() const { return nullptr; }  ///< faster than testing every cell
  virtual const Columns* columns() const { return nullptr; }
  virtual std::string why_no_columns() const { return ""; }  ///< "": there is nothing to say about it
  virtual const Size* size() const { return nullptr; }
  virtual const DesignTests* design_tests() const { return nullptr; }
  virtual const PoseMargins* pose_margins() const { return nullptr; }
  virtual const Velocities* velocities() const { return nullptr; }
  virtual const ForwardKinematics* forward() const { return nullptr; }
  virtual const Links* links() const { return nullptr; }
  virtual const Dynamics* dynamics() const { return nullptr; }
  virtual const JointReactions* reactions() const { return nullptr; }
  virtual std::string why_no_reactions() const { return ""; }  ///< "": there is nothing to say about it
  virtual const DriveTrains* drive_trains() const { return nullptr; }
  virtual const RigorousBounds* bounds() const { return nullptr; }
};

/// Why a mechanism has no coupling indices, no inertia at its joints and no forces of its drives: it has no masses, or
/// they would need the inverse of a Jacobian that is not square.
Unsupported no_joint_forces(const Mechanism& mechanism);

/// The sweep of a plan: over the coordinates that the plan names; where it names none, the first that holds all that it
/// holds. Throws std::invalid_argument when the mechanism has none.
const Sweep& sweep_of(const MechanismInfo& info, const WorkspacePlan& plan);

/// Every sweep over three coordinates, over two and over one, in this order, for mechanisms that are surveyed cell by
/// cell.
/// @param usual  comes first: the swept coordinates
std::vector<Sweep> all_sweeps(const std::vector<AxisInfo>& coordinates, const std::vector<int>& usual);

/// The number of a working mode, 0 for "". Throws std::invalid_argument where the mechanism has none of that name.
std::size_t number_of_mode(const MechanismInfo& info, const std::string& name);

/// Where a plan's map holds a coordinate for a design [m or rad]: at the plan's value, the first of several, else in
/// the middle. Throws std::invalid_argument where nothing says.
double fixed_value(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan,
                   int coordinate);

/// Unit of a product of coordinates: "m^2 rad".
std::string unit_of_product(const MechanismInfo& info, const std::vector<int>& coordinates);
/// Unit of the volume that a plan measures.
std::string volume_unit(const MechanismInfo& info, const WorkspacePlan& plan);

/// The quantities that depend on the design alone.
NamedValues quantities_of_design(const Mechanism& mechanism, std::span<const double> parameters,
                                 const LimitSpec& limits);

/// No limit given or derived.
inline LimitSpec no_limits(const MechanismInfo& info) {
  return {std::vector<std::optional<double>>(info.limits.size()), std::vector<bool>(info.limits.size(), false)};
}

}  // namespace pkm
