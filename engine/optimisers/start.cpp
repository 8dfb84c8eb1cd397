#include "engine/optimisers/start.hpp"

#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "engine/math/random.hpp"

namespace pkm {
namespace {

// Primitive polynomials over GF(2) and first direction numbers, dimensions 2 to 21, of Joe & Kuo (2008).
struct SearchDirection {
  unsigned degree, coefficients;
  std::array<unsigned, 7> first;
};
constexpr std::array<SearchDirection, 20> kDirections = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};
constexpr std::size_t kSobolDimensions = kDirections.size() + 1;

using Generator = std::array<std::uint32_t, 32>;  // column k is xored in where bit k of the point's index is set

Generator sobol_generator(std::size_t dimension) {
  Generator v{};
  if (dimension == 0) {
    for (unsigned k = 0; k < 32; ++k) v[k] = std::uint32_t{1} << (31 - k);
    return v;
  }
  const SearchDirection& d = kDirections[dimension - 1];
  for (unsigned k = 0; k < d.degree; ++k) v[k] = d.first[k] << (31 - k);
  for (unsigned k = d.degree; k < 32; ++k) {
    v[k] = v[k - d.degree] ^ (v[k - d.degree] >> d.degree);
    for (unsigned j = 1; j < d.degree; ++j)
      if (d.coefficients >> (d.degree - 1 - j) & 1) v[k] ^= v[k - j];
  }
  return v;
}

// Multiplies by a random lower triangular matrix with ones on its diagonal: each digit is mixed with those before it,
// which keeps the even cover of every power-of-two block of points.
void scramble(Generator& v, Stream& stream) {
  Generator mixed{};
  for (unsigned digit = 0; digit < 32; ++digit) {
    const std::uint32_t here = std::uint32_t{1} << (31 - digit);
    const std::uint32_t before = ~(here | (here - 1));
    const std::uint32_t row = here | (stream.bits() & before);
    for (unsigned k = 0; k < 32; ++k)
      if (std::popcount(v[k] & row) & 1) mixed[k] |= here;
  }
  v = mixed;
}

void sobol_column(std::size_t variable, std::size_t dimension, Stream& stream, std::vector<double>& points) {
  Generator v = sobol_generator(variable);
  scramble(v, stream);
  const auto shift = stream.bits();
  for (std::size_t i = 0; i * dimension < points.size(); ++i) {
    std::uint32_t x = shift;
    for (unsigned k = 0; k < 32; ++k)
      if (i >> k & 1) x ^= v[k];
    points[i * dimension + variable] = (static_cast<double>(x) + 0.5) * 0x1p-32;
  }
}

void latin_column(std::size_t variable, std::size_t dimension, Stream& stream, std::vector<double>& points) {
  std::vector<std::size_t> slice(points.size() / dimension);
  std::iota(slice.begin(), slice.end(), std::size_t{0});
  for (std::size_t i = slice.size(); i > 1; --i) std::swap(slice[i - 1], slice[stream.below(i)]);
  for (std::size_t i = 0; i < slice.size(); ++i)
    points[i * dimension + variable] =
        (static_cast<double>(slice[i]) + stream.u01()) / static_cast<double>(slice.size());
}

}  // namespace

std::vector<double> start_points(Start start, std::size_t count, std::size_t dimension, std::uint64_t seed) {
  std::vector<double> points(count * dimension);
  for (std::size_t variable = 0; variable < dimension; ++variable) {
    Stream stream(seed, 0, static_cast<std::uint32_t>(variable), Stream::Use::start);
    if (start == Start::random) {
      for (std::size_t i = 0; i < count; ++i) points[i * dimension + variable] = stream.u01();
    } else if (start == Start::sobol && variable < kSobolDimensions) {
      sobol_column(variable, dimension, stream, points);
    } else {
      latin_column(variable, dimension, stream, points);
    }
  }
  return points;
}

}  // namespace pkm
