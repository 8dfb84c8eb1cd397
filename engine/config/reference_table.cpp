// Reader of [[reference]]: published results for comparison.

#include "engine/config/study_draft.hpp"

namespace pkm {
namespace {

/// Unit of the objective or output with this name; if both exist, the unit of the objective.
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
  for (const auto& table : root.tables("reference")) {
    Reference reference;
    reference.name = table.at("name", "where the result was published").text("text");
    if (const auto design = table.find("design")) {
      design->table_of_names(variables);
      for (const auto& variable : draft.parts.space.variables())
        reference.design.push_back(design->find_number(variable.name, variable.unit));
    }
    if (const auto list = table.find("values")) {
      list->table_of_names(values);
      for (const auto& name : list->keys())
        reference.values.emplace_back(name, list->find(name)->number(unit_of(name, draft.parts)));
    }
    reference.seconds = table.find_number("seconds");
    draft.study.references.push_back(std::move(reference));
  }
}

}  // namespace pkm
