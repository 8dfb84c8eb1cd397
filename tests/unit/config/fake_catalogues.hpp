// A small made-up machine with catalogues, so that the reader of studies is tested without any real mechanism.
#pragma once

#include "engine/config/study.hpp"

namespace pkm::testing {

/// Mechanism "slider": parameters a [m], b [m], tilt [rad], mass [kg]; limits gap_min [m], angle_max [rad]; coordinates
/// x, y, z, theta with y fixed. Objectives: volume (m^2 rad), shape (with every kind of option), force (this mechanism
/// lacks it). Constraints: gap (pose level), reach, linear. Optimisers: ga, simple, newton, sweep, broken.
Catalogues fake_catalogues();

/// How often the slider has prepared a survey so far.
int prepared_evaluators();

}  // namespace pkm::testing
