// Computes the data of the panel "Pareto front": the non-dominated designs of each stage, with knees and the
// compromise.
#include "engine/problem/front.hpp"
#include "engine/report/panels.hpp"

namespace pkm {
namespace {

std::vector<double> to_vector(std::span<const double> values) { return {values.begin(), values.end()}; }

Json front_points(const ProblemRecord& problem, const StageRecord& stage) {
  const Scores front = scores_of(problem.objectives, stage.table, stage.front->rows);
  Json list = Json::array();
  for (const std::int64_t row : stage.front->rows) {
    const auto r = static_cast<std::size_t>(row);
    list.push_back({{"evaluation", r + 1},
                    {"design", to_vector(stage.table.design(r))},
                    {"objectives", to_vector(stage.table.objective_row(r))},
                    {"knee", false},
                    {"compromise", false}});
  }
  for (const std::size_t i : knees(front)) list[i]["knee"] = true;
  list[compromise(front)]["compromise"] = true;
  return list;
}

}  // namespace

Json front_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Json fronts = Json::array();
  for (const StageRecord& stage : contents.stages)
    if (stage.has_front())
      fronts.push_back({{"stage", &stage - contents.stages.data() + 1},
                        {"optimiser", stage.optimiser},
                        {"reference", stage.front->reference},
                        {"points", front_points(contents.problem, stage)}});
  if (fronts.empty() || contents.problem.objectives.size() < 2) return {};
  Json json = {{"fronts", fronts}, {"baseline", Json()}};
  if (contents.final && contents.final->baseline) json["baseline"] = contents.final->baseline->objectives;
  if (page.study)
    if (const ShownDesigns shown = evaluate_front_designs(page); !shown.designs.empty())
      for (const auto& [name, data] :
           {std::pair("workspace", workspace_data(shown)), std::pair("mechanism", mechanism_data(shown)),
            std::pair("motions", motions_data(shown))})
        if (!data.is_null()) json["designs"][name] = data;
  return json;
}

}  // namespace pkm
