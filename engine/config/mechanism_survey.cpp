// Reads [survey]: the swept coordinates, the search box, and the default values of the fixed coordinates.

#include <algorithm>
#include <cmath>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/generic/contracted_box.hpp"

namespace pkm {

using generic::Inputs;
using limbs::Term;

namespace {

/// Index of the coordinate whose name is given by `value`.
int coordinate_named(const ConfigValue& value, const MechanismInfo& info) {
  const std::string& name = value.word(names_of(info.coordinates));
  return static_cast<int>(find_named(info.coordinates, name) - info.coordinates.data());
}

/// Reads a table with a range for each coordinate, such as { x = [from, to] }, whose ends are formulas of parameters.
void read_ranges(const ConfigValue& survey, const char* key, MechanismDraft& draft,
                 std::vector<std::optional<std::array<expression::Node, 2>>>& ranges) {
  const auto value = survey.find(key);
  if (!value) return;
  const auto& coordinates = draft.model.info.coordinates;
  const ConfigValue table = value->table_of_names(names_of(coordinates));
  for (const std::string& name : table.keys()) {
    const ConfigValue range = *table.find(name);
    const auto i = static_cast<std::size_t>(find_named(coordinates, name) - coordinates.data());
    const auto ends = range.elements("[from, to]");
    if (ends.size() != 2) throw range.error("[from, to]");
    const Term from = draft.scope.of_design(ends[0], coordinates[i].unit, name),
               to = draft.scope.of_design(ends[1], coordinates[i].unit, name);
    draft.scope.refuse_empty(range, from, to);
    ranges[i] = {from.node(), to.node()};
  }
}

expression::Node middle_of(generic::Model& model, const std::array<expression::Node, 2>& range) {
  return ((model.term(range[0]) + model.term(range[1])) * 0.5).node();
}

}  // namespace

void read_survey(const ConfigValue& root, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const std::size_t count = model.inputs.coordinates;
  model.box.resize(count);
  model.is_contracted.resize(count);
  model.reach.resize(count);
  model.default_values.resize(count);
  std::vector<int> swept, columns_along;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 3); ++i) swept.push_back(static_cast<int>(i));
  const auto survey = root.find_table("survey");
  if (survey) {
    if (const auto sweep = survey->find("sweep")) {
      swept.clear();
      for (const ConfigValue& each : sweep->elements("one to three coordinates")) {
        swept.push_back(coordinate_named(each, model.info));
        if (std::ranges::count(swept, swept.back()) > 1) throw each.refusal("this coordinate is swept already");
      }
      if (swept.empty() || swept.size() > 3) throw sweep->error("one to three coordinates");
    }
    if (const auto given = survey->find("fixed")) {
      const ConfigValue fixed = given->table_of_names(names_of(model.info.coordinates));
      for (const std::string& name : fixed.keys()) {
        const ConfigValue value = *fixed.find(name);
        const auto i =
            static_cast<std::size_t>(find_named(model.info.coordinates, name) - model.info.coordinates.data());
        model.default_values[i] = draft.scope.of_design(value, model.info.coordinates[i].unit, name).node();
      }
    }
    read_ranges(*survey, "box", draft, model.box);
    read_ranges(*survey, "reach", draft, model.reach);
    if (const auto columns = survey->find("columns_along")) {
      for (const ConfigValue& each : columns->elements("a list of coordinates, the preferred one first"))
        columns_along.push_back(coordinate_named(each, model.info));
    }
  }
  // Range of a coordinate without `box`: a full rotation for an angle if other coordinates have a `box`; otherwise the
  // range of the feasible poses, which is computed by contraction.
  const bool has_box = survey && survey->has("box");
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_angle = model.rotation_axes[i].has_value();
    if (!model.box[i] && is_angle && has_box) model.box[i] = {model.graph.number(-kPi), model.graph.number(kPi)};
    if (!model.box[i]) {
      model.is_contracted[i] = true;
      model.box[i] = {model.graph.input(model.inputs.range_end(i, 0), Inputs::kDesign),
                      model.graph.input(model.inputs.range_end(i, 1), Inputs::kDesign)};
      if (is_angle && !model.default_values[i]) model.default_values[i] = model.graph.number(0);
    }
    if (!model.default_values[i]) model.default_values[i] = middle_of(model, *model.box[i]);
  }
  model.info.sweeps = all_sweeps(model.info.coordinates, swept);
  for (Sweep& sweep : model.info.sweeps) {
    const auto along = std::ranges::find_if(
        columns_along, [&](int coordinate) { return std::ranges::find(sweep.swept, coordinate) != sweep.swept.end(); });
    if (along != columns_along.end()) sweep.column = *along;
  }
}

void bound_survey(MechanismDraft& draft) {
  generic::Model& model = draft.model;
  if (std::ranges::count(model.is_contracted, true) > 0) {
    model.contracted_box = std::make_shared<generic::ContractedBox>(model, generic::inputs_of_all_designs(model));
    const bounds::IntervalBox box = model.contracted_box->bound(model);
    for (std::size_t i = 0; i < model.inputs.coordinates; ++i) {
      if (!model.is_contracted[i] || std::isfinite(box[i].width())) continue;
      model.is_contracted[i] = false;
      if (model.default_values[i] == middle_of(model, *model.box[i])) model.default_values[i].reset();
      model.box[i].reset();
    }
  }
  for (Sweep& sweep : model.info.sweeps)
    sweep.integrates = std::ranges::all_of(
        sweep.fixed, [&](int coordinate) { return model.box[static_cast<std::size_t>(coordinate)].has_value(); });
}

}  // namespace pkm
