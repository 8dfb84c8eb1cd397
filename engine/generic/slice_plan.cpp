#include "engine/generic/slice_plan.hpp"

#include <algorithm>

#include "engine/expression/derivative.hpp"
#include "engine/expression/polynomial_form.hpp"
#include "engine/generic/constraints.hpp"

namespace pkm::generic {
namespace {

using NodeSurface = std::array<Node, 6>;
using NodeClause = std::vector<NodeSurface>;

/// kPlace[i][j]: index of the coefficient of z^i v^j in Surface::coefficients of a conic; 6 if conics have no such
/// term.
constexpr std::size_t kPlace[3][3] = {{0, 1, 3}, {2, 4, 6}, {5, 6, 6}};

/// Converts constraints to clauses (disjunctions) of surfaces: of conics in v and z or, if slices are lines, of
/// functions of z.
class SurfaceConverter {
 public:
  /// @param nonnegative  by input of the graph, true: the input is >= 0
  SurfaceConverter(Graph& graph, Groups v, Groups z, std::vector<bool> nonnegative)
      : graph_(graph), v_(v), z_(z), nonnegative_(std::move(nonnegative)) {}

  std::optional<std::vector<NodeClause>> conditions(Node node) {
    if (v_ == 0) return polynomials(node);
    for (const bool z_first : {true, false})
      if (auto clauses = lowered_by(node, z_first)) return clauses;
    return {};
  }
  /// Converts a constraint to a clause that consists of a single surface.
  std::optional<NodeSurface> surface(Node node) {
    const auto found = conditions(node);
    if (!found || found->size() != 1 || found->front().size() != 1) return {};
    return found->front().front();
  }

 private:
  std::optional<std::vector<NodeClause>> polynomials(Node node) {
    const auto lower = polynomial_clauses(graph_, node, z_, 4, true, nonnegative_);
    if (!lower) return {};
    std::vector<NodeClause> clauses;
    for (const expression::Clause& clause : *lower) {
      NodeClause& to = clauses.emplace_back();
      for (const expression::Polynomial& p : clause) {
        to.emplace_back().fill(graph_.number(0));
        std::ranges::copy(p.c, to.back().begin());
      }
    }
    return clauses;
  }
  std::optional<std::vector<NodeClause>> lowered_by(Node node, bool z_first) {
    const auto lower = polynomial_clauses(graph_, node, z_first ? z_ : v_, 2, true, nonnegative_);
    if (!lower) return {};
    std::vector<NodeClause> clauses;
    for (const expression::Clause& clause : *lower) {
      NodeClause& to = clauses.emplace_back();
      for (const expression::Polynomial& q : clause) {
        NodeSurface& conic = to.emplace_back();
        conic.fill(graph_.number(0));
        for (std::size_t i = 0; i < 3; ++i) {
          const auto part = polynomial(graph_, q.c[i], z_first ? v_ : z_);
          if (!part || part->size() > 3 - i) return {};
          for (std::size_t j = 0; j < part->size(); ++j) conic[z_first ? kPlace[i][j] : kPlace[j][i]] = (*part)[j];
        }
      }
    }
    return clauses;
  }

  Graph& graph_;
  Groups v_, z_;
  std::vector<bool> nonnegative_;
};

/// By parameter: whether no permitted value is negative.
std::vector<bool> nonnegative_parameters(const Model& model) {
  std::vector<bool> all;
  for (const Parameter& each : model.info.parameters) all.push_back(each.lower >= 0);
  return all;
}

/// Whether all operations that a node depends on are defined at every point that satisfies the constraints on their
/// domains.
bool is_defined_in_domains(const Graph& graph, Node node) {
  static const std::vector<std::string> known = {"sin", "cos", "asin", "acos", "atan", "atan2", "turn", "log", "exp"};
  return std::ranges::all_of(graph.reachable({&node, 1}), [&](Node each) {
    const expression::Operation* const operation = graph[each].operation;
    return !operation || operation->code != expression::Code::other ||
           std::ranges::find(known, operation->name) != known.end();
  });
}

class Planner {
 public:
  Planner(const Evaluation& evaluation, std::size_t mode, const CoordinateOrder& order, bool curves,
          const CoordinateRanges& box)
      : model_(evaluation.model),
        known_(constraints_of(model_, mode)),
        graph_(known_.graph),
        v_(order.v ? Inputs::coordinate_group(*order.v) : 0),
        z_(Inputs::coordinate_group(order.z)),
        converter_(graph_, v_, z_, nonnegative_parameters(model_)),
        transcendental_(curves) {
    plan_.order = order;
    convert_cranks();
    for (std::size_t i = 0; i < known_.all.size() && plan_.why_not.empty(); ++i)
      if (!covered_[i]) add_condition(i);
    for (const std::size_t coordinate : order.outer) ends_.push_back(ends_of(coordinate, box));
    ends_.push_back(order.v ? ends_of(*order.v, box) : std::array{graph_.number(0), graph_.number(1)});
    ends_.push_back(ends_of(order.z, box));
    add_box_of_z();
  }

  SlicePlan finish() {
    if (surface_nodes_.size() > kMaxSurfaces)
      plan_.why_not = "its slices have more than " + std::to_string(kMaxSurfaces) + " surfaces";
    if (!plan_.why_not.empty()) return std::move(plan_);
    std::erase_if(plan_.formula.any, [&](Signs one_of) { return (one_of & plan_.formula.all) != 0; });
    std::vector<Groups> groups{~Groups{0}};
    for (const std::size_t coordinate : plan_.order.outer) groups.push_back(Inputs::coordinate_group(coordinate));
    groups.push_back(v_);
    for (std::size_t i = 1; i < groups.size(); ++i) groups[0] &= ~groups[i];
    groups[0] &= ~z_;
    if (plan_.order.v) plan_.limits = expression::Program(graph_, limits(), groups);
    if (!curve_nodes_.empty()) groups.push_back(z_);
    std::vector<Node> outputs = plain_;
    for (const NodeSurface& each : surface_nodes_) outputs.insert(outputs.end(), each.begin(), each.end());
    outputs.insert(outputs.end(), half_turns_.begin(), half_turns_.end());
    for (const auto& ends : ends_) outputs.insert(outputs.end(), ends.begin(), ends.end());
    plan_.program = expression::Program(graph_, outputs, groups);

    const std::uint32_t* at = plan_.program.outputs().data();
    plan_.independent.resize(plan_.order.outer.size() + 2);
    for (std::size_t i = 0; i < plain_.size(); ++i, ++at)
      plan_.independent[static_cast<std::size_t>(std::max(plan_.program.stage_of()[*at], 0))].push_back(*at);
    const auto is_zero = [&](Node node) { return graph_[node].is_number() && graph_[node].number == 0; };
    for (const NodeSurface& conic : surface_nodes_) {
      Surface& surface = plan_.surfaces.emplace_back();
      std::copy_n(at, 6, surface.coefficients.begin());
      surface.has_z = !is_zero(conic[2]) || !is_zero(conic[4]) || !is_zero(conic[5]);
      surface.is_transcendental = std::ranges::find(curve_nodes_, conic[0]) != curve_nodes_.end();
      surface.is_high_degree = v_ == 0 && !surface.is_transcendental && (!is_zero(conic[3]) || !is_zero(conic[4]));
      at += 6;
    }
    for (CrankSigns& crank : plan_.formula.cranks) crank.half_turn = *at++;
    for (std::size_t i = 0; i < ends_.size(); ++i, at += 2) plan_.range.push_back({at[0], at[1]});
    if (plan_.independent.size() > 1) plan_.univariate = expression::Program(graph_, univariate(), groups);
    return std::move(plan_);
  }

 private:
  void refuse(const std::string& what) {
    if (plan_.why_not.empty()) plan_.why_not = what;
  }

  /// Replaces the constraints of cranks and rods by quadratic surfaces where possible: the annulus that they reach, and
  /// the range of the crank angle.
  void convert_cranks() {
    covered_.assign(known_.all.size(), false);
    std::vector<std::optional<Signs>> reaches(known_.crank_ranges.size());
    for (const AnnulusNodes& annulus : known_.annuli) {
      const auto outer = bits_of({annulus.surfaces[0], annulus.surfaces[1]});
      if (!outer) continue;
      const Signs all = (*outer)[0] | (*outer)[1];
      plan_.formula.all |= all;
      if (annulus.crank_range) reaches[*annulus.crank_range] = all;
      cover(annulus.constraints);
    }
    for (std::size_t i = 0; i < known_.crank_ranges.size(); ++i) {
      const CrankRangeNodes& crank = known_.crank_ranges[i];
      const auto found = bits_of({crank.at_min, crank.at_max, crank.after_min, crank.before_max});
      if (!reaches[i])
        if (const auto reach = bits_of({crank.reach})) reaches[i] = reach->front();
      if (!found || !reaches[i] || (graph_[crank.half_turn].groups & ~Inputs::kDesign) != 0 ||
          !graph_[crank.branch].is_number())
        continue;
      plan_.formula.cranks.push_back(
          {(*found)[0], (*found)[1], (*found)[2], (*found)[3], *reaches[i], 0, graph_[crank.branch].number < 0});
      half_turns_.push_back(crank.half_turn);
      cover(crank.constraints);
    }
  }
  void cover(const std::vector<Node>& conditions) {
    for (std::size_t i = 0; i < known_.all.size(); ++i)
      covered_[i] = covered_[i] || std::ranges::find(conditions, known_.all[i]) != conditions.end();
  }
  /// Converts each of the given nodes to a surface.
  /// @return for each node, the set of its surface; std::nullopt if one of them cannot be converted
  std::optional<std::vector<Signs>> bits_of(std::initializer_list<Node> surfaces) {
    std::vector<NodeSurface> found;
    for (const Node surface : surfaces) {
      const auto one = converter_.surface(surface);
      if (!one) return {};
      found.push_back(*one);
    }
    std::vector<Signs> bits;
    for (const NodeSurface& conic : found) bits.push_back(bit(conic));
    return bits;
  }

  void add_condition(std::size_t number) {
    const Node node = known_.all[number];
    if ((graph_[node].groups & (v_ | z_)) == 0) {
      plain_.push_back(node);
      return;
    }
    if (auto clauses = converter_.conditions(node)) {
      for (const NodeClause& clause : *clauses) add_clause(clause);
      for (const Node finite : finiteness_constraints(graph_, node, v_ | z_))
        if (std::ranges::find(plain_, finite) == plain_.end()) plain_.push_back(finite);
      return;
    }
    const bool is_joint = number >= model_.domains.size() + model_.margins.size();
    if (is_joint && is_defined_in_domains(graph_, node)) return;
    if ((graph_[node].groups & z_) == 0)
      plain_.push_back(node);
    else if (transcendental_)
      add_curve(node);
    else
      refuse("'" + constraint_name(model_, number) + "' is not a polynomial of degree " +
             (v_ == 0 ? "four or less" : "two or less"));
  }

  void add_curve(Node node) {
    const Node z = graph_.input(model_.inputs.coordinate(plan_.order.z), z_);
    NodeSurface curve;
    curve.fill(graph_.number(0));
    curve[0] = node;
    curve[1] = expression::derivative(graph_, node, z);
    curve_nodes_.push_back(node);
    plan_.formula.all |= bit(curve);
  }

  /// The constraints that depend on no coordinate but the first one: nodes of each constraint and of its derivative
  /// with respect to this coordinate.
  std::vector<Node> univariate() {
    const std::size_t coordinate = plan_.order.outer.empty() ? plan_.order.v.value_or(0) : plan_.order.outer.front();
    const Node by = graph_.input(model_.inputs.coordinate(coordinate), Inputs::coordinate_group(coordinate));
    std::vector<Node> all;
    for (std::size_t i = 0; i < plain_.size(); ++i)
      if (plan_.program.stage_of()[plan_.program.outputs()[i]] == 1)
        all.insert(all.end(), {plain_[i], expression::derivative(graph_, plain_[i], by)});
    if (all.size() > 2 * kMaxSurfaces)
      refuse("more than " + std::to_string(kMaxSurfaces) + " constraints depend on a single coordinate");
    return all;
  }

  /// The constraints that depend on v but not on z: nodes of each constraint and of its first and second derivative
  /// with respect to v.
  std::vector<Node> limits() {
    const Node v = graph_.input(model_.inputs.coordinate(*plan_.order.v), v_);
    std::vector<Node> all;
    for (const Node limit : plain_) {
      if ((graph_[limit].groups & v_) == 0) continue;
      const Node slope = expression::derivative(graph_, limit, v);
      all.insert(all.end(), {limit, slope, expression::derivative(graph_, slope, v)});
    }
    return all;
  }

  void add_clause(const NodeClause& clause) {
    const auto changes = [&](const NodeSurface& conic) {
      return std::any_of(conic.begin() + 1, conic.end(),
                         [&](Node c) { return !graph_[c].is_number() || graph_[c].number != 0; });
    };
    if (clause.size() == 1 && !changes(clause.front())) {
      const expression::Entry& constant = graph_[clause.front()[0]];
      if (!constant.is_number() || !(constant.number >= 0)) plain_.push_back(clause.front()[0]);
      return;
    }
    Signs bits = 0;
    for (const NodeSurface& conic : clause) bits |= bit(conic);
    if (clause.size() == 1)
      plan_.formula.all |= bits;
    else if (std::ranges::find(plan_.formula.any, bits) == plan_.formula.any.end())
      plan_.formula.any.push_back(bits);
  }

  /// Adds the constraints z >= lower bound and z <= upper bound as surfaces.
  void add_box_of_z() {
    const limbs::Term from(graph_, ends_.back()[0]), to(graph_, ends_.back()[1]);
    const std::size_t place_of_z = v_ == 0 ? 1 : kPlace[1][0];
    NodeSurface below{}, above{};
    below.fill(graph_.number(0));
    above = below;
    below[0] = (-from).node();
    below[place_of_z] = graph_.number(1);
    above[0] = to.node();
    above[place_of_z] = graph_.number(-1);
    plan_.formula.all |= bit(below) | bit(above);
  }

  Signs bit(const NodeSurface& conic) {
    auto at = std::ranges::find(surface_nodes_, conic);
    if (at == surface_nodes_.end()) at = surface_nodes_.insert(at, conic);
    const auto number = static_cast<std::size_t>(at - surface_nodes_.begin());
    return Signs{1} << (number % kMaxSurfaces);
  }

  std::array<Node, 2> ends_of(std::size_t coordinate, const CoordinateRanges& box) {
    if (box[coordinate]) return {graph_.number((*box[coordinate])[0]), graph_.number((*box[coordinate])[1])};
    if (known_.box[coordinate]) return *known_.box[coordinate];
    refuse("it has no [survey] box for " + model_.info.coordinates[coordinate].name);
    return {graph_.number(0), graph_.number(0)};
  }

  const Model& model_;
  PoseConstraints known_;
  Graph& graph_;
  Groups v_, z_;
  SurfaceConverter converter_;
  bool transcendental_;
  SlicePlan plan_;
  std::vector<bool> covered_;
  std::vector<Node> plain_, half_turns_, curve_nodes_;
  std::vector<NodeSurface> surface_nodes_;
  std::vector<std::array<Node, 2>> ends_;
};

}  // namespace

SlicePlan plan_slices(const Evaluation& evaluation, std::size_t mode, const CoordinateOrder& order, bool curves,
                      const CoordinateRanges& box) {
  return Planner(evaluation, mode, order, curves, box).finish();
}

}  // namespace pkm::generic
