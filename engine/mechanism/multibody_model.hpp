// A mechanism at one design as a multibody system: rigid bodies, a spanning tree of joints, and the joints that close
// the loops, for simulation programs. Terms as in Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 8.
//
// This header is also valid C++17, for tests whose other headers do not compile as C++20.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace pkm {

/// A multibody system. All points and directions are in the base frame, with the mechanism at its reference pose.
struct MultibodyModel {
  /// A capsule (a cylinder with hemispherical ends) that represents a part in drawings.
  struct Shape {
    Eigen::Vector3d from, to;
    double radius;
  };
  struct Body {
    std::string name;
    double mass = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of mass
    /// Inertia matrix about the centre of mass; 0 about the line of a thin part.
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    std::vector<Shape> shapes{};
  };
  enum class JointType { fixed, prismatic, revolute, universal, ball };
  struct Drive {
    std::size_t joint;                             ///< index of the driven joint in MechanismInfo::joints
    double position;                               ///< position of the joint at the reference pose [m or rad]
    std::optional<std::array<double, 2>> range{};  ///< range of the joint position [m or rad]; std::nullopt: not given
    std::optional<double> peak_force{};  ///< maximum force or torque of the drive [N or N m]; std::nullopt: not given
    double inertia = 0;                  ///< inertia of the drive train at the joint [kg or kg m^2]
    double viscous = 0, coulomb = 0;     ///< friction at the joint [N s/m or N m s/rad, N or N m]
  };
  /// A joint between two bodies. Its coordinate is positive if the child has moved relative to the parent in the
  /// positive sense along or about the axis.
  struct Joint {
    std::string name;
    JointType type;
    std::size_t parent, child;  ///< indices of the two connected bodies in `bodies`
    Eigen::Vector3d point;
    /// Axes of the joint as unit vectors. Fixed or ball joint: none; universal joint: the axis on the parent and the
    /// one on the child, perpendicular to each other; any other joint: one axis.
    std::vector<Eigen::Vector3d> axes{};
    std::optional<Drive> drive{};
  };

  std::string name;
  std::vector<Body> bodies;  ///< the first is the base, which does not move
  /// For each body except the base, the joint whose child the body is; joints of parents precede those of their
  /// children.
  std::vector<Joint> tree;
  std::vector<Joint> closures;                             ///< the joints that close loops; none of them has a drive
  std::size_t platform = 0;                                ///< index of the platform among the bodies
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();        ///< origin of the platform frame
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< rotation from the platform frame to the base frame
  std::vector<std::pair<std::string, double>> pose;  ///< names and values of the coordinates at the reference pose
  std::vector<std::string> notes;                    ///< sentences that describe what the model omits
};

}  // namespace pkm
