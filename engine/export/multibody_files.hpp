// Files of a multibody model for simulation programs: URDF (ROS), SDF (Gazebo), MJCF (MuJoCo).
//
// The frames of all bodies have the axes of the base frame at the reference pose, and their origins at the joints of
// the spanning tree. Names contain only letters, digits and underscores.
#pragma once

#include <string>

#include "engine/mechanism/multibody_model.hpp"

namespace pkm {

/// URDF: the spanning tree as links and joints. Each closure is an element <constraint>, as proposed for URDF
/// (https://github.com/ros/urdfdom/pull/264), which other programs ignore.
/// @param title  text with which the comment at the top of the file begins, here and in the functions below
std::string urdf_text(const MultibodyModel& model, const std::string& title);
/// The loop closures and the reference pose of the URDF file as YAML, for programs that ignore <constraint>.
std::string loop_closures_yaml(const MultibodyModel& model, const std::string& urdf_file, const std::string& title);
/// SDF 1.7: all joints are elements <joint>, including those that close the loops.
std::string sdf_text(const MultibodyModel& model, const std::string& title);
/// MJCF for MuJoCo 2.2 or later: the closures are equality constraints, the drives are motors. The positions of driven
/// joints are measured as in the mechanism.
std::string mjcf_text(const MultibodyModel& model, const std::string& title);

}  // namespace pkm
