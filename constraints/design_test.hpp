// A design-level constraint whose formula belongs to the mechanism.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/core/catalogue.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// The tests of a mechanism; none: it has no such ability.
inline std::vector<DesignMarginInfo> design_tests_of(const Mechanism& mechanism) {
  return mechanism.design_tests() ? mechanism.design_tests()->list() : std::vector<DesignMarginInfo>();
}

inline std::string refuse_without_test(const Mechanism& mechanism, const std::string& name) {
  if (find_named(design_tests_of(mechanism), name)) return {};
  return "constraint " + name + " is a test of other mechanisms: mechanism " + mechanism.info().name +
         " has none of that name";
}

inline std::string design_test_unit(const EntryContext& context, const std::string& name) {
  const auto tests = design_tests_of(context.mechanism);
  return find_named(tests, name)->unit;
}

/// The mechanism's margin of that name, under the plan's limits.
inline std::unique_ptr<const Quantity> make_design_test(const EntryContext& context, const std::string& name) {
  const auto tests = design_tests_of(context.mechanism);
  const auto index = static_cast<std::size_t>(find_named(tests, name) - tests.data());
  return make_quantity(
      [index, limits = context.plan.limits, count = tests.size()]<class S>(const DesignView<S>& design) {
        std::array<S, 16> margins{};
        PKM_EXPECTS(count <= margins.size());
        find_design_margins<S>(design.mechanism, design.parameters, limits, std::span(margins).first(count));
        return margins[index];
      });
}

}  // namespace pkm
