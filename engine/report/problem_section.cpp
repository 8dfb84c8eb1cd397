#include "engine/report/sections.hpp"

namespace pkm {

namespace {

/// Why a stage of a gradient solver would be refused, as where the study is read; null: it would not.
Json gradients_refused(const DesignProblem& problem) {
  for (const Variable& v : problem.parts().space.variables())
    if (v.step > 0) return "the variable " + v.name + " has a step";
  const Refusal reason = problem.no_derivatives();
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
  json["gradients_refused"] =
      page.study ? gradients_refused(*page.study->problem) : Json("this program cannot read the study's text");
  json["parameters"] = Json::array();
  for (const ParameterRecord& p : problem.parameters)
    json["parameters"].push_back({{"name", p.name}, {"unit", p.unit}, {"value", p.value}, {"varies", p.variable >= 0}});
  json["variables"] = Json::array();
  for (const Variable& v : problem.variables)
    json["variables"].push_back({{"name", v.name}, {"unit", v.unit}, {"lower", v.lower}, {"upper", v.upper}});
  json["objectives"] = named(problem.objectives);
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    json["objectives"][k]["maximise"] = problem.objectives[k].direction == Direction::maximise;
  json["margins"] = named(problem.margins);
  json["reports"] = named(problem.reports);
  return json;
}

Json design_data(const Views& views) {
  const MechanismInfo& info = views.mechanism.info();
  const View& design = views.designs.front();
  Json parameters = named(info.parameters);
  for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i]["value"] = design.parameters[i];
  return {{"mechanism", info.name}, {"title", info.title}, {"name", design.name}, {"parameters", parameters}};
}

}  // namespace pkm
