#include "engine/config/study_keys.hpp"

#include "engine/config/key_specs.hpp"
#include "engine/config/mechanism_keys.hpp"

namespace pkm {
namespace {

/// Description of { name = number }: values of parameters. A parameter of a single limb, arm2.l_b, may be written in a
/// table arm2.
const TableSpec& parameter_values() {
  static const TableSpec limb = {.meaning = "parameters of this limb alone",
                                 .keys = {},
                                 .named = {{.unit = kUnitOfEntry, .meaning = "value of the parameter"}},
                                 .noun = "parameter"};
  static const TableSpec all = {.meaning = "parameters with their values",
                                .keys = {},
                                .named = {{.kind = OptionKind::any_of,
                                           .unit = kUnitOfEntry,
                                           .meaning = "value of the parameter",
                                           .parts = {{.unit = kUnitOfEntry},
                                                     {.kind = OptionKind::word},
                                                     {.kind = OptionKind::table, .table = &limb}}}},
                                .noun = "parameter"};
  return all;
}

const TableSpec& study_table() {
  static const TableSpec spec = {
      .header = "[study]",
      .meaning = "name, seed and study file",
      .keys = {{.name = "name",
                .kind = OptionKind::word,
                .meaning = "name that is displayed and stored; default: the stem of the file name"},
               {.name = "seed",
                .kind = OptionKind::integer,
                .initial = std::int64_t{1},
                .lower = 0,
                .meaning = "seed of all random numbers"},
               {.name = "output",
                .kind = OptionKind::word,
                .meaning = "study file; default: the stem of the file name + .h5 in the current folder"}}};
  return spec;
}

const TableSpec& mechanism_table() {
  static const TableSpec spec = {
      .header = "[mechanism]",
      .meaning = "the robot, by `type` or by `file`",
      .keys = {
          {.name = "type",
           .kind = OptionKind::word,
           .meaning = "built-in mechanism: a name of `pkmopt list mechanisms`"},
          {.name = "file", .kind = OptionKind::word, .meaning = "mechanism file, relative to the study's folder"},
          {.name = "masses",
           .kind = OptionKind::word,
           .meaning = "mass model, one of the mechanism's `mass_models`; default: the first"},
          table_key("parameters", parameter_values(), "fixed parameters; the others have the mechanism's defaults")}};
  return spec;
}

const TableSpec& variables_table() {
  static const TableSpec variable = {
      .meaning = "bounds of a variable",
      .keys = {{.name = "min", .unit = kUnitOfEntry, .required = true, .meaning = "lower bound"},
               {.name = "max", .unit = kUnitOfEntry, .required = true, .meaning = "upper bound"},
               {.name = "step",
                .unit = kUnitOfEntry,
                .meaning = "makes the variable discrete: min + k step",
                .positive = true},
               {.name = "tie",
                .kind = OptionKind::flag,
                .initial = false,
                .meaning = "one value for all limbs, also for those with a value of their own in the mechanism file; "
                           "a pattern such as \"arm*.l_b\" without it stands for one variable per limb"}}};
  static const TableSpec choice = {
      .meaning = "a choice from a catalogue",
      .keys = {{.name = "from",
                .kind = OptionKind::word,
                .required = true,
                .meaning = "file with one list of tables, such as [[motor]], each with a name; [[drive_train]] and "
                           "[mechanism] refer to the chosen one by \"VARIABLE.KEY\""}}};
  static const TableSpec limb = {
      .meaning = "variables of this limb alone",
      .keys = {},
      .named = {{.kind = OptionKind::table, .meaning = "bounds of the parameter", .table = &variable}},
      .noun = "parameter"};
  static const TableSpec spec = {.header = "[variables]",
                                 .meaning = "parameters that the optimisers may change",
                                 .keys = {},
                                 .named = {{.kind = OptionKind::any_of,
                                            .meaning = "bounds of the parameter",
                                            .parts = {{.kind = OptionKind::table, .table = &variable},
                                                      {.kind = OptionKind::table, .table = &choice},
                                                      {.kind = OptionKind::table, .table = &limb}}}},
                                 .noun = "parameter"};
  return spec;
}

const TableSpec& baseline_table() {
  static const TableSpec spec = [] {
    TableSpec values = parameter_values();
    values.header = "[baseline]";
    values.meaning = "design to compare with; it may lie outside the bounds";
    return values;
  }();
  return spec;
}

OptionSpec type_key(const std::string& catalogue) {
  return {.name = "type",
          .kind = OptionKind::word,
          .required = true,
          .meaning = "a name of `pkmopt list " + catalogue + "`"};
}
OptionSpec name_key() {
  return {
      .name = "name", .kind = OptionKind::word, .meaning = "name, needed if a type is used twice; default: the type"};
}
OptionSpec robust_key() {
  return {.name = "robust",
          .kind = OptionKind::word,
          .meaning =
              "statistic over the machines built within [tolerance] that replaces the value: \"worst\", \"mean\" "
              "or \"quantile:0.05\", the value that 95 % of them reach"};
}
OptionSpec region_key() {
  return {.name = "region",
          .kind = OptionKind::word,
          .meaning = "name of the [[region]] to evaluate instead of the workspace"};
}

const TableSpec& objective_table() {
  static const TableSpec spec = {.header = "[[objective]]",
                                 .meaning = "value to be optimised; its further keys are the options of its type",
                                 .keys = {type_key("objectives"),
                                          name_key(),
                                          {.name = "direction",
                                           .kind = OptionKind::word,
                                           .choices = {"minimise", "maximise"},
                                           .meaning = "default: the objective's own"},
                                          region_key(),
                                          robust_key()}};
  return spec;
}

const TableSpec& constraint_table() {
  static const TableSpec spec = {
      .header = "[[constraint]]",
      .meaning = "requirement; its further keys are the options of its type",
      .keys = {{.name = "type",
                .kind = OptionKind::word,
                .required = true,
                .meaning = "a name of `pkmopt list constraints`, or an objective with `min` or `max`"},
               name_key()}};
  return spec;
}

const TableSpec& output_table() {
  static const TableSpec spec = {
      .header = "[[output]]",
      .meaning = "value that is computed and stored, but not optimised; it has the keys of an objective",
      .keys = {type_key("objectives"), name_key(), region_key(), robust_key()}};
  return spec;
}

const TableSpec& tolerance_table() {
  static const TableSpec error = {
      .meaning = "error of a parameter of the built machines",
      .keys = {{.name = "bound",
                .unit = kUnitOfEntry,
                .required = true,
                .meaning = "largest error, of either sign",
                .positive = true},
               {.name = "distribution",
                .kind = OptionKind::word,
                .initial = std::string("uniform"),
                .choices = {"uniform", "normal"},
                .meaning = "distribution of the error within the bound; a normal one is truncated"},
               {.name = "sigma",
                .unit = kUnitOfEntry,
                .meaning = "standard deviation of a normal distribution; default: a third of the bound",
                .positive = true},
               {.name = "copies",
                .kind = OptionKind::word,
                .initial = std::string("independent"),
                .choices = {"independent", "common"},
                .meaning = "whether each limb of a mechanism file has an error of its own, or all have the same"}}};
  static const std::vector<OptionSpec> alternatives = {
      {.unit = kUnitOfEntry, .meaning = "largest error of a uniform distribution", .positive = true},
      {.kind = OptionKind::table, .table = &error}};
  // Table for the error of a parameter in a single limb, which has no key `copies`.
  static const TableSpec error_of_limb = [] {
    TableSpec table = error;
    table.keys.pop_back();
    return table;
  }();
  static const TableSpec limb = {
      .meaning = "errors of this limb alone",
      .keys = {},
      .named = {{.kind = OptionKind::any_of,
                 .unit = kUnitOfEntry,
                 .meaning = "error of the parameter",
                 .parts = {alternatives[0], {.kind = OptionKind::table, .table = &error_of_limb}}}},
      .noun = "parameter"};
  static const TableSpec correlation = {
      .header = "[[tolerance.correlation]]",
      .meaning = "correlation of normal errors",
      .keys = {{.name = "between",
                .kind = OptionKind::list,
                .required = true,
                .meaning = "two parameters; one that several limbs have stands for each of its copies",
                .count = 2,
                .parts = {{.kind = OptionKind::word}}},
               {.name = "coefficient",
                .required = true,
                .lower = -1,
                .upper = 1,
                .meaning = "correlation coefficient of each pair, before the truncation"}}};
  static const TableSpec spec = [] {
    TableSpec table = {.header = "[tolerance]",
                       .meaning = "errors of the parameters of built machines",
                       .keys = {{.name = "samples",
                                 .kind = OptionKind::integer,
                                 .initial = std::int64_t{64},
                                 .lower = 2,
                                 .upper = 1e7,
                                 .meaning = "number of built machines that statistics are computed from"},
                                tables_key("correlation", correlation)},
                       .named = {{.kind = OptionKind::any_of,
                                  .unit = kUnitOfEntry,
                                  .meaning = "error of the parameter",
                                  .parts = alternatives}},
                       .noun = "parameter"};
    table.named.front().parts.push_back({.kind = OptionKind::table, .table = &limb});
    return table;
  }();
  return spec;
}

const TableSpec& reference_table() {
  static const TableSpec design = {.meaning = "values of the variables",
                                   .keys = {},
                                   .named = {{.unit = kUnitOfEntry, .meaning = "value of the variable"}},
                                   .noun = "variable"};
  static const TableSpec values = {.meaning = "values of objectives and outputs",
                                   .keys = {},
                                   .named = {{.unit = kUnitOfEntry, .meaning = "published value"}},
                                   .noun = "objective or output"};
  static const TableSpec spec = {
      .header = "[[reference]]",
      .meaning = "published result for comparison",
      .keys = {
          {.name = "name", .kind = OptionKind::word, .required = true, .meaning = "where the result was published"},
          table_key("design", design, "published design, by variables"),
          table_key("values", values, "published values of objectives and outputs, by name"),
          {.name = "seconds", .unit = "s", .lower = 0, .meaning = "published computing time"}}};
  return spec;
}

const TableSpec& obstacle_table() {
  const auto point = [](const std::string& name, const std::string& meaning) -> OptionSpec {
    return {.name = name,
            .kind = OptionKind::list,
            .unit = "m",
            .required = true,
            .meaning = meaning,
            .count = 3,
            .parts = {{.unit = "m"}}};
  };
  const OptionSpec radius = {.name = "radius", .unit = "m", .required = true, .meaning = "radius", .positive = true};
  static const TableSpec spec = {
      .header = "[[obstacle]]",
      .meaning = "body fixed in the base, from which links keep the clearance",
      .keys =
          {{.name = "name", .kind = OptionKind::word, .required = true, .meaning = "name, for messages and pictures"},
           {.name = "shape",
            .kind = OptionKind::word,
            .required = true,
            .choices = {"box", "sphere", "capsule"},
            .meaning = "shape of the body"}},
      .choice = "shape",
      .variants = {
          {"box",
           "a box along the axes of the base",
           {point("centre", "centre of the box [x, y, z]"),
            {.name = "size",
             .kind = OptionKind::list,
             .unit = "m",
             .required = true,
             .meaning = "sizes [along x, along y, along z]",
             .count = 3,
             .parts = {{.unit = "m", .positive = true}}}}},
          {"sphere", "a sphere", {point("centre", "centre of the sphere [x, y, z]"), radius}},
          {"capsule",
           "a cylinder with hemispherical ends: a post or a pipe",
           {point("from", "one end of the axis [x, y, z]"), point("to", "other end of the axis [x, y, z]"), radius}}}};
  return spec;
}

const TableSpec& stage_table() {
  static const TableSpec spec = {
      .header = "[[stage]]",
      .meaning = "optimiser; its further keys are the options of the optimiser. Stages run one after the other",
      .keys = {{.name = "optimiser",
                .kind = OptionKind::word,
                .required = true,
                .meaning = "a name of `pkmopt list optimisers`"}}};
  return spec;
}

const TableSpec& checkpoint_table() {
  static const TableSpec spec = {
      .header = "[checkpoint]",
      .meaning = "writing of the study file during the run",
      .keys = {
          {.name = "every",
           .unit = "s",
           .lower = 0,
           .meaning =
               "time between checkpoints; default: adaptive, at most 2 % of the run time; 0: after each generation"}}};
  return spec;
}

const TableSpec& final_table() {
  static const TableSpec spec = {
      .header = "[final]",
      .meaning = "rounding of the best design after the last stage",
      .keys = {{.name = "round",
                .unit = kUnitOfEntry,
                .meaning = "the best design is rounded to multiples of this step and evaluated again",
                .positive = true}}};
  return spec;
}

const TableSpec& override_table() {
  const auto texts = [](const std::string& name, const std::string& meaning) -> OptionSpec {
    return {.name = name, .kind = OptionKind::list, .meaning = meaning, .parts = {{.kind = OptionKind::word}}};
  };
  static const TableSpec spec = {.header = "[[override]]",
                                 .meaning = "changes by the command line, appended to the text in the study file",
                                 .keys = {texts("set", "values of the option --set"),
                                          texts("limit", "values of the option --limit"),
                                          texts("cells", "values of the option --cells"),
                                          texts("start_from", "study file of the option --start-from"),
                                          texts("start", "designs of this file, at which the first stage starts"),
                                          {.name = "catalogue",
                                           .kind = OptionKind::word,
                                           .meaning = "name of the file of a catalogue that [variables] use"},
                                          texts("text", "lines of this file")}};
  return spec;
}

}  // namespace

const TableSpec& study_keys() {
  static const TableSpec spec = {.header = "",
                                 .meaning = "study of pkmopt",
                                 .keys = {table_key("study", study_table()),
                                          required(table_key("mechanism", mechanism_table())),
                                          table_key("parameters", study_parameters_keys()),
                                          table_key("variables", variables_table()),
                                          table_key("baseline", baseline_table()),
                                          table_key("workspace", workspace_keys()),
                                          tables_key("region", region_keys()),
                                          tables_key("motion", motion_keys()),
                                          tables_key("objective", objective_table()),
                                          tables_key("constraint", constraint_table()),
                                          tables_key("output", output_table()),
                                          tables_key("reference", reference_table()),
                                          tables_key("drive_train", drive_train_keys()),
                                          tables_key("motor", motor_keys()),
                                          tables_key("obstacle", obstacle_table()),
                                          tables_key("quantity", quantity_keys()),
                                          table_key("accuracy", accuracy_keys()),
                                          table_key("tolerance", tolerance_table()),
                                          required(tables_key("stage", stage_table())),
                                          table_key("checkpoint", checkpoint_table()),
                                          table_key("final", final_table()),
                                          tables_key("override", override_table())},
                                 .noun = "table"};
  return spec;
}

const TableSpec& task_keys() {
  static const TableSpec task = {.header = "[task]",
                                 .meaning = "name of the task",
                                 .keys = {{.name = "name",
                                           .kind = OptionKind::word,
                                           .meaning = "name that is displayed; default: the stem of the file name"}}};
  static const TableSpec position = {
      .meaning = "position of the robot's base in the frame of the task",
      .keys = {},
      .named = {{.unit = kUnitOfEntry, .meaning = "value of the coordinate at the robot's origin"}},
      .noun = "coordinate"};
  static const TableSpec origins = {
      .header = "[origin]",
      .meaning = "positions of the robots' bases in the frame of the task; default: 0",
      .keys = {},
      .named = {{.kind = OptionKind::table, .meaning = "position of the robot of this name", .table = &position}},
      .noun = "robot"};
  static const TableSpec limits = [] {
    TableSpec table = {
        .header = "[workspace]", .meaning = "limits of poses that every robot has to satisfy", .keys = {}};
    for (const OptionSpec& key : workspace_keys().keys)
      if (key.name == "limits") table.keys.push_back(key);
    return table;
  }();
  static const TableSpec drive_train = [] {
    TableSpec table = drive_train_keys();
    table.meaning = "drive trains of the robots, instead of those of their studies";
    for (OptionSpec& key : table.keys) {
      if (key.name == "motor") key.meaning = "name of a [[motor]] of the task: its rotor and its limits";
      if (key.name != "joint") continue;
      key.choices = {"all", "revolute", "prismatic"};
      key.meaning = "the joints of the robots that have this drive train";
    }
    return table;
  }();
  static const TableSpec spec = {.header = "",
                                 .meaning = "task of several robots",
                                 .keys = {table_key("task", task), table_key("origin", origins),
                                          table_key("workspace", limits), tables_key("region", region_keys()),
                                          tables_key("motion", motion_keys()), tables_key("output", output_table()),
                                          tables_key("drive_train", drive_train), tables_key("motor", motor_keys())},
                                 .noun = "table"};
  return spec;
}

const TableSpec& pose_constraint_keys() {
  static const TableSpec spec = {
      .header = "[[constraint]]", .meaning = "constraint of poses", .keys = {constraint_table().keys[0]}};
  return spec;
}

const TableSpec& margin_constraint_keys() {
  static const TableSpec spec = [] {
    TableSpec table = constraint_table();
    table.keys.push_back(robust_key());
    return table;
  }();
  return spec;
}

const TableSpec& bounded_objective_keys() {
  static const TableSpec spec = {
      .header = "[[constraint]]",
      .meaning = "objective with a bound",
      .keys = {constraint_table().keys[0],
               name_key(),
               {.name = "min", .unit = kUnitOfEntry, .meaning = "minimum allowed value of the objective"},
               {.name = "max", .unit = kUnitOfEntry, .meaning = "maximum allowed value of the objective"},
               region_key(),
               robust_key()}};
  return spec;
}

}  // namespace pkm
