// Scratch memory of the evaluations of a DesignProblem, and margins of constraints.
#pragma once

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// The margin of a constraint, from the value of its quantity and its bounds.
template <class S>
S margin_of(const NamedQuantity& named, const S& value) {
  if (named.lower_bound) return value - *named.lower_bound;
  if (named.upper_bound) return *named.upper_bound - value;
  return value;
}

struct DesignProblem::Buffers {
  std::vector<double> parameters;
  std::vector<Dual4> duals;  ///< the parameters of the design, with derivatives
  WorkspaceResults<double> workspaces;
  WorkspaceResults<Dual4> dual_workspaces;
  MachineValues machines;        ///< values of all machines built to the design that was evaluated last
  Yield yield;                   ///< yield of `machines`, if the problem has a yield
  std::vector<Scratch> workers;  ///< scratch memory for the machines, by worker
  std::vector<double> machine;   ///< parameters of the machine that is being evaluated
};

}  // namespace pkm
