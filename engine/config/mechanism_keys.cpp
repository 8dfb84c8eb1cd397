#include "engine/config/mechanism_keys.hpp"

#include "engine/config/key_specs.hpp"

namespace pkm {
namespace {

OptionSpec meaning_key() { return text_key("meaning", "one line of text"); }
OptionSpec unit_key(const std::string& meaning = "product of SI units; default: \"1\"") {
  return text_key("unit", meaning);
}
OptionSpec number_key(const std::string& name, const std::string& meaning) {
  return {.name = name, .unit = kUnitOfEntry, .meaning = meaning};
}

const TableSpec& name_table() {
  static const TableSpec spec = {
      .header = "[mechanism]",
      .meaning = "name and origin",
      .keys = {required(text_key("name", "name of letters, digits, '-' and '_'")),
               text_key("title", "what it is, in one line"), text_key("source", "where it was published")}};
  return spec;
}

const TableSpec& parameter_table() {
  static const TableSpec spec = {
      .meaning = "a parameter",
      .keys = {required(number_key("default", "default value; its unit is that of the parameter")),
               required(number_key("min", "minimum allowed value")),
               required(number_key("max", "maximum allowed value")), meaning_key(),
               unit_key("product of SI units, if the default has none")}};
  return spec;
}

/// Description of a table of parameters.
/// @param header  header of the table in the file: "[parameters]"; "" for the table of the same name in [masses.NAME]
TableSpec parameters_table(const std::string& header) {
  static const TableSpec limb = {.meaning = "parameters of this limb only",
                                 .keys = {},
                                 .named = {table_key("", limb_parameter_keys())},
                                 .noun = "parameter"};
  return {.header = header,
          .meaning = "dimensions, masses and other numbers that define a design",
          .keys = {},
          .named = {{.kind = OptionKind::any_of,
                     .meaning = "a parameter; or, under the name of a limb, a table of parameters of this limb only",
                     .parts = {table_key("", parameter_table()), table_key("", limb)}}},
          .noun = "parameter"};
}

/// Description of a table of named formulas.
/// @param header  header of the table in the file: "[let]"; "" for the table of the same name in [masses.NAME]
TableSpec let_table(const std::string& header) {
  return {.header = header,
          .meaning = "named formulas; each may use the names above it",
          .keys = {},
          .named = {formula_key("", "1", "formula of the names defined above it, in SI")},
          .noun = "name"};
}

const TableSpec& masses_table() {
  static const TableSpec parameters = parameters_table(""), let = let_table("");
  static const TableSpec model = {.meaning = "a mass model",
                                  .keys = {table_key("parameters", parameters, "parameters of this mass model"),
                                           table_key("let", let, "formulas of this mass model")}};
  static const TableSpec spec = {.header = "[masses]",
                                 .meaning = "alternative mass models, [masses.NAME] each; the first is the default",
                                 .keys = {},
                                 .named = {table_key("", model)},
                                 .noun = "mass model"};
  return spec;
}

const TableSpec& platform_table() {
  static const TableSpec coordinates = {
      .meaning = "coordinates of the platform",
      .keys = {},
      .named = {{.kind = OptionKind::word,
                 .choices = {"along x", "along y", "along z", "about x", "about y", "about z"},
                 .meaning = "direction of the translation or axis of the rotation, in the moving frame"}},
      .noun = "coordinate"};
  static const TableSpec follows = {
      .meaning = "coordinates that depend on the others",
      .keys = {},
      .named = {formula_key("", kUnitOfEntry, "formula of the other coordinates and of parameters")},
      .noun = "coordinate"};
  static const TableSpec size = {.meaning = "size of the mechanism",
                                 .keys = {required(formula_key("formula", kUnitOfEntry, "formula of parameters")),
                                          required(unit_key("unit of the size: \"m^3\"")), meaning_key()}};
  static const TableSpec spec = {
      .header = "[platform]",
      .meaning = "the moving platform and the coordinates of its pose",
      .keys = {
          required(table_key("coordinates", coordinates,
                             "1 to 6 coordinates; rotations about the axes of the moving frame, in their order")),
          table_key("follows", follows, "those of the coordinates that depend on the others: parasitic motions"),
          formula_key("characteristic_length", "m",
                      "length that makes rotations comparable with translations in the conditioning"),
          formula_key("characteristic_radius", "m", "radius that makes revolute drives comparable with prismatic ones"),
          texts_key("conditioning_over", "coordinates that the conditioning includes; default: all"),
          table_key("size", size, "size by which `workspace-ratio` divides the volume"),
          point_key("origin", "origin of the platform's frame, if coordinates depend on others"),
          formula_key("mass", "kg", "mass of the platform"),
          point_key("centre", "centre of mass of the platform, where wrenches act; default: the origin"),
          formulas_key("inertia", "kg m^2", 3,
                       "principal moments of inertia about the centre of mass, along the platform's axes")}};
  return spec;
}

const TableSpec& frame_table() {
  static const TableSpec spec = {
      .header = "[[frame]]",
      .meaning = "coordinate system in which limbs begin or end; it may move",
      .keys = {required(text_key("name", "name of the frame")),
               text_key("on",
                        "frame in which `origin` and `rotation` are given: \"base\", \"platform\" or another one; "
                        "default: the base"),
               point_key("origin", "position of the frame; default: that of `on`"),
               {.name = "rotation",
                .kind = OptionKind::any_of,
                .unit = "rad",
                .meaning = "angles of successive rotations about x, y and z of the moving frame, or a formula whose "
                           "value is a rotation; default: none",
                .parts = {formulas_key("", "rad", 3, ""), {.kind = OptionKind::formula, .unit = "rad", .count = 3}}},
               formula_key("mass", "kg", "mass of a body that is fixed to the frame"),
               point_key("centre", "its centre of mass, in the frame; default: the origin"),
               formulas_key("inertia", "kg m^2", 3,
                            "its principal moments of inertia about the centre of mass, along the frame's axes")}};
  return spec;
}

const TableSpec& solve_table() {
  static const TableSpec spec = {
      .header = "[[solve]]",
      .meaning = "unknowns without a closed form: Newton's method solves their equations at every pose",
      .keys = {required(texts_key("unknowns",
                                  "1 to 6 names: coordinates of the platform, which then depend on the others, or new "
                                  "names for formulas")),
               required(formulas_key("equations", kUnitOfEntry, 0,
                                     "formulas that vanish, one per unknown; the value of a formula may be a vector, "
                                     "which counts as three")),
               required(formulas_key("start", kUnitOfEntry, 0,
                                     "number or formula for each unknown, from which Newton's method starts"))}};
  return spec;
}

const TableSpec& forces_table() {
  static const TableSpec accelerations = {
      .meaning = "accelerations of coordinates",
      .keys = {},
      .named = {formula_key("", kUnitOfEntry, "maximum magnitude [m/s^2 or rad/s^2]")},
      .noun = "coordinate"};
  static const TableSpec spec = {
      .header = "[forces]",
      .meaning = "how redundant drives share a load, and the loads that cables have to balance",
      .keys = {{.name = "distribution",
                .kind = OptionKind::word,
                .initial = "least-norm",
                .choices = {"least-norm", "least-maximum", "centre"},
                .meaning = "choice of the forces of redundant drives: minimum sum of squares, minimum of the maximum, "
                           "or analytic centre of the allowed tensions"},
               formulas_key("relative_to", kUnitOfEntry, 0,
                            "one force or torque for each joint, by which `least-norm` and `least-maximum` divide the "
                            "forces; default: the same for all"),
               {.name = "cables",
                .kind = OptionKind::word,
                .initial = "wrench-feasible",
                .choices = {"wrench-feasible", "wrench-closure"},
                .meaning = "condition of feasible poses: the allowed tensions balance all loads, or some tensions "
                           "balance any load"},
               formulas_key("payload", "kg", 2, "range [minimum, maximum] of a payload, a point mass; default: none"),
               point_key("payload_at", "position of the payload in the platform's frame; default: its origin"),
               formulas_key("force", "N", 3,
                            "maximum magnitudes of an external force along x, y, z, in both directions, at the "
                            "platform's centre of mass; default: 0"),
               formulas_key("moment", "N m", 3, "maximum magnitudes of an external moment about x, y, z; default: 0"),
               table_key("acceleration", accelerations,
                         "maximum magnitudes of accelerations of coordinates, in both directions; default: 0")}};
  return spec;
}

const TableSpec& survey_table() {
  static const TableSpec fixed = {.meaning = "default values of coordinates",
                                  .keys = {},
                                  .named = {formula_key("", kUnitOfEntry, "value, or formula of parameters")},
                                  .noun = "coordinate"};
  static const TableSpec ranges = {
      .meaning = "ranges of coordinates",
      .keys = {},
      .named = {formulas_key("", kUnitOfEntry, 2, "range [from, to], formulas of parameters")},
      .noun = "coordinate"};
  static const TableSpec spec = {
      .header = "[survey]",
      .meaning = "default workspace analysis",
      .keys = {texts_key("sweep", "swept coordinates, one to three; default: the first three"),
               table_key("fixed", fixed,
                         "default values of coordinates, for analyses that fix them; default: the middle of the box"),
               table_key("box", ranges, "search box; default: computed for each design, contains every feasible pose"),
               table_key("reach", ranges, "ranges that contain every pose the mechanism can reach"),
               texts_key("columns_along", "coordinates along which columns run, the preferred one first")}};
  return spec;
}

const TableSpec& modes_table() {
  const OptionSpec signs = {.name = "signs",
                            .kind = OptionKind::list,
                            .required = true,
                            .meaning = "the possible signs, the default first",
                            .parts = {{.kind = OptionKind::word, .choices = {"+", "-"}}}};
  static const TableSpec sign = {
      .meaning = "a sign with names",
      .keys = {signs,
               texts_key("names", "names of the signs in the names of working modes"),
               {.name = "branch",
                .kind = OptionKind::flag,
                .initial = false,
                .meaning = "the option --branch selects this sign; only one sign may set the key"}}};
  static const TableSpec spec = {.header = "[modes]",
                                 .meaning = "signs, +1 or -1 in formulas, which select working modes",
                                 .keys = {},
                                 .named = {{.kind = OptionKind::any_of,
                                            .meaning = "the possible signs, the default first",
                                            .parts = {signs, table_key("", sign)}}},
                                 .noun = "sign"};
  return spec;
}

const TableSpec& inputs_table() {
  static const TableSpec input = {
      .meaning = "an input",
      .keys = {required(unit_key("unit of the input: \"rad\", \"m\", \"1\"")),
               number_key("default", "default value; 0 if it is not given"), meaning_key()}};
  static const TableSpec spec = {.header = "[inputs]",
                                 .meaning = "variables besides the pose, on which quantities depend",
                                 .keys = {},
                                 .named = {table_key("", input)},
                                 .noun = "input"};
  return spec;
}

const TableSpec& limit_table() {
  static const TableSpec spec = {
      .header = "[[limit]]",
      .meaning =
          "threshold of a constraint of poses that studies may set; a limit with the name of a parameter replaces the "
          "parameter",
      .keys = {required(text_key("name", "name of the limit")),
               unit_key("unit of the limit: \"m\", \"rad\", \"1\""),
               meaning_key(),
               number_key("inactive", "value that restricts nothing"),
               number_key("min", "minimum threshold"),
               number_key("max", "maximum threshold"),
               formula_key("derived", kUnitOfEntry, "threshold that follows from the parameters"),
               {.name = "constraint",
                .kind = OptionKind::word,
                .choices = {"interference", "singularity-margin"},
                .meaning = "constraint that sets this limit"}}};
  return spec;
}

const TableSpec& margin_table() {
  const OptionSpec formula_or_list = {
      .name = "formula",
      .kind = OptionKind::any_of,
      .unit = kUnitOfEntry,
      .required = true,
      .meaning = "a formula that is >= 0 where the pose is feasible, or a list of such formulas",
      .parts = {formula_key("", kUnitOfEntry, ""), formulas_key("", kUnitOfEntry, 0, "")}};
  static const TableSpec spec = {
      .header = "[[margin]]",
      .meaning = "constraint of poses",
      .keys = {required(text_key("name", "name of the margin")), formula_or_list, unit_key(),
               formula_key("shown", kUnitOfEntry,
                           "formula with which `pose` reports the margin; default: the minimum of the list"),
               text_key("shown_unit", "unit of `shown`; default: `unit`")}};
  return spec;
}

const TableSpec& design_table() {
  static const TableSpec spec = {
      .header = "[[design]]",
      .meaning = "constraint of the design, which studies can use",
      .keys = {required(text_key("name", "name of the constraint")),
               required(formula_key("formula", kUnitOfEntry,
                                    "formula of parameters that is >= 0 if the constraint is satisfied")),
               unit_key(),
               meaning_key(),
               {.name = "required",
                .kind = OptionKind::flag,
                .initial = false,
                .meaning = "the constraint always applies: designs that violate it are rejected"}}};
  return spec;
}

const TableSpec& link_table() {
  static const TableSpec spec = {
      .header = "[[link]]",
      .meaning = "link besides those of the limbs, drawn and tested for clearance",
      .keys = {
          required(text_key("name", "name of the link")),
          place_key("from", "one end"),
          place_key("to", "other end"),
          required(formula_key("radius", "m", "radius of the link")),
          {.name = "group",
           .kind = OptionKind::any_of,
           .meaning =
               "name or names of the groups of links with which it is not tested for clearance: limbs, \"platform\"",
           .parts = {{.kind = OptionKind::word}, texts_key("", "")}},
          {.name = "clearance", .kind = OptionKind::flag, .initial = true, .meaning = "false: the link is drawn only"},
          formula_key("mass", "kg", "mass of the link"),
          formula_key("inertia", "kg m^2", "inertia about the centre of mass, across the link")}};
  return spec;
}

const TableSpec& body_table() {
  static const TableSpec spec = {
      .header = "[[body]]",
      .meaning = "body with a mass, besides limbs, links and platform",
      .keys = {required(text_key("name", "name of the body")), place_key("centre", "centre of mass"),
               required(formula_key("mass", "kg", "mass of the body")),
               formulas_key("inertia", "kg m^2", 3, "principal moments of inertia about the centre of mass"),
               text_key("rotation",
                        "what it rotates with: \"platform\", another frame, a link, or a limb's part (\"arm1.rod\")")}};
  return spec;
}

const TableSpec& joint_table() {
  static const TableSpec spec = {
      .header = "[[joint]]",
      .meaning = "joint of two bodies, for the forces in joints and models for simulation",
      .keys = {required(text_key("name", "name of the joint")),
               {.name = "bodies",
                .kind = OptionKind::list,
                .required = true,
                .meaning = "the two bodies that it joins; the second may be \"base\"",
                .count = 2,
                .parts = {{.kind = OptionKind::word}}},
               place_key("at", "a point of its axis"),
               direction_key("about", "axis [x, y, z] of a revolute joint"),
               direction_key("along", "direction of a slide, which needs `drive`"),
               text_key("in", "frame in which `about` or `along` is given; default: the base"),
               text_key("drive",
                        "joint of a limb with drive = \"formula\" that it is: motion "
                        "of the first body relative to the second")}};
  return spec;
}

}  // namespace

const TableSpec& accuracy_keys() {
  static const TableSpec joints = {.meaning = "errors by joint",
                                   .keys = {},
                                   .named = {formula_key("", kUnitOfEntry, "bound of the joint's error")},
                                   .noun = "joint"};
  static const TableSpec of_limb = {.meaning = "errors of this limb only",
                                    .keys = {},
                                    .named = {formula_key("", kUnitOfEntry, "bound of the error")},
                                    .noun = "parameter"};
  static const TableSpec parameters = {
      .meaning = "errors by parameter; or, under the name of a limb, a table of errors of this limb only",
      .keys = {},
      .named = {{.kind = OptionKind::any_of,
                 .unit = kUnitOfEntry,
                 .meaning = "bound of the error, of each limb independently",
                 .parts = {formula_key("", kUnitOfEntry, ""), table_key("", of_limb)}}},
      .noun = "parameter"};
  static const TableSpec spec = {
      .header = "[accuracy]",
      .meaning = "errors of joints and dimensions, for the quantities `accuracy` and `accuracy_angle`",
      .keys = {{.name = "joint_error",
                .kind = OptionKind::any_of,
                .unit = kUnitOfEntry,
                .meaning = "bound of the errors of all joints, or a table by joint",
                .parts = {formula_key("", kUnitOfEntry, ""), table_key("", joints)}},
               table_key("parameter_error", parameters)}};
  return spec;
}

const TableSpec& quantity_keys() {
  static const TableSpec spec = {
      .header = "[[quantity]]",
      .meaning = "named formula: a value of the design, the pose or the motion",
      .keys = {required(text_key("name", "name of the quantity")),
               required(formula_key("formula", kUnitOfEntry, "formula; NAME_rate is the derivative of NAME by time")),
               unit_key(), meaning_key()}};
  return spec;
}

const TableSpec& limb_parameter_keys() {
  static const TableSpec spec = {
      .meaning = "a parameter of this limb alone; unit, range and default that are not given are those of all limbs",
      .keys = {number_key("default", "default value"), number_key("min", "minimum allowed value"),
               number_key("max", "maximum allowed value"), meaning_key()}};
  return spec;
}

const TableSpec& study_parameters_keys() {
  static const TableSpec spec = [] {
    TableSpec table = parameters_table("[parameters]");
    table.meaning = "parameters that the study adds to those of its mechanism, for motions and formulas";
    return table;
  }();
  return spec;
}

const TableSpec& mechanism_keys() {
  static const TableSpec parameters = parameters_table("[parameters]"), let = let_table("[let]");
  static const TableSpec spec = {.header = "",
                                 .meaning = "mechanism file of pkmopt",
                                 .keys = {required(table_key("mechanism", name_table())),
                                          required(table_key("parameters", parameters)),
                                          table_key("masses", masses_table()),
                                          required(table_key("platform", platform_table())),
                                          tables_key("frame", frame_table()),
                                          tables_key("solve", solve_table()),
                                          table_key("survey", survey_table()),
                                          table_key("modes", modes_table()),
                                          table_key("let", let),
                                          required(tables_key("limb", limb_keys())),
                                          table_key("inputs", inputs_table()),
                                          table_key("forces", forces_table()),
                                          table_key("accuracy", accuracy_keys()),
                                          tables_key("quantity", quantity_keys()),
                                          tables_key("limit", limit_table()),
                                          tables_key("margin", margin_table()),
                                          tables_key("design", design_table()),
                                          tables_key("link", link_table()),
                                          tables_key("body", body_table()),
                                          tables_key("joint", joint_table())},
                                 .noun = "table"};
  return spec;
}

}  // namespace pkm
