#include "engine/optimisers/evolutionary/operators.hpp"

#include <algorithm>
#include <utility>

#include "engine/math/portable.hpp"

namespace pkm {
namespace {

// Stochastic universal sampling (Baker 1987) with linear ranking: one pointer per parent, equally spaced, so that a
// member is drawn its expected number of times, rounded up or down. The result is shuffled to randomise the pairs.
void stochastic_universal_sampling(double pressure, std::size_t population, Stream& stream,
                                   std::span<std::uint32_t> parents) {
  const double n = static_cast<double>(population), count = static_cast<double>(parents.size());
  const double offset = stream.u01();
  double reached = 0;  // sum of the expected numbers of draws of all members before `next`
  std::size_t next = 0;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const double pointer = static_cast<double>(i) + offset;
    while (next < population && reached <= pointer) {
      const double rank = population > 1 ? static_cast<double>(next) / (n - 1) : 0.5;
      reached += count / n * (pressure - 2 * (pressure - 1) * rank);
      ++next;
    }
    parents[i] = static_cast<std::uint32_t>(next - 1);
  }
  for (std::size_t i = parents.size(); i > 1; --i) std::swap(parents[i - 1], parents[stream.below(i)]);
}

void differential_crossover(const ParentPool& pool, std::size_t first, Stream& stream, std::span<double> child) {
  const std::size_t size = pool.size(), n = child.size();
  const std::size_t elite = std::min(size, std::max<std::size_t>(2, size / 10));
  const std::size_t guide = stream.below(elite);
  std::size_t p = stream.below(size);
  std::size_t q = (p + 1 + stream.below(size - 1)) % size;
  if (p > q && stream.chance(0.75)) std::swap(p, q);
  const double factor = 0.45 + 0.9 * stream.u01();
  const std::size_t forced = stream.below(n);
  const auto x = pool.design(first), g = pool.design(guide), xp = pool.design(p), xq = pool.design(q);
  for (std::size_t i = 0; i < n; ++i) {
    const bool takes_step = stream.chance(0.9) || i == forced;
    child[i] = takes_step ? x[i] + factor * (g[i] - x[i]) + factor * (xp[i] - xq[i]) : x[i];
  }
}

void simulated_binary_crossover(double eta, std::span<const double> x, std::span<const double> y, Stream& stream,
                                std::span<double> child) {
  for (std::size_t i = 0; i < child.size(); ++i) {
    child[i] = x[i];
    if (stream.chance(0.5)) continue;
    const double u = stream.u01();
    const double base = u < 0.5 ? 2 * u : 1 / (2 * (1 - u));
    const double spread = portable::pow(base, 1 / (eta + 1));
    const double sign = stream.chance(0.5) ? 1 : -1;
    child[i] = 0.5 * ((x[i] + y[i]) + sign * spread * (x[i] - y[i]));
  }
}

double polynomial_step(double eta, double u) {
  const double power = 1 / (eta + 1);
  return u < 0.5 ? portable::pow(2 * u, power) - 1 : 1 - portable::pow(2 * (1 - u), power);
}

}  // namespace

void select_parents(const Selection& selection, std::size_t population, Stream& stream,
                    std::span<std::uint32_t> parents) {
  if (selection.kind == Selection::Kind::linear_ranking) {
    stochastic_universal_sampling(selection.pressure, population, stream, parents);
    return;
  }
  for (std::uint32_t& parent : parents) {
    std::size_t best = stream.below(population);
    for (std::int64_t i = 1; i < selection.tournament_size; ++i) best = std::min(best, stream.below(population));
    parent = static_cast<std::uint32_t>(best);
  }
}

void recombine(const Crossover& crossover, const ParentPool& pool, std::size_t first, std::size_t second,
               Stream& stream, std::span<double> child) {
  const auto x = pool.design(first), y = pool.design(second);
  switch (crossover.kind) {
    case Crossover::Kind::differential:
      return differential_crossover(pool, first, stream, child);
    case Crossover::Kind::sbx:
      return simulated_binary_crossover(crossover.eta, x, y, stream, child);
    case Crossover::Kind::blend:
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = x[i] + (2 * stream.u01() - 0.5) * (y[i] - x[i]);
      return;
    case Crossover::Kind::scattered:
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = stream.chance(0.5) ? x[i] : y[i];
      return;
  }
}

double mutate(const Mutation& mutation, const Variable& variable, double value, Stream& stream) {
  constexpr double kLog10000 = 9.210340371976182736;
  const double range = variable.upper - variable.lower;
  switch (mutation.kind) {
    case Mutation::Kind::multiscale: {
      const double sigma = mutation.sigma * portable::exp(-kLog10000 * stream.u01());
      return value + sigma * stream.normal() * range;
    }
    case Mutation::Kind::gaussian:
      return value + mutation.sigma * stream.normal() * range;
    case Mutation::Kind::polynomial:
      return value + polynomial_step(mutation.eta, stream.u01()) * range;
    case Mutation::Kind::uniform:
      break;
  }
  return variable.lower + stream.u01() * range;
}

}  // namespace pkm
