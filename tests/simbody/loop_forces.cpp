#include "tests/simbody/loop_forces.hpp"

#include <algorithm>

namespace pkm::simbody {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, Eigen::Index;
using SimTK::Vec3;

VectorXd eigen(const SimTK::Vector& v) {
  VectorXd copy(v.size());
  for (int k = 0; k < v.size(); ++k) copy[k] = v[k];
  return copy;
}

SimTK::Vector simtk(const VectorXd& v) {
  SimTK::Vector copy(static_cast<int>(v.size()));
  for (int k = 0; k < copy.size(); ++k) copy[k] = v[k];
  return copy;
}

MatrixXd eigen(const SimTK::Matrix& m) {
  MatrixXd copy(m.nrow(), m.ncol());
  for (int i = 0; i < m.nrow(); ++i)
    for (int j = 0; j < m.ncol(); ++j) copy(i, j) = m(i, j);
  return copy;
}

VectorXd stacked(const VectorXd& a, const VectorXd& b) {
  VectorXd both(a.size() + b.size());
  both << a, b;
  return both;
}

void update_max(double& worst, const VectorXd& errors) { worst = std::max(worst, errors.lpNorm<Eigen::Infinity>()); }

}  // namespace

LoopForces loop_forces(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
                       SimTK::State state, const SimTK::MobilizedBody& platform, const PlatformMotion& motion,
                       const Vec3& station, const std::array<double, 6>& wrench,
                       const std::vector<SimTK::MobilizedBody>& drives) {
  using MinNorm = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;
  const auto body = platform.getMobilizedBodyIndex();
  const auto rows = static_cast<Index>(motion.rows.size());
  system.realize(state, SimTK::Stage::Position);
  LoopForces found;
  update_max(found.closure_error, eigen(SimTK::Vector(state.getQErr())));

  // Velocities u: the loops stay closed, G u = 0, and the platform has the prescribed twist.
  SimTK::Matrix simtk_G, frame;
  matter.calcG(state, simtk_G);
  matter.calcFrameJacobian(state, body, Vec3(0), frame);
  const MatrixXd G = eigen(simtk_G), J = eigen(frame);
  const Index unknowns = G.cols();
  MatrixXd constraints(G.rows() + rows, unknowns);
  constraints.topRows(G.rows()) = G;
  for (Index i = 0; i < rows; ++i) constraints.row(G.rows() + i) = J.row(motion.rows[static_cast<std::size_t>(i)]);
  MinNorm loops;
  loops.setThreshold(1e-9);
  loops.compute(G);
  found.constraints = static_cast<int>(G.rows());
  found.constraint_rank = static_cast<int>(loops.rank());
  const MinNorm rates(constraints);
  const VectorXd speeds = stacked(VectorXd::Zero(G.rows()), motion.velocity);
  const VectorXd u = rates.solve(speeds);
  update_max(found.closure_error, constraints * u - speeds);
  state.updU() = simtk(u);
  system.realize(state, SimTK::Stage::Dynamics);

  SimTK::Vector loop_bias;
  matter.calcBiasForAccelerationConstraints(state, loop_bias);
  const SimTK::SpatialVec bias = matter.calcBiasForFrameJacobian(state, body, Vec3(0));
  VectorXd platform_bias(rows);
  for (Index i = 0; i < rows; ++i) {
    const int row = motion.rows[static_cast<std::size_t>(i)];
    platform_bias[i] = bias[row / 3][row % 3];
  }
  const VectorXd right_side = stacked(-eigen(loop_bias), motion.acceleration - platform_bias);
  const VectorXd acceleration = rates.solve(right_side);
  update_max(found.closure_error, constraints * acceleration - right_side);

  // M udot + G^T lambda + f_inertial - f_applied = B tau
  SimTK::Vector_<SimTK::SpatialVec> on_bodies = system.getRigidBodyForces(state, SimTK::Stage::Dynamics);
  matter.addInStationForce(state, body, station, Vec3(wrench[0], wrench[1], wrench[2]), on_bodies);
  matter.addInBodyTorque(state, body, Vec3(wrench[3], wrench[4], wrench[5]), on_bodies);
  SimTK::Vector residual;
  matter.calcResidualForce(state, SimTK::Vector(), on_bodies, simtk(acceleration), SimTK::Vector(), residual);
  const auto count = static_cast<Index>(drives.size());
  MatrixXd columns(unknowns, count + G.rows());
  columns << MatrixXd::Zero(unknowns, count), -G.transpose();
  for (Index i = 0; i < count; ++i)
    columns(static_cast<int>(drives[static_cast<std::size_t>(i)].getFirstUIndex(state)), i) = 1;
  const VectorXd forces = MinNorm(columns).solve(eigen(residual));
  update_max(found.force_error, columns * forces - eigen(residual));
  found.drives = forces.head(count);
  found.multipliers = forces.tail(G.rows());
  return found;
}

}  // namespace pkm::simbody
