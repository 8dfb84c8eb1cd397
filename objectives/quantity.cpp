// Statistic of a pose quantity over the feasible poses of the workspace analysis. The quantity is a formula
// ([[quantity]] in the mechanism file or the study) or built in. If it has one value per joint, the value of the worst
// joint is used.
//
// For gradient solvers the minimum and the maximum are replaced by a Kreisselmeier-Steinhauser aggregate; for this
// purpose, the values of a formula, which can have any unit, are scaled to [0, 1]. Quantiles have no derivatives.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/mechanism/availability.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

/// Throws std::invalid_argument with a sentence if the mechanism does not have the quantity.
const PoseQuantity& quantity_of(const EntryContext& context) {
  const std::string& name = context.options.word("quantity");
  const PoseQuantity& quantity = pose_quantity_called(context.mechanism.info(), name);
  if (const Unsupported reason = why_unavailable(context.mechanism, quantity))
    throw std::invalid_argument("quantity " + name + " is unavailable: " + *reason);
  return quantity;
}

class QuantityStatistic final : public Quantity {
 public:
  explicit QuantityStatistic(const EntryContext& context)
      : of_{.quantity = quantity_of(context),
            .statistic = context.options.word("statistic"),
            .sharpness = context.options.number("sharpness")} {}
  double value(const DesignView<double>& design) const override { return of_(design); }
  Dual4 smooth(const DesignView<Dual4>& design) const override { return of_(design); }
  Unsupported why_no_derivatives() const override {
    if (of_.statistic[0] != 'p') return {};
    return "quantity with statistic = \"" + of_.statistic +
           "\" is a quantile, which has none; use \"mean\", \"std\", \"min\" or \"max\"";
  }
  std::string why_undefined(const DesignView<double>& design) const override {
    const std::vector<double>& field = design.workspace->field(of_.quantity);
    if (field.empty()) return "no pose is feasible";
    const auto undefined = std::ranges::count_if(field, [](double x) { return !std::isfinite(x); });
    return std::string(of_.quantity.name) + " is undefined at " + std::to_string(undefined) + " of " +
           std::to_string(field.size()) + " feasible poses";
  }

 private:
  PoseStatistic of_;
};

}  // namespace

ObjectiveEntry quantity_objective() {
  return {
      .name = "quantity",
      .meaning =
          "statistic over the workspace of a [[quantity]] of the mechanism file or the study, or of a built-in one",
      .direction = Direction::maximise,
      .options = {{.name = "quantity", .kind = OptionKind::word, .required = true, .meaning = "name of the quantity"},
                  {.name = "statistic",
                   .kind = OptionKind::word,
                   .initial = std::string("mean"),
                   .choices = {"mean", "std", "min", "max", "p5", "p50", "p95"},
                   .meaning = "over the poses: mean, standard deviation, minimum, maximum, or quantile in percent"},
                  sharpness_option("min and max")},
      .unit = [](const EntryContext& context) { return std::string(quantity_of(context).unit); },
      .refusal = [](const Mechanism& mechanism) -> Unsupported {
        for (const PoseQuantity* const quantity : pose_quantities(mechanism.info()))
          if (!why_unavailable(mechanism, *quantity)) return {};
        return "objective quantity is unavailable: mechanism " + mechanism.info().name + " has no quantity of the pose";
      },
      .request = [](const EntryContext& context,
                    FieldRequest& request) { request_field(quantity_of(context), context, request); },
      .make = [](const EntryContext& context) -> std::unique_ptr<const Quantity> {
        return std::make_unique<QuantityStatistic>(context);
      },
      .detail =
          [](const EntryContext& context) {
            const PoseQuantity& quantity = quantity_of(context);
            const std::string name = quantity.name, meaning = quantity.meaning;
            return statistic_in_words(context.options.word("statistic")) + " of " + name + " over the workspace" +
                   (meaning == name ? "" : ": " + meaning);
          },
      .range = [](const EntryContext& context) -> Range {
        const PoseQuantity& quantity = quantity_of(context);
        if (context.options.word("statistic") != "std") return {quantity.lower, quantity.upper};
        return {0, (quantity.upper - quantity.lower) / 2};
      },
  };
}

}  // namespace pkm
