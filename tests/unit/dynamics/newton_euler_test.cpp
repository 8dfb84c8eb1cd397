// Newton-Euler equations of small mechanisms with known solutions.
#include "engine/dynamics/newton_euler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/dynamics/square_system.hpp"

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

/// A door of 2 kg whose centre of mass is 0.5 m from the hinge axis z, with one hinge or two hinges 1 m apart.
NewtonEuler door(bool two_hinges) {
  NewtonEuler system;
  system.bodies = {body("door", 2, Vec{{0.5, 0, 0}})};
  system.joints = {{"top", Vec{{0, 0, 0.5}}, 0, {}, {kX, kY}, {}}};
  if (two_hinges) system.joints.push_back({"bottom", Vec{{0, 0, -0.5}}, 0, {}, {kX, kY}, {}});
  return system;
}

TEST(NewtonEuler, OneHingeDoesNotBalanceTheMomentAboutItsAxis) {
  // 6 equations, 5 unknowns: the moment about z is not balanced by the hinge
  const NewtonEuler system = door(false);
  const LinearEquations e = equations(system);
  EXPECT_EQ(e.A.rows(), 6);
  EXPECT_EQ(e.A.cols(), 5);
  EXPECT_EQ(reactions(system).rank, 5);
  EXPECT_THAT(reactions(system).reason, ::testing::HasSubstr("6 equations of rank 5"));
}

TEST(NewtonEuler, RotatingRod) {
  // A driven rod along x that rotates about z; its centre of mass is 0.4 m from the joint at the origin.
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

TEST(NewtonEuler, RotationAboutANonPrincipalAxisNeedsAMoment) {
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

/// Two bodies along x, welded to each other; the first one is fixed to a wall.
/// @param at_wall  couples that the wall transmits
NewtonEuler beam(std::vector<Vec> at_wall) {
  NewtonEuler system;
  system.bodies = {body("first", 1, Vec{{0.5, 0, 0}}), body("second", 1, Vec{{1.5, 0, 0}})};
  system.joints = {{"wall", Vec{}, 0, {}, std::move(at_wall), {}}, {"middle", Vec{{1, 0, 0}}, 0, 1, {kX, kY, kZ}, {}}};
  return system;
}

TEST(NewtonEuler, JointForcesActOnBothBodies) {
  const Reactions found = reactions(beam({kX, kY, kZ}));
  EXPECT_EQ(found.equations, 12);
  EXPECT_EQ(found.rank, 12);
  EXPECT_NEAR(found.joints[0].force[2].value(), 2 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[1].force[2].value(), -kGravity, 1e-13);
  EXPECT_NEAR(found.joints[0].couple[1].value(), -2 * kGravity, 1e-13);
  EXPECT_NEAR(found.joints[1].couple[1].value(), 0.5 * kGravity, 1e-13);
}

TEST(NewtonEuler, OnlyTheSumOfParallelCouplesIsDetermined) {
  NewtonEuler system = beam({kX, kY, kZ, kX});
  system.bodies[1].moment = kX * 3.0;
  const Reactions found = reactions(system);
  ASSERT_EQ(found.reason, "");
  EXPECT_EQ(found.unknowns, 13);
  EXPECT_NEAR(found.joints[0].couple[0].value(), -3, 1e-13);
  const MinNormSolution least = min_norm_solution(system);
  EXPECT_EQ(least.null_space.cols(), 1);
  EXPECT_NEAR(least.x[3], -1.5, 1e-13);
  EXPECT_NEAR(least.x[6], -1.5, 1e-13);
  const Eigen::VectorXd square = test::solve_square_system(system, [](const Joint&, std::size_t k) { return k == 3; });
  EXPECT_NEAR(square[3], -3, 1e-13);
  EXPECT_EQ(square[6], 0);
}

TEST(NewtonEuler, ForcesSharedByTwoHingesAreUndetermined) {
  // Two hinges on one axis share the force along it: no component, rather than an arbitrary one.
  NewtonEuler system = door(true);
  system.joints[1].couples.push_back(kZ);
  const Reactions found = reactions(system);
  EXPECT_EQ(found.rank, 6);
  ASSERT_EQ(found.reason, "");
  for (const JointReaction& hinge : found.joints) {
    EXPECT_FALSE(hinge.force[2]);
    // the moment of the weight, 0.5 m from the axis, can be balanced by forces or by couples
    EXPECT_FALSE(hinge.force[0]);
    EXPECT_FALSE(hinge.couple[1]);
  }
}

TEST(NewtonEuler, SquareSystemNeedsAsManyUnknownsAsEquations) {
  const auto none = [](const Joint&, std::size_t) { return false; };
  EXPECT_THROW(test::solve_square_system(door(false), none), std::logic_error);
}

}  // namespace
}  // namespace pkm
