// CRTP base for workspace evaluators whose analysis is one template for double and Dual4.
#pragma once

#include "engine/math/quadrature.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"

namespace pkm {

/// CRTP base class of workspace evaluators with derivatives: Self defines `template <class S> void run(std::span<const
/// S> parameters, Scratch&, WorkspaceResult<S>&) const`.
template <class Self>
class WithGradients : public WorkspaceEvaluator, public GradientEvaluator {
 public:
  void evaluate(std::span<const double> parameters, Scratch& scratch, WorkspaceResult<double>& result) const final {
    static_cast<const Self&>(*this).run(parameters, scratch, result);
  }
  void evaluate(std::span<const Dual4> parameters, Scratch& scratch, WorkspaceResult<Dual4>& result) const final {
    static_cast<const Self&>(*this).run(parameters, scratch, result);
  }
  const GradientEvaluator* gradients() const override { return this; }
};

/// Stores the volume, the relative error and the number of columns of a quadrature in a workspace result.
template <class S, class T>
void set_volume(const Integral<T>& integral, WorkspaceResult<S>& result) {
  const double value = value_of(integral.value);
  result.volume = S(integral.value);
  result.error = value > 0 ? integral.error / value : 0;
  result.columns = integral.evaluations;
}

/// The parameters of a design, converted to constants of another scalar type.
template <class To, std::size_t N, class From>
std::array<To, N> constants(std::span<const From> parameters) {
  std::array<To, N> values;
  for (std::size_t i = 0; i < N; ++i) values[i] = To(value_of(parameters[i]));
  return values;
}

}  // namespace pkm
