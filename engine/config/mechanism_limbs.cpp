// Reads the [[limb]] tables: copies, end points, ranges, angles of passive joints.

#include <algorithm>
#include <cmath>

#include "engine/config/mechanism_chains.hpp"
#include "engine/config/mechanism_keys.hpp"
#include "engine/config/mechanism_limb.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

using limbs::Rotation, limbs::Term, limbs::Vector3;

const std::vector<std::string> kParts = {"cylinder", "piston", "crank", "slider", "first_link", "second_link", "rod"};

std::vector<std::string> names_of_drives() {
  std::vector<std::string> words;
  for (const TableVariant& variant : limb_keys().variants) words.push_back(variant.word);
  return words;
}

/// Reads the table of a limb as described by limb_keys(). Refuses keys for the mass of parts that the limb does not
/// have.
ConfigValue limb_table(const ConfigValue& table) {
  const std::string& drive = table.choice("drive", names_of_drives());
  if (const auto copies = table.find("copies"); copies && drive == "formula")
    throw copies->refusal("a limb with drive = \"formula\" cannot be copied; list its joints in `joints`");
  const std::vector<std::string> parts = parts_of_limb(table, drive);
  const auto is_absent = [&](const std::string& key) {
    return std::ranges::any_of(kParts, [&](const std::string& part) {
      return key.starts_with(part + "_") && std::ranges::find(parts, part) == parts.end();
    });
  };
  std::vector<std::string> keys = names_of(limb_keys().keys);
  for (const TableVariant& variant : limb_keys().variants)
    if (variant.word == drive)
      for (const OptionSpec& key : variant.keys)
        if (!is_absent(key.name)) keys.push_back(key.name);
  table.allow(keys);
  return table.table();
}

void refuse_known(const ConfigValue& table, const std::string& name, const MechanismDraft& draft) {
  for (const NamedLimb& limb : draft.limbs)
    if (limb.name == name || limb.group == name)
      throw table.find("name")->refusal("there is already a limb called '" + name + "'");
}

/// Reads the rotation matrix of each copy of a limb; if the limb has no copies, the result contains only the identity.
std::vector<Rotation> turns_of(const ConfigValue& table, MechanismDraft& draft) {
  const auto number = [&draft](double x) { return Term(draft.model.graph, x); };
  const auto given = table.find("copies");
  const auto copies = given && given->is_table() ? table.find_table("copies") : std::nullopt;
  if (!copies) return {limbs::rotation_about(2, number(0), number(1))};
  const auto about = static_cast<std::size_t>(copies->at("about", "an axis, \"x\", \"y\" or \"z\"").word()[0] - 'x');
  std::vector<double> angles;
  if (const auto list = copies->find("angles")) {
    if (const auto both = copies->find("number")) throw both->refusal("give either `number` or `angles`, not both");
    for (const ConfigValue& angle : list->elements("a list of angles")) angles.push_back(angle.number());
    if (angles.empty()) throw list->error("at least one angle");
  } else {
    const std::int64_t count = copies->at("number", "the number of copies, 1 to 8").integer();
    for (std::int64_t i = 0; i < count; ++i)
      angles.push_back(2 * kPi * static_cast<double>(i) / static_cast<double>(count));
  }
  std::vector<Rotation> turns;
  turns.reserve(angles.size());
  for (const double angle : angles) turns.push_back(rotation_by(about, number(angle)));
  return turns;
}

/// The frames in which the copies of a limb have one of their ends.
/// @param key    "base_in" or "platform_in": the name of a frame, or a list of names, one for each copy
/// @param usual  the frame that is used if the key is absent
std::vector<const NamedFrame*> frames_of(const ConfigValue& table, const char* key, const char* usual,
                                         std::size_t copies, const MechanismDraft& draft) {
  const auto given = table.find(key);
  if (!given) return std::vector(copies, &draft.frames.at(usual));
  const auto frame = [&](const ConfigValue& value) { return &draft.frames.at(value.word(draft.frame_names)); };
  if (!given->is_list()) return std::vector(copies, frame(*given));
  const std::string expected = "a frame, or a list of frames, one for each of the " + std::to_string(copies) + " limbs";
  const std::vector<ConfigValue> elements = given->elements(expected);
  if (elements.size() != copies) throw given->error(expected);
  std::vector<const NamedFrame*> found;
  for (const ConfigValue& element : elements) found.push_back(frame(element));
  return found;
}

/// The tables that contain the points `base` and `platform`: those of a list of `copies`, or that of the limb itself.
std::vector<ConfigValue> ends_of(const ConfigValue& table) {
  const auto copies = table.find("copies");
  if (!copies || !copies->is_list()) return {table};
  for (const char* const key : {"base", "platform", "end"})
    if (const auto both = table.find(key))
      throw both->refusal(std::string("`") + key + "` is in each table of `copies`; give it either there or here");
  std::vector<ConfigValue> ends;
  for (const ConfigValue& element : copies->elements()) ends.push_back(element.table());
  if (ends.empty()) throw copies->error("at least one table { base = [..], platform = [..] }");
  return ends;
}

/// The tables of the copies of a limb: the limb's table, to which the tables of a list of `copies` add their other
/// keys.
/// @param ends  result of ends_of()
std::vector<ConfigValue> tables_of(const ConfigValue& table, const std::vector<ConfigValue>& ends,
                                   MechanismDraft& draft) {
  const auto copies = table.find("copies");
  if (!copies || !copies->is_list()) return {table};
  std::vector<ConfigValue> tables;
  for (const ConfigValue& own : ends) {
    TomlValue both = table.toml();
    for (const std::string& key : own.keys()) {
      if (const auto common = table.find(key))
        throw common->refusal("`" + key + "` is also in a table of `copies`; give it either there or here");
      if (key != "base" && key != "platform") set_key(both, key, own.find(key)->toml());
    }
    const SourceLocation place = table.place();
    const ConfigValue merged(draft.rewritten.emplace_back(std::move(both)), place.file, place.key);
    tables.push_back(merged.described_by(limb_keys()));
  }
  return tables;
}

bool on_platform(const ConfigValue& table, const std::string& key) { return table.word_at(key) == "platform"; }

limbs::Ends read_ends(const LimbCopy& copy) {
  const ConfigValue& table = copy.table;
  MechanismDraft& draft = copy.draft;
  const auto end = table.find("end");
  for (const char* const key : {"platform", "platform_in"})
    if (const auto both = table.find(key); both && end)
      throw both->refusal(
          "give the end point either by `platform` (in the platform's or another frame) or by `end` (in the base's), "
          "not both");
  const Vector3 base =
      copy.base.at.origin +
      copy.base.at.rotation *
          (copy.turn * draft.scope.point_of_design(copy.ends.at("base", "the base point [x, y, z]"), copy.group));
  const auto reached = [&] {
    if (end) {
      if (table.has("copies"))
        throw end->refusal(
            "a limb with `copies` needs `platform` instead of `end`, which is a single point in the base's frame");
      return draft.scope.point(*end, copy.group);
    }
    const ConfigValue platform = copy.ends.at("platform", "the platform's point [x, y, z]");
    return copy.platform.at.origin +
           copy.platform.at.rotation * (copy.turn * draft.scope.point_of_design(platform, copy.group));
  };
  limbs::Ends ends{.A = base, .B = reached(), .across = {}};
  if (const auto across = table.find("across")) {
    ends.across = copy.direction(*across, on_platform(table, "across_in"));
    draft.in_planes.push_back({*across, ends.A, ends.B, *ends.across});
  }
  return ends;
}

/// Adds the angle between the rod and the axis of a passive joint at one of its ends, and the limits of this angle.
void add_passive_joint(const LimbCopy& copy, const char* key, const char* called, const Vector3& from,
                       const Vector3& to) {
  const auto table = copy.table.find_table(key);
  if (!table) return;
  MechanismDraft& draft = copy.draft;
  const Vector3 axis = copy.direction(table->at("axis", "an axis [x, y, z]"), on_platform(*table, "in"));
  const Vector3 rod = to - from;
  const Term angle = acos(dot(rod, axis) / limbs::length(rod));
  const std::string what = copy.name + called;
  draft.model.angles.push_back({what, "rad", angle.node()});
  const auto limit = [&](const char* end, const auto& margin) {
    if (const auto value = table->find(end))
      draft.model.margins.push_back(
          {what + " " + end, "rad", margin(draft.scope.of_design(*value, "rad", copy.name)).node()});
  };
  limit("min", [&](const Term& least) { return angle - least; });
  limit("max", [&](const Term& greatest) { return greatest - angle; });
  draft.scope.mark_as_defined(angle.node());
}

/// Whether a frame rotates relative to another one.
bool rotates(const NamedFrame& frame, const NamedFrame& other) {
  const Rotation &A = other.at.rotation, &B = frame.at.rotation;
  const auto is_same_row = [](const Vector3& a, const Vector3& b) { return nodes(a) == nodes(b); };
  if (std::ranges::equal(A, B, is_same_row)) return false;
  return std::ranges::any_of(expression::elements(expression::transpose(A) * B),
                             [](const Term& term) { return depends_on_pose(term.graph(), term.node()); });
}

/// Reads the vector from the middle of a pair of rods to one of them; std::nullopt for a single rod.
std::optional<Vector3> read_pair(const LimbCopy& copy, const NamedLimb& limb) {
  const auto pair = copy.table.find_table("pair");
  if (!pair) return {};
  const bool is_crank = copy.drive == "crank";
  if (limb.revolute || !copy.table.has("rod"))
    throw pair->refusal("`pair` requires a `rod` with ball joints at its ends, without `across`");
  const auto along = pair->find("along");
  if (is_crank && along)
    throw along->refusal("the rods of a crank's pair are always spaced along the crank's axis; remove `along`");
  if (limb.end_on == copy.platform.body && rotates(copy.platform, copy.base))
    throw pair->refusal("the rods of a pair stay parallel only if the " +
                        (copy.platform.name == kPlatformFrame ? "platform" : "frame " + copy.platform.name) +
                        " does not rotate, but it rotates");
  const Vector3 side =
      is_crank ? *limb.axis : copy.direction(pair->at("along", "the direction from one rod to the other"));
  return side * (copy.draft.scope.positive(pair->at("spacing", "the rods' distance"), "m", copy.name) * 0.5);
}

/// Collects the properties of a limb that other tables can refer to: points, parts, and the axes of its joints.
NamedLimb named(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& driven) {
  const ConfigValue& table = copy.table;
  NamedLimb limb{.name = copy.name,
                 .group = copy.group,
                 .points = {{"A", at.A}, {"B", at.B}, {"C", driven.C}, {"S", driven.S}},
                 .parts = read_parts(copy, at, driven),
                 .drive = copy.drive,
                 .joint = copy.draft.model.joints.size() - 1,
                 .axis = driven.e,
                 .revolute = table.has("links") ? driven.e : at.across,
                 .has_rod = copy.drive != "slider" || table.has("rod"),
                 .has_links = table.has("links")};
  if (copy.chain && copy.chain->driven != copy.chain->usual) limb.driven = copy.chain->driven;
  limb.ends_in_ball = copy.chain && limb.revolute && copy.chain->joints.back() == 'S';
  if (copy.chain) describe_base_joint(copy, limb);
  const auto end_on = table.find("end_on");
  if (end_on && !table.has("end"))
    throw end_on->refusal("`end_on` requires `end`; a limb that ends at `platform` is attached to the platform");
  limb.begin_on = copy.base.body;
  limb.end_on = end_on             ? end_on->text("\"platform\" or the name of a body")
                : table.has("end") ? ""
                                   : copy.platform.body;
  limb.beside = read_pair(copy, limb);
  if (const auto universal = table.find("universal")) {
    if (!limb.has_rod || limb.revolute || limb.beside)
      throw universal->refusal("`universal` requires a single rod or leg, without `across`, `pair` or `links`");
    limb.universal = {copy.direction(*universal), copy.direction(*universal, limb.end_on == copy.platform.body)};
  }
  return limb;
}

/// Adds alternative forms of the constraints of a limb, which workspace analyses can use instead: the annulus or path
/// that it reaches, and the range of its crank.
/// @param has_range  true if the last two margins of the model are those of the joint's range
void add_equivalent_constraints(const limbs::Limb& limb, bool has_range, generic::Model& model) {
  std::vector<expression::Node> constraints;
  for (const limbs::Constraint& constraint : limb.constraints) constraints.push_back(constraint.margin.node());
  if (limb.annulus) {
    generic::AnnulusNodes annulus{{(*limb.annulus)[0].node(), (*limb.annulus)[1].node()}, constraints, {}};
    if (limb.crank_range) annulus.crank_range = model.crank_ranges.size();
    model.annuli.push_back(annulus);
  }
  if (!has_range) return;
  for (std::size_t i = model.margins.size() - 2; i < model.margins.size(); ++i)
    constraints.push_back(model.margins[i].node);
  if (limb.path) {
    const limbs::RodAndPath& path = *limb.path;
    model.paths.push_back({path.is_circle, nodes(path.v), nodes(path.axis), nodes(path.zero), path.crank.node(),
                           path.rod.node(), path.branch.node(), model.ranges.back().from, model.ranges.back().to,
                           constraints});
  }
  if (limb.crank_range) {
    const limbs::CrankRange& r = *limb.crank_range;
    model.crank_ranges.push_back({r.at_min.node(), r.at_max.node(), r.after_min.node(), r.before_max.node(),
                                  r.half_turn.node(), r.reach.node(), r.branch.node(), constraints});
  }
}

void add_limb(const LimbCopy& copy, const std::string& joint, const limbs::Ends& at, const DrivenLimb& limb) {
  MechanismDraft& draft = copy.draft;
  generic::Model& model = draft.model;
  for (const limbs::Constraint& constraint : limb.constraints) {
    model.domains.push_back({copy.name + " " + constraint.name, constraint.unit, constraint.margin.node(),
                             copy.name + " cannot reach the pose"});
    draft.scope.mark_as_defined(constraint.margin.node());
  }
  const Term q = limb.driven.value_or(limb.joint);
  draft.scope.mark_as_defined(q.node());
  draft.scope.mark_as_defined(limb.C[0].node());
  draft.scope.add(copy.table, joint, q.node());
  model.joints.push_back(q.node());
  model.closures.push_back(limb.closure.node());
  model.info.closed_forms.push_back(copy.drive + ": " + limb.form);
  add_range(copy.chain ? copy.chain->table : copy.table, copy.group, joint, model.info.joints.back().unit, q, draft);
  add_equivalent_constraints(limb, copy.table.has("range"), model);
  if ((copy.drive != "slider" || copy.table.has("rod")) && !copy.moves())
    model.rods.push_back({nodes(limb.C), nodes(at.B)});
  add_passive_joint(copy, "joint_base", " base angle", limb.C, at.B);
  add_passive_joint(copy, "joint_platform", " platform angle", at.B, limb.C);
  draft.limbs.push_back(named(copy, at, limb));
  for (const auto& [point, place] : draft.limbs.back().points) draft.scope.add_member(copy.name + "." + point, place);
  read_tension(copy.table, draft.limbs.back(), draft);
  read_elasticity(copy.table, draft.limbs.back(), draft);
  for (const LimbPart& part : draft.limbs.back().parts) add_part_body(copy.table, copy.name, part, draft);
  add_limb_links(copy, at, limb);
  add_reach(copy, at, limb);
}

/// Reads one copy of a limb.
/// @param number  suffix of the copy's name; "": there are no copies
void read_copy(const LimbCopy& copy, const std::string& number) {
  refuse_known(copy.table, copy.name, copy.draft);
  if (!copy.table.has("end") && copy.base.body == copy.platform.body)
    throw copy.table.refusal("both ends of the limb are in frames of one body, " + copy.base.body + ": " +
                             copy.base.name + " and " + copy.platform.name);
  const auto given = copy.table.find("joint_name");
  const std::string joint = given ? given->text("the joint's name") + number : copy.name;
  if (copy.drive == "chain")
    return copy.chain->is_spherical() ? read_spherical_limb(copy, joint) : read_solved_limb(copy, joint);
  const limbs::Ends at = read_ends(copy);
  const char* const unit = copy.chain ? copy.chain->unit(copy.chain->driven) : copy.drive == "crank" ? "rad" : "m";
  const Term q = add_joint_variable(copy.table, joint, unit, copy.draft);
  DrivenLimb driven = read_drive(copy, at, q);
  const ChainJoints joints = copy.chain ? find_chain_joints(copy, at, q, driven) : ChainJoints();
  add_limb(copy, joint, at, driven);
  if (copy.chain) name_chain_joints(copy, joints);
}

void read_limb(const ConfigValue& value, MechanismDraft& draft) {
  const ConfigValue table = limb_table(value);
  const std::string name = table.at("name", "the limb's name").text("the limb's name");
  const std::string drive = table.at("drive").word();
  refuse_known(table, name, draft);
  if (drive == "formula")
    return read_as_limb(
        name, [&] { read_formula_limb(table, name, draft); }, draft);
  const std::vector<Rotation> turns = turns_of(table, draft);
  const std::vector<ConfigValue> ends = ends_of(table);
  std::vector<ConfigValue> tables = tables_of(table, ends, draft);
  std::vector<Chain> chains;
  if (drive == "chain")
    for (ConfigValue& each : tables) {
      chains.push_back(read_chain(each));
      if (chains.back().is_rewritten()) each = rewritten(chains.back(), draft);
    }
  const std::size_t copies = ends.size() * turns.size();
  const auto base = frames_of(table, "base_in", kBaseFrame, copies, draft),
             platform = frames_of(table, "platform_in", kPlatformFrame, copies, draft);
  for (std::size_t i = 0; i < copies; ++i) {
    const std::string number = table.has("copies") ? std::to_string(i + 1) : "";
    const std::size_t k = i / turns.size();
    const LimbCopy copy{tables[k],
                        draft,
                        chains.empty() ? drive : chains[k].drive,
                        name,
                        name + number,
                        turns[i % turns.size()],
                        *base[i],
                        *platform[i],
                        ends[k],
                        chains.empty() ? nullptr : &chains[k]};
    read_as_limb(
        copy.name, [&] { read_copy(copy, number); }, draft);
  }
}

}  // namespace

void read_limbs(const ConfigValue& root, MechanismDraft& draft) {
  const std::string expected = "a list of tables, each written [[limb]]";
  const auto list = root.find("limb");
  const auto tables = list ? list->elements(expected) : std::vector<ConfigValue>();
  for (const ConfigValue& table : tables) table.expect_table(expected);
  if (tables.empty()) throw root.refusal("a mechanism needs at least one [[limb]], which defines its joints");
  for (const ConfigValue& table : tables) table.explained([&] { read_limb(table, draft); });
}

}  // namespace pkm
