#include "engine/problem/tolerance_analysis.hpp"

#include <cmath>
#include <numeric>

namespace pkm {

std::vector<QuantityGradient> quantity_gradients(const DesignProblem& problem, const DesignReport& report) {
  std::vector<std::size_t> all(report.parameters.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> values = problem.derivatives(report.parameters, all);
  const std::size_t width = all.size() + 1;  // length of a row: the value, then its derivatives
  std::vector<QuantityGradient> gradients;
  const auto add = [&](const std::string& name, const std::string& unit, double value, bool maximise) {
    const auto by = std::span(values).subspan(gradients.size() * width + 1, all.size());
    gradients.push_back({name, unit, value, maximise ? -1.0 : 1.0, {by.begin(), by.end()}});
  };
  for (std::size_t k = 0; k < report.objectives.size(); ++k) {
    const ObjectiveInfo& o = problem.objectives()[k];
    add(o.name, o.unit, report.objectives[k], o.direction == Direction::maximise);
  }
  for (std::size_t k = 0; k < report.margins.size(); ++k) {
    const MarginInfo& m = problem.margins()[k];
    add(m.name + " margin", m.unit, report.margins[k], true);
  }
  return gradients;
}

WorstCase worst_case(const DesignProblem& problem, const DesignReport& report,
                     const std::vector<QuantityGradient>& gradients, std::size_t k, std::span<const double> tolerance) {
  const QuantityGradient& g = gradients[k];
  std::vector<double> corner = report.parameters;
  double change = 0, squares = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const double contribution = std::fabs(g.by[i]) * tolerance[i];
    change += contribution;
    squares += contribution * contribution;
    if (g.by[i] != 0) corner[i] += std::copysign(tolerance[i], g.worse_sign * g.by[i]);
  }
  const DesignReport at_corner = problem.report(corner);
  const bool is_objective = k < report.objectives.size();
  const double evaluated = at_corner.status == Status::failed ? std::nan("")
                           : is_objective                     ? at_corner.objectives[k]
                                                              : at_corner.margins[k - report.objectives.size()];
  return {g.value + g.worse_sign * change, std::sqrt(squares), evaluated};
}

}  // namespace pkm
