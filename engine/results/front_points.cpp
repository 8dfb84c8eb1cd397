#include "engine/results/front_points.hpp"

#include <cmath>

#include "engine/math/hypervolume.hpp"

namespace pkm {

std::vector<std::vector<std::string>> point_labels(const ProblemRecord& problem, const Scores& front) {
  std::vector<std::vector<std::string>> list(front.size());
  const std::vector<std::size_t> ends = ends_of(front);
  for (std::size_t k = 0; k < ends.size(); ++k) list[ends[k]].push_back("best " + problem.objectives[k].name);
  for (const std::size_t i : knees(front)) list[i].push_back("knee");
  list[compromise(front)].push_back("compromise");
  return list;
}

double hypervolume_of(const ProblemRecord& problem, const StageRecord& stage, const Scores& front) {
  const std::vector<double>& reference = stage.front->reference;
  if (reference.empty()) return std::nan("");
  std::vector<double> reference_point;  // scores of the reference point: maximised objectives with the opposite sign
  for (std::size_t k = 0; k < reference.size(); ++k)
    reference_point.push_back(problem.objectives[k].direction == Direction::maximise ? -reference[k] : reference[k]);
  return hypervolume(front.values, front.objectives, reference_point);
}

std::optional<double> evolved_hypervolume(const Study& study, const StudyContents& contents) {
  for (std::size_t i = contents.stages.size(); i-- > 0;) {
    const std::optional<FrontRecord>& front = contents.stages[i].front;
    if (!front || front->hypervolume.empty() || !study.stages[i].options.has("reference")) continue;
    if (std::isfinite(front->hypervolume.back())) return front->hypervolume.back();
  }
  return {};
}

}  // namespace pkm
