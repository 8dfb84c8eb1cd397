// Perceptually uniform colour scale from dark blue to yellow, legible for colour-blind readers and in print.
#pragma once

#include <array>

namespace pkm {

using Colour = std::array<double, 3>;  ///< red, green and blue, each from 0 to 255

/// A colour of the scale viridis (S. van der Walt and N. Smith, matplotlib, 2015; CC0), interpolated between nine of
/// its colours.
/// @param t  position on the scale, from 0 (dark) to 1 (bright)
Colour scale_colour(double t);

/// Colour of text that is legible on this background: black or white.
Colour text_colour_on(const Colour& background);

}  // namespace pkm
