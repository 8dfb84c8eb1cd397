#include "engine/report/packed_array.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

static_assert(std::endian::native == std::endian::little, "packed arrays are little-endian");

template <class T>
std::string packed(const std::string& kind, const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return kind + ':' + base64(bytes);
}

/// Decimal text from which the number can be read back exactly.
std::string round_trip(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {  // three bytes give four digits; missing bytes give "="
    const std::size_t available = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < available ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= available ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string packed_floats(std::span<const double> values) {
  std::vector<float> numbers;
  numbers.reserve(values.size());
  for (const double value : values) numbers.push_back(static_cast<float>(value));
  return packed("f32", numbers);
}

std::string packed_integers(std::span<const std::int64_t> values) {
  std::int64_t largest = 0;
  for (const std::int64_t value : values) {
    PKM_EXPECTS(value >= 0 && value <= std::numeric_limits<std::uint32_t>::max());
    largest = std::max(largest, value);
  }
  if (largest <= std::numeric_limits<std::uint16_t>::max())
    return packed("u16", std::vector<std::uint16_t>(values.begin(), values.end()));
  return packed("u32", std::vector<std::uint32_t>(values.begin(), values.end()));
}

std::string packed_bytes(std::span<const std::uint8_t> values) { return "u8:" + base64(values); }

std::string packed_bits(std::span<const std::uint8_t> flags) {
  std::vector<std::uint8_t> bytes((flags.size() + 7) / 8);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i]) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 1u << i % 8);
  return "bits:" + base64(bytes);
}

std::string packed_quantised(std::span<const double> values) {
  constexpr std::uint16_t kNan = 65535;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  if (!(lower <= upper)) lower = upper = 0;  // none of the values is finite
  std::vector<std::uint16_t> levels;
  levels.reserve(values.size());
  for (const double value : values) {
    const double fraction = upper > lower ? (value - lower) / (upper - lower) : 0;
    levels.push_back(std::isfinite(value) ? static_cast<std::uint16_t>(std::lround(fraction * (kNan - 1))) : kNan);
  }
  return packed("q16:" + round_trip(lower) + ':' + round_trip(upper), levels);
}

}  // namespace pkm
