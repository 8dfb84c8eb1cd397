// Geometric path of one move of a motion, parametrised by its arc length s in the space of the coordinates (in SI
// units: 1 m counts as 1 rad). With X' and X'' the time derivatives of the motion,
//
//   dX/ds = X' / |X'|,   d2X/ds2 = (X'' - (dX/ds . X'') dX/ds) / |X'|^2
//
// The arc length of a given time is computed by Gauss-Legendre quadrature of |X'|, the time of a given arc length by
// root finding.
#pragma once

#include <memory>
#include <vector>

#include "engine/motion/find_moves.hpp"

namespace pkm {

class GeometricPath {
 public:
  /// @param move  one of the moves that find_moves(*motion) returns
  GeometricPath(std::shared_ptr<const Motion> motion, const MovePeriod& move);

  double length() const { return lengths_.back(); }
  /// Arc length of node i of n. The nodes are equally spaced in the mean of the travelled fraction of the arc length
  /// and the elapsed fraction of the time, because the motion is usually slow where the path is curved.
  double node(std::size_t i, std::size_t n) const;
  /// Pose, dX/ds (as velocity) and d2X/ds2 (as acceleration) at an arc length in [0, length()]; `time` and `inputs` are
  /// those of the motion. At both ends, where the motion is at rest, the derivatives are those of a close point.
  MotionSample at(double s) const;

 private:
  double speed(double time) const;
  double integral(double from, double to) const;
  double length_until(double time) const;
  double time_at(double s) const;

  std::shared_ptr<const Motion> motion_;
  std::vector<double> times_, lengths_;  ///< nodes of the quadrature: time in the motion, and arc length
};

}  // namespace pkm
