// [modes]: signs that formulas know, and the working modes that they make with the limbs' branches.

#include <algorithm>

#include "engine/setup/mechanism_draft.hpp"
#include "engine/setup/sections.hpp"

namespace pkm {

using limbs::Term;

void read_modes(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find("modes");
  if (!all) return;
  all->expect_table("a table [modes] of signs: e1 = [\"+\", \"-\"]");
  for (const std::string& name : all->keys()) {
    constexpr const char* kExpected = "[\"+\"], [\"-\"], [\"+\", \"-\"] or [\"-\", \"+\"], the usual sign first";
    const ConfigValue value = *all->find(name);
    const auto signs = value.elements(kExpected);
    if (signs.empty() || signs.size() > 2) throw value.error(kExpected);
    const char first = signs[0].word({"+", "-"})[0];
    if (signs.size() == 2 && signs[1].word({"+", "-"})[0] == first) throw value.error(kExpected);
    const Term sign = value.explained([&] { return draft.add_sign(first, signs.size() == 2); });
    draft.scope.add(value, name, sign.node());
  }
}

void refuse_idle_signs(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find("modes");
  if (!all) return;
  described::Model& model = draft.model;
  std::vector<graph::Node> used = model.joints;
  for (const described::Result& margin : model.margins) used.push_back(margin.node);
  used = model.graph.reachable(used);
  for (std::size_t i = 0; i < all->keys().size(); ++i) {
    const std::string& name = all->keys()[i];
    if (!std::ranges::binary_search(used, model.graph.input(model.inputs.sign(i))))
      throw all->find(name)->refusal("no formula of a joint or a margin has the sign '" + name + "'");
  }
}

void list_modes(MechanismDraft& draft) {
  described::Model& model = draft.model;
  const std::size_t signs = draft.sign_choices.size();
  std::vector<std::size_t> choice(signs, 0);
  for (bool more = true; more;) {
    std::string name;
    std::vector<double> values;
    for (std::size_t i = 0; i < signs; ++i) {
      const char sign = draft.sign_choices[i][choice[i]];
      name += (i > 0 ? "," : "") + std::string(1, sign);
      values.push_back(sign == '+' ? 1 : -1);
    }
    model.info.modes.push_back(name.empty() ? "unique" : name);
    model.signs.push_back(values);
    more = false;
    for (std::size_t i = signs; i-- > 0 && !more;) {
      more = ++choice[i] < draft.sign_choices[i].size();
      if (!more) choice[i] = 0;
    }
  }
}

}  // namespace pkm
