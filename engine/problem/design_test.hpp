// Design-level constraints whose formulas the mechanism provides.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/core/catalogue.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// The design-level constraints that a mechanism provides; empty if it provides none.
inline std::vector<DesignMarginInfo> design_tests_of(const Mechanism& mechanism) {
  return mechanism.design_tests() ? mechanism.design_tests()->list() : std::vector<DesignMarginInfo>();
}

/// Catalogue entry of the constraint `name`: the mechanism computes its margin, with the limits of the plan.
inline ConstraintEntry design_test(const std::string& name, const std::string& meaning) {
  return {
      .name = name,
      .meaning = meaning,
      .unit =
          [name](const EntryContext& context) { return find_named(design_tests_of(context.mechanism), name)->unit; },
      .refusal = [name](const Mechanism& mechanism) -> Unsupported {
        if (find_named(design_tests_of(mechanism), name)) return {};
        return "constraint " + name + " is not defined for mechanism " + mechanism.info().name;
      },
      .make =
          [name](const EntryContext& context) {
            const auto tests = design_tests_of(context.mechanism);
            const auto index = static_cast<std::size_t>(find_named(tests, name) - tests.data());
            return make_quantity(
                [index, limits = context.plan.limits, count = tests.size()]<class S>(const DesignView<S>& design) {
                  std::array<S, kMaxDesignTests> margins{};
                  PKM_EXPECTS(count <= margins.size());
                  design.mechanism.design_tests()->test(design.parameters, limits, std::span(margins).first(count));
                  return margins[index];
                });
          },
  };
}

}  // namespace pkm
