// Abilities that depend on the design alone, and margins of poses; each as double and with derivatives with respect to
// the parameters.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/scratch.hpp"
#include "engine/core/unsupported.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm {

/// Size of the mechanism, by which the objective workspace-ratio divides the workspace volume.
class Size {
 public:
  virtual ~Size() = default;
  virtual std::string unit() const = 0;
  virtual std::string meaning() const = 0;
  virtual double of(std::span<const double> parameters) const = 0;
  virtual Dual4 of(std::span<const Dual4> parameters) const = 0;
};

inline constexpr std::size_t kMaxDesignTests = 16;

/// A constraint that depends on the design alone.
struct DesignMarginInfo {
  std::string name;  ///< name of the constraint, for example "rail-length"
  std::string unit;
  std::string meaning;
};

class DesignTests {
 public:
  virtual ~DesignTests() = default;
  virtual const std::vector<DesignMarginInfo>& list() const = 0;
  /// Computes the margins of a design, in the order of list(); a margin < 0 violates its constraint.
  /// @param limits  thresholds that some of the constraints use
  virtual void test(std::span<const double> parameters, const LimitSpec& limits, std::span<double> margins) const = 0;
  virtual void test(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> margins) const = 0;
};

/// Margins of poses: a pose is feasible if all of its margins are >= 0.
class PoseMargins {
 public:
  virtual ~PoseMargins() = default;
  /// The unit that all margins have; "" if their units differ (m, rad or 1).
  virtual std::string margin_unit() const = 0;
  /// The reason why the margins have no derivatives under the given limits; empty if they have derivatives.
  virtual Unsupported why_no_derivatives(const LimitSpec&) const { return {}; }
  /// Appends the margins of all poses. They are always finite; at a pose where the mechanism cannot be assembled, at
  /// least one of them is negative.
  /// @param mode     one of MechanismInfo::modes, or "": the first
  /// @param scratch  scratch memory of the calling thread
  virtual void append(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<double>> poses, Scratch& scratch, std::vector<double>& margins) const = 0;
  virtual void append(std::span<const Dual4> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<double>> poses, Scratch& scratch, std::vector<Dual4>& margins) const = 0;
};

}  // namespace pkm
