// The Delta with cranks and the Gough platform of experiments/mechanisms as closed-loop systems of Simbody: cranks on
// pins, thin rods and legs on universal joints, closed by balls at the platform.
//
// Simbody's headers are C++ before C++20, so this header includes nothing of the engine's.
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace pkm::simbody {

/// SI units. A rod's or a crank's mass lies in its middle.
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

/// X = (x, y, z) or (x, y, z, alpha, beta, gamma), its rates, and a wrench at the platform's origin.
struct LoopCase {
  std::vector<double> pose, velocity, acceleration;
  std::array<double, 6> wrench;
};

struct LoopSolution {
  std::vector<double> drive_forces;  ///< of the limbs in the file's order
  std::vector<double> at_platform;   ///< what the balls there carry: x, y, z of each limb
  double open = 0, unbalanced = 0;
};

class DescribedLoops {
 public:
  explicit DescribedLoops(const DeltaParameters& parameters);
  explicit DescribedLoops(const GoughParameters& parameters);
  ~DescribedLoops();
  LoopSolution solve(const LoopCase& at) const;

 private:
  struct Model;
  struct Delta;
  struct Gough;
  std::unique_ptr<const Model> model_;
};

}  // namespace pkm::simbody
