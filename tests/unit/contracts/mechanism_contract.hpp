// Fixture of the suites MechanismContract and WorkspaceAnalysisContract: a mechanism of the catalogue, of
// tests/own_mechanisms or from a file, with poses inside and outside its workspace.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {

class MechanismContract : public testing::TestWithParam<std::string> {
 protected:
  const Mechanism& mechanism() const { return *test::test_mechanism(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }

  struct CellCentres {
    std::vector<Pose<double>> inside, outside;  ///< centres of feasible and of infeasible cells
  };
  /// About 2700 cells of the default sweep.
  CellCentres centres() const {
    const auto axes = static_cast<double>(info().sweeps.front().swept.size());
    const test::Cells cells = test::sample_cells(mechanism(), std::lround(std::pow(14, 3 / axes)));
    CellCentres found;
    for (std::size_t i = 0; i < cells.poses.size(); ++i)
      (cells.feasible[i] ? found.inside : found.outside).push_back(cells.poses[i]);
    return found;
  }
  PoseReport inspect(const Pose<double>& pose) const {
    return mechanism().inspect(parameters(), pose, info().modes[0], no_limits(info()));
  }
};

}  // namespace pkm
