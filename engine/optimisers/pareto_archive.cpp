#include "engine/optimisers/pareto_archive.hpp"

#include "engine/math/hypervolume.hpp"
#include "engine/math/igd_plus.hpp"

namespace pkm {

ParetoArchive::ParetoArchive(const ParetoArchivePlan& plan, const Problem& problem, const EvaluationTable& table)
    : problem_(problem),
      table_(table),
      archive_(problem.objectives().size(), plan.max_size),
      min_feasible_designs_(plan.min_feasible_designs),
      sample_{problem.objectives().size()} {
  const auto& objectives = problem.objectives();
  for (std::size_t k = 0; k < objectives.size() && !plan.reference.empty(); ++k) {
    front_.reference.push_back(plan.reference.at(objectives[k].name));
    reference_scores_.push_back(sign(k) * front_.reference[k]);
  }
  Scores target_scores{objectives.size()};
  for (const NamedNumbers& point : plan.reference_front)
    for (std::size_t k = 0; k < objectives.size(); ++k)
      target_scores.values.push_back(sign(k) * point.at(objectives[k].name));
  const Ranges extent = ranges_of(target_scores);
  for (std::size_t k = 0; k < extent.minimum.size(); ++k) ranges_.push_back(extent.range(k) > 0 ? extent.range(k) : 1);
  reference_front_ = std::move(target_scores.values);
}

bool ParetoArchive::add(std::span<const std::int64_t> rows) {
  Scores feasible{archive_.scores().objectives};
  std::vector<std::int64_t> ids;
  for (const std::int64_t row : rows) {
    if (row < next_row_) continue;  // this row was added before
    next_row_ = row + 1;
    if (table_.status[static_cast<std::size_t>(row)] != Status::feasible) continue;
    ids.push_back(row);
    add_scores(problem_.objectives(), table_, static_cast<std::size_t>(row), feasible);
  }
  const bool fixed = reference_scores_.empty() && fix_reference_point(feasible);
  const bool changed = archive_.add(feasible, ids);
  if (archive_.size() == 0 || !(changed || fixed)) return false;
  const Scores& scores = archive_.scores();
  front_.rows = archive_.ids();
  compromise_ = front_.rows[compromise(scores)];
  if (!reference_scores_.empty()) front_.hypervolume = hypervolume(scores.values, scores.objectives, reference_scores_);
  if (!reference_front_.empty())
    front_.igd_plus = igd_plus(scores.values, scores.objectives, reference_front_, ranges_);
  return changed;
}

bool ParetoArchive::fix_reference_point(const Scores& feasible) {
  // For each objective, the distance of the reference point from the worst value of the feasible designs, relative to
  // the range of their values.
  constexpr double kMargin = 0.1;
  if (feasible.objectives > 3) return false;  // hypervolumes are computed for two and three objectives only
  sample_.values.insert(sample_.values.end(), feasible.values.begin(), feasible.values.end());
  if (sample_.size() < std::max<std::size_t>(min_feasible_designs_, 2)) return false;
  const Ranges extent = ranges_of(sample_);
  for (std::size_t k = 0; k < sample_.objectives; ++k)
    if (!(extent.range(k) > 0)) return false;
  for (std::size_t k = 0; k < sample_.objectives; ++k) {
    reference_scores_.push_back(extent.maximum[k] + kMargin * extent.range(k));
    front_.reference.push_back(sign(k) * reference_scores_[k]);
  }
  return true;
}

}  // namespace pkm
