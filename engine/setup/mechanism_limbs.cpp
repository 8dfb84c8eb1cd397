// [[limb]]: closed forms, copies, branches, ranges, angles of passive joints, what is drawn.

#include <algorithm>
#include <cmath>

#include "engine/core/unit.hpp"
#include "engine/setup/mechanism_draft.hpp"
#include "engine/setup/sections.hpp"

namespace pkm {
namespace {

using described::Inputs;
using limbs::Limb, limbs::Rotation, limbs::Term, limbs::Vector3;

const std::vector<std::string> kDrives = {"telescope", "slider", "crank", "formula"};
const std::vector<std::string> kOfAll = {"name", "drive", "range"};

/// Reads limbs of one table: itself, or its copies.
class LimbReader {
 public:
  LimbReader(const ConfigValue& table, MechanismDraft& draft)
      : table_(table),
        draft_(draft),
        name_(table.at("name", "the limb's name").text("the limb's name")),
        drive_(type_of(table, "drive", kDrives)) {}

  void read() {
    allow_keys();
    refuse_known(name_);
    if (drive_ == "formula")
      return read_as_limb(
          name_, [&] { read_formulas(); }, draft_);
    for (const Rotation& copy : copies()) {
      const std::string name = is_copied_ ? name_ + std::to_string(++copies_read_) : name_;
      read_as_limb(
          name, [&] { read_copy(name, copy); }, draft_);
    }
  }

 private:
  void allow_keys() const {
    std::vector<std::string> keys = kOfAll;
    const auto also = [&keys](std::initializer_list<const char*> more) {
      keys.insert(keys.end(), more.begin(), more.end());
    };
    if (drive_ == "formula") {
      if (const auto copies = table_.find("copies"))
        throw copies->refusal("a limb of formulas has no copies; it may have several joints");
      also({"joints", "joint", "unit"});
    } else {
      also({"copies", "base", "platform", "end", "across", "across_in", "radius", "joint_base", "joint_platform",
            "joint_name", "end_on"});
      for (const std::string& part : names_of_parts()) {
        const std::vector<std::string> of_mass = mass_keys(part);
        keys.insert(keys.end(), of_mass.begin(), of_mass.end());
      }
    }
    if (drive_ == "slider") also({"direction", "along", "rod", "links", "axis", "branch", "pair"});
    if (drive_ == "crank") also({"axis", "zero", "crank", "rod", "branch", "pair"});
    table_.allow(keys);
  }

  Term zero() const { return draft_.zero(); }
  Term number(double x) const { return {draft_.model.graph, x}; }
  Term length(const char* key, const char* expected) const {
    return draft_.scope.positive(table_.at(key, expected), "m", name_);
  }

  /// How each copy is turned in its frames.
  std::vector<Rotation> copies() {
    const Rotation none = limbs::turn_about(2, zero(), number(1));
    const auto copies = table_.find("copies");
    if (!copies) return {none};
    copies->expect_table("a table { number = .., about = \"z\" }").allow({"number", "angles", "about"});
    about_ =
        static_cast<std::size_t>(copies->at("about", "an axis, \"x\", \"y\" or \"z\"").word({"x", "y", "z"})[0] - 'x');
    std::vector<double> angles;
    if (const auto list = copies->find("angles")) {
      if (const auto both = copies->find("number")) throw both->refusal("copies have a number or angles, not both");
      for (const ConfigValue& angle : list->elements("a list of angles")) angles.push_back(angle.number("rad"));
      if (angles.empty()) throw list->error("at least one angle");
    } else {
      const std::int64_t number = copies->at("number", "how many copies, 1 to 8").integer(1, 8);
      for (std::int64_t i = 0; i < number; ++i)
        angles.push_back(2 * kPi * static_cast<double>(i) / static_cast<double>(number));
    }
    is_copied_ = true;
    std::vector<Rotation> turns;
    for (const double angle : angles) {
      const auto [sine, cosine] = sincos(angle);
      const auto exact = [](double x) {
        return std::fabs(x) < 1e-15 ? 0 : std::fabs(std::fabs(x) - 1) < 1e-15 ? std::round(x) : x;
      };
      turns.push_back(limbs::turn_about(about_, number(exact(sine)), number(exact(cosine))));
    }
    return turns;
  }

  /// A direction, turned with its copy; `in` the platform or the base.
  Vector3 direction(const ConfigValue& value, const Rotation& copy, bool on_platform) const {
    const Vector3 turned = copy * draft_.scope.direction(value, name_);
    return on_platform ? draft_.turn * turned : turned;
  }
  bool on_platform(const ConfigValue& table, const std::string& key) const {
    const auto in = table.find(key);
    return in && in->word({"base", "platform"}) == "platform";
  }

  limbs::Ends ends(const Rotation& copy) const {
    if (const auto both = table_.find("platform"); both && table_.has("end"))
      throw both->refusal("a limb ends at `platform` (in the platform's frame) or at `end` (in the base's), not both");
    const Vector3 base = copy * draft_.scope.point_of_design(table_.at("base", "the base point [x, y, z]"), name_);
    Vector3 B = base;
    if (const auto end = table_.find("end")) {
      if (is_copied_) throw end->refusal("copies end at `platform`; `end` is one point of the base's frame");
      B = draft_.scope.point(*end, name_);
    } else {
      const ConfigValue platform = table_.at("platform", "the platform's point [x, y, z]");
      B = draft_.origin + draft_.turn * (copy * draft_.scope.point_of_design(platform, name_));
    }
    limbs::Ends ends{.A = base, .B = B, .across = {}};
    if (const auto across = table_.find("across"))
      ends.across = direction(*across, copy, on_platform(table_, "across_in"));
    return ends;
  }

  /// The sign of a copy's branch.
  Term branch() const {
    const ConfigValue value = table_.at("branch", "\"+\" or \"-\"");
    return draft_.add_sign(value.word({"+", "-"})[0], true);
  }
  /// The input of a new joint.
  Term joint_variable(const std::string& name, const std::string& unit) {
    described::Model& model = draft_.model;
    if (model.inputs.joints == kMostJoints)
      throw table_.refusal("a mechanism has at most " + std::to_string(kMostJoints) + " joints");
    model.info.joints.push_back({name, unit});
    return model.term(model.graph.input(model.inputs.joint(model.inputs.joints++), Inputs::kJoints));
  }
  void refuse_oblique(const Vector3& a, const Vector3& b, const char* key, const char* other) const {
    if (std::fabs(draft_.scope.at_default(dot(a, b))) > 1e-9)
      throw table_.find(key)->refusal(std::string("`") + key + "` has to be normal to " + other);
  }

  void refuse_known(const std::string& name) const {
    for (const NamedLimb& limb : draft_.limbs)
      if (limb.name == name || limb.group == name)
        throw table_.find("name")->refusal("there is already a limb called '" + name + "'");
  }

  void read_copy(const std::string& name, const Rotation& copy) {
    refuse_known(name);
    std::string joint = name;
    if (const auto given = table_.find("joint_name"))
      joint = given->text("the joint's name") + (is_copied_ ? std::to_string(copies_read_) : "");
    last_copy_ = copy;
    const limbs::Ends at = ends(copy);
    const Term q = joint_variable(joint, drive_ == "crank" ? "rad" : "m");
    std::string form;
    const Limb limb = drive_ == "telescope" ? telescope(at, q, form)
                      : drive_ == "slider"  ? slider(at, copy, q, form)
                                            : crank(at, copy, q, form);
    add(name, joint, limb, at, form);
  }

  Limb telescope(const limbs::Ends& at, const Term& q, std::string& form) const {
    form = "q = |B - A|";
    return limbs::telescope(at, q);
  }

  Limb slider(const limbs::Ends& at, const Rotation& copy, const Term& q, std::string& form) {
    const auto along = table_.find("along");
    if (along && table_.has("direction"))
      throw along->refusal("a slide has a `direction` or, with `links`, runs `along`");
    const ConfigValue way = along ? *along : table_.at("direction", "the slide's direction [x, y, z]");
    const Vector3 e = direction(way, copy, false);
    if (at.across) refuse_oblique(e, *at.across, along ? "along" : "direction", "`across`");
    e_ = e;
    if (const auto links = table_.find("links")) {
      if (const auto rod = table_.find("rod")) throw rod->refusal("a limb has a `rod` or `links`, not both");
      const auto lengths = links->elements("two lengths [l_1, l_2]");
      if (lengths.size() != 2) throw links->error("two lengths [l_1, l_2]");
      const Term l_1 = draft_.scope.positive(lengths[0], "m", name_),
                 l_2 = draft_.scope.positive(lengths[1], "m", name_);
      Vector3 axis = e;
      if (const auto given = table_.find("axis")) axis = direction(*given, copy, false);
      form = "q = (B - A) . e, two links across e";
      beyond_ = l_1 + l_2;
      return limbs::slider_and_links(at, e, axis, l_1, l_2, branch(), q);
    }
    if (!table_.has("rod")) {
      if (const auto sign = table_.find("branch"))
        throw sign->refusal("a slide without rod has one way to reach a pose");
      form = "q = (B - A) . e";
      return limbs::slider(at, e, q);
    }
    const Term rod = length("rod", "the rod's length");
    form = "q = s + branch sqrt(rod^2 - (|v|^2 - s^2)), s = v . e, v = B - A";
    beyond_ = rod;
    return limbs::slider_and_rod(at, e, rod, branch(), q);
  }

  Limb crank(const limbs::Ends& at, const Rotation& copy, const Term& q, std::string& form) {
    const Vector3 axis = direction(table_.at("axis", "the pivot's axis [x, y, z]"), copy, false);
    e_ = axis;
    const Vector3 zero_way = direction(table_.at("zero", "the crank's direction at q = 0, [x, y, z]"), copy, false);
    refuse_oblique(zero_way, axis, "zero", "`axis`");
    if (at.across) {
      refuse_oblique(*at.across, zero_way, "across", "the crank's motion, along its `axis`");
      refuse_oblique(*at.across, cross(axis, zero_way), "across", "the crank's motion, along its `axis`");
    }
    const Term crank = length("crank", "the crank's length"), rod = length("rod", "the rod's length");
    std::optional<std::array<Term, 2>> ends;
    if (const auto range = table_.find("range")) ends = range_of(*range, "rad");
    form = "q = atan2(w, u) + branch acos(k / hypot(u, w)), k = (|v|^2 + crank^2 - rod^2) / (2 crank)";
    beyond_ = crank + rod;
    return limbs::crank_and_rod(at, axis, zero_way, crank, rod, branch(), ends, q);
  }

  std::array<Term, 2> range_of(const ConfigValue& range, const std::string& unit) const {
    constexpr const char* kExpected = "two numbers or formulas [least, greatest]";
    const auto ends = range.elements(kExpected);
    if (ends.size() != 2) throw range.error(kExpected);
    const Term from = draft_.scope.of_design(ends[0], unit, name_), to = draft_.scope.of_design(ends[1], unit, name_);
    draft_.scope.refuse_empty(range, from, to);
    return {from, to};
  }
  void add_range(const std::string& joint, const std::string& unit, const Term& q) {
    const auto range = table_.find("range");
    if (!range) return;
    const auto [from, to] = range_of(*range, unit);
    draft_.model.margins.push_back({joint + " min", unit, (q - from).node()});
    draft_.model.margins.push_back({joint + " max", unit, (to - q).node()});
  }

  /// Angles of the rod with an axis, at its ends.
  void add_passive_joint(const char* key, const std::string& name, const Vector3& from, const Vector3& to) {
    const auto table = table_.find(key);
    if (!table) return;
    table->expect_table("a table { axis = [..], min = .., max = .. }").allow({"axis", "in", "min", "max"});
    const Vector3 axis = direction(table->at("axis", "an axis [x, y, z]"), last_copy_, on_platform(*table, "in"));
    const Vector3 rod = to - from;
    const Term angle = acos(dot(rod, axis) / limbs::length(rod));
    const std::string what = name + (std::string(key) == "joint_base" ? " base angle" : " platform angle");
    draft_.model.angles.push_back({what, "rad", angle.node()});
    const auto limit = [&](const char* end, const auto& margin) {
      if (const auto value = table->find(end))
        draft_.model.margins.push_back(
            {what + " " + end, "rad", margin(draft_.scope.of_design(*value, "rad", name)).node()});
    };
    limit("min", [&](const Term& least) { return angle - least; });
    limit("max", [&](const Term& greatest) { return greatest - angle; });
    draft_.scope.known_to_exist(angle.node());
  }

  void add(const std::string& name, const std::string& joint, const Limb& limb, const limbs::Ends& at,
           const std::string& form) {
    described::Model& model = draft_.model;
    for (const auto& condition : limb.conditions) {
      model.domains.push_back({name + " " + condition.reason, condition.unit, condition.margin.node()});
      draft_.scope.known_to_exist(condition.margin.node());
    }
    draft_.scope.known_to_exist(limb.joint.node());
    draft_.scope.known_to_exist(limb.C[0].node());
    draft_.scope.add(table_, joint, limb.joint.node());
    model.joints.push_back(limb.joint.node());
    model.closures.push_back(limb.closure.node());
    model.info.closed_forms.push_back(drive_ + ": " + form);
    add_range(joint, model.info.joints.back().unit, limb.joint);
    if (limb.crank_range) {
      const limbs::CrankRange& r = *limb.crank_range;
      described::CoveredRange covered{r.at_min.node(),    r.at_max.node(), r.after_min.node(), r.before_max.node(),
                                      r.half_turn.node(), r.reach.node(),  r.branch.node(),    {}};
      for (const auto& condition : limb.conditions) covered.conditions.push_back(condition.margin.node());
      for (std::size_t i = model.margins.size() - 2; i < model.margins.size(); ++i)
        covered.conditions.push_back(model.margins[i].node);
      model.crank_ranges.push_back(covered);
    }
    if (limb.folds) {
      described::CoveredFolds covered{{(*limb.folds)[0].node(), (*limb.folds)[1].node()}, {}, {}};
      for (const auto& condition : limb.conditions) covered.conditions.push_back(condition.margin.node());
      if (limb.crank_range) covered.crank_range = model.crank_ranges.size() - 1;
      model.folds.push_back(covered);
    }
    add_passive_joint("joint_base", name, limb.C, at.B);
    add_passive_joint("joint_platform", name, at.B, limb.C);
    draft_.limbs.push_back({.name = name,
                            .group = name_,
                            .points = {{"A", at.A}, {"B", at.B}, {"C", limb.C}, {"S", limb.S}},
                            .parts = parts(limb, at)});
    add_kind(at, draft_.limbs.back());
    const NamedLimb named = draft_.limbs.back();
    for (const LimbPart& part : named.parts) add_part_body(table_, named.name, part, draft_);
    add_links(name, limb, at);
    add_reach(at, model.info.joints.back().unit);
  }

  /// What its joints are.
  void add_kind(const limbs::Ends& at, NamedLimb& limb) const {
    limb.drive = drive_;
    limb.joint = draft_.model.joints.size() - 1;
    limb.axis = e_;
    limb.revolute = table_.has("links") ? e_ : at.across;
    const auto end_on = table_.find("end_on");
    if (end_on && !table_.has("end"))
      throw end_on->refusal("a limb that ends at `platform` ends on the platform; `end_on` belongs to `end`");
    limb.end_on = end_on ? end_on->text("\"platform\" or the name of a body") : table_.has("end") ? "" : "platform";
    const auto pair = table_.find("pair");
    if (!pair) return;
    const bool is_crank = drive_ == "crank";
    pair->expect_table("a table { spacing = .., along = [x, y, z] }").allow({"spacing", "along"});
    if (limb.revolute || !table_.has("rod"))
      throw pair->refusal("a pair is of rods with ball joints: of a `rod` without `across`");
    const auto along = pair->find("along");
    if (is_crank && along) throw along->refusal("the rods of a pair are side by side along the crank's axis");
    const auto& about = draft_.model.turns_about;
    if (limb.end_on == "platform" && std::ranges::any_of(about, [](const auto& axis) { return axis.has_value(); }))
      throw pair->refusal("a pair of rods stays parallel where the platform does not turn, and this one does");
    const Vector3 side =
        is_crank ? *e_ : direction(pair->at("along", "the direction from one rod to the other"), last_copy_, false);
    limb.beside = side * (draft_.scope.positive(pair->at("spacing", "the rods' distance"), "m", limb.name) * 0.5);
  }

  /// Its bodies, as [[body]] names them.
  std::vector<std::string> names_of_parts() const {
    if (drive_ == "telescope") return {"cylinder", "piston"};
    if (drive_ == "crank") return {"crank", "rod"};
    if (table_.has("links")) return {"slider", "first_link", "second_link"};
    if (table_.has("rod")) return {"slider", "rod"};
    return {"slider"};
  }
  /// The same with their ends.
  std::vector<LimbPart> parts(const Limb& limb, const limbs::Ends& at) {
    if (drive_ == "telescope") {
      const Vector3 v = at.B - at.A, line = (at.across ? v - *at.across * dot(v, *at.across) : v) / limb.joint;
      return {{.name = "cylinder", .from = at.A, .to = at.B, .line = line},
              {.name = "piston", .from = at.A, .to = at.B, .line = line}};
    }
    std::vector<LimbPart> list;
    if (drive_ == "slider") list.push_back({.name = "slider", .from = limb.S, .to = limb.S});
    if (limb.arm) {
      const Term of_arm = drive_ == "crank" ? length("crank", "a length") : link_length(0),
                 of_rod = drive_ == "crank" ? length("rod", "a length") : link_length(1);
      const std::vector<std::string> names = names_of_parts();
      const Vector3 C = limb.S + limb.arm->arm;
      LimbPart::OnArm on_arm{draft_.model.arms.size(), limb.S, of_arm, true};
      add_arm(*limb.arm, at, limb);
      list.push_back({names[names.size() - 2], limb.S, C, of_arm, limb.arm->arm, on_arm});
      on_arm.is_arm = false;
      list.push_back({names.back(), C, at.B, of_rod, limb.arm->rod, on_arm});
    } else if (table_.has("rod")) {
      list.push_back({"rod", limb.S, at.B, length("rod", "a length"), at.B - limb.S});
    }
    return list;
  }
  Term link_length(std::size_t which) const {
    return draft_.scope.of_design(table_.find("links")->elements("two lengths [l_1, l_2]")[which], "m", name_);
  }
  void add_arm(const limbs::Arm& arm, const limbs::Ends& at, const Limb& limb) {
    draft_.model.arms.push_back({nodes(arm.arm), nodes(arm.axis), nodes(arm.rod), nodes(at.B),
                                 drive_ == "crank" ? std::optional(limb.joint.node()) : std::nullopt});
  }

  void add_links(const std::string& name, const Limb& limb, const limbs::Ends& at) {
    const auto radius = table_.find("radius");
    if (!radius) return;
    const Term r = draft_.scope.positive(*radius, "m", name, true);
    const auto link = [&](const std::string& what, const std::string& part, const Vector3& from, const Vector3& to) {
      const std::string& group = part == kPlatformPart ? part : name;
      draft_.model.links.push_back({what + " of " + name, part, nodes(from), nodes(to), r.node(), {group}});
    };
    if (drive_ == "crank") link("crank", name, at.A, limb.C);
    if (table_.has("links")) link("first link", name, limb.S, limb.C);
    if (drive_ == "telescope" || table_.has("rod") || table_.has("links"))
      link(drive_ == "telescope" ? "leg" : table_.has("links") ? "second link" : "rod", name, limb.C, at.B);
    if (const auto range = table_.find("range"); range && drive_ == "slider") {
      const auto [from, to] = range_of(*range, "m");
      link("rail", kFramePart, at.A + *e_ * from, at.A + *e_ * to);
    }
    if (!table_.has("end")) link("platform's arm", kPlatformPart, draft_.origin, at.B);
  }

  /// Where the platform's frame has to be for the limb to reach: a box about A, or about the rail.
  void add_reach(const limbs::Ends& at, const std::string& unit) {
    std::array<std::optional<std::array<Term, 2>>, 3> reach;
    const auto range = table_.find("range");
    std::optional<Term> far = beyond_;
    if (drive_ == "telescope" && range) far = range_of(*range, unit)[1];
    const bool usable =
        far && !at.across && !table_.has("end") && (drive_ != "slider" || (range && !table_.has("links")));
    if (usable) {
      const Vector3 arm = draft_.scope.point(table_.at("platform", "a point"), name_);
      const Term round = *far + limbs::length(arm);
      for (std::size_t i = 0; i < 3; ++i) {
        Term low = at.A[i], high = at.A[i];
        if (drive_ == "slider") {
          const auto [from, to] = range_of(*range, "m");
          const Term a = (*e_)[i] * from, b = (*e_)[i] * to;
          low = low + call(graph::operation("min"), a, b);
          high = high + call(graph::operation("max"), a, b);
        }
        reach[i] = {low - round, high + round};
      }
      draft_.scope.known_to_exist(round.node());
    }
    draft_.reaches.push_back(reach);
  }

  void read_formulas() {
    const auto unit = table_.find("unit");
    const std::string& in = unit ? unit->word({"m", "rad"}) : std::string("m");
    const auto joints = table_.find("joints");
    if (joints && table_.has("joint")) throw joints->refusal("a limb has `joint` or `joints`, not both");
    if (!joints) {
      read_formula(name_, table_.at("joint", "the joint's formula, or joints = { q1 = .., .. }"), in);
    } else {
      joints->expect_table("a table { q1 = formula, .. }");
      if (joints->keys().empty()) throw joints->error("at least one joint");
      for (const std::string& name : joints->keys()) read_formula(name, *joints->find(name), in);
    }
    draft_.limbs.push_back({.name = name_, .group = name_, .points = {}, .parts = {}});
    draft_.reaches.emplace_back();
  }
  void read_formula(const std::string& name, const ConfigValue& text, const std::string& unit) {
    described::Model& model = draft_.model;
    const Term q = joint_variable(name, unit), joint = draft_.scope.formula(text, unit, name);
    model.joints.push_back(joint.node());
    model.closures.push_back((joint - q).node());
    model.info.closed_forms.push_back("formula: " + text.text("a formula").substr(0, 80));
    model.defined.push_back(model.graph.apply(graph::operation("*"), std::array{joint.node(), zero().node()}));
    draft_.scope.add(text, name, joint.node());
    add_range(name, unit, joint);
  }

  const ConfigValue& table_;
  MechanismDraft& draft_;
  std::string name_, drive_;
  std::size_t about_ = 2, copies_read_ = 0;
  bool is_copied_ = false;
  Rotation last_copy_ = limbs::turn_about(2, draft_.zero(), limbs::Term(draft_.model.graph, 1.0));
  std::optional<Vector3> e_;    ///< along the slide, or the crank's axis
  std::optional<Term> beyond_;  ///< how far from A, or from the slide, B can be
};

}  // namespace

Term MechanismDraft::add_sign(char first, bool both) {
  const Term sign = model.term(model.graph.input(model.inputs.sign(model.inputs.signs), Inputs::kDesign));
  if (model.inputs.signs == Inputs::kMostSigns)
    throw std::invalid_argument("a mechanism has at most " + std::to_string(Inputs::kMostSigns) +
                                " signs of its working modes");
  ++model.inputs.signs;
  sign_choices.push_back(first == '+' ? (both ? "+-" : "+") : (both ? "-+" : "-"));
  return sign;
}

void read_limbs(const ConfigValue& root, MechanismDraft& draft) {
  const auto tables = tables_of(root, "limb");
  if (tables.empty()) throw root.refusal("a mechanism needs [[limb]]s: what its joints are");
  for (const ConfigValue& table : tables) table.explained([&] { LimbReader(table, draft).read(); });
}

}  // namespace pkm
