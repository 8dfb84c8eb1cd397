// Functions shared by the writers of multibody models: formatting of numbers, names and comments, and the changes to a
// model that simulation programs require.
#pragma once

#include <string>

#include <Eigen/Core>

#include "engine/mechanism/multibody_model.hpp"

namespace pkm {

/// Text of a number with 15 significant digits.
std::string xml_number(double value);
/// Text of the three components of a vector, separated by spaces.
std::string xml_numbers(const Eigen::Vector3d& v);
/// Text of an attribute, NAME="VALUE", preceded by a space.
std::string xml_attribute(const std::string& name, const std::string& value);
std::string xml_attribute(const std::string& name, double value);
std::string xml_attribute(const std::string& name, const Eigen::Vector3d& value);
/// An XML comment on a line of its own; spaces separate consecutive hyphens, which would end it.
std::string xml_comment(std::string text);
/// Replaces characters that are not letters, digits or underscores: not all programs accept them in names.
std::string plain_name(std::string name);

/// Returns the model with unique names that contain only letters, digits and underscores, and with positive masses and
/// moments of inertia that satisfy the triangle inequality, as simulation programs require. A note in the model lists
/// the changed bodies. The changes increase the total mass by less than 1e-4 of its value.
MultibodyModel for_simulators(MultibodyModel model);
/// Returns the model with each universal or ball joint of the spanning tree replaced by two or three revolute joints
/// with small bodies between them.
/// @param model  result of for_simulators()
MultibodyModel with_revolute_joints(const MultibodyModel& model);
/// Returns the model with each universal joint that closes a loop replaced by a small body between two revolute joints,
/// the first of which belongs to the spanning tree.
/// @param model  result of for_simulators()
MultibodyModel without_universal_closures(const MultibodyModel& model);

/// Origin of the frame of a body: the position of the body's joint in the spanning tree.
Eigen::Vector3d frame_origin(const MultibodyModel& model, std::size_t body);
/// XML comments with the title, the reference pose and the notes of a model.
std::string model_comments(const MultibodyModel& model, const std::string& title);
/// Roll, pitch and yaw of a rotation: angles of successive rotations about the fixed axes x, y and z, in this order
/// [rad].
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R);
/// Roll, pitch and yaw of a rotation that maps the z axis to the given direction [rad].
Eigen::Vector3d angles_of_z(const Eigen::Vector3d& direction);

}  // namespace pkm
