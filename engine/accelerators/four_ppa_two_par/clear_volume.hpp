// 4PPa-2PaR: volume of the workspace with a clearance test of poses.
//
// The test excludes parts of columns. Therefore the area of a slice has no closed form: it is integrated over delta,
// and the clear parts of columns are found by root finding. Where another pair of links begins to bound a clear part,
// the integrand has a kink, whose position is unknown. Therefore both quadratures bisect their intervals until error
// estimates that allow for kinks meet the tolerance, which is at least kFinestClearTolerance.
#pragma once

#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/columns.hpp"

namespace pkm::four_ppa_two_par {

inline constexpr double kFinestClearTolerance = 1e-4;  ///< smallest relative tolerance of clear_volume()

/// Volume of the poses with sufficient clearance: on the plane y of the design [m^2 rad] or, with `over_y`, which
/// requires the plane y = L0/2, integrated over y [m^3 rad].
/// @param over_y     true: integrates over y
/// @param tolerance  requested relative error
Integral<double> clear_volume(const SlicedDesign<double>& d, const ClearanceTest& test, bool over_y, double tolerance,
                              ColumnScratch<double>& scratch);

/// Volume of the poses with sufficient clearance, as returned by clear_volume(), but by fixed quadrature rules in theta
/// and delta, and without an error estimate.
Integral<double> clear_volume_by_rule(const SlicedDesign<double>& d, const ClearanceTest& test, bool over_y,
                                      const GaussRule& theta_rule, const GaussRule& inner_rule,
                                      ColumnScratch<double>& scratch);

}  // namespace pkm::four_ppa_two_par
