// Planar cable robot: a weight held by three winches. It has one drive more than coordinates (redundant actuation), so
// that the drive forces are not determined by the motion.
#pragma once

#include "engine/mechanism/scalar_dispatch.hpp"

namespace pkm::test {

class ThreeRopes final : public Mechanism, DynamicsDispatch<ThreeRopes> {
 public:
  ThreeRopes() {
    info_.name = "three-ropes";
    info_.title = "a weight on three winches";
    info_.parameters = {{"m", "kg", 2, 0.1, 10, "mass of the weight"}};
    info_.coordinates = {{"x", "m"}, {"z", "m"}};
    info_.joints = {{"l1", "m"}, {"l2", "m"}, {"l3", "m"}};
    info_.modes = {"hanging"};
    info_.sweeps = all_sweeps(info_.coordinates, {0, 1});
  }
  const MechanismInfo& info() const override { return info_; }
  const Dynamics* dynamics() const override { return this; }
  PoseReport inspect(std::span<const double> p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec&) const override {
    const MotionState<double> state{pose, {0, 0}};
    PoseDynamics<double> found;
    find_dynamics<double>(p, mode, {&state, 1}, {&found, 1});
    PoseReport report;
    report.margins = {{"below the winches", -pose[1]}};
    report.assembles = true;
    report.feasible = pose[1] <= 0;
    report.reason = report.feasible ? "" : "above the winches";
    report.joints = found.q;
    return report;
  }

 private:
  friend DynamicsDispatch<ThreeRopes>;

  const std::vector<std::string>& mass_models() const override { return models_; }
  const std::string& mass_model() const override { return models_.front(); }
  std::shared_ptr<const Mechanism> with_masses(const std::string&) const override { return nullptr; }

  template <class S>
  void find_dynamics(std::span<const S> p, const std::string&, std::span<const MotionState<S>> states,
                     std::span<PoseDynamics<S>> found) const {
    for (std::size_t k = 0; k < states.size(); ++k) {
      PoseDynamics<S>& d = found[k];
      d.assembles = true;
      d.q = AxisVector<S>(3);
      d.J = AxisMatrix<S>(3, 2);
      for (std::size_t i = 0; i < 3; ++i) {  // winches at x = -1, 0, 1 m
        const S x = states[k].pose[0] - (static_cast<double>(i) - 1), z = states[k].pose[1];
        d.q[i] = sqrt(S(x * x + z * z));
        d.J(i, 0) = x / d.q[i];
        d.J(i, 1) = z / d.q[i];
      }
      d.J_rate_X = AxisVector<S>(3);
      d.M_X = AxisMatrix<S>::identity(2) * p[0];
      d.h_X = AxisVector<S>(2);
      d.G_X = AxisVector<S>{S(0.0), S(p[0] * kGravity)};
      d.J_wrench = MatrixUpTo<S, 6, kMaxJoints>(6, 2);
      d.J_wrench(0, 0) = d.J_wrench(2, 1) = S(1.0);
    }
  }

  MechanismInfo info_;
  std::vector<std::string> models_ = {"parameters"};
};

}  // namespace pkm::test
