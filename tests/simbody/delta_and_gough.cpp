#include "tests/simbody/delta_and_gough.hpp"

#include <cmath>

#include "tests/simbody/loop_forces.hpp"

namespace pkm::simbody {
namespace {

using SimTK::MobilizedBody, SimTK::Transform, SimTK::Vec3;

/// The frame with the given x and z axes.
SimTK::Rotation axes_x_z(const Vec3& x, const Vec3& z) {
  return {SimTK::UnitVec3(x), SimTK::XAxis, SimTK::UnitVec3(z), SimTK::ZAxis};
}

/// A thin body along z without inertia about z. @param centre  z coordinate of the centre of mass
SimTK::Body::Rigid thin(double mass, double centre, double inertia) {
  const Vec3 at(0, 0, centre);
  const SimTK::Inertia central(inertia, inertia, 0);
  return SimTK::Body::Rigid(SimTK::MassProperties(mass, at, central.shiftFromMassCenter(-at, mass)));
}

/// Sets the angles of a universal joint, whose first axis is x, so that z points along a direction given in its frame.
void point(const MobilizedBody::Universal& joint, SimTK::State& state, const Vec3& along) {
  const SimTK::UnitVec3 u(along);
  joint.setOneQ(state, 0, std::atan2(-u[1], u[2]));
  joint.setOneQ(state, 1, std::asin(u[0]));
}

}  // namespace

struct DeltaOrGough::Model {
  virtual ~Model() = default;
  virtual SimTK::State place(const LoopCase& at) const = 0;
  virtual PlatformMotion motion(const LoopCase& at) const = 0;

  void finish() {
    SimTK::Force::Gravity(forces, matter, Vec3(0, 0, -9.81));
    system.realizeTopology();
    initial = system.getDefaultState();
    system.realizeModel(initial);
  }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  MobilizedBody platform;
  std::vector<MobilizedBody> drives;
  SimTK::State initial;
};

/// Limbs at 120 degrees, crank pivots at radius R, platform joints at radius r; q is the angle of the crank about -y,
/// from the radial direction upwards.
struct DeltaOrGough::Delta : Model {
  explicit Delta(const DeltaParameters& parameters) : p(parameters) {
    body = MobilizedBody::Translation(
        matter.Ground(), Transform(),
        SimTK::Body::Rigid(SimTK::MassProperties(p.platform_mass, Vec3(0), SimTK::Inertia(1))), Transform());
    platform = body;
    for (int i = 0; i < 3; ++i) {
      const SimTK::Rotation turned(2 * SimTK::Pi * i / 3, SimTK::ZAxis);
      // the z axis of the crank frame points along the crank, the x axis is the axis of rotation
      const SimTK::Rotation outwards = turned * axes_x_z(Vec3(0, 1, 0), Vec3(1, 0, 0));
      const SimTK::Rotation pin =
          axes_x_z(Vec3(0, 0, 1), Vec3(1, 0, 0));  // a Pin rotates about its z axis: x of the crank
      crank.push_back(MobilizedBody::Pin(matter.Ground(), Transform(outwards * pin, turned * Vec3(p.R, 0, 0)),
                                         thin(p.crank_mass, p.l_a / 2, p.crank_inertia), Transform(pin)));
      rod.push_back(MobilizedBody::Universal(crank.back(), Transform(Vec3(0, 0, p.l_a)),
                                             thin(p.rod_mass, p.l_b / 2, p.rod_inertia), Transform()));
      SimTK::Constraint::Ball(rod.back(), Vec3(0, 0, p.l_b), platform, turned * Vec3(p.r, 0, 0));
      drives.push_back(crank.back());
    }
    finish();
  }
  SimTK::State place(const LoopCase& at) const override {
    SimTK::State state = initial;
    const Vec3 P(at.pose[0], at.pose[1], at.pose[2]);
    for (int k = 0; k < 3; ++k) body.setOneQ(state, k, P[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      const SimTK::Rotation turned(2 * SimTK::Pi * static_cast<double>(i) / 3, SimTK::ZAxis);
      const Vec3 v = ~turned * P + Vec3(p.r - p.R, 0, 0);  // from the pivot to B, in the limb frame
      const double u = v[0], w = -v[2], k = (v.normSqr() + p.l_a * p.l_a - p.l_b * p.l_b) / (2 * p.l_a);
      const double q = std::atan2(w, u) - std::acos(k / std::hypot(u, w));  // elbow outwards
      crank[i].setOneQ(state, 0, q);
      // frame of the crank at q: z is (cos q, 0, -sin q), x is y of the limb
      const SimTK::Rotation at_crank = axes_x_z(Vec3(0, 1, 0), Vec3(std::cos(q), 0, -std::sin(q)));
      point(rod[i], state, ~at_crank * (v - p.l_a * Vec3(std::cos(q), 0, -std::sin(q))));
    }
    return state;
  }
  PlatformMotion motion(const LoopCase& at) const override {
    return {{3, 4, 5}, Eigen::Vector3d(at.velocity.data()), Eigen::Vector3d(at.acceleration.data())};
  }

  DeltaParameters p;
  MobilizedBody::Translation body;
  std::vector<MobilizedBody::Pin> crank;
  std::vector<MobilizedBody::Universal> rod;
};

/// Limbs: three `left` and three `right` ones, at 120 degrees.
struct DeltaOrGough::Gough : Model {
  explicit Gough(const GoughParameters& parameters) : p(parameters) {
    const auto& I = p.platform_inertia;
    body = MobilizedBody::Free(
        matter.Ground(), Transform(),
        SimTK::Body::Rigid(SimTK::MassProperties(p.platform_mass, Vec3(0), SimTK::Inertia(I[0], I[1], I[2]))),
        Transform());
    platform = body;
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < 3; ++i) {
        const SimTK::Rotation turned(2 * SimTK::Pi * i / 3, SimTK::ZAxis);
        A.push_back(turned * Vec3(p.R * std::cos(p.a_b), side * p.R * std::sin(p.a_b), 0));
        B.push_back(turned * Vec3(p.r * std::cos(p.a_p), side * p.r * std::sin(p.a_p), 0));
        cylinder.push_back(MobilizedBody::Universal(matter.Ground(), Transform(A.back()),
                                                    thin(p.cylinder_mass, p.cylinder_centre, p.cylinder_inertia),
                                                    Transform()));
        // a Slider moves along its x axis: z of the leg
        const Transform slide(SimTK::Rotation(-SimTK::Pi / 2, SimTK::YAxis));
        piston.push_back(MobilizedBody::Slider(cylinder.back(), slide,
                                               thin(p.piston_mass, -p.piston_centre, p.piston_inertia), slide));
        SimTK::Constraint::Ball(piston.back(), Vec3(0), platform, B.back());
        drives.push_back(piston.back());
      }
    finish();
  }
  SimTK::Rotation turned(const LoopCase& at) const {
    return SimTK::Rotation(at.pose[3], SimTK::XAxis) * SimTK::Rotation(at.pose[4], SimTK::YAxis) *
           SimTK::Rotation(at.pose[5], SimTK::ZAxis);
  }
  SimTK::State place(const LoopCase& at) const override {
    SimTK::State state = initial;
    const Transform X(turned(at), Vec3(at.pose[0], at.pose[1], at.pose[2]));
    body.setQToFitTransform(state, X);
    for (std::size_t i = 0; i < 6; ++i) {
      const Vec3 v = X * B[i] - A[i];
      point(cylinder[i], state, v);
      piston[i].setOneQ(state, 0, v.norm());
    }
    return state;
  }
  /// omega = x alpha' + y' beta' + z'' gamma', with the rotated axes y', z'' (intrinsic x-y-z angles).
  PlatformMotion motion(const LoopCase& at) const override {
    const SimTK::Rotation first(at.pose[3], SimTK::XAxis), both = first * SimTK::Rotation(at.pose[4], SimTK::YAxis);
    const Vec3 x(1, 0, 0), y = first * Vec3(0, 1, 0), z = both * Vec3(0, 0, 1);
    const double *v = &at.velocity[3], *a = &at.acceleration[3];
    const Vec3 omega_1 = x * v[0], omega_2 = omega_1 + y * v[1], omega = omega_2 + z * v[2];
    const Vec3 epsilon = x * a[0] + y * a[1] + z * a[2] + (omega_1 % y) * v[1] + (omega_2 % z) * v[2];
    PlatformMotion motion{{0, 1, 2, 3, 4, 5}, Eigen::VectorXd(6), Eigen::VectorXd(6)};
    for (int k = 0; k < 3; ++k) {
      motion.velocity[k] = omega[k];
      motion.acceleration[k] = epsilon[k];
      motion.velocity[3 + k] = at.velocity[static_cast<std::size_t>(k)];
      motion.acceleration[3 + k] = at.acceleration[static_cast<std::size_t>(k)];
    }
    return motion;
  }

  GoughParameters p;
  MobilizedBody::Free body;
  std::vector<Vec3> A, B;
  std::vector<MobilizedBody::Universal> cylinder;
  std::vector<MobilizedBody::Slider> piston;
};

DeltaOrGough::DeltaOrGough(const DeltaParameters& parameters) : model_(new Delta(parameters)) {}
DeltaOrGough::DeltaOrGough(const GoughParameters& parameters) : model_(new Gough(parameters)) {}
DeltaOrGough::~DeltaOrGough() = default;

LoopSolution DeltaOrGough::solve(const LoopCase& at) const {
  const Model& m = *model_;
  const LoopForces found =
      loop_forces(m.system, m.matter, m.place(at), m.platform, m.motion(at), Vec3(0), at.wrench, m.drives);
  const auto list = [](const Eigen::VectorXd& v) { return std::vector<double>(v.data(), v.data() + v.size()); };
  return {list(found.drives), list(found.multipliers), found.closure_error, found.force_error};
}

}  // namespace pkm::simbody
