// Base class that derives Jacobian, conditioning, influence coefficients and pose reports of a mechanism from its
// inverse kinematics, by automatic differentiation along a motion (second-order Taylor arithmetic).
#pragma once

#include <cmath>

#include "engine/geometry/conditioning.hpp"
#include "engine/math/taylor.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::test {

using Parameters = std::span<const double>;

/// Mechanism with N coordinates and N driven joints (CRTP). Self defines
///
///   template <class S> Vector<S, N> joints(Parameters, const Vector<S, N>& pose, const std::string& mode) const;
///   NamedValues margins(Parameters, const Pose<double>&, const AxisVector<double>& joints, const LimitSpec&) const;
///   double length(Parameters) const;  // MechanismInfo::characteristic_length
///
/// A joint coordinate is NaN if its limb does not reach the pose.
template <class Self, std::size_t N>
class FromInverse : public Mechanism, Velocities {
 public:
  const MechanismInfo& info() const final { return info_; }
  const Velocities* velocities() const final { return this; }

  PoseReport inspect(Parameters p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const final {
    PoseReport report;
    const AxisVector<double> q = self().joints(p, fixed<N>(pose), mode);
    report.joints = q;
    report.margins = self().margins(p, pose, q, limits);
    for (std::size_t i = N; i-- > 0;)
      if (!std::isfinite(q[i])) report.reason = info_.joints[i].name + " does not reach the pose";
    report.assembles = report.reason.empty();
    if (!report.assembles) return report;
    for (const auto& [name, margin] : report.margins)
      if (!(margin >= 0) && report.reason.empty()) report.reason = name + " is violated";
    report.feasible = report.reason.empty();
    const Matrix<double, N, N> J = jacobian(p, pose, mode);
    report.J = J;
    double columns[N][N];
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j)
        columns[j][i] = info_.coordinates[j].turns() ? J(i, j) / self().length(p) : J(i, j);
    report.conditioning = inverse_condition(columns);
    return report;
  }

 protected:
  explicit FromInverse(MechanismInfo info) : info_(std::move(info)) {}

 private:
  const Self& self() const { return static_cast<const Self&>(*this); }

  /// Joint coordinates with their first and second time derivatives, for a pose that moves at constant velocity.
  Vector<Taylor, N> joints_along(Parameters p, const Pose<double>& pose, const Vector<double, N>& velocity,
                                 const std::string& mode) const {
    Vector<Taylor, N> at;
    for (std::size_t i = 0; i < N; ++i) at[i] = {pose[i], velocity[i], 0};
    return self().joints(p, at, mode);
  }
  Matrix<double, N, N> jacobian(Parameters p, const Pose<double>& pose, const std::string& mode) const {
    Matrix<double, N, N> J;
    for (std::size_t j = 0; j < N; ++j) {
      Vector<double, N> unit;
      unit[j] = 1;
      const Vector<Taylor, N> q = joints_along(p, pose, unit, mode);
      for (std::size_t i = 0; i < N; ++i) J(i, j) = q[i].d;
    }
    return J;
  }
  std::optional<Influence<double>> influence(Parameters p, const Pose<double>& pose,
                                             const std::string& mode) const final {
    for (const double joint : self().joints(p, fixed<N>(pose), mode))
      if (!std::isfinite(joint)) return std::nullopt;
    const auto second_derivatives = [&](const AxisVector<double>& velocity) {
      const Vector<Taylor, N> q = joints_along(p, pose, fixed<N>(velocity), mode);
      AxisVector<double> terms(N);
      for (std::size_t i = 0; i < N; ++i) terms[i] = q[i].dd;
      return terms;
    };
    return Influence<double>{jacobian(p, pose, mode), quadratic_form_matrices(N, second_derivatives)};
  }

  MechanismInfo info_;
};

}  // namespace pkm::test
