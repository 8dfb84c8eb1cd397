// Definition of a per-pose quantity: a number of each pose, or of each joint at each pose. Workspace analyses,
// objectives, names in expressions, limits, plots and exports are derived from the definition. Built-in quantities are
// listed in engine/workspace/pose_quantities.hpp; formulas of mechanism files and studies are quantities, too
// (QuantityInfo).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "engine/geometry/pose.hpp"
#include "engine/math/dual.hpp"

namespace pkm {

/// Stores a generic lambda [](const auto& M_q, auto* values) {...} as one type, with its instantiations for all matrix
/// types of the joint-space inertia M_q.
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

/// A statistic of a quantity over the workspace, which expressions call `name_statistic`.
struct NamedStatistic {
  const char* statistic;  ///< "mean", "min", "max", or "worst": mean over the poses of the worst value among the joints
  const char* meaning;
};

struct PoseQuantity {
  enum class Worst { minimum, maximum };

  /// Name of the field, for example "inertia_condition". The name of the objective has hyphens instead of underscores.
  const char* name;
  const char* unit;           ///< SI unit; "1" if dimensionless
  const char* meaning;        ///< short description, for example "inverse condition number of the Jacobian"
  double lower, upper;        ///< smallest and largest possible value
  Worst worst;                ///< which extremum over a workspace is the worst case
  double value_if_undefined;  ///< value at poses where the quantity is not finite, and for workspaces without poses
  bool per_joint = false;
  /// Statistics that expressions can use; unused elements have no `statistic`.
  std::array<NamedStatistic, 4> results = {};
  // Exactly one of the following three members is set. It computes the values of the quantity at a pose: one value, or
  // one for each joint.

  /// Computes the values from the result of the inverse kinematics: J, margins, ...
  void (*from_report)(const PoseReport&, double* values) = nullptr;
  InertiaFunction from_inertia = {};        ///< computes the values from the joint-space inertia M_q
  std::optional<std::size_t> formula = {};  ///< index of the formula among MechanismInfo::quantities

  /// @return true if the values are computed from the joint-space inertia, which requires dynamics and a working mode
  bool needs_inertia() const { return !from_report && !formula; }
  /// @return true if the values are computed from the inverse kinematics; they may then depend on a characteristic
  /// length
  bool needs_report() const { return from_report != nullptr; }
  /// Evaluates a quantity whose values are not computed from the joint-space inertia.
  void evaluate(const PoseReport& report, double* values) const {
    if (formula)
      *values = report.quantities[*formula];
    else
      from_report(report, values);
  }
};

/// Creates the pose quantity for a formula. The range of its values is unlimited, and its statistics are NaN for a
/// workspace without poses.
/// @param index  index of the formula among MechanismInfo::quantities
std::shared_ptr<const PoseQuantity> formula_quantity(const std::string& name, const std::string& unit,
                                                     const std::string& meaning, std::size_t index);

}  // namespace pkm
