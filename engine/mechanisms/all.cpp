#include "engine/mechanisms/all.hpp"

#include "engine/mechanisms/list.hpp"

namespace pkm {

const MechanismList& all_mechanisms() {
  static const MechanismList list = {
      make_four_ppa_two_par(),
      make_three_crr_r_cru(),
      make_quadrupteron(),
      make_hybrid(),
  };
  return list;
}

}  // namespace pkm
