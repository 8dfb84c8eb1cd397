// Interface of a mechanism: a core that every mechanism implements, and optional abilities.
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
#include "engine/mechanism/abilities/elasticity.hpp"
#include "engine/mechanism/abilities/kinematics.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// Value of LimitInfo::group for the limits that a study sets for pose quantities, such as "LTI_min".
inline constexpr const char* kQuantityLimit = "quantity";

/// Description of a limit, i.e. of the threshold of a constraint on poses.
struct LimitInfo {
  std::string name;  ///< name of the threshold, for example "beta_max"
  std::string unit;
  /// Default threshold, which excludes no pose. If a parameter has the same name as the limit, this is the parameter's
  /// nominal value; its value in the design is then the threshold, unless a threshold is given.
  double inactive = 0;
  double lower = 0;  ///< minimum threshold that a study may give; `upper` is the maximum
  double upper = 0;
  /// Name of the constraint to which the limit belongs: "interference", "singularity-margin" or "clearance";
  /// kQuantityLimit for the limit of a pose quantity.
  std::string group;
  std::string derivation;  ///< formula by which the threshold follows from the parameters; "" if there is none
  std::string meaning;
};

/// A choice of the one to three coordinates that a workspace analysis sweeps; the others are fixed.
struct Sweep {
  /// Swept coordinates, in the order of the axes of a voxel map; the first axis varies slowest.
  std::vector<int> swept;
  std::vector<int> fixed;  ///< all other coordinates, in ascending order
  int column = 0;  ///< the swept coordinate along which columns run; the other swept coordinates are outer coordinates
  bool integrates = false;  ///< true if fixed coordinates can be integrated over (FixedCoordinate::Kind::integrated)
};

/// A value other than the pose on which quantities depend, such as the angle of an input shaft.
struct InputInfo {
  std::string name, unit, meaning;
  double value = 0;  ///< default value of the input
};

/// Description of a named number that depends on the design, the pose or the motion.
struct QuantityInfo {
  std::string name, unit, meaning;
  bool of_design = false;  ///< true if the quantity depends on parameters and limits alone
  bool of_motion = false;  ///< true if the quantity depends on inputs or on time derivatives
  /// The quantity as workspace analyses evaluate it, with inputs at their default values. Null if the quantity depends
  /// on the design alone or on time derivatives, or if it belongs to a single limb and is listed at single poses only.
  std::shared_ptr<const PoseQuantity> of_pose = nullptr;
};

/// A quantity that this mechanism lacks, although other mechanisms have it.
struct UndefinedQuantity {
  std::string name, why;  ///< for example "accuracy" and "[accuracy] joint_error is missing"
};

struct MechanismInfo {
  std::string name;    ///< name in studies, for example "4ppa-2par"
  std::string title;   ///< title, one line
  std::string source;  ///< publication that describes the mechanism
  std::vector<Parameter> parameters;
  std::vector<AxisInfo> coordinates;  ///< coordinates of a pose, translations and rotations; 1 to kMaxCoordinates
  std::vector<AxisInfo> joints;       ///< actuated joints, 1 to kMaxJoints
  std::vector<std::string> modes;     ///< working modes; the first is the default
  /// Signs of branches that may follow a "/" in the name of a working mode; the first is the default.
  std::vector<std::string> branches;
  std::vector<Sweep> sweeps;  ///< all supported sweeps, the default one first
  std::vector<LimitInfo> limits;
  std::vector<InputInfo> inputs;
  std::vector<QuantityInfo> quantities;
  std::vector<UndefinedQuantity> undefined_quantities{};
  /// Formula of the default characteristic length; "" if the conditioning is undefined.
  std::string characteristic_length;
  std::vector<std::string> closed_forms;  ///< method of the inverse kinematics of each joint, in words; may be empty
};

class Mechanism {
 public:
  virtual ~Mechanism() = default;
  virtual const MechanismInfo& info() const = 0;

  /// Checks that the parameters describe a mechanism. By default, each parameter has to be within its range.
  /// @return the reason if they do not; empty if they do
  virtual Unsupported refuse(std::span<const double> parameters) const;
  /// Computes the inverse kinematics of a pose: joint coordinates, Jacobian, conditioning and named margins.
  /// @param mode  one of MechanismInfo::modes
  virtual PoseReport inspect(std::span<const double> parameters, const Pose<double>& pose, const std::string& mode,
                             const LimitSpec& limits) const = 0;
  /// Ranges of all coordinates that contain the workspace, for plans without a box [m, rad]; std::nullopt: unknown.
  virtual std::optional<std::vector<std::array<double, 2>>> ranges(std::span<const double>) const { return {}; }
  /// Range of a fixed coordinate [m or rad] outside of which no pose is feasible; std::nullopt: unknown. By default, it
  /// is derived from ranges(). If the parameters vary over a box, each end of the range attains its minimum and maximum
  /// at vertices of the box.
  /// @param coordinate  index of a coordinate that one of the sweeps fixes
  virtual std::optional<std::array<double, 2>> reach(std::span<const double> parameters, int coordinate) const;
  /// Default value of a fixed coordinate [m or rad], for FixedCoordinate::Kind::default_value; std::nullopt: none.
  /// @param coordinate  index of a coordinate that one of the sweeps fixes
  virtual std::optional<double> default_value(std::span<const double>, int /*coordinate*/) const { return {}; }
  /// Computes the thresholds of a design, in the order of MechanismInfo::limits. By default, these are the given
  /// thresholds, and LimitInfo::inactive for limits that are not given. Mechanisms whose thresholds are derived from
  /// parameters override both overloads.
  virtual void thresholds(std::span<const double> parameters, const LimitSpec& limits, std::span<double> values) const;
  virtual void thresholds(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> values) const;
  /// The values of MechanismInfo::quantities at a pose and motion, NaN where they are undefined.
  /// @param at  MotionSample::inputs are in the order of MechanismInfo::inputs; empty: the defaults, constant in time
  virtual std::vector<double> quantities(std::span<const double> /*parameters*/, const std::string& /*mode*/,
                                         const LimitSpec&, const MotionSample& /*at*/) const {
    return {};
  }

  // The following functions return optional abilities; null if the mechanism does not support the ability.

  /// Analysis by voxels that is faster than testing every cell.
  virtual const Voxels* voxels() const { return nullptr; }
  virtual const Columns* columns() const { return nullptr; }
  virtual std::string why_no_columns() const { return ""; }  ///< the reason if columns() is null; "": unspecified
  virtual const Size* size() const { return nullptr; }
  virtual const DesignTests* design_tests() const { return nullptr; }
  virtual const PoseMargins* pose_margins() const { return nullptr; }
  virtual const Velocities* velocities() const { return nullptr; }
  virtual const ForwardKinematics* forward() const { return nullptr; }
  virtual const Links* links() const { return nullptr; }
  virtual const Dynamics* dynamics() const { return nullptr; }
  virtual const JointReactions* reactions() const { return nullptr; }
  virtual std::string why_no_reactions() const { return ""; }  ///< the reason if reactions() is null; "": unspecified
  virtual const Elasticity* elasticity() const { return nullptr; }
  virtual std::string why_no_elasticity() const { return ""; }  ///< the reason if elasticity() is null; "": unspecified
  virtual const DriveTrains* drive_trains() const { return nullptr; }
  virtual const RigorousBounds* bounds() const { return nullptr; }
};

/// The reason why coupling indices, joint-space inertia and drive forces are undefined: the mechanism has no masses, or
/// its Jacobian is not square and therefore has no inverse. Empty if they are defined.
Unsupported why_no_joint_forces(const Mechanism& mechanism);

/// The sweep of a plan: the first sweep of the mechanism that fixes all fixed coordinates of the plan and, if the plan
/// names swept coordinates, sweeps exactly these. Throws std::invalid_argument if the mechanism has no such sweep.
const Sweep& sweep_of(const MechanismInfo& info, const WorkspacePlan& plan);

/// Lists every sweep over three, two and one coordinates, in this order.
/// @param default_swept  swept coordinates of the sweep that is put first
std::vector<Sweep> all_sweeps(const std::vector<AxisInfo>& coordinates, const std::vector<int>& default_swept);

/// Index of a working mode by its name, 0 for "". Throws std::invalid_argument if the name is unknown.
std::size_t mode_index(const MechanismInfo& info, const std::string& name);

/// Value at which maps fix a coordinate [m or rad]: the value that the plan gives, or the first one if it lists
/// several; if it gives none, the default value of the design. Throws std::invalid_argument if there is no such value.
double fixed_value(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan,
                   int coordinate);
/// Throws std::invalid_argument with the message that a fixed coordinate has neither a given nor a default value.
[[noreturn]] void throw_no_default_value(const MechanismInfo& info, int coordinate);

/// @return true if a plan sets a limit on the clearance of links
bool requires_clearance(const MechanismInfo& info, const WorkspacePlan& plan);

/// Unit of the product of the given coordinates, for example "m^2 rad".
std::string unit_of_product(const MechanismInfo& info, const std::vector<int>& coordinates);
/// Unit of the workspace volume of a plan: the product of the units of all coordinates that are swept or integrated
/// over.
std::string volume_unit(const MechanismInfo& info, const WorkspacePlan& plan);

/// Names and values of the quantities that depend on the design alone.
NamedValues quantities_of_design(const Mechanism& mechanism, std::span<const double> parameters,
                                 const LimitSpec& limits);

/// A LimitSpec in which no limit is given or derived.
inline LimitSpec no_limits(const MechanismInfo& info) {
  return {std::vector<std::optional<double>>(info.limits.size()), std::vector<bool>(info.limits.size(), false)};
}

}  // namespace pkm
