// A number of every pose, or of every joint at every pose: stated once. Surveys of any mechanism, objectives, names of
// expressions, pictures and exports follow from the definition. Those there are: engine/workspace/pose_quantities.hpp.
#pragma once

#include <array>
#include <tuple>

#include "engine/geometry/pose.hpp"
#include "engine/math/dual.hpp"

namespace pkm {

/// [](const auto& M_q, auto* values) {...}, for every kind of matrix that surveys have.
class InertiaFunction {
 public:
  constexpr InertiaFunction() = default;
  template <class F>
  constexpr InertiaFunction(F)
      : functions_(call<F, AxisMatrix<double>>, call<F, AxisMatrix<Dual4>>, call<F, Matrix<double, 4, 4>>,
                   call<F, Matrix<Dual4, 4, 4>>) {}

  template <class M>
  void operator()(const M& M_q, typename M::Scalar* values) const {
    std::get<Function<M>>(functions_)(M_q, values);
  }

 private:
  template <class M>
  using Function = void (*)(const M&, typename M::Scalar*);
  template <class F, class M>
  static void call(const M& M_q, typename M::Scalar* values) {
    F()(M_q, values);
  }

  std::tuple<Function<AxisMatrix<double>>, Function<AxisMatrix<Dual4>>, Function<Matrix<double, 4, 4>>,
             Function<Matrix<Dual4, 4, 4>>>
      functions_;
};

/// A number that expressions know as `name_statistic`.
struct PoseResult {
  const char* statistic;  ///< "mean", "min", "max", or "worst": the mean of the worst joint
  const char* meaning;
};

struct PoseQuantity {
  enum class Worst { least, greatest };

  const char* name;        ///< of its field, "inertia_condition"; that of its objective has hyphens
  const char* unit;        ///< SI, "1"
  const char* meaning;     ///< "inverse condition number of the Jacobian"
  double least, greatest;  ///< what its values can be
  Worst worst;             ///< which value a design is judged by; objectives go the other way
  double without_value;    ///< of a pose where it is not finite, and of a workspace without poses
  bool per_joint = false;
  std::array<PoseResult, 2> results = {};  ///< without a statistic: none
  // Its values at a pose, one or as many as joints, from one of the following; the other is not set.
  void (*of_report)(const PoseReport&, double* values) = nullptr;  ///< what inverse kinematics says: J, margins, ...
  InertiaFunction of_inertia = {};                                 ///< the inertia M_q that the joints feel [kg]

  /// Then it needs dynamics and a working mode; else a Jacobian, and may depend on a characteristic length.
  bool needs_inertia() const { return !of_report; }
};

}  // namespace pkm
