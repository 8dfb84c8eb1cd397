// (3CRR/R)&CRU and the Quadrupteron as closed-loop multibody systems of Simbody.
//
// A tree of bodies: each limb hangs on its rail (slider, then pin: the cylindrical joint) with its second rod on a pin
// at the elbow; limb 3 carries the platform on a third pin; the moving platform sits on the middle one on a pin along z
// or is welded to it. Limbs 1, 2 and 4 are closed by constraints between the second rod and the platform: a ball, and
// axes at right angles, two for a revolute joint and one for a universal one. Nothing of the engine's kinematics or
// dynamics enters: rates and accelerations are solved from Simbody's constraints, forces from its equations of motion.
//
// More constraints than the mechanism needs (four and three) leave Simbody's multipliers undetermined. The forces of
// the actuators are determined all the same, by the solution of least norm.
//
// Simbody's headers are C++ before C++20, so this header includes nothing of the engine's.
#pragma once

#include <array>
#include <memory>

namespace pkm::simbody {

/// Per limb: rods 1 and 2. SI units.
struct Parameters {
  bool one_platform;  ///< Quadrupteron
  std::array<double, 4> l_1, l_2, m_1, m_2, I_1, I_2;
  double r, h, l, L;
  std::array<double, 3> beta;
  double m, c, m_middle;
  std::array<double, 3> I, I_middle;  ///< about the plates' centres of mass
  double slide, payload, c_payload;   ///< of each slide; a point mass on the moving platform, its place on the arm
};

/// What a case prescribes: X = (x, y, z, phi) with rates, and a wrench on the moving platform's centre of mass.
struct Case {
  std::array<int, 4> elbow;  ///< signs of sin theta_i2
  std::array<double, 4> pose, velocity, acceleration;
  std::array<double, 6> wrench;
};

struct Solution {
  std::array<double, 4> drive_forces;  ///< [N]
  int constraints = 0, constraint_rank = 0;
  double open = 0;        ///< greatest error of the loops' closure, as given and in rates [m, rad; per s, per s^2]
  double unbalanced = 0;  ///< greatest residual of the equations of motion [N, N m]
};

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
