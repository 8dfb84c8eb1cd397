#include "engine/mechanisms/hybrid/limits.hpp"

namespace pkm::hybrid {

const std::array<std::string, kMargins>& margin_names() {
  static const std::array<std::string, kMargins> names = {
      "reach1",     "reach2",    "reach3",   "stroke1",     "stroke2",      "stroke3",       "stroke4",
      "zclear",     "beta",      "serial1",  "serial2",     "serial3",      "parallel_xz",   "parallel_beta",
      "constraint", "passiveA",  "passiveB", "passiveC_in", "passiveC_out", "passiveCp_out", "gap",
      "aux_bend1",  "aux_bend2", "aux_len",  "cap_AB",      "cap_AC",       "cap_BC",        "cap_AF",
      "cap_BF",     "cap_CF",    "cap_CP",   "cap_FP"};
  return names;
}

}  // namespace pkm::hybrid
