// Yield: the share of built machines that satisfy all constraints of the study. Its values are computed by the design
// problem, which samples the machines (engine/problem/built_machines.hpp).
#include "engine/problem/built_machines.hpp"
#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry yield_objective() {
  return {
      .name = kYield,
      .meaning = "share of machines built within [tolerance] that satisfy all constraints",
      .direction = Direction::maximise,
      .options = {{.name = "statistic",
                   .kind = OptionKind::word,
                   .initial = std::string("share"),
                   .choices = {"share", "lower", "upper"},
                   .meaning = "the share of the samples, or an end of its 95 % confidence interval"}},
      .make =
          [](const EntryContext&) {
            return make_quantity_without_derivatives(
                [](const DesignView<double>&) -> double { throw std::logic_error("a yield is a share of samples"); },
                "a yield is a share of samples, which is constant almost everywhere; use an optimiser without "
                "gradients, or robust = \"quantile:0.05\" in the constraints");
          },
      .range = [](const EntryContext&) -> Range { return {.lower = 0, .upper = 1}; },
      .uses_workspace = false,
  };
}

}  // namespace pkm
