// Fuzzer of formulas. Input: a formula with five names. Its values must be equal for double, Dual4 and Taylor.
#include "engine/expression/formula.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "engine/math/dual.hpp"
#include "engine/math/taylor.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

namespace {

constexpr std::array kPoints = {std::array{0.5, 2.0, -1.25, 0.0, 3.0}, std::array{1e300, -1e-300, 7.0, -0.0, 1024.0}};

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Formula formula(text, {"a", "b", "x", "t", "l_u"});
    for (const std::size_t used : formula.used()) fuzz::expect(used < 5, "a formula uses only the given names");
    for (const auto& point : kPoints) {
      const std::vector<Dual4> duals(point.begin(), point.end());
      const std::vector<Taylor> taylors(point.begin(), point.end());
      const double value = formula.value<double>(point);
      fuzz::expect(same(value, value_of(formula.value<Dual4>(duals))), "Dual4 has the formula's value");
      fuzz::expect(same(value, value_of(formula.value<Taylor>(taylors))), "Taylor has the formula's value");
    }
  } catch (const std::invalid_argument& error) {
    fuzz::expect_sentence(error.what(), text);
  }
  return 0;
}
