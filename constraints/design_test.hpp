// A design-level constraint whose formula belongs to the mechanism.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// Position of a design-level test among the mechanism's, or -1.
inline int find_design_test(const MechanismInfo& mechanism, const std::string& name) {
  for (std::size_t i = 0; i < mechanism.design_margins.size(); ++i)
    if (mechanism.design_margins[i].name == name) return static_cast<int>(i);
  return -1;
}

inline std::string refuse_without_test(const MechanismInfo& mechanism, const std::string& name) {
  if (find_design_test(mechanism, name) >= 0) return {};
  return "constraint " + name + " is a test of other mechanisms: mechanism " + mechanism.name +
         " has none of that name";
}

inline std::string design_test_unit(const EntryContext& context, const std::string& name) {
  const auto& info = context.mechanism.info();
  return info.design_margins[static_cast<std::size_t>(find_design_test(info, name))].unit;
}

/// The mechanism's margin of that name, under the plan's limits.
inline std::unique_ptr<const Quantity> make_design_test(const EntryContext& context, const std::string& name) {
  const auto index = static_cast<std::size_t>(find_design_test(context.mechanism.info(), name));
  return make_quantity([index, limits = context.plan.limits,
                        count = context.mechanism.info().design_margins.size()](const auto& design) {
    std::array<std::remove_cvref_t<decltype(design.parameters[0])>, 16> margins{};
    PKM_EXPECTS(count <= margins.size());
    design.mechanism.design_margins(design.parameters, limits, std::span(margins).first(count));
    return margins[index];
  });
}

}  // namespace pkm
