// Handles parameters that belong to a single limb, such as "arm2.l_b".

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {

using generic::Inputs;

std::optional<LimbParameter> limb_parameter(const std::string& name, const SourceLocation& place) {
  const auto dot = name.find('.');
  if (dot == std::string::npos) return {};
  return LimbParameter{name.substr(0, dot), name.substr(dot + 1), place};
}

void add_own_parameter(const LimbParameter& own, const Parameter& parameter, MechanismDraft& draft) {
  std::vector<Parameter>& all = draft.model.info.parameters;
  if (find_named(all, own.name())) throw ConfigError(own.place, "there is already a parameter " + own.name());
  draft.own.push_back({own, draft.model.graph.input(all.size(), Inputs::kDesign)});
  all.push_back(parameter);
  all.back().name = own.name();
}

void read_as_limb(const std::string& limb, const std::function<void()>& read, MechanismDraft& draft) {
  const auto usual = draft.scope.meanings();
  bool any = false;
  for (const OwnParameter& own : draft.own)
    if (own.limb == limb) {
      draft.scope.replace(own.parameter, own.node);
      any = true;
    }
  for (const ConfigValue& let : draft.let)
    for (const std::string& name : let.keys())
      if (any) draft.scope.replace(name, draft.scope.formula_of_any_kind(*let.find(name), "1", name + " of " + limb));
  read();
  draft.scope.restore(usual);
}

std::vector<LimbParameter> effective_parameters(const MechanismDraft& draft) {
  const generic::Model& model = draft.model;
  std::vector<expression::Node> used = model.joints;
  std::ranges::copy(model.closures, std::back_inserter(used));
  for (const generic::Result& margin : model.margins) used.push_back(margin.node);
  used = model.graph.reachable(used);
  std::vector<LimbParameter> effective;
  for (const OwnParameter& own : draft.own)
    if (std::ranges::binary_search(used, own.node)) effective.push_back(own);
  return effective;
}

void refuse_idle_parameters(const MechanismDraft& draft) {
  const std::vector<LimbParameter> effective = effective_parameters(draft);
  const std::vector<std::string> limbs = names_of(draft.limbs);
  for (const OwnParameter& own : draft.own) {
    if (!contains(limbs, own.limb))
      throw ConfigError(own.place, "the unknown limb '" + own.limb + "' of " + own.name(), "one of " + join(limbs),
                        nearest_name(own.limb, limbs));
    if (!own.may_be_idle && std::ranges::find(effective, own.name(), &LimbParameter::name) == effective.end())
      throw ConfigError(
          own.place, own.name() + " has no effect: no joint or limit of " + own.limb + " depends on " + own.parameter);
  }
}

}  // namespace pkm
