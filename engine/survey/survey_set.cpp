#include "engine/survey/survey_set.hpp"

#include <algorithm>

namespace pkm {
namespace {

class SurveySet final : public Surveyor {
 public:
  SurveySet(const Mechanism& mechanism, const SurveyPlan& plan, const Demand& demand) {
    SurveyPlan one = plan;
    one.held_values.clear();
    for (const double value : plan.held_values) {
      one.held.kind = HeldCoordinate::Kind::value;
      one.held.value = value;
      members_.push_back(mechanism.prepare(one, demand));
    }
  }
  void survey(std::span<const double> parameters, Survey<double>& survey) const override { run(parameters, survey); }
  void survey(std::span<const Dual4> parameters, Survey<Dual4>& survey) const override { run(parameters, survey); }
  std::string no_derivatives() const override { return members_.front()->no_derivatives(); }

 private:
  template <class S>
  void run(std::span<const S> parameters, Survey<S>& survey) const {
    thread_local Survey<S> one;
    survey.clear();
    const double share = 1.0 / static_cast<double>(members_.size());
    for (const auto& member : members_) {
      member->survey(parameters, one);
      survey.volume += one.volume * share;
      survey.cells += one.cells;
      survey.feasible_cells += one.feasible_cells;
      survey.cell_volume = one.cell_volume * share;
      survey.touches_box = survey.touches_box || one.touches_box;
      survey.columns += one.columns;
      survey.error = std::max(survey.error, one.error);
      for (S& weight : one.weight) weight *= share;
      append_samples(one, survey);
    }
  }

  std::vector<std::unique_ptr<const Surveyor>> members_;
};

}  // namespace

std::unique_ptr<const Surveyor> prepare_survey(const Mechanism& mechanism, const SurveyPlan& plan,
                                               const Demand& demand) {
  if (plan.held_values.empty()) return mechanism.prepare(plan, demand);
  return std::make_unique<SurveySet>(mechanism, plan, demand);
}

}  // namespace pkm
