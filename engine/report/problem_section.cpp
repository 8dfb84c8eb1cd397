#include <nlohmann/json.hpp>

#include "engine/report/json_text.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

using Json = nlohmann::ordered_json;

template <class Infos>
Json named(const Infos& infos) {
  Json list = Json::array();
  for (const auto& info : infos) list.push_back({{"name", info.name}, {"unit", info.unit}, {"meaning", info.meaning}});
  return list;
}

}  // namespace

std::string problem_data(const PageStudy& page) {
  const ProblemRecord& problem = page.contents.problem;
  Json json = {{"mechanism", problem.mechanism}};
  if (page.study) {
    const MechanismInfo& info = page.study->problem->parts().mechanism->info();
    json["title"] = info.title;
    json["source"] = info.source;
  }
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
  return json_text(json);
}

std::string design_data(const Views& views) {
  const MechanismInfo& info = views.mechanism.info();
  const View& design = views.designs.front();
  Json parameters = Json::array();
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    parameters.push_back({{"name", info.parameters[i].name},
                          {"unit", info.parameters[i].unit},
                          {"meaning", info.parameters[i].meaning},
                          {"value", design.parameters[i]}});
  return json_text(
      Json{{"mechanism", info.name}, {"title", info.title}, {"name", design.name}, {"parameters", parameters}});
}

}  // namespace pkm
