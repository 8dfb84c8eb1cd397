// Descriptions of the keys that a [[limb]] table may have.

#include <algorithm>

#include "engine/config/key_specs.hpp"
#include "engine/config/mechanism_keys.hpp"

namespace pkm {
namespace {

using Keys = std::vector<OptionSpec>;

bool has_length(const std::string& part) { return part == "crank" || part == "rod" || part.ends_with("_link"); }
bool is_telescopic(const std::string& part) { return part == "cylinder" || part == "piston"; }

OptionSpec frame_key(const std::string& name, const std::string& of) {
  return {.name = name,
          .kind = OptionKind::word,
          .initial = "base",
          .choices = {"base", "platform"},
          .meaning = "frame in which `" + of + "` is given: that of the limb's base or of its platform end"};
}

/// A key that names a frame, or one frame for each copy of the limb.
OptionSpec frames_key(const std::string& name, const std::string& meaning) {
  return {.name = name,
          .kind = OptionKind::any_of,
          .meaning = meaning,
          .parts = {{.kind = OptionKind::word}, texts_key("", "")}};
}

OptionSpec passive_joint_key(const std::string& name, const std::string& end) {
  static const TableSpec spec = {
      .meaning = "angle between the axis and the rod",
      .keys = {required(direction_key("axis", "axis [x, y, z]")), frame_key("in", "axis"),
               formula_key("min", "rad", "minimum angle"), formula_key("max", "rad", "maximum angle")}};
  return table_key(name, spec, "limits of the passive joint at the " + end + " end of the rod");
}

OptionSpec pair_key() {
  static const TableSpec spec = {
      .meaning = "pair of parallel rods",
      .keys = {required(formula_key("spacing", "m", "distance of the rods")),
               direction_key(
                   "along",
                   "required for sliders: direction from one rod to the other; for cranks it is the crank's axis")}};
  return table_key("pair", spec, "the rod is a pair of parallel rods with ball joints");
}

OptionSpec branch_key() {
  return {.name = "branch",
          .kind = OptionKind::word,
          .choices = {"+", "-"},
          .meaning = "solution of the limb in the default working mode"};
}

OptionSpec axes_key() {
  return {.name = "axes",
          .kind = OptionKind::list,
          .meaning = "directions of the axes of its joints, in their order",
          .parts = {direction_key("", "direction")}};
}

OptionSpec zero_key() { return direction_key("zero", "direction at which the first revolute joint has the value 0"); }

/// Keys of limbs whose inverse kinematics is in closed form, i.e. of all limbs except those with drive = "formula".
Keys geometry_keys() {
  static const TableSpec copies = {.meaning = "rotated copies of the limb",
                                   .keys = {{.name = "number",
                                             .kind = OptionKind::integer,
                                             .lower = 1,
                                             .upper = 8,
                                             .meaning = "number of copies, equally spaced"},
                                            {.name = "angles",
                                             .kind = OptionKind::list,
                                             .unit = "rad",
                                             .meaning = "angles of the copies, instead of `number`",
                                             .parts = {{.unit = "rad"}}},
                                            {.name = "about",
                                             .kind = OptionKind::word,
                                             .required = true,
                                             .choices = {"x", "y", "z"},
                                             .meaning = "axis of rotation"}}};
  const OptionSpec base = point_key("base", "base point A [x, y, z]"),
                   platform = point_key(
                       "platform", "platform's point B [x, y, z] in the platform's frame, or that of `platform_in`");
  static const TableSpec own = {.meaning = "end points of one copy, and other keys that only this copy has",
                                .keys = {required(base), required(platform), axes_key(), zero_key(), branch_key()}};
  return {
      {.name = "copies",
       .kind = OptionKind::any_of,
       .meaning = "the limb is copied, rotated about an axis, or with end points, `axes`, `zero` and `branch` of its "
                  "own: arm1, ..",
       .parts = {table_key("", copies),
                 {.kind = OptionKind::list,
                  .meaning = "end points of each copy, and its own `axes`, `zero`, `branch`",
                  .parts = {{.kind = OptionKind::table, .meaning = own.meaning, .table = &own}}}}},
      base,
      platform,
      frames_key("base_in",
                 "frame of the base point and of all directions of the drive, or a list of frames, one for each copy; "
                 "default: the base"),
      frames_key("platform_in",
                 "frame of the platform's point, or a list of frames, one for each copy; default: the platform"),
      point_key("end", "end point B in the base's frame, instead of `platform`; formulas of the pose are possible"),
      direction_key(
          "across",
          "normal of the plane in which the limb's links move; all joints of the limb are revolute about this normal"),
      frame_key("across_in", "across"),
      formula_key("radius", "m", "radius of the links, for pictures and clearance"),
      passive_joint_key("joint_base", "base"),
      passive_joint_key("joint_platform", "platform"),
      text_key("joint_name", "name of the joint; default: name of the limb"),
      text_key("end_on", "body that carries the limb's `end`: \"platform\", a frame, or the name of a [[body]]"),
      direction_key("universal",
                    "axis of universal joints at both ends of rod or leg, on the base's and the platform's side; "
                    "default: ball joints"),
      formula_key("play", "m", "radial play of each passive joint at the ends of rod or leg, for `accuracy`")};
}

/// Key for the cross-section of a leg, which determines its axial stiffness. The mass of a leg is given by the keys of
/// its parts `cylinder` and `piston`.
OptionSpec leg_section_key() {
  static const TableSpec section = {.meaning = "tube or rod of some material",
                                    .keys = {required(formula_key("outer", "m", "outer diameter")),
                                             formula_key("inner", "m", "inner diameter; default: 0"),
                                             required(formula_key("young", "Pa", "Young's modulus"))}};
  return table_key("leg_section", section, "cross-section and material of the leg, for its axial stiffness");
}

/// Key for the cross-section of a slider, which determines its bending stiffness.
OptionSpec slider_section_key() {
  static const TableSpec section = {
      .meaning = "tube or rod of some material",
      .keys = {required(formula_key("outer", "m", "outer diameter")),
               formula_key("inner", "m", "inner diameter; default: 0"),
               required(formula_key("young", "Pa", "Young's modulus")),
               formula_key("shear", "Pa", "shear modulus; default: young/2.6"),
               formula_key("length", "m",
                           "distance along the slide from its guide, where it is clamped, to the rod; default: the "
                           "joint coordinate, for a guide at `base`")}};
  return table_key("slider_section", section,
                   "cross-section and material of the slider of a limb with a `rod`, a cantilever");
}

/// Keys of limbs that are chains of joints, in addition to those of all limbs with closed forms.
Keys chain_keys() {
  static const TableSpec ranges = {.meaning = "ranges of passive joints",
                                   .keys = {},
                                   .named = {formulas_key("", kUnitOfEntry, 2, "range [minimum, maximum]")},
                                   .noun = "joint"};
  Keys keys = geometry_keys();
  std::erase_if(keys, [](const OptionSpec& key) {
    return key.name == "across" || key.name == "across_in" || key.name == "universal";
  });
  const Keys own = {
      {.name = "chain",
       .kind = OptionKind::list,
       .required = true,
       .meaning = "joints from the base to the platform: P, R, C, U, S",
       .parts = {{.kind = OptionKind::word, .choices = {"P", "R", "C", "U", "S"}}}},
      axes_key(),
      {.name = "links",
       .kind = OptionKind::list,
       .unit = "m",
       .meaning = "lengths of the links between the joints, or vectors [x, y, z] from each joint to the next",
       .parts = {{.kind = OptionKind::any_of,
                  .unit = "m",
                  .parts = {formula_key("", "m", ""), formulas_key("", "m", 3, "")}}}},
      formulas_key("angles", "rad", 2, "angles [alpha_1, alpha_2] of the links of a spherical chain"),
      zero_key(),
      {.name = "driven",
       .kind = OptionKind::integer,
       .lower = 1,
       .upper = 6,
       .meaning = "number of the driven joint; default: the first P, or the first R of a chain without P"},
      table_key("joint_ranges", ranges, "ranges of passive joints: { q2 = [minimum, maximum] }"),
      formula_key("arc_radius", "m", "radius of the arcs of a spherical chain"),
      branch_key(),
      pair_key()};
  keys.insert(keys.end(), own.begin(), own.end());
  for (const char* const part : {"cylinder", "piston", "crank", "slider", "rod", "first_link", "second_link"})
    for (const OptionSpec& key : mass_keys(part)) keys.push_back(key);
  return keys;
}

Keys all(std::initializer_list<Keys> lists) {
  Keys keys;
  for (const Keys& list : lists) keys.insert(keys.end(), list.begin(), list.end());
  return keys;
}

std::vector<TableVariant> drives() {
  const OptionSpec rod = formula_key("rod", "m", "length of the rod");
  const Keys slider = {direction_key("direction", "direction of the slide"),
                       direction_key("along", "direction of the slide, for a limb with `links`"),
                       rod,
                       formulas_key("links", "m", 2, "lengths [l_1, l_2] of two links in the plane normal to `along`"),
                       direction_key("axis", "axis about which `branch` counts the angle of `links`; default: `along`"),
                       branch_key(),
                       pair_key()};
  const Keys crank = {required(direction_key("axis", "axis of the crank's pivot")),
                      required(direction_key("zero", "direction of the crank at joint value 0")),
                      required(formula_key("crank", "m", "length of the crank")),
                      required(rod),
                      required(branch_key()),
                      pair_key()};
  static const TableSpec joints = {
      .meaning = "joints with their formulas",
      .keys = {},
      .named = {formula_key("", kUnitOfEntry, "joint coordinate as a formula of the pose")},
      .noun = "joint"};
  const Keys formulas = {
      table_key("joints", joints, "for several joints: list of formulas in terms of the pose"),
      formula_key("joint", kUnitOfEntry, "one joint: formula of the pose"),
      {.name = "unit",
       .kind = OptionKind::word,
       .initial = "m",
       .choices = {"m", "rad"},
       .meaning = "unit of the joints"},
      formulas_key("closures", "1", 0, "loop-closure equations in the pose and the joints' names, one for each joint")};
  return {{"telescope", "leg of variable length",
           all({geometry_keys(),
                mass_keys("cylinder"),
                mass_keys("piston"),
                {leg_section_key(),
                 formulas_key("tension", "N", 2,
                              "range [minimum, maximum] of the tension: the leg is a straight, massless cable, which "
                              "only pulls"),
                 formula_key("pulley_radius", "m",
                             "radius of the pulley over which a cable leaves the base at `base`; default: no pulley"),
                 formulas_key("pulley_axis", "1", 3,
                              "direction in which the cable reaches the pulley at `base`, about which the pulley "
                              "swivels; default: z of the base")}})},
          {"slider", "slide on a rail, alone or with a rod or two links",
           all({geometry_keys(),
                mass_keys("slider"),
                mass_keys("rod"),
                mass_keys("first_link"),
                mass_keys("second_link"),
                slider,
                {slider_section_key()}})},
          {"crank", "crank with a rod", all({geometry_keys(), mass_keys("crank"), mass_keys("rod"), crank})},
          {"chain", "chain of joints", all({chain_keys(), {leg_section_key(), slider_section_key()}})},
          {"formula", "joints given by formulas", formulas}};
}

}  // namespace

std::vector<OptionSpec> mass_keys(const std::string& part) {
  static const TableSpec rigid_section = {
      .meaning = "tube or rod of some material",
      .keys = {required(formula_key("density", "kg/m^3", "density of the material")),
               required(formula_key("outer", "m", "outer diameter")),
               formula_key("inner", "m", "inner diameter; default: 0")}};
  static const TableSpec section = {.meaning = "tube or rod of some material",
                                    .keys = {formula_key("density", "kg/m^3", "density of the material, for the mass"),
                                             required(formula_key("outer", "m", "outer diameter")),
                                             formula_key("inner", "m", "inner diameter; default: 0"),
                                             formula_key("young", "Pa", "Young's modulus, for the stiffness"),
                                             formula_key("shear", "Pa", "shear modulus; default: young/2.6")}};
  std::string shown = part;
  std::ranges::replace(shown, '_', ' ');
  Keys keys = {formula_key(part + "_mass", "kg", "mass of the " + shown)};
  if (part != "slider")
    keys.push_back(formula_key(part + "_inertia", "kg m^2",
                               "inertia of the " + shown + " about its centre of mass, across its axis; default: " +
                                   (is_telescopic(part) ? "0" : "that of a thin rod")));
  if (has_length(part)) {
    keys.push_back(formula_key(part + "_mass_per_length", "kg/m", "mass of the " + shown + " per length"));
    keys.push_back(table_key(part + "_section", part.ends_with("_link") ? rigid_section : section,
                             "cross-section and material of the " + shown));
  }
  if (is_telescopic(part))
    keys.push_back(formula_key(part + "_centre", "m",
                               std::string("distance of its centre of mass from ") + (part == "cylinder" ? "A" : "B")));
  return keys;
}

const TableSpec& limb_keys() {
  static const TableSpec spec = {
      .header = "[[limb]]",
      .meaning = "a limb, its joint and its links",
      .keys = {required(text_key("name", "name of the limb, and of its joint")),
               {.name = "drive",
                .kind = OptionKind::word,
                .required = true,
                .choices = {"telescope", "slider", "crank", "chain", "formula"},
                .meaning = "kind of the actuated joint"},
               formulas_key("range", kUnitOfEntry, 2, "range [minimum, maximum] of the joint"),
               formula_key("drive_stiffness", kUnitOfEntry,
                           "stiffness of the drive, measured at the joint [N/m or N m/rad]; default: rigid")},
      .choice = "drive",
      .variants = drives()};
  return spec;
}

}  // namespace pkm
