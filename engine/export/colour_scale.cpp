#include "engine/export/colour_scale.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

constexpr std::array<Colour, 9> kViridis = {{{0x44, 0x01, 0x54},
                                             {0x47, 0x2d, 0x7b},
                                             {0x3b, 0x52, 0x8b},
                                             {0x2c, 0x72, 0x8e},
                                             {0x21, 0x91, 0x8c},
                                             {0x28, 0xae, 0x80},
                                             {0x5e, 0xc9, 0x62},
                                             {0xad, 0xdc, 0x30},
                                             {0xfd, 0xe7, 0x25}}};

}  // namespace

Colour scale_colour(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * (kViridis.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  Colour mixed;
  for (std::size_t c = 0; c < 3; ++c)
    mixed[c] = std::lerp(kViridis[k][c], kViridis[k + 1][c], at - static_cast<double>(k));
  return mixed;
}

Colour text_colour_on(const Colour& background) {
  const double luma = 0.299 * background[0] + 0.587 * background[1] + 0.114 * background[2];
  return luma < 128 ? Colour{255, 255, 255} : Colour{0, 0, 0};
}

}  // namespace pkm
