// Newton's and Euler's equations of small mechanisms that can be solved by hand.
#include "engine/dynamics/newton_euler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/dynamics/square_closure.hpp"

namespace pkm {
namespace {

using Vec = Vector<double, 3>;
const Vec kX{{1, 0, 0}}, kY{{0, 1, 0}}, kZ{{0, 0, 1}};

RigidBody body(const std::string& name, double mass, const Vec& centre) {
  RigidBody b;
  b.name = name;
  b.mass = mass;
  b.centre = centre;
  b.inertia = Matrix<double, 3, 3>::identity() * (0.1 * mass);
  return b;
}

/// A door of 2 kg, its centre 0.5 m off a hinge line along z; one hinge on it, or two 1 m apart.
NewtonEuler door(bool both_hinges_hold) {
  NewtonEuler system;
  system.bodies = {body("door", 2, Vec{{0.5, 0, 0}})};
  system.joints = {{"top", Vec{{0, 0, 0.5}}, 0, {}, {kX, kY}, {}}};
  if (both_hinges_hold) system.joints.push_back({"bottom", Vec{{0, 0, -0.5}}, 0, {}, {kX, kY}, {}});
  return system;
}

TEST(NewtonEuler, OneHingeLeavesTheTurningUnbalanced) {
  // 6 equations, 5 unknowns: whether they hold depends on the moment about z
  const NewtonEuler system = door(false);
  const LinearEquations e = equations(system);
  EXPECT_EQ(e.A.rows(), 6);
  EXPECT_EQ(e.A.cols(), 5);
  EXPECT_EQ(reactions(system).rank, 5);
  EXPECT_THAT(reactions(system).reason, ::testing::HasSubstr("6 equations of rank 5"));
}

TEST(NewtonEuler, APendulumsHingeCarriesWeightAndCentripetalForce) {
  // A rod on a drive: its centre 0.4 m from the hinge at the origin, along x, turning about z.
  NewtonEuler system;
  RigidBody rod = body("rod", 3, Vec{{0.4, 0, 0}});
  rod.omega = kZ * 2.0;
  rod.epsilon = kZ * 5.0;
  rod.a = Vec{{-0.4 * 4, 0.4 * 5, 0}};
  apply(rod, Vec{{0.8, 0, 0}}, kX * 7.0, Vec{});
  system.bodies = {rod};
  system.joints = {{"hinge", Vec{}, 0, {}, {kX, kY, kZ}, Actuator{2, kX, 0.25}}};
  const Reactions found = reactions(system);
  ASSERT_EQ(found.reason, "");
  EXPECT_EQ(found.joints[0].on, "rod");
  EXPECT_NEAR(found.joints[0].force[0].value(), -3 * 1.6 - 7, 1e-13);
  EXPECT_NEAR(found.joints[0].force[1].value(), 3 * 2.0, 1e-13);
  EXPECT_NEAR(found.joints[0].force[2].value(), 3 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[0].couple[0].value(), 0, 1e-13);
  EXPECT_NEAR(found.joints[0].couple[1].value(), -0.4 * 3 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[0].couple[2].value(), 0.3 * 5 + 3 * 0.4 * 2.0, 1e-13);
  EXPECT_NEAR(found.drive_forces[2], -3 * 1.6 - 7 + 0.25, 1e-13);
}

TEST(NewtonEuler, SpinningAboutNoPrincipalAxisNeedsAGyroscopicMoment) {
  NewtonEuler system;
  RigidBody rotor = body("rotor", 1, Vec{});
  rotor.inertia(0, 2) = rotor.inertia(2, 0) = 0.02;
  rotor.omega = kZ * 10.0;
  system.bodies = {rotor};
  system.joints = {{"axle", Vec{}, 0, {}, {kX, kY, kZ}, {}}};
  // omega x I omega = 10 z x (0.2 x + ..) = 2 y
  EXPECT_NEAR(reactions(system).joints[0].couple[1].value(), 2, 1e-13);
  EXPECT_NEAR(reactions(system).joints[0].couple[0].value(), 0, 1e-13);
}

/// Two bodies in a row along x, welded to each other, the first one to a wall.
NewtonEuler beam(std::vector<Vec> at_wall) {
  NewtonEuler system;
  system.bodies = {body("first", 1, Vec{{0.5, 0, 0}}), body("second", 1, Vec{{1.5, 0, 0}})};
  system.joints = {{"wall", Vec{}, 0, {}, std::move(at_wall), {}}, {"middle", Vec{{1, 0, 0}}, 0, 1, {kX, kY, kZ}, {}}};
  return system;
}

TEST(NewtonEuler, JointsActOnBothBodies) {
  const Reactions found = reactions(beam({kX, kY, kZ}));
  EXPECT_EQ(found.equations, 12);
  EXPECT_EQ(found.rank, 12);
  EXPECT_NEAR(found.joints[0].force[2].value(), 2 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[1].force[2].value(), -kGravity, 1e-13);
  EXPECT_NEAR(found.joints[0].couple[1].value(), -2 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[1].couple[1].value(), 0.5 * kGravity, 1e-13);
}

TEST(NewtonEuler, CouplesThatAJointHoldsTwiceAreDeterminedByTheirSumAlone) {
  NewtonEuler system = beam({kX, kY, kZ, kX});
  system.bodies[1].moment = kX * 3.0;
  const Reactions found = reactions(system);
  ASSERT_EQ(found.reason, "");
  EXPECT_EQ(found.unknowns, 13);
  EXPECT_NEAR(found.joints[0].couple[0].value(), -3, 1e-13);
  const LeastNorm least = least_norm(system);
  EXPECT_EQ(least.null_space.cols(), 1);
  EXPECT_NEAR(least.x[3], -1.5, 1e-13);
  EXPECT_NEAR(least.x[6], -1.5, 1e-13);
  const Eigen::VectorXd closed = test::square_closure(system, [](const Joint&, std::size_t k) { return k == 3; });
  EXPECT_NEAR(closed[3], -3, 1e-13);
  EXPECT_EQ(closed[6], 0);
}

TEST(NewtonEuler, ForcesThatTwoHingesShareAreReportedAsSuch) {
  // Two hinges on one line share the force along it: none, rather than one of many.
  NewtonEuler system = door(true);
  system.joints[1].couples.push_back(kZ);
  const Reactions found = reactions(system);
  EXPECT_EQ(found.rank, 6);
  ASSERT_EQ(found.reason, "");
  for (const JointReaction& hinge : found.joints) {
    EXPECT_FALSE(hinge.force[2]);
    // the weight's moment, half a metre from the line: in pairs of forces or of couples
    EXPECT_FALSE(hinge.force[0]);
    EXPECT_FALSE(hinge.couple[1]);
  }
}

TEST(NewtonEuler, ASquareClosureNeedsAsManyUnknownsAsEquations) {
  const auto none = [](const Joint&, std::size_t) { return false; };
  EXPECT_THROW(test::square_closure(door(false), none), std::logic_error);
}

TEST(NewtonEuler, BodiesUniteByParallelAxes) {
  PlacedBody<4> a{"a", kX, {}}, b{"b", kX * -1.0, {}};
  a.body.mass = 1;
  b.body.mass = 3;
  a.body.inertia = b.body.inertia = Matrix<double, 3, 3>::identity();
  for (std::size_t k = 0; k < 3; ++k) a.body.J_v(k, k) = b.body.J_v(k, k) = 1;
  a.body.J_v(1, 3) = 1;  // both turn about z with the fourth coordinate
  b.body.J_v(1, 3) = -1;
  a.body.J_omega(2, 3) = b.body.J_omega(2, 3) = 1;
  const PlacedBody<4> both = unite("both", a, b);
  EXPECT_EQ(both.body.mass, 4);
  EXPECT_EQ(both.centre[0], -0.5);
  EXPECT_EQ(both.body.J_v(1, 3), -0.5);
  EXPECT_EQ(both.body.inertia(0, 0), 2);
  EXPECT_EQ(both.body.inertia(1, 1), 2 + 1 * 2.25 + 3 * 0.25);
  // the same equations of motion as the two
  PoseDynamics<double, 4> apart, together;
  const Vector<double, 4> velocity{{1, 2, 3, 4}};
  add_body(apart, a.body, velocity);
  add_body(apart, b.body, velocity);
  add_body(together, both.body, velocity);
  for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(apart.M_X.m[k], together.M_X.m[k], 1e-14);
}

}  // namespace
}  // namespace pkm
