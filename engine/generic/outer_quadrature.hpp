// Adaptive Gauss-Patterson quadrature for volumes over more than three coordinates: the integrand is the
// volume over three inner coordinates as a function of the outer ones. This function is smooth except where parts of
// the workspace begin or end: there the subdivision becomes finer. A workspace that all nodes miss is not found.
#pragma once

#include <functional>
#include <vector>

#include "engine/generic/evaluation.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

class OuterQuadrature {
 public:
  /// @param coordinates  indices of the outer coordinates, the outermost first; their ranges are those of the model
  /// @param tolerance    relative error of the volume that is accepted
  OuterQuadrature(const Evaluation& evaluation, std::vector<std::size_t> coordinates, double tolerance)
      : e_(evaluation), coordinates_(std::move(coordinates)), tolerance_(tolerance) {}

  const std::vector<std::size_t>& coordinates() const { return coordinates_; }

  /// inner(inputs, by_input) returns the volume over the inner coordinates for the values of the outer ones in
  /// `inputs`, and adds its derivatives with respect to the inputs to `by_input`, unless that is empty.
  using Inner = std::function<Integral<double>(std::span<const double> inputs, std::span<double> by_input)>;
  /// The volume over all coordinates.
  /// @param inputs    values of the graph's inputs; those of the coordinates are overwritten
  /// @param by_input  derivatives by input, to which those of the volume are added; empty: not requested
  Integral<double> measure(std::vector<double>& inputs, std::span<double> by_input, const Inner& inner) const {
    return measure(0, inputs, by_input, inner);
  }
  /// The range of the coordinate coordinates_[level]. S is double or Dual4.
  template <class S>
  Subinterval<S> range(std::size_t level, const std::vector<S>& inputs) const {
    const std::size_t coordinate = coordinates_[level];
    return {outputs_of(e_.lower[coordinate], inputs).at(0), outputs_of(e_.upper[coordinate], inputs).at(0)};
  }

 private:
  Integral<double> measure(std::size_t level, std::vector<double>& inputs, std::span<double> by_input,
                           const Inner& inner) const;
  /// The volume over the coordinates after coordinates_[level], with that coordinate fixed at `value`.
  Integral<double> at(std::size_t level, double value, std::vector<double>& inputs, std::span<double> by_input,
                      const Inner& inner) const;

  const Evaluation& e_;
  std::vector<std::size_t> coordinates_;
  double tolerance_;
};

}  // namespace pkm::generic
