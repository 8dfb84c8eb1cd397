#include "tests/simbody/multibody.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "tests/simbody/loop_forces.hpp"

namespace pkm::simbody {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using SimTK::MobilizedBody, SimTK::Rotation, SimTK::Transform, SimTK::UnitVec3, SimTK::Vec3;
using Type = MultibodyModel::JointType;

Vec3 vec3(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
Eigen::Vector3d eigen3(const Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

struct MultibodySystem::System {
  explicit System(const MultibodyModel& of);

  /// Point of the base frame at the reference pose, in the frame of a body.
  Vec3 station(std::size_t body, const Eigen::Vector3d& point) const {
    return vec3(point) - (body == model.platform ? vec3(model.origin) : Vec3(0));
  }
  void add_body(const MultibodyModel::Joint& joint);
  void close(const MultibodyModel::Joint& joint);

  MultibodyModel model;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::vector<MobilizedBody> bodies;  ///< by body of the model
  std::vector<std::size_t> drives;    ///< by joint of the mechanism: index in the tree
  SimTK::State initial, state;
};

/// The frames of all bodies have the axes of the base frame at the reference pose, and its origin; but that of the
/// platform has the origin of the platform frame.
MultibodySystem::System::System(const MultibodyModel& of) : model(of), bodies(of.bodies.size()) {
  bodies[0] = matter.Ground();
  for (const MultibodyModel::Joint& joint : model.tree) add_body(joint);
  for (const MultibodyModel::Joint& joint : model.closures) close(joint);
  for (std::size_t i = 0; i < model.tree.size(); ++i)
    if (const auto& drive = model.tree[i].drive) {
      drives.resize(std::max(drives.size(), drive->joint + 1));
      drives[drive->joint] = i;
    }
  SimTK::Force::Gravity(forces, matter, Vec3(0, 0, -9.81));
  system.realizeTopology();
  initial = system.getDefaultState();
  matter.setUseEulerAngles(initial, true);
  system.realizeModel(initial);
  state = initial;
}

void MultibodySystem::System::add_body(const MultibodyModel::Joint& joint) {
  const MultibodyModel::Body& body = model.bodies[joint.child];
  SimTK::Body made = SimTK::Body::Massless();
  if (body.mass > 0) {
    Eigen::Matrix3d I = body.inertia;
    // Simbody requires that no moment is larger than the sum of the others; a planar mechanism has one moment only.
    if (const double largest = I.diagonal().maxCoeff(); 2 * largest > I.trace() * (1 + 1e-12)) {
      Index axis;
      I.diagonal().maxCoeff(&axis);
      for (Index k = 0; k < 3; ++k)
        if (k != axis) I(k, k) += largest;
    }
    const Vec3 centre = station(joint.child, body.centre);
    const SimTK::Inertia central(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    made =
        SimTK::Body::Rigid(SimTK::MassProperties(body.mass, centre, central.shiftFromMassCenter(-centre, body.mass)));
  }
  Rotation axes;
  const auto axis = [&](std::size_t k) { return UnitVec3(vec3(joint.axes[k])); };
  if (joint.type == Type::prismatic) axes = Rotation(axis(0), SimTK::XAxis);
  if (joint.type == Type::revolute) axes = Rotation(axis(0), SimTK::ZAxis);
  if (joint.type == Type::universal) axes = Rotation(axis(0), SimTK::XAxis, axis(1), SimTK::YAxis);
  MobilizedBody& parent = bodies[joint.parent];
  const Transform on_parent(axes, station(joint.parent, joint.point)),
      on_child(axes, station(joint.child, joint.point));
  MobilizedBody& child = bodies[joint.child];
  switch (joint.type) {
    case Type::fixed:
      child = MobilizedBody::Weld(parent, on_parent, made, on_child);
      break;
    case Type::prismatic:
      child = MobilizedBody::Slider(parent, on_parent, made, on_child);
      break;
    case Type::revolute:
      child = MobilizedBody::Pin(parent, on_parent, made, on_child);
      break;
    case Type::universal:
      child = MobilizedBody::Universal(parent, on_parent, made, on_child);
      break;
    case Type::ball:
      child = MobilizedBody::Ball(parent, on_parent, made, on_child);
      break;
  }
}

void MultibodySystem::System::close(const MultibodyModel::Joint& joint) {
  MobilizedBody &a = bodies[joint.parent], &b = bodies[joint.child];
  SimTK::Constraint::Ball(a, station(joint.parent, joint.point), b, station(joint.child, joint.point));
  const auto normal = [&](const Eigen::Vector3d& on_a, const Eigen::Vector3d& on_b) {
    SimTK::Constraint::ConstantAngle(a, UnitVec3(vec3(on_a)), b, UnitVec3(vec3(on_b)), SimTK::Pi / 2);
  };
  if (joint.type == Type::universal) normal(joint.axes[0], joint.axes[1]);
  if (joint.type != Type::revolute) return;
  const Eigen::Vector3d across = joint.axes[0].unitOrthogonal();
  normal(across, joint.axes[0]);
  normal(joint.axes[0].cross(across), joint.axes[0]);
}

MultibodySystem::MultibodySystem(const MultibodyModel& model) : system_(new System(model)) {}
MultibodySystem::~MultibodySystem() = default;

void MultibodySystem::reset() { system_->state = system_->initial; }

double MultibodySystem::assemble(const PlatformState& platform, bool with_orientation) {
  System& s = *system_;
  double residual = 1;
  for (int k = 0; k < 20 && residual > 1e-13; ++k) {
    s.system.realize(s.state, SimTK::Stage::Velocity);
    const MobilizedBody& body = s.bodies[s.model.platform];
    SimTK::Matrix G, frame;
    s.matter.calcG(s.state, G);
    s.matter.calcFrameJacobian(s.state, body.getMobilizedBodyIndex(), Vec3(0), frame);
    const SimTK::Vector errors = s.state.getQErr();
    const int loops = errors.size(), rows = with_orientation ? 6 : 3;
    MatrixXd J(loops + rows, G.ncol());
    VectorXd error(loops + rows);
    for (int i = 0; i < loops; ++i) {
      error[i] = errors[i];
      for (int j = 0; j < G.ncol(); ++j) J(i, j) = G(i, j);
    }
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < G.ncol(); ++j) J(loops + i, j) = frame(with_orientation ? i : i + 3, j);
    const Transform& X = body.getBodyTransform(s.state);
    Eigen::Matrix3d R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) R(i, j) = X.R()[i][j];
    const Eigen::AngleAxisd turned(R * s.model.rotation * platform.rotation.transpose());
    if (with_orientation) error.segment<3>(loops) = turned.angle() * turned.axis();
    error.tail<3>() = eigen3(X.p()) - platform.origin;
    residual = error.lpNorm<Eigen::Infinity>();
    const VectorXd step = -Eigen::CompleteOrthogonalDecomposition<MatrixXd>(J).solve(error);
    SimTK::Vector u(static_cast<int>(step.size())), q;
    for (int i = 0; i < u.size(); ++i) u[i] = step[i];
    s.matter.multiplyByN(s.state, false, u, q);
    s.state.updQ() += q;
  }
  return residual;
}

MultibodySolution MultibodySystem::solve(const PlatformState& platform, const Eigen::Vector3d& point,
                                         const std::array<double, 6>& wrench) {
  System& s = *system_;
  s.system.realize(s.state, SimTK::Stage::Position);
  const MobilizedBody& body = s.bodies[s.model.platform];
  std::vector<MobilizedBody> driven;
  MultibodySolution solution;
  for (const std::size_t i : s.drives) {
    driven.push_back(s.bodies[s.model.tree[i].child]);
    solution.positions.push_back(s.model.tree[i].drive->position + driven.back().getOneQ(s.state, 0));
  }
  const LoopForces found =
      loop_forces(s.system, s.matter, s.state, body, {platform.rows, platform.velocity, platform.acceleration},
                  body.findStationAtGroundPoint(s.state, vec3(point)), wrench, driven);
  solution.forces.assign(found.drives.data(), found.drives.data() + found.drives.size());
  solution.closure_error = found.closure_error;
  solution.force_error = found.force_error;
  return solution;
}

}  // namespace pkm::simbody
