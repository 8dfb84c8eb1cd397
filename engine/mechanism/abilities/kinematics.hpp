// Kinematic abilities beyond inverse kinematics: influence coefficients, forward kinematics, links.
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

/// First- and second-order influence coefficients, which give joint velocities and accelerations of a motion.
class Velocities {
 public:
  virtual ~Velocities() = default;
  /// @return the coefficients at a pose; std::nullopt if the pose cannot be assembled or a coefficient is infinite
  /// @param mode  one of MechanismInfo::modes
  virtual std::optional<Influence<double>> influence(std::span<const double> parameters, const Pose<double>& pose,
                                                     const std::string& mode) const = 0;
};

/// States whether a list of assembly modes is complete, and how it was computed.
struct ForwardGuarantee {
  bool is_complete = true;  ///< true if the list contains every isolated solution
  std::string method = "closed form: every isolated pose";
};

class ForwardKinematics {
 public:
  virtual ~ForwardKinematics() = default;
  /// Finds the assembly modes, i.e. the poses that have given joint values [m, rad]: all of them if
  /// guarantee().is_complete. Empty if there is no solution or a continuum of solutions.
  virtual std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                               const AxisVector<double>& joints) const = 0;
  /// Assembly modes found by a search that starts near the pose `from`. By default, all modes that assemblies() finds.
  virtual std::vector<AssemblyMode> assemblies_near(std::span<const double> parameters,
                                                    const AxisVector<double>& joints,
                                                    const Pose<double>& /*from*/) const {
    return assemblies(parameters, joints);
  }
  /// States whether assemblies() finds all solutions. Overridden by mechanisms whose forward kinematics is a numerical
  /// search.
  virtual ForwardGuarantee guarantee() const { return {}; }
  /// Status that is reported with the result `found` of assemblies(), such as NO_POSE if it is empty.
  virtual ForwardStatus status(std::span<const double> /*parameters*/, const AxisVector<double>& /*joints*/,
                               const std::vector<AssemblyMode>& found) const {
    if (found.empty()) return {"NO_POSE", "no pose assembles with these joint values"};
    return {};
  }
};

/// A link, and the links to which it is joined; no clearance is required between them.
struct JoinedLinks {
  std::string link;
  std::vector<std::string> others;
};

/// All links of the mechanism for drawings, including rails, platform and sliders.
class Links {
 public:
  virtual ~Links() = default;
  /// The links at a pose, in the same order for every pose; empty if the pose cannot be assembled.
  /// @param mode  one of MechanismInfo::modes
  virtual std::vector<PlacedLink> place(std::span<const double> parameters, const Pose<double>& pose,
                                        const std::string& mode) const = 0;
  /// For each link, the links from which no clearance is required because they are joined to it; for display only.
  /// Empty if this is unspecified.
  virtual std::vector<JoinedLinks> joined() const { return {}; }
};

}  // namespace pkm
