// Reads the tables [[link]], which define links in addition to those of the limbs, and adds the limit on the clearance
// of all links.

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/generic/clearance.hpp"

namespace pkm {

using limbs::Term, limbs::Vector3;

std::vector<LimbPart> read_links(const ConfigValue& root, MechanismDraft& draft) {
  std::vector<LimbPart> links;
  for (const ConfigValue& table : root.tables("link")) {
    const std::string& name = table.at("name", "the link's name").text("the link's name");
    const Vector3 from = draft.scope.point(table.at("from", "a point"), name),
                  to = draft.scope.point(table.at("to", "a point"), name);
    const Term radius = draft.scope.positive(table.at("radius", "the link's radius"), "m", name, true);
    const auto moves = [](const Vector3& end) {
      return std::ranges::any_of(end, [](const Term& x) { return depends_on_pose(x.graph(), x.node()); });
    };
    std::string part = moves(from) || moves(to) ? name : kFramePart;  // without a group
    // Names of the groups of the link; the name of a limb with copies stands for all its copies.
    std::vector<std::string> in, copies;
    if (const auto group = table.find("group")) {
      constexpr const char* kExpected = "a name or a list of names";
      const auto groups = group->is_list() ? group->elements(kExpected) : std::vector{*group};
      if (groups.empty()) throw group->error(kExpected);
      for (const ConfigValue& each : groups) {
        in.push_back(each.text(kExpected));
        for (const NamedLimb& limb : draft.limbs)
          if (limb.group == in.back() && limb.name != in.back()) copies.push_back(limb.name);
      }
      part = in.front();
      in.insert(in.end(), copies.begin(), copies.end());
    }
    draft.model.links.push_back({.name = name,
                                 .part = part,
                                 .from = nodes(from),
                                 .to = nodes(to),
                                 .radius = radius.node(),
                                 .groups = in,
                                 .has_clearance = table.flag_at("clearance")});
    add_link_body(table, name, from, to, draft);
    links.push_back({.name = name, .from = from, .to = to, .line = to - from});
  }
  return links;
}

void add_clearance(MechanismDraft& draft) {
  generic::Model& model = draft.model;
  model.link_pairs = generic::pairs_to_keep_clear(model.graph, model.links);
  model.moving_links = generic::moving_links(model.graph, model.links);
  if (model.link_pairs.empty()) return;
  model.clearance_limit = model.info.limits.size();
  model.info.limits.push_back({generic::kClearanceLimit, "m", kInactiveClearance, kInactiveClearance, 100, "clearance",
                               "", "minimum distance of links that are not joined; < 0: permitted overlap"});
  model.derived.emplace_back();
  model.limit_parameters.emplace_back();
}

}  // namespace pkm
