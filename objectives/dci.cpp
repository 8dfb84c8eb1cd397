// Dynamic coupling indices over the workspace or a region of it, and their spread.
//
// DCI_i = 1 - exp(-sum of |M_q(i,k)| / |M_q(i,i)|), k != i: 0 where a joint moves without forcing the others. Where no
// pose is feasible it counts as 1, so that an empty workspace is no good design. Gradient solvers see the maximum
// through a smooth upper end of the samples; a quantile is a sample and has no derivative.
#include "engine/math/statistics.hpp"
#include "engine/problem/conditioning_options.hpp"
#include "engine/problem/inertia_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

struct Order {
  std::vector<std::size_t> of_samples;
};

/// A statistic of the field of a limb, 1 where there are no samples.
template <class Statistic>
auto over_samples(const std::string& limb, Statistic statistic) {
  return [limb, statistic](const auto& design) {
    const auto& survey = *design.survey;
    using S = std::remove_cvref_t<decltype(survey.volume)>;
    if (survey.weight.empty()) return S(1.0);
    return S(statistic(survey.weight, coupling_of(survey, limb, design.scratch), design.scratch));
  };
}

std::unique_ptr<const Quantity> deviation(const std::string& limb) {
  return make_quantity(
      over_samples(limb, [](const auto& w, const auto& f, Scratch&) { return weighted_deviation(w, f); }));
}

std::unique_ptr<const Quantity> make_dci(const EntryContext& context) {
  const std::string &limb = context.options.word("limb"), &statistic = context.options.word("statistic");
  if (statistic == "std") return deviation(limb);
  if (statistic == "mean")
    return make_quantity(
        over_samples(limb, [](const auto& w, const auto& f, Scratch&) { return weighted_mean(w, f); }));
  if (statistic == "max")
    return make_quantity(
        over_samples(limb, [](const auto&, const auto& f, Scratch&) { return greatest(f); }),
        over_samples(limb, [r = context.options.number("sharpness")](const auto& w, const auto& f, Scratch&) {
          return soft_greatest(w, f, r);
        }));
  return make_plain_quantity(
      over_samples(limb,
                   [](const auto& w, const auto& f, Scratch& scratch) {
                     return weighted_quantile(w, f, 0.95, scratch.get<Order>().of_samples);
                   }),
      "dci with statistic = \"p95\" is a quantile, which has none; take \"mean\", \"max\" or \"std\"");
}

}  // namespace

ObjectiveEntry dci() {
  return {
      .name = "dci",
      .meaning = "dynamic coupling index of the joints over the workspace, in [0, 1]; 1 where no pose is feasible",
      .direction = Direction::minimise,
      .options = {{.name = "statistic",
                   .kind = OptionKind::word,
                   .initial = std::string("mean"),
                   .choices = {"mean", "max", "std", "p95"},
                   .meaning = "over the poses: mean, largest, standard deviation, or 95 % quantile"},
                  limb_option(),
                  mode_option(),
                  sharpness_option("max")},
      .unit = [](const EntryContext&) { return std::string("1"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_dynamics("dci", mechanism); },
      .demand = demand_dci,
      .make = make_dci,
  };
}

ObjectiveEntry dci_uniformity() {
  return {
      .name = "dci-uniformity",
      .meaning = "standard deviation of the dynamic coupling index over the workspace: 0 is isotropic",
      .direction = Direction::minimise,
      .options = {limb_option(), mode_option()},
      .unit = [](const EntryContext&) { return std::string("1"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_dynamics("dci-uniformity", mechanism); },
      .demand = demand_dci,
      .make = [](const EntryContext& context) { return deviation(context.options.word("limb")); },
  };
}

}  // namespace pkm
