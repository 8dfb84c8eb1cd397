// 4PPa-2PaR: the volume of the workspace where poses are tested for clearance.
//
// Where a capsule test cuts columns, a section's area has no closed form left: it is integrated over delta, and along
// z the clear parts are found by roots. The integrand has kinks where a pair of links begins to cut or another pair
// takes over; nobody knows where, so both quadratures halve their pieces until their error estimates, which count the
// kinks in, meet the tolerance. Tolerances below kFinestClearTolerance are not aimed at.
#pragma once

#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/columns.hpp"

namespace pkm::four_ppa_two_par {

inline constexpr double kFinestClearTolerance = 1e-4;  ///< relative

/// Volume on the frame's plane [m^2 rad], or integrated over y [m^3 rad] (then of a frame at y = L0/2).
Integral<double> clear_volume(const Frame<double>& f, const ClearanceTest& test, bool over_y, double tolerance,
                              ColumnScratch<double>& scratch);

/// The volume on one plane by fixed rules in theta and delta; no error is estimated.
Integral<double> clear_volume_by_rule(const Frame<double>& f, const ClearanceTest& test, const GaussRule& theta_rule,
                                      const GaussRule& inner_rule, ColumnScratch<double>& scratch);

}  // namespace pkm::four_ppa_two_par
