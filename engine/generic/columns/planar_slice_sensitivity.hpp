// Sensitivities of the vertices and columns of a planar slice.
#pragma once

#include <vector>

#include "engine/generic/columns/planar_slice.hpp"
#include "engine/math/dual.hpp"

namespace pkm::generic {

/// A root with the value `at` of an equation, and with the derivatives -sum / by. Derivatives that would be infinite
/// are 0.
/// @param sum, by  derivatives of the equation with respect to the design, and to the root
Dual4 differentiable_root(double at, const Components<4>& sum, double by);

/// Derivatives of a quantity with respect to the design, by the chain rule.
/// @param by  derivatives of the quantity with respect to the registers
Components<4> tangent(std::span<const double> by, std::span<const Dual4> registers);

/// Provides endpoints of pieces (intervals of t) and of columns with their derivatives with respect to the design for
/// PlanarSlice::for_each_node().
class PlanarSliceSensitivity {
 public:
  using Scalar = Dual4;

  /// @param scratch         scratch memory of planar_slice after measure()
  /// @param dual_registers  registers with derivatives, after all stages except that of v
  /// @param registers       values of `dual_registers`
  PlanarSliceSensitivity(const PlanarSlice& planar_slice, const PlanarSliceScratch& scratch,
                         std::span<const Dual4> dual_registers, std::span<double> registers)
      : slice_(planar_slice), scratch_(scratch), dual_registers_(dual_registers), registers_(registers) {}

  /// The coordinate t of a vertex with its derivatives. @param first  index of the first vertex at t
  Dual4 vertex(std::size_t first, double t) const;
  Dual4 end(EndLabel end, const Dual4& t) const;

  /// Derivatives of the polynomial of a boundary curve: with respect to t, to s, and (`change`) to the design at
  /// constant t and s.
  struct Boundary {
    double t, s;
    Components<4> change;
  };
  /// @param of  index of a surface, or label of a vertex that lies on a side of the slice or on an independent
  ///            constraint
  Boundary boundary(std::uint32_t of, double t, double s) const;

 private:
  Dual4 crossing(const PlanarSliceScratch::Vertex& at) const;
  Dual4 turning_point(std::uint32_t surface, const PlanarSliceScratch::Vertex& at) const;

  const PlanarSlice& slice_;
  const PlanarSliceScratch& scratch_;
  std::span<const Dual4> dual_registers_;
  std::span<double> registers_;
};

}  // namespace pkm::generic
