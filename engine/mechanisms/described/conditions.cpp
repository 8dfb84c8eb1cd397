#include "engine/mechanisms/described/conditions.hpp"

namespace pkm::described {

Conditions conditions_of(const Model& model, std::size_t mode) {
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  std::vector<Node> nodes;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) nodes.push_back(result.node);
  nodes.insert(nodes.end(), model.defined.begin(), model.defined.end());
  const std::size_t own = nodes.size();
  for (const CoveredRange& crank : model.crank_ranges) {
    nodes.insert(nodes.end(), {crank.at_min, crank.at_max, crank.after_min, crank.before_max, crank.half_turn,
                               crank.reach, crank.branch});
    nodes.insert(nodes.end(), crank.conditions.begin(), crank.conditions.end());
  }
  for (const CoveredFolds& folds : model.folds) {
    nodes.insert(nodes.end(), folds.surfaces.begin(), folds.surfaces.end());
    nodes.insert(nodes.end(), folds.conditions.begin(), folds.conditions.end());
  }
  for (const auto& ends : model.box)
    if (ends) nodes.insert(nodes.end(), ends->begin(), ends->end());
  Conditions conditions;
  conditions.graph = with_numbers(model.graph, signs, nodes);
  const Node* n = nodes.data();
  conditions.all.assign(n, n + own);
  n += own;
  for (const CoveredRange& crank : model.crank_ranges) {
    const std::size_t count = crank.conditions.size();
    conditions.cranks.push_back({n[0], n[1], n[2], n[3], n[4], n[5], n[6], {n + 7, n + 7 + count}});
    n += 7 + count;
  }
  for (const CoveredFolds& folds : model.folds) {
    const std::size_t count = folds.conditions.size();
    conditions.folds.push_back({{n[0], n[1]}, {n + 2, n + 2 + count}, folds.crank_range});
    n += 2 + count;
  }
  for (const auto& ends : model.box) {
    conditions.box.emplace_back();
    if (!ends) continue;
    conditions.box.back() = {n[0], n[1]};
    n += 2;
  }
  return conditions;
}

std::string name_of_condition(const Model& model, std::size_t condition) {
  if (condition < model.domains.size()) return model.domains[condition].name;
  condition -= model.domains.size();
  if (condition < model.margins.size()) return model.margins[condition].name;
  return "a joint's formula";
}

}  // namespace pkm::described
