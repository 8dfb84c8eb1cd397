#include "engine/survey/survey_set.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/survey/plain_voxels.hpp"

namespace pkm {
namespace {

class SurveySet final : public Surveyor, public SlopeSurveyor {
 public:
  explicit SurveySet(std::vector<std::unique_ptr<const Surveyor>> members) : members_(std::move(members)) {}
  void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const override {
    add_up(scratch, survey, [&](std::size_t k, Survey<double>& one) { members_[k]->survey(parameters, scratch, one); });
  }
  void survey(std::span<const Dual4> parameters, Scratch& scratch, Survey<Dual4>& survey) const override {
    add_up(scratch, survey,
           [&](std::size_t k, Survey<Dual4>& one) { members_[k]->slopes()->survey(parameters, scratch, one); });
  }
  const SlopeSurveyor* slopes() const override { return members_.front()->slopes() ? this : nullptr; }
  std::string why_no_slopes() const override { return members_.front()->why_no_slopes(); }

 private:
  template <class S>
  struct Room {
    Survey<S> one;
  };

  template <class S, class Find>
  void add_up(Scratch& scratch, Survey<S>& survey, const Find& find) const {
    Survey<S>& one = scratch.get<Room<S>>().one;
    survey.clear();
    const double share = 1.0 / static_cast<double>(members_.size());
    for (std::size_t k = 0; k < members_.size(); ++k) {
      find(k, one);
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

std::unique_ptr<const Surveyor> prepare_one(const Mechanism& mechanism, const SurveyPlan& plan, const Demand& demand) {
  sweep_of(mechanism.info(), plan);  // refuses what it has no sweep for
  if (const ColumnOptions* const columns = plan.columns()) {
    if (!mechanism.columns())
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has no column surveys; take workspace.method = \"voxels\"");
    return mechanism.columns()->prepare(plan, *columns, demand);
  }
  if (mechanism.voxels()) return mechanism.voxels()->prepare(plan, *plan.voxels(), demand);
  return prepare_plain_voxels(mechanism, plan, *plan.voxels(), demand);
}

/// The plans without lists that a plan stands for.
std::vector<SurveyPlan> single_plans(const SurveyPlan& plan) {
  using Kind = HeldCoordinate::Kind;
  const auto list = std::ranges::find(plan.held, Kind::listed, &HeldCoordinate::kind);
  if (list == plan.held.end()) return {plan};
  std::vector<SurveyPlan> plans;
  for (const double value : list->values) {
    SurveyPlan one = plan;
    one.held[static_cast<std::size_t>(list - plan.held.begin())] = {list->coordinate, Kind::value, value};
    for (SurveyPlan& single : single_plans(one)) plans.push_back(std::move(single));
  }
  return plans;
}

}  // namespace

std::unique_ptr<const Surveyor> prepare_survey(const Mechanism& mechanism, const SurveyPlan& plan,
                                               const Demand& demand) {
  std::vector<std::unique_ptr<const Surveyor>> members;
  for (const SurveyPlan& one : single_plans(plan)) members.push_back(prepare_one(mechanism, one, demand));
  if (members.size() == 1) return std::move(members.front());
  return std::make_unique<SurveySet>(std::move(members));
}

VoxelMap voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan) {
  sweep_of(mechanism.info(), plan);
  if (mechanism.voxels()) return mechanism.voxels()->map(parameters, plan, *plan.voxels());
  return plain_voxel_map(mechanism, parameters, plan, *plan.voxels());
}

}  // namespace pkm
