#include "engine/accelerators/hybrid/conditioning.hpp"
#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/geometry/conditioning.hpp"

namespace pkm::hybrid {

// The same operations in the same order as inverse() and inverse_condition(), which serve the derivatives.
template <InstructionSet set>
void inverse_conditions(const ConditioningDesign& g, const double* heights, const double* sines, const double* cosines,
                        std::size_t count, double* result) {
  using L = LanesOf<set>;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const L z = L::load(heights + i), sin_b = L::load(sines + i), cos_b = L::load(cosines + i);
    auto regular = z >= z;
    const Limbs<L> j = limbs(g, z, sin_b, cos_b, [&](const L& square, double length, std::size_t limb) {
      regular = regular & (square > g.roundoff * length * length);
      return sqrt_or_zero(square) * g.signs[limb];
    });
    const ExtremeSingularValues<L> s = extreme_singular_values(homogeneous_jacobian(z, j, L(g.length)));
    select(regular, inverse_condition_of(s.min_squared(), s.max_squared), L(0.0)).store(result + i);
  }
}

template void inverse_conditions<PKM_INSTRUCTION_SET>(const ConditioningDesign&, const double*, const double*,
                                                      const double*, std::size_t, double*);

}  // namespace pkm::hybrid
