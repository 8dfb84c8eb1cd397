// Margins of poses in a fixed order, with derivatives by the pose or by the design.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The margins of PoseMargins, in the same order at every pose.
class OrderedMargins {
 public:
  virtual ~OrderedMargins() = default;
  /// Names of the margins, in their order.
  virtual std::vector<std::string> margin_names(const LimitSpec& limits) const = 0;
  /// Appends the margins of all poses, NaN where one does not exist; a pose that cannot be assembled has a negative one
  /// or one that is NaN.
  /// @param mode     one of MechanismInfo::modes, or "": the first
  /// @param scratch  scratch memory of the calling thread
  virtual void append_ordered(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                              std::span<const Pose<double>> poses, Scratch& scratch,
                              std::vector<double>& margins) const = 0;
  /// The same with derivatives. Margins that have none (limits of quantities without a formula) are NaN.
  virtual void append_ordered(std::span<const Dual4> parameters, const std::string& mode, const LimitSpec& limits,
                              std::span<const Pose<Dual4>> poses, Scratch& scratch,
                              std::vector<Dual4>& margins) const = 0;
};

/// The interface OrderedMargins of a mechanism with or without drive trains; null if the mechanism does not have it.
const OrderedMargins* find_ordered_margins(const Mechanism& mechanism);

}  // namespace pkm
