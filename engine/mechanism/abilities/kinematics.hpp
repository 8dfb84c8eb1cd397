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
  /// @return std::nullopt if the pose cannot be assembled or a coefficient is infinite
  /// @param mode  one of MechanismInfo::modes
  virtual std::optional<Influence<double>> influence(std::span<const double> parameters, const Pose<double>& pose,
                                                     const std::string& mode) const = 0;
};

/// Guarantee of a list of assembly modes.
struct ForwardGuarantee {
  bool is_complete = true;  ///< the list contains every isolated solution
  std::string method = "closed form: every isolated pose";
};

class ForwardKinematics {
 public:
  virtual ~ForwardKinematics() = default;
  /// Assembly modes for joint values [m, rad]: all of them, if guarantee().is_complete. Empty if there is no solution
  /// or a continuum of solutions.
  virtual std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                               const AxisVector<double>& joints) const = 0;
  /// Assembly modes found by a search that starts near the pose `from`. By default the same as assemblies().
  virtual std::vector<AssemblyMode> assemblies_near(std::span<const double> parameters,
                                                    const AxisVector<double>& joints,
                                                    const Pose<double>& /*from*/) const {
    return assemblies(parameters, joints);
  }
  /// Guarantee of assemblies(). Overridden by mechanisms whose forward kinematics is a numerical search.
  virtual ForwardGuarantee guarantee() const { return {}; }
  /// Interpretation of the result of assemblies().
  virtual ForwardStatus status(std::span<const double> /*parameters*/, const AxisVector<double>& /*joints*/,
                               const std::vector<AssemblyMode>& found) const {
    if (found.empty()) return {"NO_POSE", "no pose assembles with these joint values"};
    return {};
  }
};

/// A link, and the links joined to it, from which it needs no clearance.
struct JoinedLinks {
  std::string link;
  std::vector<std::string> others;
};

/// All links of the mechanism for drawings, including rails, platform and sliders.
class Links {
 public:
  virtual ~Links() = default;
  /// The links in the same order at every pose; empty if the pose cannot be assembled.
  /// @param mode  one of MechanismInfo::modes
  virtual std::vector<PlacedLink> place(std::span<const double> parameters, const Pose<double>& pose,
                                        const std::string& mode) const = 0;
  /// Pairs of links between which no clearance is required because they are joined, for display; empty if unspecified.
  virtual std::vector<JoinedLinks> joined() const { return {}; }
};

}  // namespace pkm
