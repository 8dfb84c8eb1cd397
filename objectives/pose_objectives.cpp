// Statistics over the workspace, or a region of it, of every quantity of poses: its mean and its worst case, and of
// those of joints the spread.
//
// The mean converges with the grid. The worst case is that of the samples: cell centres or quadrature nodes; the least
// conditioning tends to 0 unless the singularity margins are positive. Gradient solvers see it through a smooth end of
// the samples (soft_least, soft_greatest); a quantile is a sample and has no derivative.
#include <algorithm>
#include <cmath>

#include "engine/problem/no_conditioning.hpp"
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

/// ", in [0, 1]"; "" for any number.
std::string range_words(const PoseQuantity& quantity) {
  if (!std::isfinite(quantity.least) || !std::isfinite(quantity.greatest)) return {};
  return ", in [" + shortest(quantity.least) + ", " + shortest(quantity.greatest) + "]";
}

OptionSpec limb_option(Worst worst) {
  return {.name = "limb",
          .kind = OptionKind::word,
          .initial = std::string("worst"),
          .choices = numbers_of_joints({"worst", "mean"}),
          .meaning = std::string("whose index: one limb's, the ") + (worst == Worst::least ? "least" : "largest") +
                     " of each pose, or the mean over the limbs"};
}

std::vector<OptionSpec> options_of(const PoseQuantity& quantity, bool with_statistic) {
  const bool least = quantity.worst == Worst::least;
  std::vector<OptionSpec> options;
  if (with_statistic)
    options.push_back({.name = "statistic",
                       .kind = OptionKind::word,
                       .initial = std::string("mean"),
                       .choices = least ? std::vector<std::string>{"mean", "min"}
                                        : std::vector<std::string>{"mean", "max", "std", "p95"},
                       .meaning = least ? "mean over the workspace, or the worst pose"
                                        : "over the poses: mean, largest, standard deviation, or 95 % quantile"});
  if (quantity.per_joint) options.push_back(limb_option(quantity.worst));
  options.push_back(quantity.needs_inertia() ? mode_option() : characteristic_length_option());
  if (with_statistic) options.push_back(sharpness_option(least ? "min" : "max"));
  return options;
}

/// @param statistic  "": the option of that name
ObjectiveEntry entry(const PoseQuantity& quantity, const std::string& name, const std::string& meaning,
                     Direction direction, const std::string& statistic) {
  return {
      .name = name,
      .meaning = meaning,
      .direction = direction,
      .options = options_of(quantity, statistic.empty()),
      .unit = [&quantity](const EntryContext&) { return std::string(quantity.unit); },
      .refusal = [&quantity, name](const Mechanism& mechanism) -> Refusal {
        if (quantity.needs_inertia()) return refuse_without_dynamics(name, mechanism);
        const Refusal reason = no_conditioning(mechanism.info());
        return reason ? "objective " + name + " is unavailable: " + *reason : Refusal();
      },
      .demand = [&quantity](const EntryContext& context, Demand& demand) { demand_field(quantity, context, demand); },
      .make = [&quantity, name, statistic](const EntryContext& context) -> std::unique_ptr<const Quantity> {
        const Options& options = context.options;
        PoseStatistic of{quantity, statistic};
        if (quantity.per_joint) of.joint = options.word("limb");
        if (statistic.empty()) {
          of.statistic = options.word("statistic");
          of.sharpness = options.number("sharpness");
        }
        if (of.statistic != "p95") return make_quantity(of);
        return make_plain_quantity(of, name +
                                           " with statistic = \"p95\" is a quantile, which has none; take \"mean\", "
                                           "\"max\" or \"std\"");
      },
      .range = [&quantity, statistic](const EntryContext& context) -> Range {
        if ((statistic.empty() ? context.options.word("statistic") : statistic) != "std")
          return {quantity.least, quantity.greatest};
        return {0, (quantity.greatest - quantity.least) / 2};
      },
  };
}

}  // namespace

std::vector<ObjectiveEntry> pose_objectives() {
  std::vector<ObjectiveEntry> entries;
  for (const PoseQuantity* const quantity : pose_quantities()) {
    const bool least = quantity->worst == Worst::least;
    const std::string name = name_of(*quantity), meaning = quantity->meaning;
    entries.push_back(entry(*quantity, name,
                            meaning + (quantity->per_joint ? " of the joints" : "") + " over the workspace" +
                                range_words(*quantity) + where_empty(*quantity),
                            least ? Direction::maximise : Direction::minimise, ""));
    if (quantity->per_joint)
      entries.push_back(entry(*quantity, name + "-uniformity",
                              "standard deviation of the " + meaning + " over the workspace: 0 is isotropic",
                              Direction::minimise, "std"));
  }
  return entries;
}

}  // namespace pkm
