// Simbody models of (3CRR/R)&CRU and the Quadrupteron, as closed-loop multibody systems.
//
// The spanning tree: each limb is attached to its rail by a slider and a pin (together the cylindrical joint), with its
// second rod on a pin at the elbow; limb 3 carries the platform on a third pin; the moving platform is connected to the
// middle platform by a pin along z, or welded to it. Limbs 1, 2 and 4 are closed by constraints between the second rod
// and the platform: a ball, plus perpendicular axes, two for a revolute joint and one for a universal joint. The model
// is independent of the engine's kinematics and dynamics: velocities and accelerations are solved from Simbody's
// constraints, forces from its equations of motion.
//
// The models have redundant constraints (four and three), so the constraint multipliers are not unique. The forces of
// the actuators are unique nevertheless, and are computed by a minimum-norm solution.
//
// This header includes no header of the engine, because Simbody's headers do not compile as C++20.
#pragma once

#include <array>
#include <memory>

namespace pkm::simbody {

/// Geometry and mass parameters; l_1, m_1, I_1 are those of rod 1 of each limb, l_2, m_2, I_2 those of rod 2. SI units.
struct Parameters {
  bool one_platform;  ///< true: Quadrupteron, middle and moving platform are one body
  std::array<double, 4> l_1, l_2, m_1, m_2, I_1, I_2;
  double r, h, l, L;
  std::array<double, 3> beta;
  double m, c, m_middle;
  std::array<double, 3> I, I_middle;  ///< about the plates' centres of mass
  double slide, payload;              ///< mass of each slide; mass of a point mass on the moving platform
  double c_payload;                   ///< position of the payload on the arm
};

/// Prescribed state: X = (x, y, z, phi) with velocity and acceleration, and a wrench at the centre of mass of the
/// moving platform.
struct Case {
  std::array<int, 4> elbow;  ///< signs of sin theta_i2
  std::array<double, 4> pose, velocity, acceleration;
  std::array<double, 6> wrench;
};

struct Solution {
  std::array<double, 4> drive_forces;  ///< [N]
  int constraints = 0, constraint_rank = 0;
  double closure_error = 0;  ///< maximum residual of the loop-closure equations and their time derivatives (SI units)
  double force_error = 0;    ///< maximum residual of the equations of motion [N, N m]
};

/// The Simbody model of one of the two mechanisms.
class ClosedLoop {
 public:
  explicit ClosedLoop(const Parameters& parameters);
  ~ClosedLoop();
  Solution solve(const Case& at) const;

 private:
  struct Model;
  std::unique_ptr<const Model> model_;
};

}  // namespace pkm::simbody
