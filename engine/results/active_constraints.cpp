#include "engine/results/active_constraints.hpp"

#include <algorithm>

#include "engine/core/formatted.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

std::vector<std::string> active_sentences(const ProblemRecord& problem, std::span<const double> design,
                                          std::span<const double> margins) {
  std::vector<std::string> sentences;
  const auto is_choice = [&](std::size_t variable) {
    return problem.choices && std::ranges::find(*problem.choices, static_cast<std::int64_t>(variable),
                                                &ChoiceName::variable) != problem.choices->end();
  };
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    if (is_choice(i)) continue;
    const Variable& v = problem.variables[i];
    const double value = design[i], tolerance = 1e-6 * (v.upper - v.lower);
    if (value - v.lower <= tolerance) sentences.push_back(v.name + " at its lower bound " + with_unit(v.lower, v.unit));
    if (v.upper - value <= tolerance) sentences.push_back(v.name + " at its upper bound " + with_unit(v.upper, v.unit));
  }
  for (std::size_t i = 0; i < margins.size(); ++i) {
    const MarginInfo& m = problem.margins[i];
    if (!(margins[i] <= 1e-4)) continue;
    sentences.push_back(m.name + (margins[i] < 0 ? " is violated" : " is active") + ", margin " +
                        formatted("%.3g", margins[i]) + (m.unit == "1" ? "" : " " + m.unit));
  }
  return sentences;
}

}  // namespace pkm
