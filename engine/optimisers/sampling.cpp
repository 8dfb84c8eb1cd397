#include "engine/optimisers/sampling.hpp"

#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "engine/math/random.hpp"

namespace pkm {
namespace {

// Primitive polynomials over GF(2) and initial direction numbers of Joe and Kuo (2008), dimensions 2 to 21.
struct SobolDirection {
  unsigned degree, coefficients;
  std::array<unsigned, 7> first;
};
constexpr std::array<SobolDirection, 20> kDirections = {{
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

// Column k is XORed into a point if bit k of the point's index is set.
using GeneratorMatrix = std::array<std::uint32_t, 32>;

GeneratorMatrix sobol_generator_matrix(std::size_t dimension) {
  GeneratorMatrix v{};
  if (dimension == 0) {
    for (unsigned k = 0; k < 32; ++k) v[k] = std::uint32_t{1} << (31 - k);
    return v;
  }
  const SobolDirection& d = kDirections[dimension - 1];
  for (unsigned k = 0; k < d.degree; ++k) v[k] = d.first[k] << (31 - k);
  for (unsigned k = d.degree; k < 32; ++k) {
    v[k] = v[k - d.degree] ^ (v[k - d.degree] >> d.degree);
    for (unsigned j = 1; j < d.degree; ++j)
      if (d.coefficients >> (d.degree - 1 - j) & 1) v[k] ^= v[k - j];
  }
  return v;
}

// Matousek's linear scrambling: multiplies by a random lower triangular matrix over GF(2) with unit diagonal. Each
// digit is combined with more significant digits only, so the net property of every power-of-two block of points is
// preserved.
void scramble(GeneratorMatrix& v, Stream& stream) {
  GeneratorMatrix mixed{};
  for (unsigned digit = 0; digit < 32; ++digit) {
    const std::uint32_t bit = std::uint32_t{1} << (31 - digit);
    const std::uint32_t more_significant = ~(bit | (bit - 1));
    const std::uint32_t row = bit | (stream.bits() & more_significant);
    for (unsigned k = 0; k < 32; ++k)
      if (std::popcount(v[k] & row) & 1) mixed[k] |= bit;
  }
  v = mixed;
}

void fill_sobol(std::size_t variable, std::size_t dimension, Stream& stream, std::vector<double>& points) {
  GeneratorMatrix v = sobol_generator_matrix(variable);
  scramble(v, stream);
  const auto shift = stream.bits();
  for (std::size_t i = 0; i * dimension < points.size(); ++i) {
    std::uint32_t x = shift;
    for (unsigned k = 0; k < 32; ++k)
      if (i >> k & 1) x ^= v[k];
    points[i * dimension + variable] = (static_cast<double>(x) + 0.5) * 0x1p-32;
  }
}

void fill_latin_hypercube(std::size_t variable, std::size_t dimension, Stream& stream, std::vector<double>& points) {
  std::vector<std::size_t> strata(points.size() / dimension);
  std::iota(strata.begin(), strata.end(), std::size_t{0});
  for (std::size_t i = strata.size(); i > 1; --i) std::swap(strata[i - 1], strata[stream.below(i)]);
  for (std::size_t i = 0; i < strata.size(); ++i)
    points[i * dimension + variable] =
        (static_cast<double>(strata[i]) + stream.u01()) / static_cast<double>(strata.size());
}

}  // namespace

std::vector<double> unit_cube_samples(Start start, std::size_t count, std::size_t dimension, std::uint64_t seed) {
  std::vector<double> points(count * dimension);
  for (std::size_t variable = 0; variable < dimension; ++variable) {
    Stream stream(seed, 0, static_cast<std::uint32_t>(variable), Stream::Use::start);
    if (start == Start::random) {
      for (std::size_t i = 0; i < count; ++i) points[i * dimension + variable] = stream.u01();
    } else if (start == Start::sobol && variable < kSobolDimensions) {
      fill_sobol(variable, dimension, stream, points);
    } else {
      fill_latin_hypercube(variable, dimension, stream, points);
    }
  }
  return points;
}

}  // namespace pkm
