// Numbers as text for people, in the formats of std::printf.
#pragma once

#include <string>

namespace pkm {

/// A number formatted by std::printf; "-" for NaN. Negative zero is written as zero.
/// @param format  at most 39 characters, with one conversion of a double such as "%.4g"
std::string formatted(const char* format, double value);

}  // namespace pkm
