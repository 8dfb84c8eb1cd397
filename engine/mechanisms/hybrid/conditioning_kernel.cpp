#include "engine/mechanisms/hybrid/conditioning.hpp"
#include "engine/model/conditioning.hpp"

namespace pkm::hybrid {

// The same operations in the same order as inverse(), homogeneous_jacobian() and inverse_condition(), which serve the
// derivatives.
template <InstructionSet set>
void inverse_conditions(const ConditioningDesign& g, const double* heights, const double* sines, const double* cosines,
                        std::size_t count, double* result) {
  using L = LanesOf<set>;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const L z = L::load(heights + i), sin_b = L::load(sines + i), cos_b = L::load(cosines + i);
    const L k = g.e * cos_b - g.d, N1 = z + g.e * sin_b, N2 = g.e * (z * cos_b + g.d * sin_b);
    const L A2 = (g.L1 - z) * (g.L1 + z), B2 = (g.L2 - z) * (g.L2 + z), C2 = g.L3 * g.L3 - k * k - N1 * N1;
    const auto regular =
        (A2 > g.roundoff * g.L1 * g.L1) & (B2 > g.roundoff * g.L2 * g.L2) & (C2 > g.roundoff * g.L3 * g.L3);
    const L n1 = root_or_zero(A2) * g.signs[0], n2 = root_or_zero(B2) * g.signs[1], n3 = root_or_zero(C2) * g.signs[2];
    const Rows3<L> J = {{{L(1.0), z / n1, L(0.0)}, {L(1.0), z / n2, L(0.0)}, {L(1.0), N1 / n3, N2 / n3 / g.length}}};
    const ExtremeSingularValues<L> s = extreme_singular_values(J);
    select(regular, inverse_condition_of(s.least_2(), s.greatest_2), L(0.0)).store(result + i);
  }
}

template void inverse_conditions<PKM_INSTRUCTION_SET>(const ConditioningDesign&, const double*, const double*,
                                                      const double*, std::size_t, double*);

}  // namespace pkm::hybrid
