#include "engine/results/design_values.hpp"

#include <cmath>

namespace pkm {

std::string choice_name(const ProblemRecord& problem, std::size_t variable, double value) {
  if (!problem.choices) return "";
  double number = 0;
  for (const ChoiceName& choice : *problem.choices)
    if (choice.variable == static_cast<std::int64_t>(variable) && ++number == std::round(value)) return choice.name;
  return "";
}

}  // namespace pkm
