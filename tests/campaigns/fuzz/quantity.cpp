// Fuzzer of quantities with units. Input: one byte that selects a unit, then the text of a quantity. A value that is
// parsed, written and parsed again must have the same bits.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/core/unit.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  constexpr std::array kUnits = {"1",   "m",      "rad",     "s",     "kg",    "N",
                                 "N m", "kg m^2", "m^2 rad", "rad/s", "m/s^2", "N m/rad"};
  if (size == 0) return 0;
  const std::string_view unit = kUnits[data[0] % kUnits.size()];
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (const auto value = parse_quantity(text, unit)) {
    fuzz::expect(std::isfinite(*value), "a quantity is finite");
    const auto again = parse_quantity(with_unit(*value, unit), unit);
    fuzz::expect(again && std::bit_cast<std::uint64_t>(*value) == std::bit_cast<std::uint64_t>(*again),
                 "the same bits again");
  }
  if (is_si_unit(text)) fuzz::expect(!quantity_hint(text).empty(), "a unit has a hint");
  return 0;
}
