#include "engine/core/formatted.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace pkm {

std::string formatted(const char* format, double value) {
  if (std::isnan(value)) return "-";
  std::array<char, 40> buffer{};
  // Adding 0.0 turns -0 into 0, so that "-0" is not printed.
  std::snprintf(buffer.data(), buffer.size(), format, value + 0.0);
  return buffer.data();
}

}  // namespace pkm
