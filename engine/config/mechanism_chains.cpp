#include "engine/config/mechanism_chains.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/mechanism_keys.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/scalar.hpp"

namespace pkm {
namespace {

using limbs::Ends, limbs::Term, limbs::Vector3;

/// A chain with closed-form inverse kinematics.
struct ChainForm {
  const char* joints;
  const char* drive;
  /// For each direction that the chain lists under `axes`, the key of the drive that it becomes; "=": none, because the
  /// direction has to be parallel to the previous one; "": none, because it concerns the forces in the joints alone.
  std::vector<const char*> axes;
  std::vector<const char*> links;  ///< for each length in the chain's list `links`: its key in the rewritten limb
};

const std::vector<ChainForm>& chain_forms() {
  static const std::vector<ChainForm> forms = {
      {"RRR", "crank", {"axis", "=", "="}, {"crank", "rod"}},
      {"RRS", "crank", {"axis", "="}, {"crank", "rod"}},
      {"RUS", "crank", {"axis"}, {"crank", "rod"}},
      {"RSS", "crank", {"axis"}, {"crank", "rod"}},
      {"RUU", "crank", {"axis", "universal"}, {"crank", "rod"}},
      {"PRR", "slider", {"direction", "across", "="}, {"rod"}},
      {"PRRR", "slider", {"along", "=", "=", "="}, {"links", "links"}},
      {"PRS", "slider", {"direction", "across"}, {"rod"}},
      {"PUS", "slider", {"direction"}, {"rod"}},
      {"PSS", "slider", {"direction"}, {"rod"}},
      {"PUU", "slider", {"direction", "universal"}, {"rod"}},
      {"RPR", "telescope", {"across", "="}, {}},
      {"RPS", "telescope", {"across"}, {}},
      {"UPS", "telescope", {}, {}},
      {"SPS", "telescope", {}, {}},
      {"UPU", "telescope", {"universal"}, {}},
      {"SPR", "telescope", {"across"}, {}},
      {"UPR", "telescope", {"", "across"}, {}},
  };
  return forms;
}

const ChainForm& form_of(const Chain& chain) {
  return *std::ranges::find_if(chain_forms(), [&](const ChainForm& form) { return form.joints == chain.joints; });
}

std::string supported_chains() {
  std::vector<std::string> names;
  for (const ChainForm& form : chain_forms()) names.push_back(with_dashes(form.joints));
  return join(names) + ", and R-R-R with `angles`, a spherical chain";
}

TomlValue text_value(const std::string& text, int line) {
  TomlValue value;
  value.kind = TomlValue::Kind::text;
  value.text = text;
  value.line = line;
  value.written = '"' + text + '"';
  return value;
}

/// The element `index` of the list under `key` of a chain, for another key of the limb that replaces the chain.
TomlValue moved(const ConfigValue& element, const char* key, std::size_t index) {
  TomlValue value = element.toml();
  value.key_in_file = std::string(key) + "[" + std::to_string(index + 1) + "]";
  return value;
}

/// The elements of a list, whose number has to be `count`. @param what  what the elements are, for messages
std::vector<ConfigValue> elements_of(const ConfigValue& table, const char* key, std::size_t count,
                                     const std::string& what) {
  if (count == 0) {
    if (const auto given = table.find(key)) throw given->refusal(what);
    return {};
  }
  const ConfigValue list = table.at(key, what);
  const std::vector<ConfigValue> elements = list.elements(what);
  if (elements.size() != count) throw list.error(what);
  return elements;
}

/// Angle from one vector to another about the unit vector n, to which one of them is normal.
Term angle_about(const Vector3& n, const Vector3& from, const Vector3& to) {
  return atan2(dot(n, cross(from, to)), dot(from, to));
}

/// A vector normal to n, rotated about n.
Vector3 rotated(const Vector3& x, const Vector3& n, const Term& angle) {
  return x * cos(angle) + cross(n, x) * sin(angle);
}

/// The plane of the parallel revolute joints of a chain.
struct Plane {
  Vector3 normal, v;  ///< v: vector from A to B, projected onto the plane
  /// Directions in the plane: that of the base from which the angle of the first revolute joint is measured; those of
  /// the links; and, if the last joint is a revolute joint, that of the platform to which its angle is measured.
  std::vector<Vector3> directions;
};

Plane plane_of(const LimbCopy& copy, const Ends& at, const DrivenLimb& limb) {
  const Chain& chain = *copy.chain;
  const bool has_links = copy.table.has("links"), slides = chain.drive == "slider";
  const bool on_platform = chain.is_hinged_at_platform();
  const std::vector<ConfigValue> axes = chain.table.find("axes")->elements("axes");
  const Vector3 n = at.across ? *at.across : copy.direction(axes[1]);
  const auto in_plane = [&n](const Vector3& x) { return x - n * dot(x, n); };
  const ConfigValue zero = slides && !has_links
                               ? axes[0]
                               : chain.table.at("zero",
                                                "the direction, normal to the axis, at which the first revolute joint "
                                                "has the value 0, [x, y, z]");
  Plane plane{n, in_plane(at.B - at.A), {copy.direction(zero, on_platform)}};
  if (std::fabs(copy.draft.scope.at_default(dot(plane.directions[0], n))) > 1e-9)
    throw zero.refusal("`zero` has to be normal to the axis of the revolute joints");
  if (on_platform) plane.directions.clear();
  if (limb.arm) plane.directions.push_back(limb.arm->arm);
  plane.directions.push_back(in_plane(at.B - (chain.drive == "telescope" ? at.A : limb.C)));
  if (chain.joints.back() != 'R') return plane;
  for (const Vector3& turn : copy.platform.turns.value_or(std::vector<Vector3>())) {
    const Vector3 normal = cross(turn, n);
    if (!on_platform && copy.draft.scope.at_default(dot(normal, normal)) > 1e-18)
      throw chain.table.find("chain")->refusal("the last joint is a revolute joint, but the frame " +
                                               copy.platform.name + " rotates about other axes, too");
  }
  plane.directions.push_back(copy.direction(zero, true));
  return plane;
}

/// Loop-closure function for a driven revolute joint: the equation of the link whose angle does not depend on this
/// joint.
Term closure_of(const LimbCopy& copy, const Plane& plane, const Term& q) {
  const Chain& chain = *copy.chain;
  const Vector3 &n = plane.normal, &v = plane.v, &zero = plane.directions.front();
  const auto number = std::count(chain.joints.begin(), chain.joints.begin() + static_cast<std::ptrdiff_t>(chain.driven),
                                 'R');  // of revolute joints before the driven one
  const auto last_link = [&] { return rotated(plane.directions.back(), n, q * -1.0); };
  if (chain.drive == "telescope")
    return dot(v, cross(n, number == 0 && !chain.is_hinged_at_platform() ? rotated(zero, n, q) : last_link()));
  if (chain.drive == "slider" && !copy.table.has("links")) {
    const Vector3 rod = (number == 0 ? rotated(zero, n, q) : last_link()) * copy.length("rod", "the rod's length");
    return dot(v - rod, cross(n, zero));
  }
  const auto [l_1, l_2] = chain.drive == "slider"
                              ? copy.links()
                              : std::array{copy.length("crank", "a length"), copy.length("rod", "a length")};
  if (number == 1) return (dot(v, v) - l_1 * l_1 - l_2 * l_2) * 0.5 - l_1 * l_2 * cos(q);
  const Vector3 rest = v - (number == 0 ? rotated(zero, n, q) * l_1 : last_link() * l_2);
  const Term& length = number == 0 ? l_2 : l_1;
  return (dot(rest, rest) - length * length) * 0.5;
}

}  // namespace

Term wrapped(const Term& angle, const Term& centre) {
  return centre + call(expression::angle_wrapping(), angle - centre);
}

std::string with_dashes(const std::string& joints) {
  std::string text;
  for (const char letter : joints) text += (text.empty() ? "" : "-") + std::string(1, letter);
  return text;
}

namespace {

/// Index of the driven joint of a chain that Newton's method solves.
std::size_t driven_of_solved(const Chain& chain) {
  const auto is_possible = [&](char joint) { return joint == 'P' || joint == 'R'; };
  const auto driven = chain.table.find("driven");
  if (!driven) {
    const std::size_t slide = chain.joints.find('P'),
                      found = slide < chain.joints.size() ? slide : chain.joints.find('R');
    if (found >= chain.joints.size())
      throw chain.table.find("chain")->refusal("the chain " + with_dashes(chain.joints) +
                                               " has no P or R that could be driven");
    return found;
  }
  const auto index = static_cast<std::size_t>(driven->integer() - 1);
  std::vector<std::string> possible;
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    if (is_possible(chain.joints[i])) possible.push_back(std::to_string(i + 1));
  if (index >= chain.joints.size() || !is_possible(chain.joints[index]))
    throw driven->refusal("joint " + std::to_string(index + 1) + " of the chain " + with_dashes(chain.joints) +
                          " cannot be driven; expected one of " + join(possible));
  return index;
}

/// Whether the table gives the links as vectors.
bool has_link_vectors(const ConfigValue& table) {
  const auto links = table.find("links");
  if (!links || !links->is_list()) return false;
  return std::ranges::any_of(links->elements("a list"), [](const ConfigValue& link) { return link.is_list(); });
}

}  // namespace

Chain read_chain(const ConfigValue& table) {
  Chain chain{.table = table, .joints = "", .drive = "chain", .driven = 0, .usual = 0};
  constexpr const char* kExpected = "a list of joints from the base to the platform: [\"P\", \"R\", \"S\"]";
  const ConfigValue list = table.at("chain", kExpected);
  for (const ConfigValue& joint : list.elements(kExpected)) chain.joints += joint.word({"P", "R", "C", "U", "S"});
  const auto form =
      std::ranges::find_if(chain_forms(), [&](const ChainForm& each) { return each.joints == chain.joints; });
  const bool is_spherical = table.has("angles");
  if (is_spherical && chain.joints != "RRR")
    throw list.refusal("no closed form of the spherical chain " + with_dashes(chain.joints) +
                       " is known; expected R-R-R");
  if (!is_spherical && (form == chain_forms().end() || has_link_vectors(table))) {
    if (!has_link_vectors(table))
      throw list.refusal(
          "no closed form of the chain " + with_dashes(chain.joints) + " is known; expected one of " +
          supported_chains() +
          ", or `links` with the vectors from each joint to the next, [[x, y, z], ..], for Newton's method");
    chain.driven = chain.usual = driven_of_solved(chain);
    return chain;
  }
  if (!is_spherical) chain.drive = form->drive;
  chain.usual = chain.drive == "telescope" ? 1 : 0;
  chain.driven = chain.usual;
  const auto driven = table.find("driven");
  if (!driven) return chain;
  chain.driven = static_cast<std::size_t>(driven->integer() - 1);
  const bool has_plane = is_spherical || std::ranges::any_of(form->axes, [](const std::string& key) {
                           return key == "=" || key == "across";
                         });
  std::vector<std::string> possible;
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    if (i == chain.usual || (has_plane && chain.joints[i] == 'R')) possible.push_back(std::to_string(i + 1));
  if (!contains(possible, std::to_string(chain.driven + 1)))
    throw driven->refusal("joint " + std::to_string(chain.driven + 1) + " of the chain " + with_dashes(chain.joints) +
                          " cannot be driven; expected " + (possible.size() > 1 ? "one of " : "") + join(possible));
  return chain;
}

ConfigValue rewritten(const Chain& chain, MechanismDraft& draft) {
  const ConfigValue& table = chain.table;
  const ChainForm& form = form_of(chain);
  const bool is_usual = chain.driven == chain.usual;
  const std::vector<std::string> names = {"drive", "chain", "axes", "links", "driven", "joint_ranges"};
  TomlValue kept = filtered(table.toml(), [&](const std::string& key) {
    return !contains(names, key) && (is_usual || key != "range") && (chain.drive == "crank" || key != "zero");
  });
  const bool counts_from_zero =
      chain.joints == "PRRR" || chain.joints.starts_with("R") || chain.is_hinged_at_platform();
  if (const auto zero = table.find("zero"); zero && !counts_from_zero)
    throw zero->refusal("`zero` has no effect on the chain " + with_dashes(chain.joints));
  set_key(kept, "drive", text_value(chain.drive, table.find("chain")->toml().line));

  const std::size_t count = form.axes.size();
  const std::vector<ConfigValue> axes =
      elements_of(table, "axes", count,
                  count == 0 ? "the chain " + with_dashes(chain.joints) + " has no axis that is fixed to the base"
                             : "the directions of " + std::to_string(count) + (count == 1 ? " axis" : " axes") +
                                   " of the chain " + with_dashes(chain.joints) + ", each [x, y, z]");
  std::vector<Vector3> directions;
  for (const ConfigValue& axis : axes) directions.push_back(draft.scope.direction(axis, "axes"));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string key = form.axes[i];
    const auto differs = [&](const Vector3& v) { return draft.scope.at_default(dot(v, v)) > 1e-18; };
    if (key == "=" && differs(cross(directions[i], directions[i - 1])))
      throw axes[i].refusal(
          "the revolute joints of the chain " + with_dashes(chain.joints) +
          " have to be parallel for a closed form; expected the direction of the axis before, or `links` as "
          "vectors, [[x, y, z], ..], for Newton's method");
    if (key == "across" && i > 0 && std::fabs(draft.scope.at_default(dot(directions[i], directions[0]))) > 1e-9)
      throw axes[i].refusal("the axis of the revolute joint has to be normal to " +
                            std::string(chain.is_hinged_at_platform() ? "that of the universal joint" : "the slide") +
                            ", axes[1]");
    if (key != "=" && !key.empty()) set_key(kept, key, moved(axes[i], "axes", i));
    if (key == "axis" && count > 1 && form.axes[1] == std::string("="))
      set_key(kept, "across", moved(axes[i], "axes", i));
  }
  if (chain.is_hinged_at_platform()) set_key(kept, "across_in", text_value("platform", kept.find("across")->line));
  const std::vector<ConfigValue> links =
      elements_of(table, "links", form.links.size(),
                  form.links.empty() ? "the chain " + with_dashes(chain.joints) + " has no link of constant length"
                  : form.links.size() == 1 ? "a list with the length of the rod, [l]"
                                           : "two lengths [l_1, l_2]");
  for (std::size_t i = 0; i < links.size(); ++i) {
    const std::string key = form.links[i];
    set_key(kept, key, key == "links" ? table.find(key)->toml() : moved(links[i], "links", i));
  }
  if (!is_usual)
    for (const char* const key : {"play", "rod_section", "crank_section", "slider_section", "leg_section"})
      if (const auto elastic = table.find(key))
        throw elastic->refusal(std::string("`") + key + "` requires that joint " + std::to_string(chain.usual + 1) +
                               " of the chain is driven");
  const SourceLocation place = table.place();
  return ConfigValue(draft.rewritten.emplace_back(std::move(kept)), place.file, place.key).described_by(limb_keys());
}

ChainJoints find_chain_joints(const LimbCopy& copy, const Ends& at, const Term& q, DrivenLimb& limb) {
  const Chain& chain = *copy.chain;
  ChainJoints joints = {{chain.usual, limb.joint}};
  if (at.across || copy.table.has("links")) {
    const Plane plane = plane_of(copy, at, limb);
    for (std::size_t i = 0, k = 0; i < chain.joints.size() && k + 1 < plane.directions.size(); ++i)
      if (chain.joints[i] == 'R') {
        joints.emplace(i, angle_about(plane.normal, plane.directions[k], plane.directions[k + 1]));
        ++k;
      }
    if (chain.driven != chain.usual) limb.closure = closure_of(copy, plane, q);
  }
  const std::string text =
      "chain " + with_dashes(chain.joints) + ", joint " + std::to_string(chain.driven + 1) + " driven: ";
  if (chain.driven == chain.usual) {
    limb.form = text + limb.form;
    return joints;
  }
  Term centre = copy.draft.zero();
  if (const auto range = chain.table.find("range")) {
    const auto [from, to] = read_range(*range, "rad", copy.group, copy.draft);
    centre = (from + to) * 0.5;
  }
  joints.at(chain.driven) = wrapped(joints.at(chain.driven), centre);
  limb.driven = joints.at(chain.driven);
  limb.path.reset();
  limb.crank_range.reset();
  limb.form = text + "angle between neighbouring links";
  return joints;
}

void describe_base_joint(const LimbCopy& copy, NamedLimb& limb) {
  limb.begins_in_ball = copy.chain->joints == "SPR";
  if (copy.chain->joints != "UPR") return;
  const ConfigValue axis = copy.chain->table.find("axes")->elements("axes")[0];
  limb.swivel = copy.direction(axis);
  const Term zero = copy.draft.zero();
  copy.draft.in_planes.push_back({axis, {zero, zero, zero}, *limb.swivel, *limb.revolute, true});
}

void name_chain_joints(const LimbCopy& copy, const ChainJoints& joints) {
  const Chain& chain = *copy.chain;
  std::vector<ChainCoordinate> coordinates;
  for (const auto& [index, joint] : joints)
    coordinates.push_back({"q" + std::to_string(index + 1), chain.unit(index), joint, index == chain.driven});
  name_chain_coordinates(copy, coordinates);
}

void name_chain_coordinates(const LimbCopy& copy, const std::vector<ChainCoordinate>& coordinates) {
  const Chain& chain = *copy.chain;
  MechanismDraft& draft = copy.draft;
  const auto ranges = chain.table.find_table("joint_ranges");
  if (ranges) {
    std::vector<std::string> passive;
    std::string driven;
    for (const ChainCoordinate& each : coordinates) {
      if (!each.is_driven) passive.push_back(each.name);
      if (each.is_driven) driven = each.name;
    }
    for (const std::string& key : ranges->keys())
      if (!contains(passive, key))
        throw ranges->find(key)->refusal(
            passive.empty() ? "the chain " + with_dashes(chain.joints) + " has no passive joint with a range"
                            : "expected a passive joint of the chain, one of " + join(passive) +
                                  (key == driven ? "; `range` is that of the driven joint" : ""));
  }
  for (const ChainCoordinate& each : coordinates) {
    const std::string name = copy.name + "." + each.name, unit = each.unit;
    const bool is_driven = each.is_driven;
    const auto range = ranges && !is_driven ? ranges->find(each.name) : std::nullopt;
    std::optional<std::array<Term, 2>> ends;
    if (range) ends = read_range(*range, unit, copy.group, draft);
    Term value = each.value;
    if (ends && unit == "rad") value = wrapped(value, ((*ends)[0] + (*ends)[1]) * 0.5);
    draft.scope.mark_as_defined(value.node());
    draft.scope.add_member(name, value);
    if (is_driven) continue;
    draft.model.angles.push_back({name, unit, value.node()});
    if (!ends) continue;
    draft.model.margins.push_back({name + " min", unit, (value - (*ends)[0]).node()});
    draft.model.margins.push_back({name + " max", unit, ((*ends)[1] - value).node()});
  }
}

}  // namespace pkm
