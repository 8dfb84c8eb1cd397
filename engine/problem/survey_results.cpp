#include "engine/problem/survey_results.hpp"

#include "engine/math/statistics.hpp"
#include "engine/problem/conditioning_options.hpp"
#include "engine/problem/inertia_options.hpp"

namespace pkm {
namespace {

std::string no_unit(const MechanismInfo&, const SurveyPlan&) { return "1"; }
bool always(const Mechanism&) { return true; }
void nothing(const EntryContext&, Demand&) {}

/// A result that is a smooth function of the survey.
template <class F>
SurveyResult smooth_result(SurveyResult result, F) {
  result.value = [](const Survey<double>& survey, Scratch& scratch) { return F()(survey, scratch); };
  result.smooth = [](const Survey<Dual4>& survey, double, Scratch& scratch) { return F()(survey, scratch); };
  return result;
}

/// A result with kinks, and its stand-in.
template <class F, class G>
SurveyResult worst_case(SurveyResult result, F, G) {
  result.value = [](const Survey<double>& survey, Scratch&) { return F()(survey); };
  result.smooth = [](const Survey<Dual4>& survey, double sharpness, Scratch&) { return G()(survey, sharpness); };
  result.has_stand_in = true;
  return result;
}

template <class S>
S mean_coupling(const Survey<S>& survey, const char* limb, Scratch& scratch) {
  return survey.weight.empty() ? S(1.0) : weighted_mean(survey.weight, coupling_of(survey, limb, scratch));
}

}  // namespace

const std::vector<SurveyResult>& survey_results() {
  static const std::vector<SurveyResult> list = {
      smooth_result(
          {"volume", "measure of the feasible poses over the swept coordinates", volume_unit, always, nothing},
          [](const auto& survey, Scratch&) { return survey.volume; }),
      smooth_result({"conditioning_mean", "mean inverse condition number of the Jacobian", no_unit, has_jacobian,
                     demand_conditioning},
                    [](const auto& survey, Scratch&) { return weighted_mean(survey.weight, survey.conditioning); }),
      worst_case(
          {"conditioning_min", "least inverse condition number of the Jacobian", no_unit, has_jacobian,
           demand_conditioning},
          [](const auto& survey) { return least(survey.conditioning); },
          [](const auto& survey, double r) { return soft_least(survey.weight, survey.conditioning, r); }),
      smooth_result({"dci_mean", "mean coupling index over poses and joints; 1 where no pose is feasible", no_unit,
                     has_dynamics, demand_dci},
                    [](const auto& survey, Scratch& scratch) { return mean_coupling(survey, "mean", scratch); }),
      smooth_result({"dci_worst", "mean over the poses of their largest coupling index; 1 where no pose is feasible",
                     no_unit, has_dynamics, demand_dci},
                    [](const auto& survey, Scratch& scratch) { return mean_coupling(survey, "worst", scratch); }),
  };
  return list;
}

}  // namespace pkm
