// Abilities that look at the design alone, or at margins of poses in one unit: for numbers, and with derivatives by
// parameters (both_scalars.hpp: written once for the two).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/scratch.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm {

/// The mechanism's size, to which workspace-ratio refers.
class Size {
 public:
  virtual ~Size() = default;
  virtual std::string unit() const = 0;
  virtual std::string meaning() const = 0;
  virtual double of(std::span<const double> parameters) const = 0;
  virtual Dual4 of(std::span<const Dual4> parameters) const = 0;
};

inline constexpr std::size_t kMostDesignTests = 16;

/// A test of the design alone.
struct DesignMarginInfo {
  std::string name;  ///< the constraint's name: "rail-length"
  std::string unit;
  std::string meaning;
};

class DesignTests {
 public:
  virtual ~DesignTests() = default;
  virtual const std::vector<DesignMarginInfo>& list() const = 0;
  /// Margins in the order of list(). Limits enter some of them.
  virtual void test(std::span<const double> parameters, const LimitSpec& limits, std::span<double> margins) const = 0;
  virtual void test(std::span<const Dual4> parameters, const LimitSpec& limits, std::span<Dual4> margins) const = 0;
};

/// Margins of poses: a pose is feasible where all of its margins are >= 0.
class PoseMargins {
 public:
  virtual ~PoseMargins() = default;
  /// The unit that they share; "": each has its own, m, rad or 1.
  virtual std::string margin_unit() const = 0;
  /// Appends the margins of poses, finite numbers. A pose that does not assemble has some, too, one of them negative.
  /// @param mode     one of MechanismInfo::modes, or "": the first
  /// @param scratch  of the calling thread
  virtual void append(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<double>> poses, Scratch& scratch, std::vector<double>& margins) const = 0;
  virtual void append(std::span<const Dual4> parameters, const std::string& mode, const LimitSpec& limits,
                      std::span<const Pose<double>> poses, Scratch& scratch, std::vector<Dual4>& margins) const = 0;
};

}  // namespace pkm
