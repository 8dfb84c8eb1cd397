#include "engine/optimisers/evolutionary/selection.hpp"

#include <algorithm>
#include <utility>

namespace pkm {
namespace {

// One turn of a wheel with as many equally spaced pointers as parents are wanted: the number of times a member is
// drawn differs from its expectation by less than one. Shuffled afterwards, so that neighbours are not mates.
void sample_universally(double pressure, std::size_t population, Stream& stream, std::span<std::uint32_t> parents) {
  const double n = static_cast<double>(population), count = static_cast<double>(parents.size());
  const double offset = stream.u01();
  double reached = 0;  // expected number of draws of the members up to `next`
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

}  // namespace

void select_parents(const Selection& selection, std::size_t population, Stream& stream,
                    std::span<std::uint32_t> parents) {
  if (selection.kind == Selection::Kind::linear_ranking) {
    sample_universally(selection.pressure, population, stream, parents);
    return;
  }
  for (std::uint32_t& parent : parents) {
    std::size_t best = stream.below(population);
    for (std::int64_t i = 1; i < selection.tournament_size; ++i) best = std::min(best, stream.below(population));
    parent = static_cast<std::uint32_t>(best);
  }
}

}  // namespace pkm
