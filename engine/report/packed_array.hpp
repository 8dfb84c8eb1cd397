// Base64 encoding of numeric arrays for the JSON data of the page.
//
// A packed array is one string: "kind:base64" of little-endian numbers, or "q16:lower:upper:base64" for values
// quantised to 16 bits between lower and upper. engine/report/page/packed_array.js decodes them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pkm {

/// Base64 text of bytes (RFC 4648), with padding.
std::string base64(std::span<const std::uint8_t> bytes);

/// Packs numbers as kind "f32": single precision, i.e. seven digits, which suffice for plots and displayed values.
std::string packed_floats(std::span<const double> values);
/// Packs integers as kind "u16" if all values fit, otherwise as "u32". Values must be in [0, 2^32).
std::string packed_integers(std::span<const std::int64_t> values);
/// Packs bytes as kind "u8".
std::string packed_bytes(std::span<const std::uint8_t> values);
/// Packs flags as kind "bits": eight flags per byte, lowest bit first.
std::string packed_bits(std::span<const std::uint8_t> flags);
/// Packs numbers as kind "q16": 65535 equidistant levels from the smallest to the largest finite value. Non-finite
/// values are decoded as NaN.
std::string packed_quantised(std::span<const double> values);

}  // namespace pkm
