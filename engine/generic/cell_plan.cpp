#include "engine/generic/cell_plan.hpp"

#include <algorithm>
#include <numeric>

#include "engine/expression/polynomial_form.hpp"
#include "engine/generic/conditions.hpp"

namespace pkm::generic {
namespace {

using expression::Program;

using Surfaces = std::array<expression::Polynomial, 4>;  ///< of a crank's range, as CellPlan::Crank has them

/// What has to hold, taken apart along the coordinate of the innermost loop.
struct Parts {
  std::vector<Node> plain;                  ///< conditions that are tested as they are
  std::vector<expression::Clause> clauses;  ///< of polynomials
  struct Crank {
    CoveredRange range;
    Surfaces surfaces;
  };
  std::vector<Crank> cranks;

  /// Their nodes, in this order; of polynomials the coefficients.
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
  return entry.number < 0 ? Shape::concave : entry.number > 0 ? Shape::convex : Shape::line;
}

/// Leaves out clauses that others imply, makes one of those that differ in their constants alone, and moves those that
/// do not depend on z to `plain`.
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

/// The surfaces of a crank's range along z; none: they are no quadratics, or not along z.
std::optional<Surfaces> surfaces_of(expression::Graph& graph, const CoveredRange& crank, Groups z) {
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

/// @param z  the group of the innermost loop
Parts taken_apart(Conditions& known, Groups z) {
  Parts parts;
  std::vector<Node> conditions = known.all;
  for (const CoveredRange& range : known.cranks) {
    const auto surfaces = surfaces_of(known.graph, range, z);
    if (!surfaces) continue;
    parts.cranks.push_back({range, *surfaces});
    std::erase_if(conditions,
                  [&](Node node) { return std::ranges::find(range.conditions, node) != range.conditions.end(); });
  }
  for (const Node condition : conditions) {
    const bool along = (known.graph[condition].groups & z) != 0;
    const auto lower = along ? polynomial_clauses(known.graph, condition, z) : std::nullopt;
    if (!lower) {
      parts.plain.push_back(condition);
      continue;
    }
    parts.clauses.insert(parts.clauses.end(), lower->begin(), lower->end());
    for (const Node finite : finite_parts(known.graph, condition, z))
      if (std::ranges::find(parts.plain, finite) == parts.plain.end()) parts.plain.push_back(finite);
  }
  simplify(known.graph, parts.clauses, parts.plain);
  return parts;
}

/// The inputs that each stage brings.
std::array<Groups, 4> groups_of(const std::vector<int>& swept, const std::vector<std::size_t>& order) {
  std::array<Groups, 4> groups{~Groups{0}, 0, 0, 0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    Groups& group = groups[kInner + 1 + i - order.size()];
    group = Inputs::coordinate_group(static_cast<std::size_t>(swept[order[i]]));
    groups[0] &= ~group;
  }
  return groups;
}

/// Of two alternatives, one that is the same all along a column is said beside the other.
/// @param all  a condition for each of the clause's polynomials
CellPlan::Alternatives with_constant_aside(const expression::Clause& clause, CellPlan::Alternatives all, Node zero) {
  if (clause.size() != 2) return all;
  const auto constant =
      std::ranges::find_if(clause, [&](const expression::Polynomial& q) { return q.c[1] == zero && q.c[2] == zero; });
  if (constant == clause.end()) return all;
  ColumnCondition left = all[constant == clause.begin() ? 1 : 0];
  left.has_unless = true;
  left.unless = all[constant == clause.begin() ? 0 : 1].c[0];
  return {left};
}

/// What a step takes, in additions.
double cost_of(const std::vector<Program::Step>& steps) {
  double sum = 0;
  for (const Program::Step& step : steps) {
    const expression::Code code = step.operation->code;
    sum += code == expression::Code::other                                      ? 40
           : code == expression::Code::sqrt || code == expression::Code::divide ? 4
                                                                                : 1;
  }
  return sum;
}

}  // namespace

CellPlan::CellPlan(const Evaluation& evaluation, const std::vector<int>& swept, std::vector<std::size_t> axes,
                   std::size_t mode)
    : order(std::move(axes)) {
  Conditions known = conditions_of(evaluation.model, mode);
  expression::Graph& graph = known.graph;
  const std::array<Groups, 4> groups = groups_of(swept, order);
  const Parts parts = taken_apart(known, groups[kInner]);
  program = Program(graph, parts.outputs(), groups);
  set_loops(parts.plain.size());

  std::size_t output = parts.plain.size();  // of the program, to be read next
  const auto next = [&](const expression::Polynomial& q) {
    ColumnCondition condition{.shape = shape_of(graph, q.c[2])};
    for (expression::Operand& c : condition.c) c = middle->operand(program.outputs()[output++]);
    return condition;
  };
  const Node zero = graph.number(0);
  for (const expression::Clause& clause : parts.clauses) {
    Alternatives all;
    for (const expression::Polynomial& q : clause) all.push_back(next(q));
    all = with_constant_aside(clause, all, zero);
    if (all.size() == 1)
      columns.push_back(all.front());
    else
      alternatives.push_back(all);
  }
  std::ranges::stable_sort(columns, {}, &ColumnCondition::shape);
  for (const auto& [range, surfaces] : parts.cranks) {
    Crank& crank = cranks.emplace_back();
    ColumnCondition* const ends[] = {&crank.at_min, &crank.at_max, &crank.after_min, &crank.before_max};
    for (std::size_t k = 0; k < surfaces.size(); ++k) *ends[k] = next(surfaces[k]);
    crank.half_turn = program.outputs()[output++];
    crank.reach = program.outputs()[output++];
    crank.is_first = graph[range.branch].number < 0;
  }
}

void CellPlan::set_loops(std::size_t count) {
  std::vector<std::uint32_t> kept, tested;  // of the middle loop; of the inner one: conditions, and cranks' reaches
  for (std::size_t i = 0; i < program.outputs().size(); ++i) {
    const std::uint32_t at = program.outputs()[i];
    const int stage = program.stage_of()[at];
    if (i < count) (stage == kInner ? of_inner : stage == kMiddle ? of_middle : early).push_back(at);
    if (stage == kMiddle) kept.push_back(at);
    if (stage == kInner) tested.push_back(at);
  }
  for (const auto& step : program.stages()[kInner].steps)
    for (std::size_t i = 0; i < step.count; ++i)
      if (program.stage_of()[step.from[i]] == kMiddle) handed_down.push_back(step.from[i]);
  std::ranges::sort(handed_down);
  handed_down.erase(std::unique(handed_down.begin(), handed_down.end()), handed_down.end());
  kept.insert(kept.end(), handed_down.begin(), handed_down.end());
  middle.emplace(program, kMiddle, kept);
  inner.emplace(program, kInner, tested);
}

double CellPlan::cost(const std::array<std::int64_t, 3>& cells) const {
  double passes = 1, sum = 0;
  std::size_t stage = kInner + 1 - order.size();
  for (const std::size_t axis : order) {
    passes *= static_cast<double>(cells[axis]);
    sum += passes * cost_of(program.stages()[stage].steps) * (stage == kOuter ? 4 : 1);  // numbers are slower than rows
    if (stage == kMiddle)
      sum += passes * 8 * static_cast<double>(columns.size() + 4 * alternatives.size() + 8 * cranks.size());
    ++stage;
  }
  return sum;
}

CellPlan CellPlan::fastest(const Evaluation& evaluation, const std::vector<int>& swept,
                           const std::array<std::int64_t, 3>& cells, std::size_t mode) {
  std::vector<std::size_t> order(swept.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::optional<CellPlan> best;
  double least = 0;
  do {
    CellPlan plan(evaluation, swept, order, mode);
    const double cost = plan.cost(cells);
    if (best && cost >= least) continue;
    least = cost;
    best.emplace(std::move(plan));
  } while (std::next_permutation(order.begin(), order.end()));
  return std::move(*best);
}

}  // namespace pkm::generic
