// A pose of the default design, for tests of mechanism files.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {

/// Report on a pose of the default design, in the first working mode and without limits.
inline PoseReport report_at(const Mechanism& mechanism, const Pose<double>& pose) {
  const MechanismInfo& info = mechanism.info();
  return mechanism.inspect(test::nominal(info), pose, info.modes.empty() ? "" : info.modes.front(), no_limits(info));
}

}  // namespace pkm
