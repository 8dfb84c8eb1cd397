#include "engine/generic/elastostatics.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "engine/generic/eigen_matrix.hpp"
#include "engine/generic/newton_euler.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm::generic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d;

Vector3d vector(const Vector<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// Numerical values of nodes at a pose: positions and stiffnesses of all elastic bodies, compliances of the drives,
/// origin of the platform frame, and the pin's axis if the platform is a pin.
class Numbers {
 public:
  Numbers(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose, std::size_t mode) {
    std::vector<Node> nodes(e.model.origin.begin(), e.model.origin.end());
    const auto add = [&nodes](const BeamNodes& beam) {
      nodes.insert(nodes.end(), beam.near.begin(), beam.near.end());
      nodes.insert(nodes.end(), beam.far.begin(), beam.far.end());
      nodes.insert(nodes.end(), {beam.EA, beam.EI, beam.GJ});
    };
    for (const SolidNodes& solid : e.model.jointed->solids)
      if (solid.beam) add(*solid.beam);
    for (const JointNodes& joint : e.model.jointed->joints) {
      if (joint.holds_pin) nodes.insert(nodes.end(), joint.axes[0].begin(), joint.axes[0].end());
      if (!joint.drive) continue;
      if (joint.drive->ram) add(*joint.drive->ram);
      if (joint.drive->compliance) nodes.push_back(*joint.drive->compliance);
    }
    std::vector<double> inputs = e.inputs(parameters, no_limits(e.model.info), mode);
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e.model.inputs.coordinate(0)));
    const std::vector<double> values = outputs_of(expression::Program(e.model.graph, nodes), inputs);
    for (std::size_t i = 0; i < nodes.size(); ++i) value_.emplace(nodes[i], values[i]);
  }
  double operator()(Node node) const { return value_.at(node); }
  Vector3d operator()(const std::array<Node, 3>& nodes) const {
    return {value_.at(nodes[0]), value_.at(nodes[1]), value_.at(nodes[2])};
  }

 private:
  std::map<Node, double> value_;
};

/// Column of the first unknown of each joint in the equilibrium matrix, by joint: its three force components, then its
/// couples. The last element is the total number of unknowns.
std::vector<Index> first_columns(const NewtonEuler& system) {
  std::vector<Index> first = {0};
  for (const Joint& joint : system.joints) first.push_back(first.back() + 3 + std::ssize(joint.couples));
  return first;
}

/// Twice the complementary energy as a quadratic form x^T Q x of the unknown forces and couples x.
class Energy {
 public:
  Energy(const NewtonEuler& system, const JointedBodies& bodies, const Numbers& numbers)
      : system_(system), bodies_(bodies), numbers_(numbers), first_(first_columns(system)) {
    Q_ = MatrixXd::Zero(first_.back(), first_.back());
    add_drives();
    for (std::size_t i = 0; i < bodies.solids.size(); ++i)
      if (const auto& beam = bodies.solids[i].beam) add_beam(*beam, loads_of_solid(i, beam->near_joint));
    for (const auto& [drive, joints] : joints_of_rams())
      add_beam(*bodies.joints[joints.front().first].drive->ram, joints);
  }
  const MatrixXd& matrix() const { return Q_; }

 private:
  // three rows: the components of a force or couple as linear forms of the unknowns x
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  Rows no_rows() const { return Rows::Zero(3, Q_.cols()); }
  Rows force(std::size_t joint) const {
    Rows rows = no_rows();
    rows.middleCols<3>(first_[joint]) = Eigen::Matrix3d::Identity();
    return rows;
  }
  Rows couple(std::size_t joint) const {
    Rows rows = no_rows();
    for (std::size_t k = 0; k < system_.joints[joint].couples.size(); ++k)
      rows.col(first_[joint] + 3 + static_cast<Index>(k)) = vector(system_.joints[joint].couples[k]);
    return rows;
  }
  /// Adds the energy of elastic drives. If several joints have the same drive, the force of the drive is the sum of
  /// their forces.
  void add_drives() {
    std::map<std::size_t, Eigen::RowVectorXd> forces;
    std::map<std::size_t, double> compliances;
    for (std::size_t i = 0; i < bodies_.joints.size(); ++i) {
      const auto& drive = bodies_.joints[i].drive;
      if (!drive || !drive->compliance) continue;
      const Actuator& actuator = *system_.joints[i].actuator;
      Eigen::RowVectorXd& sum = forces.try_emplace(drive->joint, Eigen::RowVectorXd::Zero(Q_.cols())).first->second;
      sum += vector(actuator.axis).transpose() * (actuator.turns ? couple(i) : force(i));
      compliances[drive->joint] = numbers_(*drive->compliance);
    }
    for (const auto& [drive, sum] : forces) Q_ += compliances[drive] * sum.transpose() * sum;
  }
  /// The joints that load a beam: pairs of the joint's index and the sign (1 or -1) with which its force and couples
  /// act.
  using Loads = std::vector<std::pair<std::size_t, double>>;

  Loads loads_of_solid(std::size_t solid, std::size_t near_joint) const {
    Loads loads;
    for (std::size_t i = 0; i < bodies_.joints.size(); ++i) {
      const JointNodes& joint = bodies_.joints[i];
      if (i != near_joint && (joint.on == solid || joint.from == solid))
        loads.push_back({i, joint.on == solid ? 1 : -1});
    }
    return loads;
  }
  /// For each drive with an elastic slide, the joints whose forces load this slide; the key is the index of the drive.
  std::map<std::size_t, Loads> joints_of_rams() const {
    std::map<std::size_t, Loads> loads;
    for (std::size_t i = 0; i < bodies_.joints.size(); ++i)
      if (const auto& drive = bodies_.joints[i].drive; drive && drive->ram) loads[drive->joint].push_back({i, 1});
    return loads;
  }
  /// Adds the energy of a beam. The bending moment is linear along the beam, so that the integral of its square follows
  /// from the values at both ends.
  void add_beam(const BeamNodes& beam, const Loads& loads) {
    const Vector3d near = numbers_(beam.near), far = numbers_(beam.far);
    const double length = (far - near).norm();
    if (length == 0) return;  // the slide is fully retracted into its guide
    const Vector3d u = (far - near) / length;
    Rows load = no_rows(), at_near = no_rows(), at_far = no_rows();
    for (const auto& [i, sign] : loads) {
      const Rows F = force(i) * sign, M = couple(i) * sign;
      const Vector3d p = vector(system_.joints[i].point);
      load += F;
      for (const auto& [place, moment] : {std::pair(near, &at_near), std::pair(far, &at_far)}) {
        const Vector3d arm = p - place;
        *moment += M;
        for (Index k = 0; k < F.cols(); ++k) moment->col(k) += arm.cross(Vector3d(F.col(k)));
      }
    }
    const Eigen::RowVectorXd axial = u.transpose() * load, torsion = u.transpose() * at_far;
    Q_ += axial.transpose() * axial * (length / numbers_(beam.EA)) +
          torsion.transpose() * torsion * (length / numbers_(beam.GJ));
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - u * u.transpose();
    const Rows a = across * at_near, b = across * at_far;
    Q_ += (a.transpose() * a + b.transpose() * b + (a.transpose() * b + b.transpose() * a) * 0.5) *
          (length / (3 * numbers_(beam.EI)));
  }

  const NewtonEuler& system_;
  const JointedBodies& bodies_;
  const Numbers& numbers_;
  std::vector<Index> first_;
  MatrixXd Q_;
};

}  // namespace

PlatformCompliance platform_compliance(const Evaluation& evaluation, std::span<const double> parameters,
                                       const Pose<double>& pose, std::size_t mode) {
  const JointedBodies& bodies = *evaluation.model.jointed;
  const MotionState<double> at_rest{pose, AxisVector<double>(pose.size())};
  NewtonEuler system = newton_euler(evaluation, parameters, mode, at_rest, AxisVector<double>(pose.size()), {});
  const Numbers numbers(evaluation, parameters, pose, mode);
  const MatrixXd A = equations(system).A;
  const Energy energy(system, bodies, numbers);
  const MatrixXd& Q = energy.matrix();

  // The loads are six unit wrenches on the platform, acting at the origin of the platform frame. Lengths are divided by
  // `size`, so that matrix ranks do not depend on units.
  const auto platform = static_cast<std::size_t>(std::ranges::find(bodies.solids, true, &SolidNodes::is_platform) -
                                                 bodies.solids.begin());
  const double size = couple_length(system);
  MatrixXd B = MatrixXd::Zero(A.rows(), 6);
  const Vector3d arm = numbers(evaluation.model.origin) - vector(system.bodies[platform].centre);
  const auto row = static_cast<Index>(6 * platform);
  for (Index k = 0; k < 3; ++k) {
    B(row + k, k) = B(row + 3 + k, 3 + k) = -1;
    B.block<3, 1>(row + 3, k) = -arm.cross(Vector3d(Vector3d::Unit(k)));
  }
  for (const JointNodes& joint : bodies.joints)
    if (joint.holds_pin) {  // a moment about the axis of the pin has no effect, as in newton_euler()
      const Vector3d axis = numbers(joint.axes[0]).normalized();
      B.middleRows<3>(row + 3) -= axis * (axis.transpose() * B.middleRows<3>(row + 3)).eval();
    }
  Eigen::VectorXd scale_rows = Eigen::VectorXd::Ones(A.rows()), scale_columns = Eigen::VectorXd::Ones(A.cols());
  for (Index i = 0; i < A.rows(); ++i)
    if (i % 6 >= 3) scale_rows[i] = 1 / size;
  for (Index column = 0; const Joint& joint : system.joints) {
    column += 3;
    for (std::size_t k = 0; k < joint.couples.size(); ++k) scale_columns[column++] = size;
  }
  Eigen::VectorXd scale_wrench(6);
  scale_wrench << 1, 1, 1, size, size, size;
  const MatrixXd scaled_A = scale_rows.asDiagonal() * A * scale_columns.asDiagonal(),
                 scaled_B = scale_rows.asDiagonal() * B * scale_wrench.asDiagonal(),
                 scaled_Q = scale_columns.asDiagonal() * Q * scale_columns.asDiagonal();

  // Find the wrenches that the mechanism supports: B w is in the column space of A, i.e. has no component in its left
  // null space.
  Eigen::JacobiSVD<MatrixXd> decomposition(scaled_A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  decomposition.setThreshold(1e-9);
  const Index rank = decomposition.rank();
  const MatrixXd unbalanced = decomposition.matrixU().rightCols(A.rows() - rank).transpose() * scaled_B;
  MatrixXd supported = MatrixXd::Identity(6, 6);
  if (unbalanced.rows() > 0) {
    Eigen::JacobiSVD<MatrixXd> of_wrenches(unbalanced, Eigen::ComputeFullV);
    Index blocked = 0;
    while (blocked < of_wrenches.singularValues().size() && of_wrenches.singularValues()[blocked] > 1e-9) ++blocked;
    supported = of_wrenches.matrixV().rightCols(6 - blocked);
  }
  if (supported.cols() == 0) return {AxisMatrix<double>(6, 0), {}};
  // The unknowns are x = x_0 + N y, where N spans the null space of A and y minimises the energy.
  const MatrixXd x_0 = decomposition.solve(scaled_B * supported);
  const MatrixXd N = decomposition.matrixV().rightCols(A.cols() - rank);
  MatrixXd x = x_0;
  if (N.cols() > 0) {
    // Smaller eigenvalues are rounding errors: they belong to redundant forces that load rigid bodies only and
    // therefore have no energy.
    constexpr double kNoEnergy = 1e-13;  // relative to the largest element of the energy
    const Eigen::SelfAdjointEigenSolver<MatrixXd> of_energy(MatrixXd(N.transpose() * scaled_Q * N));
    const double threshold = kNoEnergy * scaled_Q.diagonal().maxCoeff();
    for (Index k = 0; k < N.cols(); ++k) {
      const double eigenvalue = of_energy.eigenvalues()[k];
      if (!(eigenvalue > threshold)) continue;
      const Eigen::VectorXd direction = N * of_energy.eigenvectors().col(k);
      x -= direction * (direction.transpose() * scaled_Q * x_0) / eigenvalue;
    }
  }
  // Convert the scaled wrenches to an orthonormal basis in the units N and N m.
  const MatrixXd wrenches = scale_wrench.asDiagonal() * supported;
  const MatrixXd basis =
      supported.cols() == 6
          ? MatrixXd::Identity(6, 6)
          : MatrixXd(Eigen::HouseholderQR<MatrixXd>(wrenches).householderQ() * MatrixXd::Identity(6, wrenches.cols()));
  const MatrixXd back = (basis.transpose() * wrenches).inverse();
  const MatrixXd scaled_C = x.transpose() * scaled_Q * x;
  MatrixXd C = back.transpose() * scaled_C * back;
  C = ((C + C.transpose()) / 2).eval();
  constexpr double kRounding = 1e-13;  // relative to the largest compliance: smaller elements are rounding errors
  const Eigen::VectorXd scale = (scale_wrench.cwiseInverse().asDiagonal() * basis).colwise().norm();
  for (Index i = 0; i < C.rows(); ++i)
    for (Index j = 0; j < C.cols(); ++j)
      if (std::fabs(C(i, j)) < kRounding * scaled_C.diagonal().maxCoeff() * scale[i] * scale[j]) C(i, j) = 0;
  return {axis_matrix(basis), axis_matrix(C)};
}

}  // namespace pkm::generic
