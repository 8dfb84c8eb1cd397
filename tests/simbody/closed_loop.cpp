#include "tests/simbody/closed_loop.hpp"

#include <cmath>

#include "tests/simbody/loop_forces.hpp"

namespace pkm::simbody {
namespace {

using SimTK::Vec3;

const double kRightAngle = SimTK::Pi / 2;

/// The rails of the paper's figure: direction e, axes p and q of the plane of the limb, and a point on the rail in
/// units of the rail spacing.
struct Rail {
  Vec3 e, p, q, point;
  double sense() const { return SimTK::dot(e, SimTK::cross(p, q)); }
};
const std::array<Rail, 4> kRails = {{{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 1, 0}},
                                     {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}},
                                     {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
                                     {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {1, 0, 1}}}};

/// The frame with the given x and y axes.
SimTK::Rotation axes(const Vec3& x, const Vec3& y) {
  return {SimTK::UnitVec3(x), SimTK::XAxis, SimTK::UnitVec3(y), SimTK::YAxis};
}

/// A rod along x from the origin that rotates about z. @param inertia  about z and y, at the centre of mass
SimTK::Body::Rigid rod(double mass, double length, double inertia) {
  const SimTK::Inertia central(inertia * 0.05, inertia, inertia);
  const Vec3 centre(length / 2, 0, 0);
  return SimTK::Body::Rigid(SimTK::MassProperties(mass, centre, central.shiftFromMassCenter(-centre, mass)));
}

SimTK::Body::Rigid plate(double mass, const Vec3& centre, const std::array<double, 3>& inertia) {
  const SimTK::Inertia central(inertia[0], inertia[1], inertia[2]);
  return SimTK::Body::Rigid(SimTK::MassProperties(mass, centre, central.shiftFromMassCenter(-centre, mass)));
}

SimTK::Body point_mass(double mass) {
  if (mass == 0) return SimTK::Body::Massless();
  return SimTK::Body::Rigid(SimTK::MassProperties(mass, Vec3(0), SimTK::Inertia(0)));
}

/// Joint angles of a limb about e: of rod 1 relative to p, and of rod 2 relative to rod 1.
struct Angles {
  double first, second;
};

}  // namespace

struct ClosedLoop::Model {
  explicit Model(const Parameters& parameters);

  SimTK::Vec3 joint_on_circle(std::size_t i) const {  // C_i relative to N, in the platform frame
    return {p.r * std::cos(p.beta[i]), p.r * std::sin(p.beta[i]), 0};
  }
  Angles angles(std::size_t i, const Vec3& C, int elbow) const;
  SimTK::State place(const Case& at) const;

  Parameters p;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::array<SimTK::MobilizedBody::Slider, 4> slide;
  std::array<SimTK::MobilizedBody::Pin, 4> first, second;
  SimTK::MobilizedBody::Pin middle, yaw;
  SimTK::MobilizedBody moving;
  SimTK::State initial;
};

ClosedLoop::Model::Model(const Parameters& parameters) : p(parameters) {
  using SimTK::Transform, SimTK::MobilizedBody, SimTK::UnitVec3;
  SimTK::Force::Gravity(forces, matter, Vec3(0, 0, -9.81));
  for (std::size_t i = 0; i < 4; ++i) {
    const Rail& rail = kRails[i];
    const double l1 = p.l_1[i], l2 = p.l_2[i];
    const Transform on_rail(axes(rail.e, rail.p), rail.point * p.L);
    slide[i] = MobilizedBody::Slider(matter.Ground(), on_rail, point_mass(p.slide), Transform());
    // the x axis of the slide is the rail; the z axis of the rods is, and their x axis is p at angle 0
    const Transform at_slide(axes(Vec3(0, 1, 0), Vec3(0, 0, 1)));
    first[i] = MobilizedBody::Pin(slide[i], at_slide, rod(p.m_1[i], l1, p.I_1[i]), Transform());
    second[i] = MobilizedBody::Pin(first[i], Vec3(l1, 0, 0), rod(p.m_2[i], l2, p.I_2[i]), Transform());
  }
  middle =
      MobilizedBody::Pin(second[2], Vec3(p.l_2[2], 0, 0), plate(p.m_middle, Vec3(0), p.I_middle), joint_on_circle(2));
  const SimTK::Body::Rigid moving_plate = plate(p.m, Vec3(p.c, 0, 0), p.I);
  const Vec3 D(0, 0, p.h);
  if (p.one_platform) {
    moving = MobilizedBody::Weld(middle, D, moving_plate, Transform());
  } else {
    yaw = MobilizedBody::Pin(middle, D, moving_plate, Transform());
    moving = yaw;
  }
  if (p.payload > 0) MobilizedBody::Weld(moving, Vec3(p.c_payload, 0, 0), point_mass(p.payload), Transform());

  const UnitVec3 z(0, 0, 1);
  for (const std::size_t i : {0, 1, 3}) {
    MobilizedBody& platform = i == 3 ? moving : middle;
    const Vec3 C = i == 3 ? Vec3(p.l, 0, 0) : joint_on_circle(i);
    SimTK::Constraint::Ball(second[i], Vec3(p.l_2[i], 0, 0), platform, C);
    SimTK::Constraint::ConstantAngle(second[i], z, platform, z, kRightAngle);
    if (i != 3 && !p.one_platform)
      SimTK::Constraint::ConstantAngle(second[i], z, platform, UnitVec3(SimTK::cross(kRails[i].e, z)), kRightAngle);
  }
  system.realizeTopology();
  initial = system.getDefaultState();
  system.realizeModel(initial);
}

/// Inverse kinematics of a limb by the law of cosines.
Angles ClosedLoop::Model::angles(std::size_t i, const Vec3& C, int elbow) const {
  const Rail& rail = kRails[i];
  const double l1 = p.l_1[i], l2 = p.l_2[i];
  const Vec3 to_C = C - rail.point * p.L;
  const double x = SimTK::dot(rail.p, to_C), y = SimTK::dot(rail.q, to_C), d2 = x * x + y * y;
  const double at_A = std::acos((d2 + l1 * l1 - l2 * l2) / (2 * l1 * std::sqrt(d2)));
  const double at_B = std::acos((l1 * l1 + l2 * l2 - d2) / (2 * l1 * l2));
  const double theta_1 = std::atan2(y, x) - elbow * at_A, theta_2 = elbow * (SimTK::Pi - at_B);
  return {rail.sense() * theta_1, rail.sense() * theta_2};
}

SimTK::State ClosedLoop::Model::place(const Case& at) const {
  SimTK::State state = initial;
  const Vec3 D(at.pose[0], at.pose[1], at.pose[2]);
  const double phi = at.pose[3], circle = p.one_platform ? phi : 0;
  const SimTK::Rotation turned(phi, SimTK::ZAxis), circle_turned(circle, SimTK::ZAxis);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 C = i == 3 ? D + turned * Vec3(p.l, 0, 0) : D - Vec3(0, 0, p.h) + circle_turned * joint_on_circle(i);
    const Angles angle = angles(i, C, at.elbow[i]);
    slide[i].setOneQ(state, 0, SimTK::dot(kRails[i].e, C - kRails[i].point * p.L));
    first[i].setOneQ(state, 0, angle.first);
    second[i].setOneQ(state, 0, angle.second);
    if (i == 2) middle.setOneQ(state, 0, circle - angle.first - angle.second);
  }
  if (!p.one_platform) yaw.setOneQ(state, 0, phi);
  return state;
}

ClosedLoop::ClosedLoop(const Parameters& parameters) : model_(std::make_unique<const Model>(parameters)) {}
ClosedLoop::~ClosedLoop() = default;

Solution ClosedLoop::solve(const Case& at) const {
  const Model& m = *model_;
  const Eigen::Vector4d velocity(at.velocity.data()), acceleration(at.acceleration.data());
  const LoopForces found =
      loop_forces(m.system, m.matter, m.place(at), m.moving, {{3, 4, 5, 2}, velocity, acceleration}, Vec3(m.p.c, 0, 0),
                  at.wrench, {m.slide.begin(), m.slide.end()});
  Solution solution{{}, found.constraints, found.constraint_rank, found.closure_error, found.force_error};
  for (int i = 0; i < 4; ++i) solution.drive_forces[static_cast<std::size_t>(i)] = found.drives[i];
  return solution;
}

}  // namespace pkm::simbody
