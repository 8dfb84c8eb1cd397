// [[reference]]: published results that the end of a run is set beside.

#include "engine/config/sections.hpp"

namespace pkm {
namespace {

/// The unit of an objective or report; of one name in both, the objective's.
std::string unit_of(const std::string& name, const ProblemParts& parts) {
  for (const auto* list : {&parts.objectives, &parts.reports})
    for (const auto& quantity : *list)
      if (quantity.name == name) return quantity.unit;
  return "1";
}

}  // namespace

void read_references(const ConfigValue& root, StudyDraft& draft) {
  const auto variables = names_of(draft.parts.space.variables());
  const auto values = names_of(draft.parts.objectives, draft.parts.reports);
  for (const auto& table : tables_of(root, "reference")) {
    table.allow({"name", "design", "values", "seconds"});
    Reference reference;
    reference.name = table.at("name", "where the result was published").text("text");
    if (const auto design = table.find("design")) {
      design->expect_table("a table of variables").allow(variables, "variable");
      for (const auto& variable : draft.parts.space.variables())
        reference.design.push_back(design->find_number(variable.name, variable.unit));
    }
    if (const auto list = table.find("values")) {
      list->expect_table("a table of objectives and reports").allow(values, "objective or report");
      for (const auto& name : list->keys())
        reference.values.emplace_back(name, list->find(name)->number(unit_of(name, draft.parts)));
    }
    reference.seconds = table.find_number("seconds", "s", 0);
    draft.study.references.push_back(std::move(reference));
  }
}

}  // namespace pkm
