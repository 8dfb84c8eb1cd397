// Bodies and joints of a mechanism file, for the forces in joints (engine/dynamics/newton_euler.hpp) and for the
// mobility of the platform.
//
// The type of the limb determines which forces and couples its joints transmit:
//
//   a crank's pivot       all forces and couples; the drive exerts the couple about its axis
//   a rod, a leg          ball joints at both ends: forces only. A constraint without reaction suppresses the spin
//                         about the rod's own axis
//   with `universal`      universal joints at both ends: forces, and a couple normal to both axes of the joint
//   a pair of rods        two parallel rods with half the mass each
//   `links`, `across`     revolute joints with parallel axes: forces, and couples normal to the axis. If the platform
//                         rotates about other axes, the joint at the platform is free about these, too
//   a leg S P R, U P R    a revolute joint at the platform, and at the base a ball joint or a universal joint, whose
//                         second axis is parallel to that of the revolute joint
//   a leg                 in addition a prismatic joint at its middle: all forces and couples; the drive exerts the
//                         force along it
//   a slider on its rail  not a body: the drive force includes the force that accelerates the mass of the slider
//   a spherical chain     revolute joints whose axes intersect in the centre of the arcs
//   [[joint]]             a revolute joint of two bodies, or a driven prismatic or revolute joint

#include <algorithm>
#include <map>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

using generic::BodyNodes, generic::JointNodes, generic::SolidNodes;
using limbs::Term, limbs::Vector3;
using Nodes = std::array<expression::Node, 3>;

/// Exception with one sentence, thrown if the mechanism file does not describe all joints.
struct IncompleteDescription {
  std::string why;
};

class JointReader {
 public:
  explicit JointReader(MechanismDraft& draft) : draft_(draft), model_(draft.model) {}

  /// Reads the bodies and joints that the mechanism file describes, without masses.
  generic::JointedBodies read(const std::vector<ConfigValue>& tables) {
    add_solid("platform", {.name = "platform",
                           .point = nodes(draft_.origin),
                           .is_platform = true,
                           .rotation = rotation_nodes(draft_.frames.at(kPlatformFrame))});
    for (const BodyNodes& body : model_.bodies) {
      if (!body.part_of.empty() || is_of_limb(body.name) || body.name == "platform") continue;
      add_solid(body.name, {.name = body.name, .point = body.centre});
      if (!body.line_rotations.empty()) solids_.back().line = body.line_rotations.front().d;
    }
    for (const NamedLimb& limb : draft_.limbs) add_limb(limb);
    for (const ConfigValue& table : tables) add_joint(table);
    refuse_unknown_links();
    hold_pin();
    return {solids_, joints_};
  }
  /// The reason why forces in the joints cannot be computed although the joints are known; "" if they can be computed.
  std::string why_no_forces() const {
    if (passive_slide_.empty()) return "";
    return "limb " + passive_slide_ + " has a passive slide, whose reactions are not computed";
  }
  /// Assigns the masses, which are required for the forces in the joints.
  generic::JointedBodies with_masses() {
    assign_masses();
    refuse_loose_bodies();
    return {solids_, joints_};
  }

 private:
  Vector3 vector(const Nodes& of) { return {model_.term(of[0]), model_.term(of[1]), model_.term(of[2])}; }

  /// Adds a solid, i.e. a rigid body with joints.
  /// @param body  name of the body of the model, or "platform", whose mass the solid has completely or in part
  std::size_t add_solid(const std::string& body, SolidNodes solid) {
    made_of_[body].push_back(solids_.size());
    solids_.push_back(std::move(solid));
    return solids_.size() - 1;
  }
  static std::array<Nodes, 3> rotation_nodes(const NamedFrame& frame) {
    const limbs::Rotation& R = frame.at.rotation;
    return {nodes(R[0]), nodes(R[1]), nodes(R[2])};
  }
  /// Index of the solid with a name; std::nullopt if there is none. If the name is that of a moving [[frame]] without a
  /// solid, its solid is added.
  std::optional<std::size_t> find_solid(const std::string& name) {
    const auto frame = draft_.frames.find(name);
    const std::string& body = frame == draft_.frames.end() ? name : frame->second.body;
    const auto found = std::ranges::find(solids_, body, &SolidNodes::name);
    if (found != solids_.end()) return static_cast<std::size_t>(found - solids_.begin());
    if (frame == draft_.frames.end() || body == kBaseFrame) return {};
    const NamedFrame& own = draft_.frames.at(body);
    return add_solid(body, {.name = body, .point = nodes(own.at.origin), .rotation = rotation_nodes(own)});
  }
  /// Axes about which the body at the end of a limb rotates. The joints of a limb with parallel revolute joints can
  /// rotate about these axes in addition to their own.
  std::vector<Vector3> turns_of(const NamedLimb& limb) const {
    const auto frame = draft_.frames.find(limb.end_on);
    if (frame == draft_.frames.end()) return {};
    if (!frame->second.turns && limb.revolute)
      throw IncompleteDescription{"limb " + limb.name + " ends on the frame " + limb.end_on +
                                  ", whose axes of rotation are unknown; give its `rotation` as three angles"};
    return frame->second.turns.value_or(std::vector<Vector3>());
  }
  bool is_of_limb(const std::string& body) const {
    for (const NamedLimb& limb : draft_.limbs)
      for (const LimbPart& part : limb.parts)
        if (body == part.name + " of " + limb.name) return true;
    return false;
  }

  JointNodes joint(const std::string& name, const Vector3& point, std::size_t on, std::optional<std::size_t> from,
                   JointNodes::Couples couples, const std::vector<Vector3>& axes) const {
    JointNodes joint{name, nodes(point), on, from, couples, {}};
    for (const Vector3& axis : axes) joint.axes.push_back(nodes(axis));
    return joint;
  }

  /// Makes a joint between two solids of a limb. If the limb has parallel revolute joints, it is a revolute joint about
  /// their axis, which can also rotate about the axes `also`; otherwise it is a ball joint and, if `line` is given,
  /// prevents the spin about that line.
  JointNodes limb_joint(const NamedLimb& limb, const std::string& name, const Vector3& point, std::size_t on,
                        std::optional<std::size_t> from, const std::optional<Vector3>& line,
                        const std::vector<Vector3>& also = {}) const {
    using enum JointNodes::Couples;
    if (!limb.revolute) return joint(name, point, on, from, along, line ? std::vector{*line} : std::vector<Vector3>());
    std::vector<Vector3> axes = {*limb.revolute};
    axes.insert(axes.end(), also.begin(), also.end());
    return joint(name, point, on, from, all_but_about, axes);
  }
  /// Makes the joint of a leg with the body on which it begins.
  JointNodes first_joint(const NamedLimb& limb, const std::string& name, const Vector3& point, std::size_t on,
                         std::optional<std::size_t> from, const std::optional<Vector3>& line) const {
    if (limb.begins_in_ball) return joint(name, point, on, from, JointNodes::Couples::along, {});
    return limb_joint(limb, name, point, on, from, line,
                      limb.swivel ? std::vector{*limb.swivel} : std::vector<Vector3>());
  }
  /// Makes the joint of a limb with the body that carries its end.
  JointNodes end_joint(const NamedLimb& limb, const std::string& name, const Vector3& point, std::size_t on,
                       std::optional<std::size_t> from, const std::vector<Vector3>& turns) const {
    if (limb.ends_in_ball) return joint(name, point, on, from, JointNodes::Couples::along, {});
    return limb_joint(limb, name, point, on, from, {}, turns);
  }
  JointNodes rigid_joint(const std::string& name, const Vector3& point, std::size_t on,
                         std::optional<std::size_t> from) const {
    return joint(name, point, on, from, JointNodes::Couples::all_but_about, {});
  }

  static generic::BeamNodes beam_of(const NamedLimb::Section& section, const Vector3& near, const Vector3& far) {
    return {nodes(near), nodes(far), section.EA.node(), section.EI.node(), section.GJ.node(), section.area.node()};
  }
  /// A part of a limb as an elastic beam from `near` to `far`; it is clamped by the joint that was added last.
  SolidNodes::Beam held_beam(const NamedLimb::Section& section, const Vector3& near, const Vector3& far,
                             bool is_rod) const {
    return {beam_of(section, near, far), joints_.size() - 1, is_rod};
  }
  /// Converts the joint added last into a universal joint, if the limb has such joints. It rotates about the axis a,
  /// which is fixed to the body that carries the rod, and about a x rod; it transmits a couple normal to both.
  /// @param solid  index of the rod among the solids
  void make_universal(const NamedLimb& limb, const Vector3& rod, std::size_t solid, bool on_platform) {
    if (!limb.universal) return;
    const Vector3& a = (*limb.universal)[on_platform ? 1 : 0];
    joints_.back().couples = JointNodes::Couples::along;
    joints_.back().axes = {nodes(cross(a, cross(a, rod)))};
    joints_.back().universal = JointNodes::Universal{nodes(a), solid};
  }

  std::size_t add_part(const NamedLimb& limb, const LimbPart& part) {
    const std::string name = part.name + " of " + limb.name;
    Vector3 line = *part.line;
    if (limb.revolute) line = line - *limb.revolute * dot(line, *limb.revolute);
    const Vector3& point = part.name == "piston" ? part.to : part.from;
    return add_solid(name, {.name = name, .point = nodes(point), .line = nodes(line)});
  }

  /// If the platform does not rotate, is a point mass, and all its joints are revolutes about one common axis, it is
  /// just the pin that connects the rods. It is then treated as part of the first rod.
  void hold_pin() {
    constexpr std::size_t kPlatform = 0;
    if (!draft_.turns.empty()) return;
    for (const BodyNodes& body : model_.bodies)
      if (body.part_of == "platform" || (body.name == "platform" && body.inertia)) return;
    JointNodes* first = nullptr;
    for (JointNodes& joint : joints_) {
      if (joint.on != kPlatform && joint.from != kPlatform) continue;
      if (joint.couples != JointNodes::Couples::all_but_about || joint.axes.size() != 1) return;
      if (!first) first = &joint;
      if (joint.point != first->point || !parallel(vector(joint.axes[0]), vector(first->axes[0]))) return;
    }
    if (first) first->holds_pin = true;
  }

  void add_limb(const NamedLimb& limb) {
    if (limb.drive == "formula") return;  // the joints of this limb are described by [[joint]] tables instead
    if (limb.axes) return add_spherical(limb);
    if (limb.parts.size() == 1)
      throw IncompleteDescription{"limb " + limb.name +
                                  " has neither `rod` nor `links` that connect it to the platform"};
    if (limb.end_on.empty())
      throw IncompleteDescription{
          "limb " + limb.name +
          " ends at `end`, but the body there is unknown; give end_on = \"platform\" or the name of a [[body]]"};
    if (limb.begin_on != kBaseFrame && limb.drive == "slider")
      throw IncompleteDescription{"the rail of limb " + limb.name + " moves with " + limb.begin_on +
                                  ", but joint forces are computed only for rails that are fixed to the base"};
    if (limb.pulley_radius)
      throw IncompleteDescription{"limb " + limb.name +
                                  " is a cable over a pulley, whose joints have no fixed place on the base"};
    const std::optional<std::size_t> carrier = find_solid(limb.end_on),
                                     base = limb.begin_on == kBaseFrame ? std::nullopt : find_solid(limb.begin_on);
    if (!carrier)
      throw IncompleteDescription{"limb " + limb.name + " ends on '" + limb.end_on +
                                  "', which is neither the platform nor a body" +
                                  did_you_mean(limb.end_on, names_of(solids_))};
    const auto& points = limb.points;
    const Vector3 &A = points.at("A"), &B = points.at("B"), &C = points.at("C"), &S = points.at("S");
    const LimbPart &first = limb.parts[limb.parts.size() - 2], &last = limb.parts.back();
    const bool turns_alone = limb.ends_in_ball || limb.is_hinged_at_end();
    const std::vector<Vector3> turns = turns_alone ? std::vector<Vector3>() : turns_of(limb);

    // A revolute joint of the chain is driven, and its slide is passive. The slide is described as the drive all the
    // same: the mobility does not depend on it, because all drives are free there.
    if (limb.driven && limb.drive != "crank" && passive_slide_.empty()) passive_slide_ = limb.name;
    const bool telescope = limb.drive == "telescope", slides = limb.drive == "slider",
               has_links = first.name != "slider" && slides;
    JointNodes::Drive drive{limb.joint, nodes(telescope ? *last.line : *limb.axis), limb.drive == "crank"};
    if (const auto compliance = drive_compliance(limb, draft_)) drive.compliance = compliance->node();
    if (const auto& section = limb.slider_section)
      drive.ram = beam_of(*section, S - *limb.axis * *limb.slider_length, S);
    if (slides)
      for (std::size_t i = 0; i < model_.bodies.size(); ++i)
        if (model_.bodies[i].name == "slider of " + limb.name) drive.slide = i;

    // Index of the crank, of the cylinder, or of the first of two links, among the solids; std::nullopt: the limb has
    // none of these.
    std::optional<std::size_t> inner;
    if (telescope || has_links || limb.drive == "crank") inner = add_part(limb, first);
    if (telescope) {
      joints_.push_back(first_joint(limb, limb.name + ".A", A, *inner, base, first.line));
      make_universal(limb, B - A, *inner, false);
      const std::size_t piston = add_part(limb, last);
      joints_.push_back(rigid_joint(limb.name + ".slide", (A + B) * Term(model_.graph, 0.5), piston, inner));
      joints_.back().drive = drive;
      joints_.push_back(end_joint(limb, limb.name + ".B", B, piston, carrier, turns));
      make_universal(limb, B - A, piston, true);
      return;
    }
    if (limb.drive == "crank") {
      joints_.push_back(limb.driven ? limb_joint(limb, limb.name + ".A", A, *inner, base, {})
                                    : rigid_joint(limb.name + ".A", A, *inner, base));
      if (const auto& section = limb.crank_section) solids_[*inner].beam = held_beam(*section, A, C, false);
    }
    if (has_links) joints_.push_back(limb_joint(limb, limb.name + ".S", S, *inner, {}, {}));
    if (inner && !(limb.driven && limb.drive == "crank")) joints_.back().drive = drive;
    const int rods = limb.beside ? 2 : 1;
    for (int rod = 1; rod <= rods; ++rod) {
      const std::string number = rods == 2 ? " " + std::to_string(rod) : "";
      const std::size_t outer = add_part(limb, last);
      Vector3 near = inner ? C : S, far = B;
      if (rods == 2) {
        const Vector3 beside = rod == 1 ? *limb.beside * Term(model_.graph, -1) : *limb.beside;
        near = near + beside;
        far = far + beside;
        solids_[outer].name = "rod" + number + " of " + limb.name;
        solids_[outer].share = 0.5;
        solids_[outer].centre_offset = nodes(beside);
      }
      if (inner) {
        joints_.push_back(limb_joint(limb, limb.name + ".C" + number, near, *inner, outer, last.line));
        if (limb.driven == 1 && limb.drive == "crank") drive_last(drive);
      } else {
        joints_.push_back(limb_joint(limb, limb.name + ".S" + number, near, outer, {}, last.line));
        joints_.back().drive = drive;
        drive.slide = {};  // of a pair of rods, only the joint of the first rod carries the mass of the slider
      }
      make_universal(limb, far - near, outer, false);
      if (const auto& section = limb.rod_section) solids_[outer].beam = held_beam(*section, near, far, true);
      joints_.push_back(end_joint(limb, limb.name + ".B" + number, far, outer, carrier, turns));
      if (limb.driven == 2 && limb.drive == "crank") drive_last(drive);
      make_universal(limb, far - near, outer, true);
    }
  }
  /// Makes the revolute joint that was added last the driven joint. The coordinate of the drive is the angle of the
  /// joint's second body relative to its first body.
  void drive_last(JointNodes::Drive drive) {
    drive.axis = nodes(vector(drive.axis) * Term(model_.graph, -1.0));
    joints_.back().axes.clear();
    joints_.back().drive = drive;
  }

  /// Adds a spherical chain. Its links rotate with the frames of their arcs.
  void add_spherical(const NamedLimb& limb) {
    const std::array<const char*, 3> points = {"A", "C", "B"};
    std::optional<std::size_t> before = limb.begin_on == kBaseFrame ? std::nullopt : find_solid(limb.begin_on);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 &axis = (*limb.axes)[k], &point = limb.points.at(points[k]);
      std::size_t next = 0;
      if (k < 2) {
        const LimbPart& part = limb.parts[k];
        const std::string name = part.name + " of " + limb.name;
        const LimbPart::Arc& arc = *part.arc;
        const Vector3 n = cross(arc.first, arc.last) / sin(arc.angle), t = cross(n, arc.first);
        next = add_solid(name, {.name = name,
                                .point = nodes(point),
                                .rotation = std::array<Nodes, 3>{nodes(Vector3{arc.first[0], t[0], n[0]}),
                                                                 nodes(Vector3{arc.first[1], t[1], n[1]}),
                                                                 nodes(Vector3{arc.first[2], t[2], n[2]})}});
      } else {
        next = *find_solid(limb.end_on);
      }
      const std::string name = limb.name + "." + points[k];
      if (k == limb.driven) {
        joints_.push_back(rigid_joint(name, point, next, before));
        joints_.back().drive = JointNodes::Drive{limb.joint, nodes(axis), true};
        if (const auto compliance = drive_compliance(limb, draft_))
          joints_.back().drive->compliance = compliance->node();
      } else {
        joints_.push_back(joint(name, point, next, before, JointNodes::Couples::all_but_about, {axis}));
      }
      before = next;
    }
  }

  /// Index of the solid that has the name given by `value`; std::nullopt: the base.
  std::optional<std::size_t> solid_called(const ConfigValue& value) {
    std::vector<std::string> names = names_of(solids_);
    for (const std::string& frame : draft_.frame_names)
      if (!contains(names, frame)) names.push_back(frame);
    return find_solid(value.word(names));
  }

  void add_joint(const ConfigValue& table) {
    const std::string name = new_name(table, "joint", joints_, "the joint's name");
    const ConfigValue both = table.at("bodies", "the two bodies that it joins");
    const auto bodies = both.elements("two bodies");
    if (bodies.size() != 2) throw both.error("two bodies");
    const auto first = solid_called(bodies[0]), second = solid_called(bodies[1]);
    if (!first) throw bodies[0].error("a body; the base may be the second one");
    if (first == second) throw bodies[1].error("a body other than the first");
    const auto about = table.find("about"), along = table.find("along"), drive = table.find("drive");
    if (about && along) throw along->refusal("give either `about` or `along`, not both");
    if (along && !drive) throw along->refusal("a joint with `along`, a slide, needs `drive`");
    const ConfigValue given = along ? *along : table.at("about", "the axis [x, y, z] in the base's frame");
    const NamedFrame& frame =
        draft_.frames.at(table.find("in") ? table.find("in")->word(draft_.frame_names) : kBaseFrame);
    const Vector3 axis = frame.at.rotation * draft_.scope.direction(given, name),
                  at = draft_.scope.point(table.at("at", "a point"), name);
    if (!drive) {
      joints_.push_back(joint(name, at, *first, second, JointNodes::Couples::all_but_about, {axis}));
      return;
    }
    joints_.push_back(rigid_joint(name, at, *first, second));
    joints_.back().drive = JointNodes::Drive{driven_by(*drive, along.has_value()), nodes(axis), !along};
  }
  /// Reads the drive of a [[joint]], which must be a joint of a limb with drive = "formula".
  /// @param slides  true if the [[joint]] is prismatic
  /// @return index of that joint among the joints of the mechanism
  std::size_t driven_by(const ConfigValue& value, bool slides) const {
    std::vector<std::string> names;
    for (const NamedLimb& limb : draft_.limbs)
      for (std::size_t k = 0; limb.drive == "formula" && k < limb.joint_count; ++k)
        names.push_back(model_.info.joints[limb.joint + k].name);
    const std::string& name = value.word(names);
    const auto found = std::ranges::find(model_.info.joints, name, &AxisInfo::name);
    if (found->turns() == slides)
      throw value.refusal("the joint " + name + " has the unit " + found->unit + ", so give `" +
                          (slides ? "about" : "along") + "` instead of `" + (slides ? "along" : "about") + "`");
    const auto index = static_cast<std::size_t>(found - model_.info.joints.begin());
    if (is_driven(index)) throw value.refusal("another joint has the drive " + name + " already");
    return index;
  }
  bool is_driven(std::size_t joint) const {
    return std::ranges::any_of(joints_,
                               [&](const JointNodes& each) { return each.drive && each.drive->joint == joint; });
  }
  /// Refuses a limb with drive = "formula" unless each of its joints is the drive of a [[joint]].
  void refuse_unknown_links() const {
    for (const NamedLimb& limb : draft_.limbs) {
      if (limb.drive != "formula") continue;
      std::vector<std::string> missing;
      for (std::size_t k = limb.joint; k < limb.joint + limb.joint_count; ++k)
        if (!is_driven(k)) missing.push_back(model_.info.joints[k].name);
      if (missing.empty()) continue;
      throw IncompleteDescription{
          "limb " + limb.name +
          (limb.points.contains("J1") ? " is a chain without a closed form" : " has drive = \"formula\"") +
          ", so its links are unknown" +
          (missing.size() < limb.joint_count ? ": no [[joint]] has drive = \"" + missing.front() + "\"" : "")};
    }
  }

  /// Assigns each mass to the solid that contains it.
  void assign_masses() {
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyNodes& body = model_.bodies[i];
      // The force of the limb's drive already includes the force that accelerates the slider.
      if (body.name.starts_with("slider of ") && is_of_limb(body.name)) continue;
      std::string owner = body.part_of.empty() ? body.name : body.part_of;
      for (const NamedLimb& limb : draft_.limbs)
        for (const LimbPart& part : limb.parts)
          if (owner == limb.name + "." + part.name) owner = part.name + " of " + limb.name;
      find_solid(owner);
      const auto owners = made_of_.find(owner);
      if (owners == made_of_.end())
        throw IncompleteDescription{"body " + body.name + " rotates with " + body.part_of +
                                    ", which is not a separate body"};
      if (owners->second.size() > 1 && body.name != owner)
        throw IncompleteDescription{"body " + body.name +
                                    " rotates with one rod of a pair, but it is unknown with which"};
      for (const std::size_t solid : owners->second) solids_[solid].bodies.push_back(i);
    }
  }

  /// Refuses bodies without a joint, and systems with fewer unknown reactions than equations of equilibrium, because
  /// such bodies can move although all drives are locked.
  void refuse_loose_bodies() {
    std::vector<bool> has_joint(solids_.size(), false);
    std::size_t unknowns = 0;
    for (const JointNodes& joint : joints_) {
      has_joint[joint.on] = true;
      if (joint.from) has_joint[*joint.from] = true;
      unknowns += 3 + (joint.holds_pin ? 3 : couples_of(joint));
    }
    for (std::size_t i = 0; i < solids_.size(); ++i)
      if (!has_joint[i])
        throw IncompleteDescription{
            "the body " + solids_[i].name +
            " has no joint; add a [[joint]], or make it part of the platform with rotation = \"platform\""};
    if (const std::size_t equations = 6 * solids_.size(); unknowns < equations)
      throw IncompleteDescription{
          "the joints of the file constrain its bodies too little: " + std::to_string(unknowns) +
          " unknown joint forces in " + std::to_string(equations) +
          " equations; give `pair` for rods in pairs, and `across` for limbs with parallel revolute joints"};
  }
  std::size_t couples_of(const JointNodes& joint) {
    if (joint.couples == JointNodes::Couples::along) return joint.axes.size();
    std::vector<Vector3> free;  // axes about which the joint rotates in the default design
    for (const Nodes& axis : joint.axes)
      if (free.empty() || (free.size() < 2 && !parallel(free[0], vector(axis)))) free.push_back(vector(axis));
    return 3 - free.size();
  }
  bool parallel(const Vector3& a, const Vector3& b) const {
    const Vector3 normal = cross(a, b);
    return draft_.scope.at_default(dot(normal, normal)) < 1e-18;
  }

  MechanismDraft& draft_;
  generic::Model& model_;
  std::vector<SolidNodes> solids_;
  std::vector<JointNodes> joints_;
  /// For each body of the model, by its name, the indices of the solids that have its mass.
  std::map<std::string, std::vector<std::size_t>> made_of_;
  std::string passive_slide_;  ///< name of a limb whose slide is not driven; "": none
};

}  // namespace

void add_joints(const ConfigValue& root, MechanismDraft& draft) {
  const std::vector<ConfigValue> tables = root.tables("joint");
  generic::Model& model = draft.model;
  JointReader reader(draft);
  try {
    model.jointed = reader.read(tables);
    if (const std::string why = reader.why_no_forces(); !why.empty()) {
      model.why_no_reactions = model.why_no_elasticity = why;
      return;
    }
    const bool has_beam =
        std::ranges::any_of(model.jointed->solids, [](const SolidNodes& solid) { return solid.beam.has_value(); });
    const bool has_spring = std::ranges::any_of(model.jointed->joints, [](const JointNodes& joint) {
      return joint.drive && (joint.drive->compliance || joint.drive->ram);
    });
    if (!has_beam && !has_spring) model.why_no_elasticity = "no limb has `drive_stiffness`, or a section with `young`";
    if (model.bodies.empty()) throw IncompleteDescription{"the mechanism file has no masses"};
    model.jointed = reader.with_masses();
  } catch (const IncompleteDescription& incomplete) {
    model.why_no_reactions = incomplete.why;
    if (!model.jointed) model.why_no_elasticity = incomplete.why;
  }
}

}  // namespace pkm
