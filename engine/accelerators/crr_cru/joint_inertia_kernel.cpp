#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/math/lanes_functions.hpp"

namespace pkm::crr_cru {
namespace {

template <class L>
[[gnu::always_inline]] inline PlaneInertia<L> inertia_at(const InertiaRow& row, std::size_t voxel) {
  if (!row.varies) return {L(*row.pp), L(*row.pq), L(*row.qq)};
  return {L::load(row.pp + voxel), L::load(row.pq + voxel), L::load(row.qq + voxel)};
}

}  // namespace

template <InstructionSet set>
void coupling_of_row(const YawInertia<double>& inertia, const std::array<InertiaRow, 4>& limbs, std::size_t first,
                     std::size_t end, const std::array<double*, 4>& index) {
  using L = LanesOf<set>;
  for (std::size_t voxel = first; voxel < end; voxel += kLanes) {
    const std::array<PlaneInertia<L>, 4> at = {inertia_at<L>(limbs[0], voxel), inertia_at<L>(limbs[1], voxel),
                                               inertia_at<L>(limbs[2], voxel), inertia_at<L>(limbs[3], voxel)};
    const std::array<L, 4> dci = coupling_indices(joint_inertia(inertia, at));
    for (std::size_t i = 0; i < 4; ++i) dci[i].store(index[i] + voxel);
  }
}

template void coupling_of_row<PKM_INSTRUCTION_SET>(const YawInertia<double>&, const std::array<InertiaRow, 4>&,
                                                   std::size_t, std::size_t, const std::array<double*, 4>&);

}  // namespace pkm::crr_cru
