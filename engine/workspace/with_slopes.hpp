// Surveyors written once for numbers and for derivatives.
#pragma once

#include "engine/math/quadrature.hpp"
#include "engine/mechanism/surveyor.hpp"

namespace pkm {

/// Self has `template <class S> void run(std::span<const S> parameters, Scratch&, Survey<S>&) const`.
template <class Self>
class WithGradients : public WorkspaceEvaluator, public GradientEvaluator {
 public:
  void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const final {
    static_cast<const Self&>(*this).run(parameters, scratch, survey);
  }
  void survey(std::span<const Dual4> parameters, Scratch& scratch, Survey<Dual4>& survey) const final {
    static_cast<const Self&>(*this).run(parameters, scratch, survey);
  }
  const GradientEvaluator* slopes() const override { return this; }
};

/// What a quadrature found, with derivatives or without.
template <class S, class T>
void take_volume(const Integral<T>& found, Survey<S>& survey) {
  const double value = value_of(found.value);
  survey.volume = S(found.value);
  survey.error = value > 0 ? found.error / value : 0;
  survey.columns = found.evaluations;
}

/// The parameters of a design as constants of another scalar.
template <class To, std::size_t N, class From>
std::array<To, N> constants(std::span<const From> parameters) {
  std::array<To, N> values;
  for (std::size_t i = 0; i < N; ++i) values[i] = To(value_of(parameters[i]));
  return values;
}

}  // namespace pkm
