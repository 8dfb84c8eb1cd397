#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"

namespace pkm::four_ppa_two_par {

template <InstructionSet set>
void conditioning_of_poses(const ColumnPoses<double>& column, const double* z_c1, const double* z_c2, std::size_t count,
                           double* result) {
  using L = LanesOf<set>;
  for (std::size_t i = 0; i < count; i += kLanes)
    conditioning<L>(column, {L::load(z_c1 + i), L::load(z_c2 + i)}).store(result + i);
}

template void conditioning_of_poses<PKM_INSTRUCTION_SET>(const ColumnPoses<double>&, const double*, const double*,
                                                         std::size_t, double*);

}  // namespace pkm::four_ppa_two_par
