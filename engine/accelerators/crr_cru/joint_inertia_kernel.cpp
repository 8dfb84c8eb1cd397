#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/math/lanes_functions.hpp"

namespace pkm::crr_cru {
namespace {

template <class L>
[[gnu::always_inline]] inline PlaneInertia<L> share_at(const ShareRow& row, std::size_t voxel) {
  if (!row.varies) return {L(*row.pp), L(*row.pq), L(*row.qq)};
  return {L::load(row.pp + voxel), L::load(row.pq + voxel), L::load(row.qq + voxel)};
}

}  // namespace

template <InstructionSet set>
void coupling_along(const SlideFrame<double>& frame, const std::array<ShareRow, 4>& shares, std::size_t first,
                    std::size_t end, const std::array<double*, 4>& index) {
  using L = LanesOf<set>;
  for (std::size_t voxel = first; voxel < end; voxel += kLanes) {
    const std::array<L, 4> dci =
        coupling_indices(joint_inertia(frame, share_at<L>(shares[0], voxel), share_at<L>(shares[1], voxel),
                                       share_at<L>(shares[2], voxel), share_at<L>(shares[3], voxel)));
    for (std::size_t i = 0; i < 4; ++i) dci[i].store(index[i] + voxel);
  }
}

template void coupling_along<PKM_INSTRUCTION_SET>(const SlideFrame<double>&, const std::array<ShareRow, 4>&,
                                                  std::size_t, std::size_t, const std::array<double*, 4>&);

}  // namespace pkm::crr_cru
