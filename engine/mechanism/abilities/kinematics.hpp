// Abilities of a mechanism at a pose beside its inverse kinematics.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/influence.hpp"
#include "engine/geometry/placed_link.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// First- and second-order influence coefficients: what speeds and accelerations of the joints a motion takes.
class Velocities {
 public:
  virtual ~Velocities() = default;
  /// Absent where the pose does not assemble or they are infinite.
  /// @param mode  one of MechanismInfo::modes
  virtual std::optional<Influence<double>> influence(std::span<const double> parameters, const Pose<double>& pose,
                                                     const std::string& mode) const = 0;
};

/// What a list of assemblies guarantees.
struct ForwardGuarantee {
  bool is_complete = true;  ///< it has every isolated pose
  std::string method = "closed form: every isolated pose";
};

class ForwardKinematics {
 public:
  virtual ~ForwardKinematics() = default;
  /// Assembly modes for joint values [m, rad], as `guarantee` has it every one; empty when the joints cannot be
  /// reached, or reached in infinitely many ways.
  virtual std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                               const AxisVector<double>& joints) const = 0;
  /// Those that are looked for about a pose: here, too, every one.
  virtual std::vector<AssemblyMode> assemblies_near(std::span<const double> parameters,
                                                    const AxisVector<double>& joints,
                                                    const Pose<double>& /*from*/) const {
    return assemblies(parameters, joints);
  }
  /// Of assemblies(): overridden by mechanisms that search.
  virtual ForwardGuarantee guarantee() const { return {}; }
  /// What an answer of theirs means.
  virtual ForwardStatus status(std::span<const double> /*parameters*/, const AxisVector<double>& /*joints*/,
                               const std::vector<AssemblyMode>& found) const {
    if (found.empty()) return {"NO_POSE", "no pose assembles with these joint values"};
    return {};
  }
};

/// A link, and those that it need not keep clear of.
struct JoinedLinks {
  std::string link;
  std::vector<std::string> others;
};

/// The mechanism as it is drawn: rails, platform and slides included.
class Links {
 public:
  virtual ~Links() = default;
  /// The same links in the same order at every pose; empty where the pose does not assemble.
  /// @param mode  one of MechanismInfo::modes
  virtual std::vector<PlacedLink> place(std::span<const double> parameters, const Pose<double>& pose,
                                        const std::string& mode) const = 0;
  /// What the clearance of links does not count, for people; empty: it does not say.
  virtual std::vector<JoinedLinks> joined() const { return {}; }
};

}  // namespace pkm
