// Reads the masses of a mechanism file: those of parts of limbs, of links, of the platform, and of [[body]] tables.
//
// Parts of limbs and links are thin: they rotate with the line between their ends, but do not spin about it. Their
// inertia is therefore a single number: the moment of inertia about an axis through the centre of mass, normal to that
// line.

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_keys.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

using generic::BodyNodes;
using limbs::Term, limbs::Vector3;

/// Registers a mass, an inertia or a dimension, which must be positive for every design; if `may_vanish`, it may be 0.
Term checked(MechanismDraft& draft, const Term& value, const std::string& name, const std::string& unit,
             bool may_vanish) {
  draft.model.masses.push_back({name, unit, value.node(), may_vanish});
  return value;
}

struct Mass {
  Term mass;
  std::optional<Term> inertia;  ///< moment of inertia, if it follows from a cross-section; otherwise std::nullopt
};

/// Mass and moment of inertia of a tube or rod, from its diameters and the density of its material.
/// @param number_of  number of parallel tubes or rods
Mass mass_of_profile(const ConfigValue& value, const Term& length, double number_of, const std::string& what,
                     MechanismDraft& draft) {
  const ConfigValue profile = value.table();
  const auto number = [&](const char* key, const char* unit, const char* expected) {
    return checked(
        draft, draft.scope.positive(profile.at(key, expected), unit, what),
        "the " + std::string(key == std::string("density") ? key : std::string(key) + " diameter") + " of " + what,
        unit, false);
  };
  const Term density = number("density", "kg/m^3", "the material's density: \"2700 kg/m^3\"");
  const Term outer = number("outer", "m", "the outer diameter");
  const Term inner = profile.has("inner") ? number("inner", "m", "the inner diameter") : draft.zero();
  const Term mass = density * length * (outer * outer - inner * inner) * (kPi / 4 * number_of);
  return {mass, mass * (length * length / 12 + (outer * outer + inner * inner) / 16)};
}

/// The value of a key such as "rod_inertia", in which `part` is "rod" and `suffix` is "_inertia"; std::nullopt if it is
/// absent or does not exist for this part.
std::optional<ConfigValue> find_mass_key(const ConfigValue& table, const std::string& part, const std::string& suffix) {
  return find_named(mass_keys(part), part + suffix) ? table.find(part + suffix) : std::nullopt;
}

/// The mass of a part of a limb; std::nullopt if the limb's table gives none.
std::optional<Mass> mass_of_part(const ConfigValue& table, const LimbPart& part, const std::string& what,
                                 MechanismDraft& draft) {
  std::optional<ConfigValue> given;
  for (const char* way : {"_mass", "_mass_per_length", "_section"}) {
    auto value = find_mass_key(table, part.name, way);
    if (way == std::string("_section") && value && !value->table().has("density")) {
      if (!value->table().has("young"))
        throw value->refusal("a section needs a `density`, for the mass, or `young`, for the stiffness");
      value.reset();
    }
    if (value && given) throw value->refusal("the mass of the " + part.name + " is also given at " + given->line());
    if (value) given = value;
  }
  if (!given) return {};
  if (const auto profile = find_mass_key(table, part.name, "_section"); profile && profile->table().has("density"))
    return mass_of_profile(*profile, *part.length, part.name == "rod" && table.has("pair") ? 2 : 1, what, draft);
  if (const auto per_length = find_mass_key(table, part.name, "_mass_per_length"))
    return Mass{draft.scope.positive(*per_length, "kg/m", what) * *part.length, {}};
  return Mass{draft.scope.positive(*given, "kg", what, part.name == "slider"), {}};
}

void add_square(const std::array<expression::Node, 3>& f, const Term& weight, BodyNodes& body) {
  body.products.push_back({f, f, weight.node()});
}

/// Adds the rotational inertia of a body that rotates with a frame. It is given by its principal moments about the
/// frame's axes. If the platform rotates about a single axis, the moment of inertia about this axis is sufficient;
/// otherwise the second moments of mass along all three axes are used.
void add_rotation_with(const NamedFrame& frame, const std::array<Term, 3>& inertia, BodyNodes& body,
                       MechanismDraft& draft) {
  body.part_of = frame.body;
  body.inertia = {inertia[0].node(), inertia[1].node(), inertia[2].node()};
  const limbs::Rotation& R = frame.at.rotation;
  body.axes = {nodes(R[0]), nodes(R[1]), nodes(R[2])};
  if (frame.name == kPlatformFrame && draft.turns.size() <= 1) {
    const expression::Node zero = draft.zero().node();
    for (const PlatformTurn& turn : draft.turns) add_square({turn.angle.node(), zero, zero}, inertia[turn.index], body);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Term moment = (inertia[(k + 1) % 3] + inertia[(k + 2) % 3] - inertia[k]) * 0.5;
    add_square(nodes(column(R, k)), moment, body);
  }
}

std::array<Term, 3> read_inertia(const ConfigValue& value, const std::string& of, MechanismDraft& draft) {
  constexpr const char* kExpected = "three principal values about the centre of mass [I_1, I_2, I_3]";
  const auto elements = value.elements(kExpected);
  if (elements.size() != 3) throw value.error(kExpected);
  const auto one = [&](std::size_t k) {
    return checked(draft, draft.scope.positive(elements[k], "kg m^2", of, true), "the inertia of " + of, "kg m^2",
                   true);
  };
  return {one(0), one(1), one(2)};
}

/// A point mass at `centre`, which is a point in the base frame.
BodyNodes body_at(const Vector3& centre, const Term& mass, const std::string& name) {
  BodyNodes body{name, mass.node(), nodes(centre), {}, {}, {}};
  add_square(body.centre, mass, body);
  return body;
}

/// A thin part of constant length l with its centre of mass in the middle. In terms of the velocities P' and Q' of its
/// ends, twice its kinetic energy is (m/4 + I/l^2) (P'^2 + Q'^2) + 2 (m/4 - I/l^2) P' . Q'.
BodyNodes thin_body(const LimbPart& part, const Term& mass, const Term& inertia, const std::string& name,
                    MechanismDraft& draft) {
  const Term quarter = mass * 0.25, turning = inertia / (*part.length * *part.length);
  const Vector3 centre = (part.from + part.to) * Term(draft.model.graph, 0.5);
  BodyNodes body{name, mass.node(), nodes(centre), {}, {}, {}};
  // A part that is itself an arm rotates about its pivot, which moves along the axis of rotation only.
  if (part.on_arm && part.on_arm->is_arm) {
    add_square(nodes(part.from), mass, body);
    body.arm_rotations.push_back({part.on_arm->arm, (mass * 0.25 * *part.length * *part.length + inertia).node()});
    return body;
  }
  const Term square = quarter + turning;
  if (part.on_arm) {
    add_square(nodes(part.on_arm->pivot), square, body);
    body.arm_rotations.push_back({part.on_arm->arm, (square * part.on_arm->length * part.on_arm->length).node()});
  } else {
    add_square(nodes(part.from), square, body);
  }
  add_square(nodes(part.to), square, body);
  body.products.push_back({nodes(part.from), nodes(part.to), ((quarter - turning) * 2.0).node()});
  return body;
}

/// A thin link of uniform mass along an arc of the angle a, about whose centre it rotates. With the ends u and w as
/// unit vectors, its middle is c = (u + w) / (2 cos(a/2)), and t = (w - u) / (2 sin(a/2)) is normal to c. The mean
/// squares of the mass along c and t are r^2 (1 + sin(a)/a)/2 and r^2 (1 - sin(a)/a)/2.
BodyNodes arc_body(const LimbPart& part, const Term& mass, const std::string& name) {
  const LimbPart::Arc& arc = *part.arc;
  const Term half = arc.angle * 0.5, slope = sin(arc.angle) / arc.angle, one(mass.graph(), 1.0);
  const Vector3 c = (arc.first + arc.last) / (cos(half) * 2.0), t = (arc.last - arc.first) / (sin(half) * 2.0);
  const Vector3 n = cross(c, t);
  const Term square = mass * arc.radius * arc.radius, along = (one + slope) * 0.5, across = (one - slope) * 0.5;
  const Term distance = sin(half) / half;  // of the centre of mass from the centre of the arc, divided by the radius
  BodyNodes body{name, mass.node(), nodes(arc.centre + c * (arc.radius * distance)), {}, {}, {}};
  add_square(nodes(c), square * along, body);
  add_square(nodes(t), square * across, body);
  const Term offset = distance * distance;
  body.inertia = {(square * across).node(), (square * (along - offset)).node(), (square * (one - offset)).node()};
  body.axes = {nodes(Vector3{c[0], t[0], n[0]}), nodes(Vector3{c[1], t[1], n[1]}), nodes(Vector3{c[2], t[2], n[2]})};
  return body;
}

/// One of the two bodies of a telescopic leg, with its centre of mass on the line from A to B, whose direction is
/// `part.line`.
BodyNodes telescopic_body(const LimbPart& part, const Term& mass, const Term& along, const Term& inertia,
                          const std::string& name) {
  const std::array<expression::Node, 3> direction = nodes(*part.line);
  const bool at_base = part.name == "cylinder";
  BodyNodes body{name, mass.node(), nodes(at_base ? part.from + *part.line * along : part.to - *part.line * along),
                 {},   {},          {}};
  add_square(direction, mass * along * along + inertia, body);
  const auto moves = [](const Term& term) { return depends_on_pose(term.graph(), term.node()); };
  const Vector3& end = at_base ? part.from : part.to;
  if (std::ranges::none_of(end, moves)) return body;
  add_square(nodes(end), mass, body);
  body.products.push_back({nodes(end), direction, (mass * along * (at_base ? 2.0 : -2.0)).node()});
  return body;
}

}  // namespace

void add_part_body(const ConfigValue& table, const std::string& limb, const LimbPart& part, MechanismDraft& draft) {
  const std::string what = part.name + " of " + limb;
  const std::optional<Mass> given = mass_of_part(table, part, what, draft);
  for (const char* key : {"_inertia", "_centre"})
    if (const auto alone = find_mass_key(table, part.name, key); alone && !given)
      throw alone->refusal("the " + part.name + " has no mass: " + part.name + "_mass is missing");
  if (!given) return;
  const Term mass = checked(draft, given->mass, "the mass of " + what, "kg", part.name == "slider");
  Term inertia = given->inertia ? *given->inertia
                 : part.length  ? mass * *part.length * *part.length / 12
                                : draft.zero();
  if (const auto own = find_mass_key(table, part.name, "_inertia"))
    inertia = draft.scope.positive(*own, "kg m^2", what, true);
  if (part.arc) {
    draft.model.bodies.push_back(arc_body(part, mass, what));
    return;
  }
  checked(draft, inertia, "the inertia of " + what, "kg m^2", true);
  const expression::Node none = draft.zero().node(), across = inertia.node();
  if (part.length) {
    draft.model.bodies.push_back(thin_body(part, mass, inertia, what, draft));
    draft.model.bodies.back().inertia = {none, across, across};
  } else if (part.line) {
    const std::string from = part.name == "cylinder" ? "A" : "B";
    const Term along = draft.scope.of_design(
        table.at(part.name + "_centre", "the distance of its centre of mass from " + from), "m", what);
    draft.model.bodies.push_back(telescopic_body(part, mass, along, inertia, what));
    draft.model.bodies.back().inertia = {none, across, across};
  } else {
    draft.model.bodies.push_back(body_at(part.from, mass, what));
  }
}

void add_link_body(const ConfigValue& table, const std::string& name, const Vector3& from, const Vector3& to,
                   MechanismDraft& draft) {
  const auto mass = table.find("mass"), inertia = table.find("inertia");
  if (inertia && !mass) throw inertia->refusal("the link has no mass: mass is missing");
  if (!mass) return;
  const Term m = checked(draft, draft.scope.positive(*mass, "kg", name), "the mass of " + name, "kg", false);
  BodyNodes body = body_at((from + to) * Term(draft.model.graph, 0.5), m, name);
  if (inertia) {
    const Term I = draft.scope.positive(*inertia, "kg m^2", name, true);
    body.line_rotations.push_back(
        {nodes(to - from), checked(draft, I, "the inertia of " + name, "kg m^2", true).node()});
    body.inertia = {draft.zero().node(), I.node(), I.node()};
  }
  draft.model.bodies.push_back(std::move(body));
}

void read_platform_body(const ConfigValue& platform, MechanismDraft& draft) {
  const auto mass = platform.find("mass"), centre = platform.find("centre"), inertia = platform.find("inertia");
  if (inertia && !mass) throw inertia->refusal("the platform has no mass: mass is missing");
  const Vector3 at = centre ? draft.scope.point(*centre, "centre") : draft.origin;
  draft.model.wrench_point = nodes(at);
  if (!mass) return;
  const Term m = checked(draft, draft.scope.positive(*mass, "kg", "mass"), "the mass of the platform", "kg", false);
  BodyNodes body = body_at(at, m, "platform");
  if (inertia) {
    add_rotation_with(draft.frames.at(kPlatformFrame), read_inertia(*inertia, "the platform", draft), body, draft);
    body.part_of.clear();
  }
  draft.model.bodies.push_back(std::move(body));
}

void read_frame_bodies(const ConfigValue& root, MechanismDraft& draft) {
  for (const ConfigValue& table : root.tables("frame")) {
    const std::string& name = table.find("name")->text("the frame's name");
    const auto mass = table.find("mass"), centre = table.find("centre"), inertia = table.find("inertia");
    if (const auto alone = inertia ? inertia : centre; alone && !mass)
      throw alone->refusal("the frame has no mass: mass is missing");
    if (!mass) continue;
    const NamedFrame& frame = draft.frames.at(name);
    if (frame.body == kBaseFrame) throw mass->refusal("the frame is fixed to the base, so its mass has no effect");
    const Vector3 at =
        centre ? frame.at.origin + frame.at.rotation * draft.scope.point_of_design(*centre, name) : frame.at.origin;
    const Term m = checked(draft, draft.scope.positive(*mass, "kg", name, true), "the mass of " + name, "kg", true);
    BodyNodes body = body_at(at, m, name);
    body.part_of = frame.body;
    if (inertia) add_rotation_with(frame, read_inertia(*inertia, name, draft), body, draft);
    draft.model.bodies.push_back(std::move(body));
  }
}

void read_bodies(const ConfigValue& root, const std::vector<LimbPart>& links, MechanismDraft& draft) {
  std::vector<LimbPart> turning = links;
  for (const NamedLimb& limb : draft.limbs)
    for (LimbPart part : limb.parts) {
      part.name = limb.name + "." + part.name;
      turning.push_back(part);
    }
  std::vector<std::string> names = draft.frame_names;
  for (const LimbPart& part : turning) names.push_back(part.name);
  for (const ConfigValue& table : root.tables("body")) {
    const std::string name = new_name(table, "body", draft.model.bodies, "the body's name");
    const Vector3 centre = draft.scope.point(table.at("centre", "a point"), name);
    const Term mass = checked(draft, draft.scope.positive(table.at("mass", "the body's mass"), "kg", name, true),
                              "the mass of " + name, "kg", true);
    BodyNodes body = body_at(centre, mass, name);
    const auto rotation = table.find("rotation");
    if (rotation) body.part_of = rotation->word(names);
    const auto frame = draft.frames.find(body.part_of);
    if (frame != draft.frames.end()) body.part_of = frame->second.body;
    if (const auto value = table.find("inertia")) {
      const std::array<Term, 3> inertia = read_inertia(*value, name, draft);
      body.inertia = {inertia[0].node(), inertia[1].node(), inertia[2].node()};
      if (frame != draft.frames.end()) {
        add_rotation_with(frame->second, inertia, body, draft);
      } else if (rotation) {
        if (inertia[1].node() != inertia[2].node())
          throw value->refusal(
              "a body that rotates with a link needs the same formula for the last two moments of inertia: [along the "
              "link, across, across]");
        const LimbPart& link = *find_named(turning, rotation->text("a name"));
        if (link.line) body.line_rotations.push_back({nodes(*link.line), inertia[1].node()});
      }
    }
    draft.model.bodies.push_back(std::move(body));
  }
}

}  // namespace pkm
