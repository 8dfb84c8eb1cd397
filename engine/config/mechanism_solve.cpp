#include "engine/config/mechanism_solve.hpp"

#include <algorithm>

#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/expression/implicit_system.hpp"

namespace pkm {
namespace {

using expression::Entry, expression::Graph, expression::ImplicitSystem, expression::Node;
using generic::Inputs;

// Index of the first unknown among the inputs of the graph in which the equations are read; all other inputs have
// smaller indices.
constexpr std::size_t kFirstUnknown = 1'000'000;
// Unknowns count as inputs that depend on all coordinates; formulas that may depend on parameters only therefore refuse
// them.
constexpr expression::Groups kUnknownGroups = Inputs::kRates - Inputs::coordinate_group(0);

constexpr const char* kNames = "a list of 1 to 6 names: [\"x\", \"y\"]";

std::string quoted(const std::string& name) { return "'" + name + "'"; }

std::string count_of(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// The unit of an unknown: that of the coordinate of this name, otherwise that of the unknown's start value.
std::string unit_of_unknown(const std::string& name, const ConfigValue& start, const MechanismDraft& draft) {
  if (const PlatformMotion* const motion = find_named(draft.motions, name)) return motion->unit();
  if (start.is_text())
    for (const char* const unit : {"m", "rad"})
      if (!parse_quantity(start.text("a number or a formula"), "1") &&
          parse_quantity(start.text("a number or a formula"), unit))
        return unit;
  return "1";
}

/// A system of equations, and the nodes of the graph that are its coefficients.
struct ExtractedSystem {
  std::shared_ptr<const ImplicitSystem> system;
  std::vector<Node> coefficients;
};

/// Makes a system of as many equations, nodes of a graph, as there are unknowns. Subexpressions without unknowns become
/// its coefficients.
/// @param unknown  unknown(entry): index of the unknown that an input of the graph stands for; std::nullopt: none
template <class Unknown>
ExtractedSystem system_of(const Graph& graph, const std::vector<Node>& equations, const Unknown& unknown) {
  const std::size_t n = equations.size();
  Graph made;
  std::vector<Node> coefficients, operands, copies(graph.size());
  std::vector<bool> depends(graph.size());
  for (std::size_t i = 0; i < n; ++i) made.input(i, 2);
  const auto copy_of = [&](Node node) {
    const auto index = static_cast<std::size_t>(node);
    if (!depends[index] && copies[index] == Node{}) {
      copies[index] = made.input(n + coefficients.size(), 1);
      coefficients.push_back(node);
    }
    return copies[index];
  };
  for (const Node node : graph.reachable(equations)) {
    const Entry& entry = graph[node];
    const auto index = static_cast<std::size_t>(node);
    const std::optional<std::size_t> i = unknown(entry);
    if (i) copies[index] = made.input(*i, 2);
    depends[index] = i || std::ranges::any_of(entry.operands(),
                                              [&](Node operand) { return depends[static_cast<std::size_t>(operand)]; });
    if (!depends[index] || i) continue;
    operands.clear();
    for (const Node operand : entry.operands()) operands.push_back(copy_of(operand));
    copies[index] = made.apply_like(entry, operands);
  }
  std::vector<Node> left_sides;
  for (const Node equation : equations) left_sides.push_back(copies[static_cast<std::size_t>(equation)]);
  return {std::make_shared<const ImplicitSystem>(std::move(made), std::move(left_sides), coefficients.size()),
          coefficients};
}

}  // namespace

limbs::Term unknown_of_equations(std::size_t index, MechanismDraft& draft) {
  return draft.model.term(draft.model.graph.input(kFirstUnknown + index, kUnknownGroups));
}

std::vector<Node> solve_equations(const std::vector<Node>& equations, const std::vector<Node>& start,
                                  MechanismDraft& draft) {
  auto [system, operands] =
      system_of(draft.model.graph, equations, [](const Entry& entry) -> std::optional<std::size_t> {
        if (entry.input < static_cast<std::int32_t>(kFirstUnknown)) return {};
        return static_cast<std::size_t>(entry.input) - kFirstUnknown;
      });
  operands.insert(operands.end(), start.begin(), start.end());
  return draft.model.graph.solve(std::move(system), std::move(operands));
}

SolvedSystems::SolvedSystems(const ConfigValue& root) {
  std::vector<std::string> known;
  for (const ConfigValue& table : root.tables("solve")) {
    System system{.table = table, .unknowns = {}, .at = {}, .equations = {}, .start = {}};
    const ConfigValue list = table.at("unknowns");
    for (const ConfigValue& each : list.elements(kNames)) {
      const std::string& name = each.text("the name of an unknown");
      if (contains(known, name)) throw each.refusal(quoted(name) + " is an unknown already");
      known.push_back(name);
      system.unknowns.push_back(name);
      system.at.push_back(each);
    }
    if (system.unknowns.empty() || system.unknowns.size() > ImplicitSystem::kMaxUnknowns) throw list.error(kNames);
    systems_.push_back(std::move(system));
  }
}

void SolvedSystems::use_inputs() {
  draft_ = std::make_unique<MechanismDraft>();
  std::size_t position = kFirstUnknown;
  for (const System& system : systems_)
    for (std::size_t i = 0; i < system.unknowns.size(); ++i, ++position)
      draft_->unknowns.push_back({system.at[i], system.unknowns[i], [this, position] {
                                    return draft_->model.term(draft_->model.graph.input(position, kUnknownGroups));
                                  }});
}

void SolvedSystems::use_solutions(MechanismDraft& mechanism) {
  for (System& system : systems_)
    for (std::size_t i = 0; i < system.unknowns.size(); ++i)
      mechanism.unknowns.push_back({system.at[i], system.unknowns[i], [this, &system, &mechanism, i] {
                                      return mechanism.model.term(solve(system, mechanism)[i + 1]);
                                    }});
}

void SolvedSystems::read_equations() {
  for (System& system : systems_) {
    read_equations(system);
    read_start(system);
  }
}

void SolvedSystems::read_equations(System& system) {
  const Graph& graph = draft_->model.graph;
  const ConfigValue list = system.table.at("equations");
  std::vector<bool> occurs(system.unknowns.size());
  for (const ConfigValue& each : list.elements("a list of formulas, one per unknown")) {
    const MechanismScope::Value value = draft_->scope.formula_of_any_kind(each, "1", "an equation");
    const std::vector<limbs::Term> terms = expression::elements(value);
    if (terms.size() > 3)
      throw each.error_of(expression::kind_of(value) + ", the value of this formula", "a scalar or a vector");
    for (std::size_t k = 0; k < terms.size(); ++k) {
      bool depends = false;
      const Node node = terms[k].node();
      for (const Node operand : graph.reachable({&node, 1}))
        if (const auto [of, i] = unknown_of(graph[operand]); of == &system) occurs[i] = depends = true;
      if (!depends)
        throw each.refusal(
            (terms.size() > 1 ? "component " + std::string(1, "xyz"[k]) + " of the equation" : "the equation") +
            " contains none of the unknowns " + join(system.unknowns));
      system.equations.push_back(node);
    }
  }
  if (system.equations.size() != system.unknowns.size())
    throw list.error_of(count_of(system.equations.size(), "equation"),
                        "as many as there are unknowns, " + std::to_string(system.unknowns.size()) + " (" +
                            join(system.unknowns) + "); a vector counts as three");
  for (std::size_t i = 0; i < occurs.size(); ++i)
    if (!occurs[i]) throw system.at[i].refusal("the unknown " + quoted(system.unknowns[i]) + " appears in no equation");
}

void SolvedSystems::read_start(System& system) {
  const Graph& graph = draft_->model.graph;
  const ConfigValue list = system.table.at("start");
  const std::string expected = "a number or formula for each of the " + count_of(system.unknowns.size(), "unknown") +
                               " (" + join(system.unknowns) + ")";
  const auto elements = list.elements(expected);
  if (elements.size() != system.unknowns.size()) throw list.error(expected);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string& name = system.unknowns[i];
    const Node node =
        draft_->scope.formula(elements[i], unit_of_unknown(name, elements[i], *draft_), "the start of " + name).node();
    for (const Node operand : graph.reachable({&node, 1}))
      if (const auto [of, index] = unknown_of(graph[operand]); of == &system)
        throw elements[i].refusal("the start of " + quoted(name) + " depends on the unknown " +
                                  quoted(of->unknowns[index]));
    system.start.push_back(node);
  }
}

std::pair<SolvedSystems::System*, std::size_t> SolvedSystems::unknown_of(const Entry& entry) {
  if (entry.input < static_cast<std::int32_t>(kFirstUnknown)) return {nullptr, 0};
  std::size_t i = static_cast<std::size_t>(entry.input) - kFirstUnknown;
  auto system = systems_.begin();
  for (; i >= system->unknowns.size(); ++system) i -= system->unknowns.size();
  return {&*system, i};
}

std::vector<Node> SolvedSystems::copied(const std::vector<Node>& nodes, MechanismDraft& mechanism) {
  const Graph& from = draft_->model.graph;
  Graph& to = mechanism.model.graph;
  std::vector<Node> copies(from.size()), operands, made;
  for (const Node node : from.reachable(nodes)) {
    const Entry& entry = from[node];
    Node& copy = copies[static_cast<std::size_t>(node)];
    operands.clear();
    for (const Node operand : entry.operands()) operands.push_back(copies[static_cast<std::size_t>(operand)]);
    if (const auto [system, i] = unknown_of(entry); system)
      copy = solve(*system, mechanism)[i + 1];
    else if (entry.operation)
      copy = to.apply_like(entry, operands);
    else
      copy =
          entry.is_number() ? to.number(entry.number) : to.input(static_cast<std::size_t>(entry.input), entry.groups);
  }
  for (const Node node : nodes) made.push_back(copies[static_cast<std::size_t>(node)]);
  return made;
}

const std::vector<Node>& SolvedSystems::solve(System& system, MechanismDraft& mechanism) {
  if (!system.solution.empty()) return system.solution;
  if (system.is_being_solved)
    throw system.table.refusal(
        "the equations of " + join(system.unknowns) +
        " depend on those of another [[solve]] that depend on them; write them as one [[solve]]");
  system.is_being_solved = true;
  auto [solver, coefficients] =
      system_of(draft_->model.graph, system.equations, [&](const Entry& entry) -> std::optional<std::size_t> {
        const auto [of, i] = unknown_of(entry);
        if (of != &system) return {};
        return i;
      });
  coefficients.insert(coefficients.end(), system.start.begin(), system.start.end());
  system.solution = mechanism.model.graph.solve(std::move(solver), copied(coefficients, mechanism));
  return system.solution;
}

void SolvedSystems::add_margins(MechanismDraft& mechanism) {
  for (System& system : systems_) {
    const std::string names = join(system.unknowns);
    mechanism.model.domains.push_back(
        {names + " solved", "1", solve(system, mechanism).front(),
         "the equations of " + names +
             " are not solved: Newton's method does not converge from the start, or leaves the branch of the start"});
  }
}

void add_unknowns(MechanismDraft& draft) {
  for (const SolvedUnknown& unknown : draft.unknowns)
    if (!find_named(draft.motions, unknown.name)) draft.scope.add_deferred(unknown.at, unknown.name, unknown.value);
}

}  // namespace pkm
