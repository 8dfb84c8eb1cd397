// Arrays as text: what the page's long columns of numbers travel in.
//
// A packed array is one string, "kind:base64" of little-endian numbers; a quantised one says its range in between,
// "q16:lower:upper:base64". engine/report/page/data.js unpacks them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pkm {

std::string base64(std::span<const std::uint8_t> bytes);

/// Single precision, seven digits: for pictures and for values that are read off.
std::string packed_floats(std::span<const double> values);
/// Each in [0, 2^32); of two bytes where that is enough, else of four.
std::string packed_integers(std::span<const std::int64_t> values);
std::string packed_bytes(std::span<const std::uint8_t> values);
/// Flags, eight to a byte, the lowest bit first.
std::string packed_bits(std::span<const std::uint8_t> flags);
/// 65535 levels from the least to the greatest finite value; what is not finite comes back as NaN.
std::string packed_levels(std::span<const double> values);

}  // namespace pkm
