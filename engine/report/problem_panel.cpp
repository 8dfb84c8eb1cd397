// Computes the data on the problem of a study, which all panels use, and on a single design.
#include "engine/report/panels.hpp"

namespace pkm {

namespace {

/// The reason why the study cannot have a stage with a gradient-based solver (the message of the study reader); null if
/// it can.
Json gradients_unsupported(const DesignProblem& problem) {
  for (const Variable& v : problem.parts().space.variables())
    if (v.step > 0) return "the variable " + v.name + " has a step";
  const Unsupported reason = problem.why_no_derivatives();
  return reason ? Json(*reason) : Json();
}

}  // namespace

Json problem_data(const PageStudy& page) {
  const ProblemRecord& problem = page.contents.problem;
  Json json = {{"mechanism", problem.mechanism}};
  if (page.study) {
    const MechanismInfo& info = page.study->problem->parts().mechanism->info();
    json["title"] = info.title;
    json["source"] = info.source;
  }
  json["gradients_unsupported"] =
      page.study ? gradients_unsupported(*page.study->problem) : Json("this program cannot read the study's text");
  json["parameters"] = Json::array();
  for (const ParameterRecord& p : problem.parameters)
    json["parameters"].push_back({{"name", p.name}, {"unit", p.unit}, {"value", p.value}, {"varies", p.variable >= 0}});
  json["variables"] = Json::array();
  for (const Variable& v : problem.variables)
    json["variables"].push_back({{"name", v.name}, {"unit", v.unit}, {"lower", v.lower}, {"upper", v.upper}});
  for (const ChoiceName& choice : problem.choices.value_or(std::vector<ChoiceName>()))
    json["variables"][static_cast<std::size_t>(choice.variable)]["choices"].push_back(choice.name);
  json["objectives"] = infos_json(problem.objectives);
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    json["objectives"][k]["maximise"] = problem.objectives[k].direction == Direction::maximise;
  json["margins"] = infos_json(problem.margins);
  json["outputs"] = infos_json(problem.reports);
  return json;
}

Json design_data(const ShownDesigns& shown) {
  const MechanismInfo& info = shown.mechanism.info();
  const ShownDesign& design = shown.designs.front();
  Json parameters = infos_json(info.parameters);
  for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i]["value"] = design.parameters[i];
  return {{"mechanism", info.name}, {"title", info.title}, {"name", design.name}, {"parameters", parameters}};
}

}  // namespace pkm
