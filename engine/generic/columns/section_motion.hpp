// How a section's corners and columns move with the design: the nodes between them move along.
#pragma once

#include <vector>

#include "engine/generic/columns/section.hpp"
#include "engine/math/dual.hpp"

namespace pkm::generic {

/// A place that moves by -sum / by; it stays where that is infinite.
Dual4 moved(double at, const Components<4>& sum, double by);

/// The change of what changes with registers like `by`.
Components<4> motion_of(std::span<const double> by, std::span<const Dual4> registers);

/// Ends of pieces and columns, for Section::for_each_node().
class SectionMotion {
 public:
  using Scalar = Dual4;

  /// @param room       after measure()
  /// @param moving     registers after all stages but that of v
  /// @param registers  their values
  SectionMotion(const Section& section, const SectionRoom& room, std::span<const Dual4> moving,
                std::span<double> registers)
      : section_(section), room_(room), moving_(moving), registers_(registers) {}

  /// @param first  the first corner at t
  Dual4 corner(std::size_t first, double t) const;
  Dual4 end(EndLabel end, const Dual4& t) const;

  /// What ends columns, by t and s and where they stay.
  struct Boundary {
    double t, s;
    Components<4> change;
  };
  /// @param of  a surface, or the label of a corner at a side or a plain condition
  Boundary boundary(std::uint32_t of, double t, double s) const;

 private:
  Dual4 crossing(const SectionRoom::Corner& at) const;
  Dual4 extreme(std::uint32_t surface, const SectionRoom::Corner& at) const;

  const Section& section_;
  const SectionRoom& room_;
  std::span<const Dual4> moving_;
  std::span<double> registers_;
};

}  // namespace pkm::generic
