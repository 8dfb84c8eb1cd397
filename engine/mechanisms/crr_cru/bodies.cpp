#include "engine/mechanisms/crr_cru/bodies.hpp"

#include "engine/mechanisms/crr_cru/dynamics.hpp"

namespace pkm::crr_cru {
namespace {

using Vec = Vector<double, 3>;
using Map = Matrix<double, 3, 4>;

const Vec kUp{{0, 0, 1}};

Vec vector(const Vector3<double>& v) { return {v}; }
Vec vector(const Pose<double>& at) { return {{at.x, at.y, at.z}}; }

Vec unit(std::size_t axis) {
  Vec e;
  e[axis] = 1;
  return e;
}

/// Velocity map and acceleration at Xddot = 0 of a point at the end of an arm from D.
struct Carried {
  Map J;
  Vec b;
};
Carried carried(const Arm<double>& arm, const MotionState<double>& state) {
  Carried point;
  const Vec turn = turning(arm);
  for (std::size_t k = 0; k < 3; ++k) {
    point.J(k, k) = 1;
    point.J(k, 3) = turn[k];
  }
  point.b = swinging(arm) * (state.velocity[3] * state.velocity[3]);
  return point;
}

void add_rods(const Geometry<double>& g, const Masses<double>& masses, const Limbs<double>& limbs, std::size_t i,
              const MotionState<double>& state, std::vector<PlacedBody>& list) {
  const Limb<double>& limb = limbs.limb[i];
  const double l1 = g.l_1[i], l2 = g.l_2[i], s = kLimbs[i].sense;
  const Vec e = unit(kLimbs[i].e), A = vector(limb.A), B = vector(limb.B), C = vector(limb.C);
  const LimbFrame& f = kLimbs[i];
  const Vec u1 = in_space(f, limb.u1), n1 = in_space(f, across(limb.u1));
  const Vec u2 = in_space(f, limb.u2), n2 = in_space(f, across(limb.u2));
  const Carried at_C = carried(limbs.arm[i], state);

  const RodRates<double> rates = rod_rates(g, i, limb, (at_C.J * state.velocity).m, at_C.b.m);
  const auto jpsi_1 = transpose(u2) * at_C.J * (1 / (l1 * limb.sin_2));
  const auto jpsi_2 = transpose(u1) * at_C.J * (-1 / (l2 * limb.sin_2));
  const Map along = e * (transpose(e) * at_C.J);
  const Vec b_along = e * dot(e, at_C.b);
  // of the far end of a rod, as seen from its near end, per length
  const auto swing = [&](std::size_t rod, const Vec& n, const Vec& u) {
    return n * rates.acceleration[rod] - u * (rates.velocity[rod] * rates.velocity[rod]);
  };
  const Vec swing_1 = swing(0, n1, u1) * l1, swing_2 = swing(1, n2, u2) * l2;
  // Rods turn about e alone: of their inertia only this component enters.
  const auto about_e = [&](double I) { return e * transpose(e) * I; };
  const std::string name = "rod " + std::to_string(i + 1);

  list.push_back({name + "1",
                  (A + B) * 0.5,
                  {.mass = masses.m_1[i],
                   .inertia = about_e(masses.I_1[i]),
                   .J_v = along + n1 * jpsi_1 * (0.5 * l1),
                   .J_omega = e * jpsi_1 * s,
                   .b_v = b_along + swing_1 * 0.5,
                   .b_omega = e * (s * rates.acceleration[0])}});
  list.push_back({name + "2",
                  (B + C) * 0.5,
                  {.mass = masses.m_2[i],
                   .inertia = about_e(masses.I_2[i]),
                   .J_v = along + n1 * jpsi_1 * l1 + n2 * jpsi_2 * (0.5 * l2),
                   .J_omega = e * jpsi_2 * s,
                   .b_v = b_along + swing_1 + swing_2 * 0.5,
                   .b_omega = e * (s * rates.acceleration[1])}});
}

/// Part of a platform with its centre of mass at the end of an arm. It turns about z alone, so of its own inertia I_zz
/// enters.
PlacedBody platform_part(const std::string& name, double mass, double I_zz, const Arm<double>& arm,
                         const MotionState<double>& state) {
  const Carried centre = carried(arm, state);
  PlacedBody part{name, vector(state.pose) + vector(arm.to_joint), {.mass = mass, .J_v = centre.J, .b_v = centre.b}};
  part.body.inertia(2, 2) = I_zz;
  if (arm.turns) part.body.J_omega(2, 3) = 1;
  return part;
}

/// Along D-C_4.
Arm<double> on_arm(double distance, double angle) {
  const auto [s, c] = sincos(angle);
  return {{distance * c, distance * s, 0}, true};
}

std::vector<Vec> normal_to(std::size_t axis) {
  std::vector<Vec> couples;
  for (std::size_t k = 0; k < 3; ++k)
    if (k != axis) couples.push_back(unit(k));
  return couples;
}

void add_joints(const Geometry<double>& g, const Limbs<double>& limbs, std::size_t i, double on_slide,
                std::vector<Joint>& joints) {
  const Limb<double>& limb = limbs.limb[i];
  const std::size_t e = kLimbs[i].e, inner = 2 * i, outer = inner + 1;
  const bool jointed = g.platform == Platform::jointed, universal = jointed ? i == 3 : i != 2;
  const std::size_t platform = i == 3 && jointed ? 9 : 8;
  // C_i is an R joint along e, or a U joint along e and z
  const std::vector<Vec> at_platform = universal ? std::vector<Vec>{unit(1 - e)} : normal_to(e);
  const std::string number = std::to_string(i + 1);
  joints.push_back({"a" + number, vector(limb.A), inner, {}, normal_to(e), Actuator{i, unit(e), on_slide}});
  joints.push_back({"b" + number, vector(limb.B), inner, outer, normal_to(e), {}});
  joints.push_back({"c" + number, vector(limb.C), outer, platform, at_platform, {}});
}

}  // namespace

std::vector<PlacedBody> bodies(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                               const MotionState<double>& state) {
  std::vector<PlacedBody> list;
  for (std::size_t i = 0; i < 4; ++i) add_rods(g, b, limbs, i, state, list);
  const bool jointed = g.platform == Platform::jointed;
  const double phi = state.pose.angle;
  const PlacedBody middle = platform_part("middle platform", b.m_middle, b.I_middle, {{0, 0, -g.h}, !jointed}, state);
  const PlacedBody moving = unite("moving platform", platform_part("", b.m, b.I_zz, on_arm(b.c, phi), state),
                                  platform_part("payload", b.payload, 0, on_arm(b.c_payload, phi), state));
  if (jointed) {
    list.push_back(middle);
    list.push_back(moving);
  } else {
    list.push_back(unite("platform", moving, middle));
  }
  return list;
}

std::array<PlacedBody, 4> slides(const Masses<double>& b, const Limbs<double>& limbs,
                                 const MotionState<double>& state) {
  std::array<PlacedBody, 4> list;
  for (std::size_t i = 0; i < 4; ++i) {
    const Carried at_C = carried(limbs.arm[i], state);
    const Vec e = unit(kLimbs[i].e);
    list[i] = {"slide " + std::to_string(i + 1),
               vector(limbs.limb[i].A),
               {.mass = b.slide, .J_v = e * (transpose(e) * at_C.J), .b_v = e * dot(e, at_C.b)}};
  }
  return list;
}

NewtonEuler newton_euler(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                         const MotionState<double>& state, const Vector<double, 4>& acceleration,
                         const Wrench<double>& wrench) {
  NewtonEuler system;
  for (const PlacedBody& body : bodies(g, b, limbs, state))
    system.bodies.push_back(in_motion(body, state.velocity, acceleration));
  const std::array<PlacedBody, 4> slide = slides(b, limbs, state);
  for (std::size_t i = 0; i < 4; ++i) {
    const RigidBody moving = in_motion(slide[i], state.velocity, acceleration);
    const Vec needed = (moving.a + kUp * kGravity) * moving.mass;
    add_joints(g, limbs, i, needed[kLimbs[i].e], system.joints);
  }
  const Vec D = vector(state.pose);
  if (g.platform == Platform::jointed) system.joints.push_back({"t1", D, 8, 9, normal_to(2), {}});
  apply(system.bodies.back(), D + vector(on_arm(b.c, state.pose.angle).to_joint),
        Vec{{wrench[0], wrench[1], wrench[2]}}, Vec{{wrench[3], wrench[4], wrench[5]}});
  return system;
}

}  // namespace pkm::crr_cru
