// Simbody models of the rotary Delta and the Gough platform of experiments/mechanisms, as closed-loop multibody
// systems: cranks on pins, thin rods and legs on universal joints, closed by ball constraints at the platform.
//
// This header includes no header of the engine, because Simbody's headers do not compile as C++20.
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace pkm::simbody {

/// SI units. The centres of mass of rods and cranks are at their midpoints.
struct DeltaParameters {
  double R, r, l_a, l_b;
  double crank_mass, crank_inertia, rod_mass, rod_inertia, platform_mass;
};
struct GoughParameters {
  double R, r, a_b, a_p;
  double cylinder_mass, cylinder_centre, cylinder_inertia, piston_mass, piston_centre, piston_inertia;
  double platform_mass;
  std::array<double, 3> platform_inertia;
};

/// Prescribed state: X = (x, y, z) or (x, y, z, alpha, beta, gamma) with velocity and acceleration, and a wrench at the
/// origin of the platform.
struct LoopCase {
  std::vector<double> pose, velocity, acceleration;
  std::array<double, 6> wrench;
};

struct LoopSolution {
  std::vector<double> drive_forces;           ///< in the order of the limbs in the mechanism file
  std::vector<double> at_platform;            ///< forces of the ball constraints: x, y, z of each limb
  double closure_error = 0, force_error = 0;  ///< as LoopForces
};

/// The Simbody model of a Delta or a Gough platform.
class DeltaOrGough {
 public:
  explicit DeltaOrGough(const DeltaParameters& parameters);
  explicit DeltaOrGough(const GoughParameters& parameters);
  ~DeltaOrGough();
  LoopSolution solve(const LoopCase& at) const;

 private:
  struct Model;
  struct Delta;
  struct Gough;
  std::unique_ptr<const Model> model_;
};

}  // namespace pkm::simbody
