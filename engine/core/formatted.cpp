#include "engine/core/formatted.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace pkm {

std::string formatted(const char* format, double value) {
  if (std::isnan(value)) return "-";
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value + 0.0);  // no "-0"
  return buffer.data();
}

}  // namespace pkm
