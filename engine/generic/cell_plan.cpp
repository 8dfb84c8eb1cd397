#include "engine/generic/cell_plan.hpp"

#include <algorithm>
#include <numeric>

#include "engine/expression/polynomial_form.hpp"
#include "engine/generic/constraints.hpp"

namespace pkm::generic {
namespace {

using expression::Program;

/// Four quadratics in the innermost coordinate that decide whether a crank angle is in its range: at_min, at_max,
/// after_min and before_max of limbs::CrankRange, in this order.
using Surfaces = std::array<expression::Polynomial, 4>;

/// The constraints in polynomial normal form along the coordinate of the innermost loop.
struct NormalisedConstraints {
  std::vector<Node> plain;  ///< constraints that have no normal form or do not depend on the innermost coordinate
  std::vector<expression::Clause> clauses;
  struct Crank {
    CrankRangeNodes range;
    Surfaces surfaces;
  };
  std::vector<Crank> cranks;

  /// All nodes that the program has to compute: constraints, then clauses, then cranks. For each polynomial of a clause
  /// or crank, these nodes are its coefficients c[0] to c[2].
  std::vector<Node> outputs() const {
    std::vector<Node> all = plain;
    const auto add = [&all](const expression::Polynomial& q) { all.insert(all.end(), q.c.begin(), q.c.begin() + 3); };
    for (const expression::Clause& clause : clauses) std::ranges::for_each(clause, add);
    for (const Crank& crank : cranks) {
      std::ranges::for_each(crank.surfaces, add);
      all.insert(all.end(), {crank.range.half_turn, crank.range.reach});
    }
    return all;
  }
};

Shape shape_of(const expression::Graph& graph, Node leading) {
  const expression::Entry& entry = graph[leading];
  if (!entry.is_number()) return Shape::any;
  return entry.number < 0 ? Shape::concave : entry.number > 0 ? Shape::convex : Shape::linear;
}

/// Removes clauses that are implied by others, merges clauses that differ in the constant coefficient only, and moves
/// those that do not depend on the innermost coordinate to `plain`.
void simplify(expression::Graph& graph, std::vector<expression::Clause>& clauses, std::vector<Node>& plain) {
  const Node zero = graph.number(0);
  std::vector<expression::Polynomial> single;
  for (const expression::Clause& clause : clauses)
    if (clause.size() == 1) single.push_back(clause.front());
  std::erase_if(clauses, [&](const expression::Clause& clause) {
    return clause.size() == 1 || std::ranges::any_of(clause, [&](const expression::Polynomial& q) {
             return std::ranges::find(single, q) != single.end();
           });
  });
  std::ranges::sort(clauses);
  clauses.erase(std::unique(clauses.begin(), clauses.end()), clauses.end());
  std::ranges::sort(single, {}, [](const expression::Polynomial& q) { return std::pair(q.c[1], q.c[2]); });
  for (std::size_t i = 0; i < single.size();) {
    expression::Polynomial all = single[i];
    for (++i; i < single.size() && single[i].c[1] == all.c[1] && single[i].c[2] == all.c[2]; ++i)
      if (single[i].c[0] != all.c[0])
        all.c[0] = graph.apply(expression::operation("min"), std::array{all.c[0], single[i].c[0]});
    if (all.c[1] == zero && all.c[2] == zero)
      plain.push_back(all.c[0]);
    else
      clauses.push_back({all});
  }
}

/// The quadratics in the innermost coordinate z that decide whether the angle of a crank is in its range; std::nullopt
/// if quadratics do not decide it.
std::optional<Surfaces> surfaces_of(expression::Graph& graph, const CrankRangeNodes& crank, Groups z) {
  if ((graph[crank.reach].groups & z) == 0 || (graph[crank.half_turn].groups & ~Inputs::kDesign) != 0 ||
      !graph[crank.branch].is_number())
    return {};
  Surfaces surfaces;
  for (std::size_t k = 0; const Node node : {crank.at_min, crank.at_max, crank.after_min, crank.before_max}) {
    const auto found = polynomial_clauses(graph, node, z);
    if (!found || found->size() != 1 || found->front().size() != 1) return {};
    surfaces[k++] = found->front().front();
  }
  return surfaces;
}

/// @param z  input group of the coordinate of the innermost loop
NormalisedConstraints normalised(PoseConstraints& known, Groups z) {
  NormalisedConstraints made;
  std::vector<Node> constraints = known.all;
  for (const CrankRangeNodes& range : known.crank_ranges) {
    const auto surfaces = surfaces_of(known.graph, range, z);
    if (!surfaces) continue;
    made.cranks.push_back({range, *surfaces});
    std::erase_if(constraints,
                  [&](Node node) { return std::ranges::find(range.constraints, node) != range.constraints.end(); });
  }
  for (const Node constraint : constraints) {
    const bool depends_on_z = (known.graph[constraint].groups & z) != 0;
    const auto clauses = depends_on_z ? polynomial_clauses(known.graph, constraint, z) : std::nullopt;
    if (!clauses) {
      made.plain.push_back(constraint);
      continue;
    }
    made.clauses.insert(made.clauses.end(), clauses->begin(), clauses->end());
    for (const Node finite : finiteness_constraints(known.graph, constraint, z))
      if (std::ranges::find(made.plain, finite) == made.plain.end()) made.plain.push_back(finite);
  }
  simplify(known.graph, made.clauses, made.plain);
  return made;
}

/// The input groups that become available in each stage of the program, by stage.
std::array<Groups, 4> groups_of(const std::vector<int>& swept, const std::vector<std::size_t>& order) {
  std::array<Groups, 4> groups{~Groups{0}, 0, 0, 0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    Groups& group = groups[kInner + 1 + i - order.size()];
    group = Inputs::coordinate_group(static_cast<std::size_t>(swept[order[i]]));
    groups[0] &= ~group;
  }
  return groups;
}

/// Merges a clause of two constraints, of which one does not depend on the innermost coordinate, into a single
/// ColumnConstraint, whose alternative is this constraint. Other clauses are returned unchanged.
/// @param all  the constraints of the clause, one per polynomial
CellPlan::Disjunction merge_constant(const expression::Clause& clause, CellPlan::Disjunction all, Node zero) {
  if (clause.size() != 2) return all;
  const auto constant =
      std::ranges::find_if(clause, [&](const expression::Polynomial& q) { return q.c[1] == zero && q.c[2] == zero; });
  if (constant == clause.end()) return all;
  const std::size_t i = constant == clause.begin() ? 0 : 1;
  ColumnConstraint merged = all[1 - i];
  merged.has_alternative = true;
  merged.alternative = all[i].c[0];
  return {merged};
}

/// Estimated time of executing steps of a program once, relative to the time of an addition.
double cost_of(const std::vector<Program::Step>& steps) {
  double sum = 0;
  for (const Program::Step& step : steps) {
    const expression::Code code = step.operation->code;
    sum += code == expression::Code::solve                                      ? 2000
           : code == expression::Code::other                                    ? 40
           : code == expression::Code::sqrt || code == expression::Code::divide ? 4
                                                                                : 1;
  }
  return sum;
}

}  // namespace

CellPlan::CellPlan(const Evaluation& evaluation, const std::vector<int>& swept, std::vector<std::size_t> axes,
                   std::size_t mode)
    : order(std::move(axes)) {
  PoseConstraints known = constraints_of(evaluation.model, mode);
  expression::Graph& graph = known.graph;
  const std::array<Groups, 4> groups = groups_of(swept, order);
  const NormalisedConstraints constraints = normalised(known, groups[kInner]);
  program = Program(graph, constraints.outputs(), groups);
  set_loops(constraints.plain.size());

  std::size_t output = constraints.plain.size();  // index of the program output that next() reads next
  const auto next = [&](const expression::Polynomial& q) {
    ColumnConstraint constraint{.shape = shape_of(graph, q.c[2])};
    for (expression::Operand& c : constraint.c) c = middle->operand(program.outputs()[output++]);
    return constraint;
  };
  const Node zero = graph.number(0);
  for (const expression::Clause& clause : constraints.clauses) {
    Disjunction all;
    for (const expression::Polynomial& q : clause) all.push_back(next(q));
    all = merge_constant(clause, all, zero);
    if (all.size() == 1)
      columns.push_back(all.front());
    else
      disjunctions.push_back(all);
  }
  std::ranges::stable_sort(columns, {}, &ColumnConstraint::shape);
  for (const auto& [range, surfaces] : constraints.cranks) {
    Crank& crank = cranks.emplace_back();
    ColumnConstraint* const ends[] = {&crank.at_min, &crank.at_max, &crank.after_min, &crank.before_max};
    for (std::size_t k = 0; k < surfaces.size(); ++k) *ends[k] = next(surfaces[k]);
    crank.half_turn = program.outputs()[output++];
    crank.reach = program.outputs()[output++];
    crank.is_first = graph[range.branch].number < 0;
  }
}

void CellPlan::set_loops(std::size_t count) {
  Registers retained_by_middle, retained_by_inner;
  for (std::size_t i = 0; i < program.outputs().size(); ++i) {
    const std::uint32_t at = program.outputs()[i];
    const int stage = program.stage_of()[at];
    if (i < count)
      (stage == kInner ? inner_constraints : stage == kMiddle ? middle_constraints : outer_constraints).push_back(at);
    if (stage == kMiddle) retained_by_middle.push_back(at);
    if (stage == kInner) retained_by_inner.push_back(at);
  }
  for (const auto& step : program.stages()[kInner].steps)
    for (const std::uint32_t operand : step.operands())
      if (program.stage_of()[operand] == kMiddle) passed_to_inner.push_back(operand);
  std::ranges::sort(passed_to_inner);
  passed_to_inner.erase(std::unique(passed_to_inner.begin(), passed_to_inner.end()), passed_to_inner.end());
  retained_by_middle.insert(retained_by_middle.end(), passed_to_inner.begin(), passed_to_inner.end());
  middle.emplace(program, kMiddle, retained_by_middle);
  inner.emplace(program, kInner, retained_by_inner);
}

double CellPlan::cost(const std::array<std::int64_t, 3>& cells) const {
  double iterations = 1, sum = 0;
  std::size_t stage = kInner + 1 - order.size();
  for (const std::size_t axis : order) {
    iterations *= static_cast<double>(cells[axis]);
    // The factor 4 accounts for the outer loop not being vectorised.
    sum += iterations * cost_of(program.stages()[stage].steps) * (stage == kOuter ? 4 : 1);
    if (stage == kMiddle)
      sum += iterations * 8 * static_cast<double>(columns.size() + 4 * disjunctions.size() + 8 * cranks.size());
    ++stage;
  }
  return sum;
}

CellPlan CellPlan::fastest(const Evaluation& evaluation, const std::vector<int>& swept,
                           const std::array<std::int64_t, 3>& cells, std::size_t mode) {
  std::vector<std::size_t> order(swept.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::optional<CellPlan> best;
  double min_cost = 0;
  do {
    CellPlan plan(evaluation, swept, order, mode);
    const double cost = plan.cost(cells);
    if (best && cost >= min_cost) continue;
    min_cost = cost;
    best.emplace(std::move(plan));
  } while (std::next_permutation(order.begin(), order.end()));
  return std::move(*best);
}

}  // namespace pkm::generic
