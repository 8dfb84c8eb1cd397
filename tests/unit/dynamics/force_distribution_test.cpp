// Forces of redundant drives: optimality conditions at random Jacobians, loads and limits.
#include "engine/dynamics/force_distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace pkm {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

struct Drives {
  AxisMatrix<double> J;
  AxisVector<double> load;
  DriveLimits limits;

  MatrixXd jacobian() const {
    MatrixXd values(J.rows(), J.cols());
    for (std::size_t i = 0; i < J.rows(); ++i)
      for (std::size_t j = 0; j < J.cols(); ++j)
        values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = J(i, j);
    return values;
  }
  /// Basis of the internal forces.
  MatrixXd kernel() const { return jacobian().transpose().fullPivLu().kernel(); }
};

VectorXd eigen_of(const AxisVector<double>& x) {
  return Eigen::Map<const VectorXd>(x.begin(), static_cast<Eigen::Index>(x.size()));
}

/// Random drives with limits within which a load is balanced by forces at the given distance from all limits.
Drives random_drives(std::size_t joints, std::size_t coordinates, double reserve, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  Drives drives{AxisMatrix<double>(joints, coordinates), AxisVector<double>(coordinates), no_drive_limits(joints)};
  for (auto& element : drives.J) element = number(random);
  for (std::size_t i = 0; i < joints; ++i) {
    drives.limits.lower[i] = -500 + 100 * number(random);
    drives.limits.upper[i] = -20 + 10 * number(random);
    const double share = (number(random) + 1) / 2, width = drives.limits.upper[i] - drives.limits.lower[i];
    const double tau = drives.limits.lower[i] + reserve + share * (width - 2 * reserve);
    for (std::size_t j = 0; j < coordinates; ++j) drives.load[j] += drives.J(i, j) * tau;
  }
  return drives;
}

/// Checks equilibrium and limits.
VectorXd checked(const Drives& drives) {
  const auto tau = distribute_forces(drives.J, drives.load, drives.limits);
  EXPECT_TRUE(tau.has_value());
  if (!tau) return VectorXd::Zero(static_cast<Eigen::Index>(drives.J.rows()));
  EXPECT_LT((drives.jacobian().transpose() * eigen_of(*tau) - eigen_of(drives.load)).norm(), 1e-6);
  for (std::size_t i = 0; i < tau->size(); ++i) {
    EXPECT_GE((*tau)[i], drives.limits.lower[i]);
    EXPECT_LE((*tau)[i], drives.limits.upper[i]);
  }
  return eigen_of(*tau);
}

TEST(ForceDistribution, WithoutLimitsIsThePseudoInverse) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    Drives drives = random_drives(4 + trial % 5, 1 + trial % 3, 1, random);
    drives.limits = no_drive_limits(drives.J.rows());
    const VectorXd expected =
        drives.jacobian().transpose().completeOrthogonalDecomposition().solve(eigen_of(drives.load));
    EXPECT_LT((checked(drives) - expected).norm(), 1e-10 * (1 + expected.norm()));
    // weighted by limits: least norm of tau / scale
    for (std::size_t i = 0; i < drives.J.rows(); ++i) drives.limits.scale[i] = 1.0 + static_cast<double>(i);
    const VectorXd scale = eigen_of(drives.limits.scale);
    EXPECT_LT((drives.kernel().transpose() * checked(drives).cwiseQuotient(scale.cwiseAbs2())).norm(),
              1e-9 * (1 + expected.norm()));
  }
}

TEST(ForceDistribution, LeastNormWithinLimitsIsNearerThanItsNeighbours) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Drives drives = random_drives(5 + trial % 4, 2 + trial % 4, 20, random);
    const VectorXd tau = checked(drives);
    const MatrixXd kernel = drives.kernel();
    // The projection of 0 on a convex set: no allowed change of the forces has a component towards 0.
    Drives other = drives;
    other.limits.sharing = ForceSharing::centre;
    const VectorXd inside = checked(other);
    EXPECT_GE(tau.dot(inside - tau), -1e-6 * tau.squaredNorm());
    for (int k = 0; k < 20; ++k) {
      VectorXd lambda(kernel.cols());
      for (auto& component : lambda) component = number(random);
      const VectorXd direction = kernel * lambda;
      double step = 1e3;  // up to the limits
      for (Eigen::Index i = 0; i < tau.size(); ++i) {
        const auto j = static_cast<std::size_t>(i);
        const double room = direction(i) > 0 ? drives.limits.upper[j] - inside(i) : drives.limits.lower[j] - inside(i);
        if (direction(i) != 0) step = std::min(step, room / direction(i));
      }
      EXPECT_GE(tau.dot(inside + step * direction - tau), -1e-6 * tau.squaredNorm());
    }
  }
}

TEST(ForceDistribution, CentreIsTheStationaryPointOfTheProductOfDistances) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    Drives drives = random_drives(5 + trial % 4, 2 + trial % 4, 5, random);
    drives.limits.sharing = ForceSharing::centre;
    const VectorXd tau = checked(drives);
    const VectorXd slope =
        (tau - eigen_of(drives.limits.lower)).cwiseInverse() - (eigen_of(drives.limits.upper) - tau).cwiseInverse();
    EXPECT_LT((drives.kernel().transpose() * slope).norm(), 1e-7 * slope.norm());
  }
}

TEST(ForceDistribution, LeastMaximumCannotBeReduced) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    Drives drives = random_drives(5 + trial % 4, 2 + trial % 4, 10, random);
    drives.limits.sharing = ForceSharing::least_maximum;
    const double largest = checked(drives).cwiseAbs().maxCoeff();
    drives.limits.sharing = ForceSharing::least_norm;
    EXPECT_LE(largest, checked(drives).cwiseAbs().maxCoeff() + 1e-9);
    for (double& lower : drives.limits.lower) lower = std::max(lower, -largest * (1 - 1e-6));
    EXPECT_FALSE(distribute_forces(drives.J, drives.load, drives.limits));
  }
}

TEST(ForceDistribution, FindsNoForcesOutsideOfTheLimits) {
  // one coordinate, two cables that pull in the same direction: 3 N need at least 1 N in one of them
  DriveLimits limits = no_drive_limits(2);
  limits.lower = {-10, -10};
  limits.upper = {-1, -1};
  AxisMatrix<double> J(2, 1);
  J(0, 0) = J(1, 0) = 1;
  EXPECT_FALSE(distribute_forces(J, {-1.999999}, limits));
  ASSERT_TRUE(distribute_forces(J, {-2.000001}, limits));
  EXPECT_FALSE(distribute_forces(J, {3}, limits));
  const auto tau = distribute_forces(J, {-7}, limits);
  ASSERT_TRUE(tau);
  EXPECT_DOUBLE_EQ((*tau)[0], -3.5);
  J(1, 0) = J(0, 0) = 0;  // singular
  EXPECT_FALSE(distribute_forces(J, {-7}, limits));
}

TEST(ForceDistribution, InternalForcesBalanceEachOther) {
  std::mt19937 random(5);
  const Drives drives = random_drives(8, 6, 1, random);
  const AxisMatrix<double> internal = internal_forces(drives.J);
  ASSERT_EQ(internal.rows(), 8u);
  ASSERT_EQ(internal.cols(), 2u);
  MatrixXd N(8, 2);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 2; ++k) N(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = internal(i, k);
  EXPECT_LT((drives.jacobian().transpose() * N).norm(), 1e-12);
  EXPECT_LT((N.transpose() * N - MatrixXd::Identity(2, 2)).norm(), 1e-12);
}

}  // namespace
}  // namespace pkm
