// Reads the table [modes]: signs that formulas use and that, together with the branches of the limbs, select the
// working mode.

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"

namespace pkm {

using limbs::Term;

namespace {

constexpr const char* kSigns = "[\"+\"], [\"-\"], [\"+\", \"-\"] or [\"-\", \"+\"], the default first";

/// Reads the words that stand for the values of a sign ('+', '-') in the names of working modes.
void read_names(const ConfigValue& table, SignChoice& choice) {
  choice.is_branch = table.flag_at("branch");
  const auto names = table.find("names");
  if (!names) return;
  constexpr const char* kNames = "a different name for each sign, of letters, digits, '-' and '_'";
  const auto elements = names->elements(kNames);
  if (elements.size() != choice.names.size()) throw names->error(kNames);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string& name = elements[i].text(kNames);
    if (name.empty() || !std::ranges::all_of(name, [](char c) {
          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
        }))
      throw elements[i].error(kNames);
    choice.names[i] = name;
  }
  if (choice.names.size() == 2 && choice.names[0] == choice.names[1]) throw names->error(kNames);
}

}  // namespace

void read_modes(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find_table("modes");
  if (!all) return;
  for (const std::string& name : all->keys()) {
    const bool is_named = all->find(name)->is_table();
    const ConfigValue value = is_named ? *all->find_table(name) : *all->find(name);
    const ConfigValue list = is_named ? value.at("signs", kSigns) : value;
    const auto signs = list.elements(kSigns);
    if (signs.empty() || signs.size() > 2) throw list.error(kSigns);
    const char first = signs[0].word()[0];
    if (signs.size() == 2 && signs[1].word()[0] == first) throw list.error(kSigns);
    const Term sign = value.explained([&] { return draft.add_sign(first, signs.size() == 2); });
    draft.scope.add(value, name, sign.node());
    if (is_named) read_names(value, draft.sign_choices.back());
    for (const SignChoice& other : draft.sign_choices)
      if (&other != &draft.sign_choices.back() && other.is_branch && draft.sign_choices.back().is_branch)
        throw value.refusal("at most one sign may have branch = true");
  }
}

void refuse_idle_signs(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find("modes");
  if (!all) return;
  generic::Model& model = draft.model;
  std::vector<expression::Node> used = model.joints;
  for (const generic::Result& margin : model.margins) used.push_back(margin.node);
  used = model.graph.reachable(used);
  for (std::size_t i = 0; i < all->keys().size(); ++i) {
    const std::string& name = all->keys()[i];
    if (!std::ranges::binary_search(used, model.graph.input(model.inputs.sign(i))))
      throw all->find(name)->refusal("the sign '" + name +
                                     "' has no effect: no formula of a joint or a margin uses it");
  }
}

void list_modes(MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const std::size_t signs = draft.sign_choices.size();
  std::vector<std::size_t> choice(signs, 0);
  for (bool more = true; more;) {
    std::string name, branch;
    std::vector<double> values;
    for (std::size_t i = 0; i < signs; ++i) {
      const SignChoice& sign = draft.sign_choices[i];
      const std::string& value = sign.names[choice[i]];
      if (!sign.is_branch)
        name += (name.empty() ? "" : ",") + value;
      else if (choice[i] > 0)
        branch = "/" + value;
      values.push_back(sign.signs[choice[i]] == '+' ? 1 : -1);
    }
    model.info.modes.push_back((name.empty() ? "unique" : name) + branch);
    model.signs.push_back(values);
    more = false;
    for (std::size_t i = signs; i-- > 0 && !more;) {
      more = ++choice[i] < draft.sign_choices[i].signs.size();
      if (!more) choice[i] = 0;
    }
  }
  for (const SignChoice& sign : draft.sign_choices)
    if (sign.is_branch) model.info.branches = sign.names;
}

}  // namespace pkm
