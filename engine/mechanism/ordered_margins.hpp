// Margins of poses in a fixed order, with derivatives with respect to the pose or to the parameters of the design.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Interface that lists the margins of PoseMargins in an order that is the same at every pose.
class OrderedMargins {
 public:
  virtual ~OrderedMargins() = default;
  /// Names of the margins, in the order in which append_ordered() appends their values.
  virtual std::vector<std::string> margin_names(const LimitSpec& limits) const = 0;
  /// Appends the margins of all poses; a margin that does not exist at a pose is NaN. At a pose that cannot be
  /// assembled, at least one margin is negative or NaN.
  /// @param mode     one of MechanismInfo::modes, or "": the first
  /// @param scratch  scratch memory of the calling thread
  virtual void append_ordered(std::span<const double> parameters, const std::string& mode, const LimitSpec& limits,
                              std::span<const Pose<double>> poses, Scratch& scratch,
                              std::vector<double>& margins) const = 0;
  /// Appends the margins with derivatives. Margins without derivatives (limits of quantities without a formula) are
  /// NaN.
  virtual void append_ordered(std::span<const Dual4> parameters, const std::string& mode, const LimitSpec& limits,
                              std::span<const Pose<Dual4>> poses, Scratch& scratch,
                              std::vector<Dual4>& margins) const = 0;
};

/// Finds the interface OrderedMargins of a mechanism, which may have been wrapped by with_drive_trains(); null if the
/// mechanism does not implement it.
const OrderedMargins* find_ordered_margins(const Mechanism& mechanism);

}  // namespace pkm
