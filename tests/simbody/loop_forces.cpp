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

void note(double& worst, const VectorXd& errors) { worst = std::max(worst, errors.lpNorm<Eigen::Infinity>()); }

}  // namespace

LoopForces loop_forces(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
                       SimTK::State state, const SimTK::MobilizedBody& platform, const PlatformMotion& motion,
                       const Vec3& station, const std::array<double, 6>& wrench,
                       const std::vector<SimTK::MobilizedBody>& drives) {
  using Least = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;
  const auto body = platform.getMobilizedBodyIndex();
  const auto told = static_cast<Index>(motion.rows.size());
  system.realize(state, SimTK::Stage::Position);
  LoopForces found;
  note(found.open, eigen(SimTK::Vector(state.getQErr())));

  // Rates: loops stay closed, G u = 0, and the platform moves as told.
  SimTK::Matrix simtk_G, frame;
  matter.calcG(state, simtk_G);
  matter.calcFrameJacobian(state, body, Vec3(0), frame);
  const MatrixXd G = eigen(simtk_G), J = eigen(frame);
  const Index unknowns = G.cols();
  MatrixXd moves(G.rows() + told, unknowns);
  moves.topRows(G.rows()) = G;
  for (Index i = 0; i < told; ++i) moves.row(G.rows() + i) = J.row(motion.rows[static_cast<std::size_t>(i)]);
  Least loops;
  loops.setThreshold(1e-9);
  loops.compute(G);
  found.constraints = static_cast<int>(G.rows());
  found.constraint_rank = static_cast<int>(loops.rank());
  const Least rates(moves);
  const VectorXd speeds = stacked(VectorXd::Zero(G.rows()), motion.velocity);
  const VectorXd u = rates.solve(speeds);
  note(found.open, moves * u - speeds);
  state.updU() = simtk(u);
  system.realize(state, SimTK::Stage::Dynamics);

  SimTK::Vector loop_bias;
  matter.calcBiasForAccelerationConstraints(state, loop_bias);
  const SimTK::SpatialVec bias = matter.calcBiasForFrameJacobian(state, body, Vec3(0));
  VectorXd platform_bias(told);
  for (Index i = 0; i < told; ++i) {
    const int row = motion.rows[static_cast<std::size_t>(i)];
    platform_bias[i] = bias[row / 3][row % 3];
  }
  const VectorXd wanted = stacked(-eigen(loop_bias), motion.acceleration - platform_bias);
  const VectorXd acceleration = rates.solve(wanted);
  note(found.open, moves * acceleration - wanted);

  // M udot + G^T lambda + f_inertial - f_applied = B tau
  SimTK::Vector_<SimTK::SpatialVec> on_bodies = system.getRigidBodyForces(state, SimTK::Stage::Dynamics);
  matter.addInStationForce(state, body, station, Vec3(wrench[0], wrench[1], wrench[2]), on_bodies);
  matter.addInBodyTorque(state, body, Vec3(wrench[3], wrench[4], wrench[5]), on_bodies);
  SimTK::Vector needed;
  matter.calcResidualForce(state, SimTK::Vector(), on_bodies, simtk(acceleration), SimTK::Vector(), needed);
  const auto count = static_cast<Index>(drives.size());
  MatrixXd carried(unknowns, count + G.rows());
  carried << MatrixXd::Zero(unknowns, count), -G.transpose();
  for (Index i = 0; i < count; ++i)
    carried(static_cast<int>(drives[static_cast<std::size_t>(i)].getFirstUIndex(state)), i) = 1;
  const VectorXd forces = Least(carried).solve(eigen(needed));
  note(found.unbalanced, carried * forces - eigen(needed));
  found.drives = forces.head(count);
  found.multipliers = forces.tail(G.rows());
  return found;
}

}  // namespace pkm::simbody
