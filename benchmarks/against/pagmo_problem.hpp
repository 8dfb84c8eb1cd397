// Adapter from pkm::Problem to a pagmo problem, without the constraints.
#pragma once

#include <utility>

#include <pagmo/types.hpp>

#include "engine/problem/problem.hpp"

namespace pkm::benchmarks {

struct PagmoProblem {
  const Problem* problem = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& design) const {
    pagmo::vector_double objectives(get_nobj());
    Status status = Status::failed;
    Scratch scratch;
    problem->evaluate(design, scratch, {objectives, {}, {}, status});
    return objectives;
  }
  pagmo::vector_double::size_type get_nobj() const { return problem->objectives().size(); }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    std::pair<pagmo::vector_double, pagmo::vector_double> bounds;
    for (const Variable& variable : problem->space().variables()) {
      bounds.first.push_back(variable.lower);
      bounds.second.push_back(variable.upper);
    }
    return bounds;
  }
};

}  // namespace pkm::benchmarks
