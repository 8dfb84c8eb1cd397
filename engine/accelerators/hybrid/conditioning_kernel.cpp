#include "engine/accelerators/hybrid/conditioning.hpp"

namespace pkm::hybrid {

template <InstructionSet set>
void conditioning_of_poses(const ConditioningDesign<double>& design, const double* z, const double* sine,
                           const double* cosine, std::size_t count, double* result) {
  using L = LanesOf<set>;
  for (std::size_t i = 0; i < count; i += kLanes)
    conditioning(design, L::load(z + i), L::load(sine + i), L::load(cosine + i)).store(result + i);
}

template void conditioning_of_poses<PKM_INSTRUCTION_SET>(const ConditioningDesign<double>&, const double*,
                                                         const double*, const double*, std::size_t, double*);

}  // namespace pkm::hybrid
