#include "engine/setup/mechanism_file.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/graph/formula_words.hpp"
#include "engine/mechanisms/described/mechanism.hpp"
#include "engine/setup/mechanism_draft.hpp"
#include "engine/setup/sections.hpp"

namespace pkm {
namespace {

using described::Inputs;
using limbs::Term, limbs::Vector3;

const std::vector<std::string> kUnits = {"m", "rad", "kg", "kg m^2", "kg/m", "kg/m^3", "N", "N/m", "N m/rad", "1"};
const std::vector<std::string> kAxes = {"along x", "along y", "along z", "about x", "about y", "about z"};

std::string text_of(const ConfigValue& table, const std::string& key) {
  const auto value = table.find(key);
  return value ? value->text("text") : "";
}

void read_names(const ConfigValue& root, MechanismDraft& draft) {
  const ConfigValue table = root.at("mechanism", "a table [mechanism] with name, title, source");
  table.expect_table("a table [mechanism]").allow({"name", "title", "source"});
  const ConfigValue name = table.at("name", "the mechanism's name");
  draft.model.info.name = name.text("the mechanism's name");
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (draft.model.info.name.empty() || draft.model.info.name.size() > 60 ||
      !std::ranges::all_of(draft.model.info.name, fits))
    throw name.error("a name of at most 60 letters, digits, '-' and '_'");
  draft.model.info.title = text_of(table, "title");
  draft.model.info.source = text_of(table, "source");
}

/// The unit in which a quantity is written: of "200 mm" it is m.
std::string unit_of(const ConfigValue& table) {
  if (const auto unit = table.find("unit")) {
    if (!is_si_unit(unit->text("a unit"))) throw unit->error("a product of SI units: \"m\", \"rad\", \"kg m^2\"");
    return unit->text("a unit");
  }
  const ConfigValue value = table.at("default", "the default, a number or text with a unit: \"200 mm\"");
  if (!value.is_text()) return "1";
  const std::string& text = value.text("a number or text with a unit");
  if (parse_quantity(text, "1")) return "1";
  for (const std::string& unit : kUnits)
    if (parse_quantity(text, unit)) return unit;
  throw value.error("a number, or text with a unit: \"200 mm\", \"40 deg\"; other units by unit = \"..\"");
}

void read_parameters(const ConfigValue& root, MechanismDraft& draft) {
  const ConfigValue all = root.at("parameters", "a table [parameters]: what a design may choose");
  all.expect_table("a table [parameters]");
  if (all.keys().empty()) throw all.error("at least one parameter");
  described::Model& model = draft.model;
  for (const std::string& name : all.keys()) {
    const ConfigValue table = *all.find(name);
    table.expect_table("a table { default = .., min = .., max = .., meaning = .. }")
        .allow({"default", "min", "max", "meaning", "unit"});
    Parameter p;
    p.name = name;
    p.unit = unit_of(table);
    p.lower = table.at("min", "the least value allowed").number(p.unit);
    p.upper = table.at("max", "the greatest value allowed").number(p.unit);
    if (!(p.lower < p.upper)) throw table.find("max")->error("a number above min = " + with_unit(p.lower, p.unit));
    p.nominal = table.at("default", "the default").number(p.unit, p.lower, p.upper);
    p.meaning = text_of(table, "meaning");
    draft.scope.add(table, name, model.graph.input(model.info.parameters.size(), Inputs::kDesign));
    model.info.parameters.push_back(p);
  }
  model.inputs.parameters = model.info.parameters.size();
}

void read_limits(const ConfigValue& root, MechanismDraft& draft) {
  described::Model& model = draft.model;
  const auto tables = tables_of(root, "limit");
  for (const ConfigValue& table : tables) {
    table.allow({"name", "unit", "meaning", "inactive", "min", "max", "derived", "constraint"});
    LimitInfo limit;
    limit.name = table.at("name", "the limit's name").text("the limit's name");
    const Parameter* const parameter = find_named(model.info.parameters, limit.name);
    if (find_named(model.info.limits, limit.name))
      throw table.find("name")->refusal("there is already a limit called '" + limit.name + "'");
    if (parameter) {
      for (const char* key : {"unit", "inactive", "min", "max", "derived"})
        if (const auto given = table.find(key))
          throw given->refusal("a limit that is called like a parameter has its unit, default and range");
      limit.unit = parameter->unit;
      limit.inactive = parameter->nominal;
      limit.lower = parameter->lower;
      limit.upper = parameter->upper;
      limit.meaning = parameter->meaning;
    } else {
      const ConfigValue unit = table.at("unit", "the limit's unit: \"m\", \"rad\", \"1\"");
      if (!is_si_unit(unit.text("a unit"))) throw unit.error("a product of SI units: \"m\", \"rad\", \"1\"");
      limit.unit = unit.text("a unit");
      limit.lower = table.at("min", "the least threshold").number(limit.unit);
      limit.upper = table.at("max", "the greatest threshold").number(limit.unit, limit.lower);
      limit.inactive = table.at("inactive", "the value that cuts nothing").number(limit.unit, limit.lower, limit.upper);
      limit.derivation = text_of(table, "derived");
    }
    if (table.has("meaning")) limit.meaning = text_of(table, "meaning");
    if (const auto owner = table.find("constraint")) limit.group = owner->word({"interference", "singularity-margin"});
    const auto node = model.graph.input(model.inputs.limit(model.inputs.limits++), Inputs::kDesign);
    model.replaced.push_back(
        parameter ? std::optional(static_cast<std::size_t>(parameter - model.info.parameters.data())) : std::nullopt);
    std::optional<graph::Node> derived;
    if (const auto formula = table.find("derived"))
      derived = draft.scope.of_design(*formula, limit.unit, limit.name).node();
    model.derived.push_back(derived);
    parameter ? draft.scope.replace(limit.name, node) : draft.scope.add(table, limit.name, node);
    model.info.limits.push_back(limit);
  }
}

void read_coordinates(const ConfigValue& platform, MechanismDraft& draft) {
  described::Model& model = draft.model;
  const ConfigValue all = platform.at("coordinates", "a table { x = \"along x\", phi = \"about z\", .. }");
  all.expect_table("a table { x = \"along x\", phi = \"about z\", .. }");
  const std::size_t count = all.keys().size();
  if (count < 1 || count > kMostCoordinates) throw all.error("1 to 6 coordinates");
  for (const std::string& name : all.keys()) {
    const ConfigValue value = *all.find(name);
    const std::string& kind = value.word(kAxes);
    const auto axis = static_cast<std::size_t>(kind.back() - 'x');
    const bool turns = kind.starts_with("about");
    const std::size_t i = model.inputs.coordinates++;
    const Term coordinate = model.term(model.graph.input(model.inputs.coordinate(i), Inputs::coordinate_group(i)));
    draft.scope.add(value, name, coordinate.node());
    model.info.coordinates.push_back({name, turns ? "rad" : "m"});
    model.turns_about.push_back(turns ? std::optional(axis) : std::nullopt);
    const graph::Node none = model.graph.number(0);
    model.turn_axes.push_back({none, none, none});
    if (turns) {
      for (std::size_t row = 0; row < 3; ++row) model.turn_axes.back()[row] = draft.turn[row][axis].node();
      if (std::ranges::count_if(model.turns_about, [](const auto& each) { return each.has_value(); }) > 3)
        throw value.refusal("a platform has at most three rotations");
      draft.turn = draft.turn * limbs::turn_about(axis, sin(coordinate), cos(coordinate));
    } else {
      if (!draft.origin[axis].is(0)) throw value.refusal("there is already a coordinate " + kind);
      draft.origin[axis] = coordinate;
    }
  }
}

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

void read_let(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find("let");
  if (!all) return;
  all->expect_table("a table [let] of formulas");
  for (const std::string& name : all->keys()) {
    const ConfigValue value = *all->find(name);
    draft.scope.add(value, name, draft.scope.formula(value, "1", name).node());
  }
}

void read_platform(const ConfigValue& platform, MechanismDraft& draft) {
  described::Model& model = draft.model;
  if (const auto origin = platform.find("origin")) draft.origin = draft.scope.point(*origin, "origin");
  if (const auto length = platform.find("characteristic_length")) {
    model.length = draft.scope.of_design(*length, "m", "characteristic_length").node();
    model.info.characteristic_length = length->is_text() ? length->text("a formula") : shortest(length->number("m"));
  }
  if (const auto radius = platform.find("characteristic_radius"))
    model.radius = draft.scope.of_design(*radius, "m", "characteristic_radius").node();
  const auto turns = std::ranges::count_if(model.info.coordinates, &AxisInfo::turns);
  const bool mixed = turns > 0 && turns < std::ssize(model.info.coordinates);
  if (!mixed && model.info.characteristic_length.empty()) model.info.characteristic_length = "1";  // of no effect
  if (const auto size = platform.find("size")) {
    size->expect_table("a table { formula = .., unit = .., meaning = .. }").allow({"formula", "unit", "meaning"});
    const ConfigValue unit = size->at("unit", "the size's unit: \"m^3\"");
    if (!is_si_unit(unit.text("a unit"))) throw unit.error("a product of SI units: \"m^3\"");
    model.size = {
        draft.scope.of_design(size->at("formula", "a formula of parameters"), unit.text("a unit"), "size").node(),
        unit.text("a unit"), text_of(*size, "meaning")};
  }
  read_platform_body(platform, draft);
}

void read_margins(const ConfigValue& root, MechanismDraft& draft) {
  described::Model& model = draft.model;
  const auto name_of = [](const ConfigValue& table, const auto& others) {
    return new_name(table, "margin", others, "a name for the margin");
  };
  for (const ConfigValue& table : tables_of(root, "margin")) {
    table.allow({"name", "formula", "unit"});
    const std::string name = name_of(table, model.margins), unit = text_of(table, "unit");
    if (!unit.empty() && !is_si_unit(unit)) throw table.find("unit")->error("a product of SI units");
    const Term value = draft.scope.formula(table.at("formula", "a formula that is >= 0 where it holds"),
                                           unit.empty() ? "1" : unit, name);
    model.margins.push_back({name, unit.empty() ? "1" : unit, value.node()});
  }
  for (const ConfigValue& table : tables_of(root, "design")) {
    table.allow({"name", "formula", "unit", "meaning"});
    if (model.tests.size() == kMostDesignTests)
      throw table.refusal("a mechanism has at most " + std::to_string(kMostDesignTests) + " tests of the design");
    const std::string name = name_of(table, model.tests), unit = text_of(table, "unit");
    if (!unit.empty() && !is_si_unit(unit)) throw table.find("unit")->error("a product of SI units");
    constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";
    if (name.find_first_not_of(kLetters) != std::string::npos)
      throw table.find("name")->error("a name of letters, digits, blanks, '-', '_' and '.'");
    const ConfigValue formula = table.at("formula", "a formula of parameters that is >= 0 where it holds");
    model.test_nodes.push_back(draft.scope.of_design(formula, unit.empty() ? "1" : unit, name).node());
    const std::string meaning = text_of(table, "meaning");
    model.tests.push_back(
        {name, unit.empty() ? "1" : unit, meaning.empty() && formula.is_text() ? formula.text("a formula") : meaning});
  }
}

/// Refuses signs that double the working modes for nothing.
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

/// @return  the links as [[body]] names them
std::vector<LimbPart> read_links(const ConfigValue& root, MechanismDraft& draft) {
  std::vector<LimbPart> links;
  for (const ConfigValue& table : tables_of(root, "link")) {
    table.allow({"name", "from", "to", "radius", "group", "mass", "inertia"});
    const std::string& name = table.at("name", "the link's name").text("the link's name");
    const Vector3 from = read_point(table.at("from", "a point"), name, draft),
                  to = read_point(table.at("to", "a point"), name, draft);
    const Term radius = draft.scope.of_design(table.at("radius", "the link's radius"), "m", name);
    std::string part = kFramePart;
    if (const auto group = table.find("group")) {
      constexpr const char* kExpected = "a name or a list of names";
      const auto groups = group->is_list() ? group->elements(kExpected) : std::vector{*group};
      if (groups.empty()) throw group->error(kExpected);
      for (const ConfigValue& each : groups) each.text(kExpected);
      part = groups.front().text(kExpected);
    }
    const auto nodes = [](const Vector3& p) { return std::array{p[0].node(), p[1].node(), p[2].node()}; };
    draft.model.links.push_back({name, part, nodes(from), nodes(to), radius.node()});
    add_link_body(table, name, from, to, draft);
    links.push_back({.name = name, .from = from, .to = to, .line = to - from});
  }
  return links;
}

/// The number of a coordinate that a value names.
int coordinate_named(const ConfigValue& value, const MechanismInfo& info) {
  const std::string& name = value.word(names_of(info.coordinates));
  return static_cast<int>(find_named(info.coordinates, name) - info.coordinates.data());
}

void read_survey(const ConfigValue& root, MechanismDraft& draft) {
  described::Model& model = draft.model;
  const std::size_t count = model.inputs.coordinates;
  model.box.resize(count);
  model.middle.resize(count);
  std::vector<int> swept;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 3); ++i) swept.push_back(static_cast<int>(i));
  const auto survey = root.find("survey");
  if (survey) {
    survey->expect_table("a table [survey]").allow({"sweep", "hold", "box"});
    if (const auto sweep = survey->find("sweep")) {
      swept.clear();
      for (const ConfigValue& each : sweep->elements("one to three coordinates")) {
        swept.push_back(coordinate_named(each, model.info));
        if (std::ranges::count(swept, swept.back()) > 1) throw each.refusal("this coordinate is swept already");
      }
      if (swept.empty() || swept.size() > 3) throw sweep->error("one to three coordinates");
    }
    if (const auto hold = survey->find("hold")) {
      hold->expect_table("a table { phi = 0 }").allow(names_of(model.info.coordinates), "coordinate");
      for (const std::string& name : hold->keys()) {
        const ConfigValue value = *hold->find(name);
        const auto i =
            static_cast<std::size_t>(find_named(model.info.coordinates, name) - model.info.coordinates.data());
        if (std::ranges::find(swept, static_cast<int>(i)) != swept.end())
          throw value.refusal("the coordinate " + name + " is swept; it cannot be held, too");
        model.middle[i] = draft.scope.of_design(value, model.info.coordinates[i].unit, name).node();
      }
    }
    if (const auto box = survey->find("box")) {
      box->expect_table("a table { x = [from, to] }").allow(names_of(model.info.coordinates), "coordinate");
      for (const std::string& name : box->keys()) {
        const ConfigValue range = *box->find(name);
        const auto i =
            static_cast<std::size_t>(find_named(model.info.coordinates, name) - model.info.coordinates.data());
        const auto ends = range.elements("[from, to]");
        if (ends.size() != 2) throw range.error("[from, to]");
        const std::string& unit = model.info.coordinates[i].unit;
        const Term from = draft.scope.of_design(ends[0], unit, name), to = draft.scope.of_design(ends[1], unit, name);
        draft.scope.refuse_empty(range, from, to);
        model.box[i] = {from.node(), to.node()};
      }
    }
  }
  // What the file leaves out: turns once around, places within the reach of all limbs that say theirs.
  for (std::size_t i = 0; i < count; ++i) {
    if (!model.box[i] && model.turns_about[i]) model.box[i] = {model.graph.number(-kPi), model.graph.number(kPi)};
    if (!model.box[i])
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (draft.origin[axis].node() != model.graph.input(model.inputs.coordinate(i))) continue;
        std::optional<std::array<Term, 2>> common;
        for (const auto& reach : draft.reaches)
          if (reach[axis])
            common = common ? std::array{call(graph::operation("max"), (*common)[0], (*reach[axis])[0]),
                                         call(graph::operation("min"), (*common)[1], (*reach[axis])[1])}
                            : *reach[axis];
        const auto of_design = [&](const Term& t) { return (model.graph[t.node()].groups & ~Inputs::kDesign) == 0; };
        if (common && of_design((*common)[0]) && of_design((*common)[1]))
          model.box[i] = {(*common)[0].node(), (*common)[1].node()};
      }
    if (!model.middle[i] && model.box[i])
      model.middle[i] = ((model.term((*model.box[i])[0]) + model.term((*model.box[i])[1])) * 0.5).node();
  }
  model.info.sweeps = all_sweeps(model.info.coordinates, swept);
}

/// All combinations of the signs, the file's first.
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

}  // namespace

Vector3 read_point(const ConfigValue& value, const std::string& what, MechanismDraft& draft) {
  if (!value.is_text()) return draft.scope.point(value, what);
  const std::string& text = value.text("a point");
  std::vector<std::string> known;
  for (const NamedLimb& limb : draft.limbs)
    for (const auto& [point, place] : limb.points) {
      known.push_back(limb.name + "." + point);
      if (known.back() == text) return place;
    }
  throw value.error("[x, y, z] or the point of a limb: " + join(known), nearest_name(text, known));
}

std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name) {
  const TomlValue document = parse_toml(text, file_name, "a mechanism in TOML");
  const ConfigValue root(document, file_name, "");
  if (root.keys().empty())
    throw ConfigError({file_name, 0, ""}, "an empty file",
                      "a mechanism: [mechanism], [parameters], [platform], [[limb]]");
  root.allow({"mechanism", "parameters", "platform", "survey", "modes", "let", "limb", "limit", "margin", "design",
              "link", "body"});
  MechanismDraft draft;
  read_names(root, draft);
  read_parameters(root, draft);
  draft.model.inputs.limits = 0;
  read_limits(root, draft);
  const ConfigValue platform = root.at("platform", "a table [platform] with its coordinates");
  platform.expect_table("a table [platform]")
      .allow({"coordinates", "characteristic_length", "characteristic_radius", "size", "origin", "mass", "centre",
              "inertia"});
  read_coordinates(platform, draft);
  read_modes(root, draft);
  read_let(root, draft);
  read_platform(platform, draft);
  read_limbs(root, draft);
  read_margins(root, draft);
  refuse_idle_signs(root, draft);
  read_bodies(root, read_links(root, draft), draft);
  read_survey(root, draft);
  draft.scope.note_domains();
  list_modes(draft);
  return described::make_mechanism(std::move(draft.model));
}

}  // namespace pkm
