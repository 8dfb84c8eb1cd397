// Statistics of the pose quantities over the workspace or a region: the mean, the worst case and other statistics of
// each quantity, and the standard deviation of those with one value per joint.
//
// The mean converges under grid refinement. The worst case is taken over the samples (cell centres or quadrature
// nodes); with refinement the minimum conditioning tends to 0, unless the singularity margins are positive. For
// gradient solvers the worst case is replaced by a Kreisselmeier-Steinhauser aggregate (soft_min, soft_max).
// Quantiles have no derivatives.
#include <algorithm>
#include <cmath>

#include "engine/mechanism/availability.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

using Worst = PoseQuantity::Worst;

std::string name_of(const PoseQuantity& quantity) {
  std::string name = quantity.name;
  std::ranges::replace(name, '_', '-');
  return name;
}

/// Text with the range of a quantity's values, such as ", in [0, 1]"; "" if it is unbounded.
std::string range_text(const PoseQuantity& quantity) {
  if (!std::isfinite(quantity.lower) || !std::isfinite(quantity.upper)) return {};
  return ", in [" + shortest(quantity.lower) + ", " + shortest(quantity.upper) + "]";
}

OptionSpec limb_option(Worst worst) {
  return {.name = "limb",
          .kind = OptionKind::word,
          .initial = std::string("worst"),
          .choices = joint_choices({"worst", "mean"}),
          .meaning = std::string("number of a limb, worst (the ") + (worst == Worst::minimum ? "minimum" : "maximum") +
                     " over the limbs at each pose) or mean (over the limbs)"};
}

std::vector<OptionSpec> options_of(const PoseQuantity& quantity, bool with_statistic) {
  const bool worst_is_min = quantity.worst == Worst::minimum;
  std::vector<OptionSpec> options;
  if (with_statistic)
    options.push_back({.name = "statistic",
                       .kind = OptionKind::word,
                       .initial = std::string("mean"),
                       .choices = worst_is_min ? std::vector<std::string>{"mean", "min"}
                                               : std::vector<std::string>{"mean", "max", "std", "p95"},
                       .meaning = worst_is_min
                                      ? "mean or minimum over the workspace"
                                      : "over the poses: mean, maximum, standard deviation, or 95 % quantile"});
  if (quantity.per_joint) options.push_back(limb_option(quantity.worst));
  options.push_back(quantity.needs_inertia() ? mode_option() : characteristic_length_option());
  if (with_statistic) options.push_back(sharpness_option(worst_is_min ? "min" : "max"));
  return options;
}

/// Catalogue entry for a statistic of a pose quantity.
/// @param statistic  the statistic, such as "mean"; "": the option `statistic` selects it
ObjectiveEntry entry(const PoseQuantity& quantity, const std::string& name, const std::string& meaning,
                     Direction direction, const std::string& statistic) {
  return {
      .name = name,
      .meaning = meaning,
      .direction = direction,
      .options = options_of(quantity, statistic.empty()),
      .unit = [&quantity](const EntryContext&) { return std::string(quantity.unit); },
      .refusal = [&quantity, name](const Mechanism& mechanism) -> Unsupported {
        if (quantity.needs_inertia()) return check_dynamics(name, mechanism);
        const Unsupported reason = why_no_conditioning(mechanism.info());
        return reason ? "objective " + name + " is unavailable: " + *reason : Unsupported();
      },
      .request = [&quantity](const EntryContext& context,
                             FieldRequest& request) { request_field(quantity, context, request); },
      .make = [&quantity, name, statistic](const EntryContext& context) -> std::unique_ptr<const Quantity> {
        const Options& options = context.options;
        PoseStatistic of{quantity, statistic};
        if (quantity.per_joint) of.joint = options.word("limb");
        if (statistic.empty()) {
          of.statistic = options.word("statistic");
          of.sharpness = options.number("sharpness");
        }
        if (of.statistic != "p95") return make_quantity(of);
        return make_quantity_without_derivatives(
            of, name +
                    " with statistic = \"p95\" is a quantile, which has none; use \"mean\", "
                    "\"max\" or \"std\"");
      },
      .detail =
          [statistic, meaning](const EntryContext& context) {
            return statistic.empty() ? statistic_in_words(context.options.word("statistic")) + " of the " + meaning
                                     : meaning;
          },
      .range = [&quantity, statistic](const EntryContext& context) -> Range {
        if ((statistic.empty() ? context.options.word("statistic") : statistic) != "std")
          return {quantity.lower, quantity.upper};
        return {0, (quantity.upper - quantity.lower) / 2};
      },
  };
}

}  // namespace

std::vector<ObjectiveEntry> pose_objectives() {
  std::vector<ObjectiveEntry> entries;
  for (const PoseQuantity* const quantity : pose_quantities()) {
    const bool worst_is_min = quantity->worst == Worst::minimum;
    const std::string name = name_of(*quantity), meaning = quantity->meaning;
    entries.push_back(entry(*quantity, name,
                            meaning + (quantity->per_joint ? " of the joints" : "") + " over the workspace" +
                                range_text(*quantity) + empty_workspace_note(*quantity),
                            worst_is_min ? Direction::maximise : Direction::minimise, ""));
    if (quantity->per_joint)
      entries.push_back(entry(*quantity, name + "-uniformity",
                              "standard deviation of the " + meaning + " over the workspace: 0 is isotropic",
                              Direction::minimise, "std"));
  }
  return entries;
}

}  // namespace pkm
