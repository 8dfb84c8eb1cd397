#include "engine/optimisers/front_keeper.hpp"

#include "engine/math/hypervolume.hpp"
#include "engine/math/igd_plus.hpp"

namespace pkm {

FrontKeeper::FrontKeeper(const FrontPlan& plan, const Problem& problem, const EvaluationTable& table)
    : problem_(problem),
      table_(table),
      archive_(problem.objectives().size(), plan.limit),
      settled_(plan.settled),
      seen_{problem.objectives().size()} {
  const auto& objectives = problem.objectives();
  for (std::size_t k = 0; k < objectives.size() && !plan.reference.empty(); ++k) {
    front_.reference.push_back(plan.reference.at(objectives[k].name));
    corner_.push_back(sign(k) * front_.reference[k]);
  }
  Scores target{objectives.size()};
  for (const NamedNumbers& point : plan.front)
    for (std::size_t k = 0; k < objectives.size(); ++k) target.values.push_back(sign(k) * point.at(objectives[k].name));
  const Ranges extent = ranges_of(target);
  for (std::size_t k = 0; k < extent.least.size(); ++k) per_range_.push_back(extent.range(k) > 0 ? extent.range(k) : 1);
  target_ = std::move(target.values);
}

bool FrontKeeper::add(std::span<const std::int64_t> rows) {
  Scores feasible{archive_.scores().objectives};
  std::vector<std::int64_t> ids;
  for (const std::int64_t row : rows) {
    if (row < next_row_) continue;  // a design known already
    next_row_ = row + 1;
    if (table_.status[static_cast<std::size_t>(row)] != Status::feasible) continue;
    ids.push_back(row);
    add_scores(problem_.objectives(), table_, static_cast<std::size_t>(row), feasible);
  }
  const bool fixed = corner_.empty() && fix_reference(feasible);
  const bool gained = archive_.add(feasible, ids);
  if (archive_.size() == 0 || !(gained || fixed)) return false;
  const Scores& scores = archive_.scores();
  front_.rows = archive_.ids();
  compromise_ = front_.rows[compromise(scores)];
  if (!corner_.empty()) front_.hypervolume = hypervolume(scores.values, scores.objectives, corner_);
  if (!target_.empty()) front_.igd_plus = igd_plus(scores.values, scores.objectives, target_, per_range_);
  return gained;
}

bool FrontKeeper::fix_reference(const Scores& feasible) {
  constexpr double kBeyond = 0.1;
  if (feasible.objectives > 3) return false;  // the hypervolume is for two and three objectives
  seen_.values.insert(seen_.values.end(), feasible.values.begin(), feasible.values.end());
  if (seen_.size() < std::max<std::size_t>(settled_, 2)) return false;
  const Ranges extent = ranges_of(seen_);
  for (std::size_t k = 0; k < seen_.objectives; ++k)
    if (!(extent.range(k) > 0)) return false;
  for (std::size_t k = 0; k < seen_.objectives; ++k) {
    corner_.push_back(extent.greatest[k] + kBeyond * extent.range(k));
    front_.reference.push_back(sign(k) * corner_[k]);
  }
  return true;
}

}  // namespace pkm
