// Nested quadrature over the slices of a mechanism file, for comparison with other methods.
#pragma once

#include "engine/generic/column_volume.hpp"
#include "engine/generic/mechanism.hpp"

namespace pkm::test {

/// The slices of a design in the default working mode.
struct SlicesOf {
  generic::ColumnVolume volume;
  std::vector<double> inputs;
  generic::ColumnVolume::Scratch scratch;

  SlicesOf(const Mechanism& mechanism, const std::vector<double>& design, const WorkspacePlan& plan)
      : volume(*generic::evaluation_of(mechanism), plan, *plan.columns(), 0, true) {
    generic::evaluation_of(mechanism)->fill_inputs<double>(design, plan, 0, inputs);
  }
  /// The volume by slices alone, which are searched for critical values.
  Integral<double> measure() { return volume.slices().measure(inputs, scratch.integral); }
};

}  // namespace pkm::test
