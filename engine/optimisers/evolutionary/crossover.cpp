#include "engine/optimisers/evolutionary/crossover.hpp"

#include <algorithm>
#include <utility>

#include "engine/math/portable.hpp"

namespace pkm {
namespace {

void differential(const Pool& pool, std::size_t first, Stream& stream, std::span<double> child) {
  const std::size_t size = pool.size(), n = child.size();
  const std::size_t elite = std::min(size, std::max<std::size_t>(2, size / 10));
  const std::size_t guide = stream.below(elite);
  std::size_t p = stream.below(size);
  std::size_t q = (p + 1 + stream.below(size - 1)) % size;
  if (p > q && stream.chance(0.75)) std::swap(p, q);
  const double factor = 0.45 + 0.9 * stream.u01();
  const std::size_t always = stream.below(n);
  const auto x = pool.design(first), g = pool.design(guide), xp = pool.design(p), xq = pool.design(q);
  for (std::size_t i = 0; i < n; ++i) {
    const bool moves = stream.chance(0.9) || i == always;
    child[i] = moves ? x[i] + factor * (g[i] - x[i]) + factor * (xp[i] - xq[i]) : x[i];
  }
}

void simulated_binary(double eta, std::span<const double> x, std::span<const double> y, Stream& stream,
                      std::span<double> child) {
  for (std::size_t i = 0; i < child.size(); ++i) {
    child[i] = x[i];
    if (stream.chance(0.5)) continue;
    const double u = stream.u01();
    const double base = u < 0.5 ? 2 * u : 1 / (2 * (1 - u));
    const double spread = portable::pow(base, 1 / (eta + 1));
    const double side = stream.chance(0.5) ? 1 : -1;
    child[i] = 0.5 * ((x[i] + y[i]) + side * spread * (x[i] - y[i]));
  }
}

}  // namespace

void cross(const Crossover& crossover, const Pool& pool, std::size_t first, std::size_t second, Stream& stream,
           std::span<double> child) {
  const auto x = pool.design(first), y = pool.design(second);
  switch (crossover.kind) {
    case Crossover::Kind::differential:
      return differential(pool, first, stream, child);
    case Crossover::Kind::sbx:
      return simulated_binary(crossover.eta, x, y, stream, child);
    case Crossover::Kind::blend:
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = x[i] + (2 * stream.u01() - 0.5) * (y[i] - x[i]);
      return;
    case Crossover::Kind::scattered:
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = stream.chance(0.5) ? x[i] : y[i];
      return;
  }
}

}  // namespace pkm
