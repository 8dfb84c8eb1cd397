// Reads the coordinates of the platform, those that follow from others, and the tables [[frame]].
//
// Dependent coordinates and frames are formulas that are substituted into the expression graph. Joints, Jacobians,
// inertia, clearance and bounds therefore include them without further code. The angular velocity of the platform is
// the sum over its rotations of axis * angle', where the rate of a dependent angle follows from the chain rule.

#include "engine/config/mechanism_frames.hpp"

#include <algorithm>
#include <cmath>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/text_table.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/geometry/placed_link.hpp"

namespace pkm {
namespace {

using expression::Node;
using generic::Inputs;
using limbs::Rotation, limbs::Term, limbs::Vector3;

/// Rotates the platform's frame about an axis of the moving frame. Adds the contribution of this rotation to the
/// angular velocities of the platform for unit rates of the coordinates.
void add_rotation(const PlatformMotion& motion, const Term& angle, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const Vector3 axis = column(draft.turn, motion.axis);
  for (std::size_t i = 0; i < model.rotation_directions.size(); ++i) {
    if (motion.coordinate && *motion.coordinate != i) continue;
    const Term rate = motion.coordinate
                          ? Term(model.graph, 1.0)
                          : model.term(expression::derivative(model.graph, angle.node(), draft.model.coordinate(i)));
    for (std::size_t k = 0; k < 3; ++k) {
      Node& direction = model.rotation_directions[i][k];
      direction = (model.term(direction) + axis[k] * rate).node();
    }
  }
  draft.turns.push_back({axis, angle, motion.axis});
  draft.turn = draft.turn * limbs::rotation_about(motion.axis, sin(angle), cos(angle));
}

/// The value of a dependent coordinate. @param user  value of the file whose formula refers to the coordinate
Term dependent(const PlatformMotion& motion, const ConfigValue& user, MechanismDraft& draft) {
  return std::get<Term>(draft.scope.value(motion.name, user));
}

/// The rotation of the platform, with all dependent angles.
const Rotation& rotation_of_platform(const ConfigValue& platform, MechanismDraft& draft) {
  while (!draft.pending_rotations.empty()) {
    const PlatformMotion motion = draft.pending_rotations.front();
    const Term angle = motion.coordinate ? draft.model.term(draft.model.coordinate(*motion.coordinate))
                                         : dependent(motion, platform, draft);
    add_rotation(motion, angle, draft);
    draft.pending_rotations.erase(draft.pending_rotations.begin());
  }
  return draft.turn;
}

const NamedFrame& platform_frame(const ConfigValue& platform, MechanismDraft& draft) {
  if (const auto known = draft.frames.find(kPlatformFrame); known != draft.frames.end()) return known->second;
  rotation_of_platform(platform, draft);
  if (const auto origin = platform.find("origin")) {
    draft.origin = draft.scope.point(*origin, "origin");
  } else {
    for (const PlatformMotion& motion : draft.motions)
      if (!motion.rotates && !motion.coordinate) draft.origin[motion.axis] = dependent(motion, platform, draft);
  }
  NamedFrame frame{kPlatformFrame, {draft.origin, draft.turn}, kPlatformFrame, std::vector<Vector3>()};
  for (const PlatformTurn& turn : draft.turns) frame.turns->push_back(turn.axis);
  return draft.frames.emplace(kPlatformFrame, std::move(frame)).first->second;
}

/// A rotation in a mechanism file, given by a list of three angles about x, y and z, or by a formula whose value is a
/// rotation.
struct RelativeRotation {
  Rotation R;
  std::optional<std::array<Term, 3>> angles;
};

RelativeRotation read_rotation(const ConfigValue& value, const std::string& name, MechanismDraft& draft) {
  constexpr const char* kExpected =
      "three angles [a, b, c] of rotations about x, y and z of the moving frame, or a formula whose value is a "
      "rotation";
  if (value.is_text()) {
    const MechanismScope::Value found = draft.scope.formula_of_any_kind(value, "rad", name);
    const Rotation* const R = std::get_if<Rotation>(&found);
    if (!R) throw value.error_of(expression::kind_of(found) + ", the value of this formula", kExpected);
    return {*R, {}};
  }
  const std::vector<ConfigValue> elements = value.elements(kExpected);
  if (elements.size() != 3) throw value.error(kExpected);
  const auto angle = [&](std::size_t k) { return draft.scope.formula(elements[k], "rad", name); };
  const std::array<Term, 3> angles = {angle(0), angle(1), angle(2)};
  return {rotation_by(0, angles[0]) * rotation_by(1, angles[1]) * rotation_by(2, angles[2]), angles};
}

/// Reads a [[frame]], and the frame on which it is defined.
const NamedFrame& read_frame(const ConfigValue& table, const std::string& name, const ConfigValue& platform,
                             MechanismDraft& draft) {
  const std::string on = table.find("on") ? table.find("on")->word(draft.frame_names) : kBaseFrame;
  if (on == kPlatformFrame) platform_frame(platform, draft);
  if (!draft.frames.contains(on)) draft.scope.value(on, *table.find("on"));
  const NamedFrame& parent = draft.frames.at(on);
  const Vector3 zero{draft.zero(), draft.zero(), draft.zero()};
  const Rotation& none = draft.frames.at(kBaseFrame).at.rotation;
  const auto given = table.find("origin"), rotation = table.find("rotation");
  const Vector3 origin = given ? draft.scope.point(*given, name) : zero;
  const RelativeRotation turn = rotation ? read_rotation(*rotation, name, draft) : RelativeRotation{none, {}};
  const auto moves = [&](const Term& term) { return depends_on_pose(draft.model.graph, term.node()); };
  const auto any_moves = [&](const Vector3& v) { return std::ranges::any_of(v, moves); };
  NamedFrame frame{
      name, {parent.at.origin + parent.at.rotation * origin, parent.at.rotation * turn.R}, parent.body, parent.turns};
  const bool rotates = std::ranges::any_of(turn.R, any_moves);
  if (rotates || any_moves(origin)) frame.body = name;
  if (rotates && !turn.angles) frame.turns.reset();
  if (rotates && turn.angles && frame.turns) {
    Rotation before = parent.at.rotation;
    for (std::size_t k = 0; k < 3; ++k) {
      if (moves((*turn.angles)[k])) frame.turns->push_back(column(before, k));
      before = before * rotation_by(k, (*turn.angles)[k]);
    }
  }
  draft.model.frames.push_back({name, on, frame.body == name});
  return draft.frames.emplace(name, std::move(frame)).first->second;
}

}  // namespace

Rotation rotation_by(std::size_t axis, const Term& angle) {
  const expression::Entry& entry = angle.graph()[angle.node()];
  if (!entry.is_number()) return limbs::rotation_about(axis, sin(angle), cos(angle));
  const auto exact = [](double x) {
    return std::fabs(x) < 1e-15 ? 0 : std::fabs(std::fabs(x) - 1) < 1e-15 ? std::round(x) : x;
  };
  const auto [sine, cosine] = sincos(entry.number);
  return limbs::rotation_about(axis, {angle.graph(), exact(sine)}, {angle.graph(), exact(cosine)});
}

bool depends_on_pose(const expression::Graph& graph, Node node) { return (graph[node].groups & ~Inputs::kDesign) != 0; }

void read_coordinates(const ConfigValue& platform, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const std::string expected = "a table { x = \"along x\", phi = \"about z\", .. }";
  const ConfigValue all = platform.at("coordinates", expected).expect_table(expected).table();
  const std::size_t count = all.keys().size();
  if (count < 1 || count > kMaxCoordinates) throw all.error("1 to 6 coordinates");
  const auto follows_key = platform.find("follows");
  const auto follows = follows_key ? std::optional(follows_key->table_of_names(all.keys())) : std::nullopt;
  const auto is_dependent = [&](const std::string& name) {
    return (follows && follows->has(name)) || find_named(draft.unknowns, name);
  };
  if (std::ranges::all_of(all.keys(), is_dependent))
    throw(follows ? *follows : all)
        .refusal("every coordinate follows from the others; at least one has to be independent");
  for (const std::string& name : all.keys()) {
    const ConfigValue value = *all.find(name);
    const std::string& kind = value.word();
    PlatformMotion motion{name, static_cast<std::size_t>(kind.back() - 'x'), kind.starts_with("about"), {}};
    const auto same = [&](const PlatformMotion& other) { return !other.rotates && other.axis == motion.axis; };
    if (!motion.rotates && std::ranges::any_of(draft.motions, same))
      throw value.refusal("there is already a coordinate " + kind);
    if (motion.rotates && std::ranges::count(draft.motions, true, &PlatformMotion::rotates) == 3)
      throw value.refusal("a platform has at most three rotations");
    const auto formula = follows ? follows->find(name) : std::nullopt;
    if (const SolvedUnknown* const unknown = find_named(draft.unknowns, name)) {
      if (formula) throw formula->refusal("'" + name + "' is an unknown of [[solve]], and needs no formula");
      draft.scope.add_deferred(value, name, unknown->value);
      model.dependent.push_back({name, motion.unit(), kind, {}});
    } else if (formula) {
      draft.scope.add_deferred(*formula, name, [formula = *formula, name, unit = motion.unit(), &draft] {
        return draft.scope.formula(formula, unit, name);
      });
      model.dependent.push_back({name, motion.unit(), kind, {}});
    } else {
      const std::size_t i = model.inputs.coordinates++;
      const Term coordinate = model.term(draft.model.coordinate(i));
      draft.scope.add(value, name, coordinate.node());
      motion.coordinate = i;
      model.info.coordinates.push_back({name, motion.unit()});
      model.rotation_axes.push_back(motion.rotates ? std::optional(motion.axis) : std::nullopt);
      model.translation_axes.push_back(motion.rotates ? std::nullopt : std::optional(motion.axis));
      const Node none = model.graph.number(0);
      model.rotation_directions.push_back({none, none, none});
      if (!motion.rotates) draft.origin[motion.axis] = coordinate;
    }
    draft.motions.push_back(motion);
    if (!motion.rotates) continue;
    draft.pending_rotations.push_back(motion);
    if (motion.coordinate && draft.pending_rotations.size() == 1) rotation_of_platform(platform, draft);
  }
}

void read_frames(const ConfigValue& root, const ConfigValue& platform, MechanismDraft& draft) {
  draft.frames.emplace(kBaseFrame, NamedFrame{kBaseFrame,
                                              {{draft.zero(), draft.zero(), draft.zero()},
                                               limbs::rotation_about(2, draft.zero(), {draft.model.graph, 1.0})},
                                              kBaseFrame,
                                              std::vector<Vector3>()});
  draft.frame_names = {kBaseFrame, kPlatformFrame};
  // A dependent translation may use the rotation of the platform, although the translation is part of the origin of the
  // platform's frame.
  for (const char* const name : {"R", "platform.R"})
    draft.scope.add_predefined(name, [platform, &draft] { return rotation_of_platform(platform, draft); });
  draft.scope.add_predefined(kPlatformFrame, [platform, &draft] { return platform_frame(platform, draft).at; });
  for (const ConfigValue& table : root.tables("frame")) {
    const ConfigValue name = table.at("name", "the frame's name");
    const std::string& text = name.text("the frame's name");
    if (text == kFramePart || text == kBaseFrame || text == kPlatformFrame)
      throw name.refusal("'" + text + "' is a predefined name");
    draft.scope.add_deferred(name, text, [=, &draft] { return read_frame(table, text, platform, draft).at; });
    draft.frame_names.push_back(text);
  }
}

std::string frames_text(const Mechanism& mechanism) {
  const generic::Evaluation* const evaluation = generic::evaluation_of(mechanism);
  if (!evaluation) return "";
  std::vector<std::vector<std::string>> dependent, frames;
  for (const generic::DependentCoordinate& each : evaluation->model.dependent)
    dependent.push_back({each.name, each.unit, each.kind});
  for (const generic::FrameInfo& each : evaluation->model.frames)
    frames.push_back({each.name, (each.is_movable ? "moves relative to " : "fixed to ") + each.on});
  std::string text;
  if (!dependent.empty()) text += format_titled_table("dependent coordinates", dependent);
  if (!frames.empty()) text += format_titled_table("frames", frames);
  return text;
}

void resolve_frames(const ConfigValue& root, const ConfigValue& platform, MechanismDraft& draft) {
  platform_frame(platform, draft);
  draft.scope.resolve(root);
  for (generic::DependentCoordinate& coordinate : draft.model.dependent)
    coordinate.node = std::get<Term>(draft.scope.value(coordinate.name, root)).node();
}

}  // namespace pkm
