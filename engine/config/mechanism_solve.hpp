// Reads the tables [[solve]]: unknowns that are defined by equations.
//
// The equations of a file may use its frames and formulas, which may use the unknowns. The definitions of the file are
// therefore read twice: first into a draft of their own, in which the unknowns are inputs of the graph, to find the
// equations; then into the draft of the mechanism, in which the unknowns are solutions of these equations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/config/mechanism_draft.hpp"

namespace pkm {

class SolvedSystems {
 public:
  explicit SolvedSystems(const ConfigValue& root);

  bool empty() const { return systems_.empty(); }
  /// The draft in which the unknowns are inputs.
  MechanismDraft& draft() { return *draft_; }
  /// Defines the unknowns as inputs of draft().
  void use_inputs();
  /// Reads the equations and the start values of all systems, after the definitions have been read into draft().
  void read_equations();
  /// Defines the unknowns of the mechanism as solutions of the equations.
  void use_solutions(MechanismDraft& mechanism);
  /// Adds a constraint for each system of equations: that the system has a solution.
  void add_margins(MechanismDraft& mechanism);

 private:
  struct System {
    ConfigValue table;
    std::vector<std::string> unknowns;
    std::vector<ConfigValue> at;                     ///< the names of the unknowns in the file
    std::vector<expression::Node> equations, start;  ///< left sides and start values, as nodes of draft()
    std::vector<expression::Node> solution = {};  ///< nodes of the mechanism: status of the solution, then the unknowns
    bool is_being_solved = false;
  };

  void read_equations(System& system);
  void read_start(System& system);
  /// The solution of a system as nodes of the mechanism. Refuses a system that depends on itself through another one.
  const std::vector<expression::Node>& solve(System& system, MechanismDraft& mechanism);
  /// Copies nodes of draft() to the mechanism, with the solutions of other systems in place of their unknowns.
  std::vector<expression::Node> copied(const std::vector<expression::Node>& nodes, MechanismDraft& mechanism);
  /// The system and the index of the unknown that an input of draft() stands for; {null, 0} for other inputs.
  std::pair<System*, std::size_t> unknown_of(const expression::Entry& entry);

  std::vector<System> systems_;
  std::unique_ptr<MechanismDraft> draft_;
};

/// An unknown of equations for solve_equations(): an input of the mechanism's graph without a value. Systems may share
/// their unknowns.
limbs::Term unknown_of_equations(std::size_t index, MechanismDraft& draft);
/// Solves as many equations, nodes of the mechanism's graph that vanish, as there are unknowns, by Newton's method.
/// @param start  by unknown: where Newton's method starts
/// @return nodes of the mechanism's graph: the status, then the unknowns (Graph::solve())
std::vector<expression::Node> solve_equations(const std::vector<expression::Node>& equations,
                                              const std::vector<expression::Node>& start, MechanismDraft& draft);

/// Adds the unknowns of [[solve]] that are not coordinates to the names that formulas may use.
void add_unknowns(MechanismDraft& draft);

}  // namespace pkm
