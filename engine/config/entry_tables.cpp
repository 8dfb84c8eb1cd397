// Readers of [[objective]], [[constraint]] and [[output]]: entries of the catalogues as named quantities of the
// problem.

#include <algorithm>
#include <map>

#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/design_test.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"

namespace pkm {
namespace {

std::string in_unit(const std::string& unit) { return unit == "1" ? "dimensionless" : "in " + unit; }

constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";

/// The name of an entry within its kind: the value of `name`, otherwise the type. Names are keys of the study file and
/// of JSON.
std::string entry_name(const ConfigValue& table, const std::string& type, const std::vector<StudyEntry>& before) {
  const auto given = table.find("name");
  std::string name = given ? given->text("text") : type;
  // A type that is the name of a [[design]] of the mechanism file can contain blanks.
  if (!given) std::ranges::replace(name, ' ', '-');
  const bool has_outer_blanks = name.starts_with(' ') || name.ends_with(' ');
  if (name.empty() || has_outer_blanks || name.find_first_not_of(kLetters) != std::string::npos)
    throw given->error("a name of letters, digits, blanks between them, '-', '_' and '.'");
  if (find_named(before, name))
    throw table.refusal("the name '" + name + "' is already used; give this one another name with name = \"...\"");
  return name;
}

/// The elements of the array of tables [[name]]; their keys depend on their types and are checked later.
std::vector<ConfigValue> tables_in(const ConfigValue& root, const std::string& name) {
  const auto list = root.find(name);
  if (!list) return {};
  const std::string expected = "a list of tables, each written [[" + name + "]]";
  auto tables = list->elements(expected);
  for (const auto& table : tables) table.expect_table(expected);
  return tables;
}

/// The default name of an objective: "LTI-min" for a statistic of a quantity. The peak and the RMS value of one
/// quantity have different names.
std::string default_name(const ObjectiveEntry& entry, const Options& options) {
  if (options.has("quantity")) return options.word("quantity") + "-" + options.word("statistic");
  if (options.has("call")) return options.word("call").substr(options.word("call").rfind(':') + 1);
  const bool rms = options.has("statistic") && options.word("statistic") == "rms";
  return entry.name + (rms ? "-rms" : "");
}

/// Adds the fields `own` that an entry requests to those requested by the previous entries. Refuses a second
/// characteristic length or working mode, because all samples of a workspace analysis share one of each.
void add_request(const ConfigValue& table, const FieldRequest& own, FieldRequest& request) {
  if (own.needs_jacobian()) {
    if (request.needs_jacobian() && own.characteristic_length != request.characteristic_length)
      throw table.refusal(
          "conditioning is requested with two different characteristic lengths; use one length in all tables");
    request.characteristic_length = own.characteristic_length;
  }
  const auto uses_mode = [](const FieldRequest& of) { return of.needs_inertia() || of.poses; };
  if (uses_mode(own)) {
    if (uses_mode(request) && own.mode != request.mode)
      throw table.refusal("the same workspace analysis is requested in two working modes, " + request.mode + " and " +
                          own.mode + "; use a [[region]] for one of them");
    request.mode = own.mode;
  }
  request.poses = request.poses || own.poses;
  for (const PoseQuantity* const quantity : own.fields) request.add(*quantity);
}

/// Index of the workspace analysis that an entry uses: 0 for the workspace, k for the k-th region.
std::size_t analysis_index(const ConfigValue& table, const ObjectiveEntry& entry, const StudyDraft& draft) {
  const auto named = table.find("region");
  if (!named) return 0;
  if (!entry.uses_workspace)
    throw named->refusal("the objective " + entry.name +
                         " does not use a workspace analysis, so the key region has no effect");
  const auto names = names_of(draft.parts.regions);
  if (names.empty()) throw named->refusal("the study has no [[region]]");
  return static_cast<std::size_t>(std::ranges::find(names, named->word(names)) - names.begin()) + 1;
}

/// Refuses an entry that the mechanism does not support.
template <class Entry>
void refuse_unsupported(const ConfigValue& table, const Entry& entry, const StudyDraft& draft) {
  if (const Unsupported reason = entry.refusal(*draft.parts.mechanism)) throw table.find("type")->refusal(*reason);
}

/// The statistic over built machines that replaces the value of an entry: that of the objective `yield`, or the one
/// that the key `robust` names; std::nullopt if there is none.
std::optional<SampledValue> sampled_value(const ConfigValue& table, const ObjectiveEntry& entry, const Options& options,
                                          const StudyDraft& draft) {
  using Statistic = SampledValue::Statistic;
  constexpr const char* kExpected = "\"worst\", \"mean\", or \"quantile:\" with a number between 0 and 1";
  constexpr const char* kNeeded = " needs the errors of the built machines: give a table [tolerance]";
  const auto robust = table.find("robust");
  if (entry.name == kYield) {
    if (robust) throw robust->refusal("a yield is a statistic over the built machines already");
    if (!draft.has_tolerances) throw table.refusal("the objective yield" + std::string(kNeeded));
    const std::string& statistic = options.word("statistic");
    return SampledValue{statistic == "share"   ? Statistic::yield
                        : statistic == "lower" ? Statistic::yield_lower
                                               : Statistic::yield_upper};
  }
  if (!robust) return {};
  if (!draft.has_tolerances) throw robust->refusal("robust" + std::string(kNeeded));
  const std::string& text = robust->text(kExpected);
  if (text == "worst") return SampledValue{Statistic::worst};
  if (text == "mean") return SampledValue{Statistic::mean};
  const std::string prefix = "quantile:";
  const auto probability = text.starts_with(prefix) ? parse_quantity(text.substr(prefix.size()), "1") : std::nullopt;
  if (!probability || !(*probability > 0 && *probability < 1)) throw robust->error(kExpected);
  return SampledValue{Statistic::quantile, *probability};
}

/// Text that describes the statistic of a quantity, such as ", mean of built machines", for NamedQuantity's role in
/// listings; "" if the quantity has no statistic, or is a yield.
std::string statistic_text(const NamedQuantity& q) {
  using Statistic = SampledValue::Statistic;
  if (!q.sampled || q.sampled->is_yield()) return "";
  if (q.sampled->statistic == Statistic::worst) return ", worst value of built machines";
  if (q.sampled->statistic == Statistic::mean) return ", mean of built machines";
  return ", value that the share " + shortest(1 - q.sampled->probability) + " of built machines reaches";
}

/// Makes a quantity from an entry of the catalogue of objectives, and appends it to `entries`, with an empty
/// StudyEntry::role.
NamedQuantity make_objective(const ConfigValue& table, const ObjectiveEntry& entry, std::vector<StudyEntry>& entries,
                             StudyDraft& draft) {
  const Options options = read_options(table, entry.options);
  const std::string name = entry_name(table, default_name(entry, options), entries);
  entries.push_back({entry.name, name, "", entry.options, options});
  refuse_unsupported(table, entry, draft);
  const std::size_t survey = analysis_index(table, entry, draft);
  if (survey > 0 && options.has("motion"))
    throw table.find("region")->refusal("the objective " + entry.name +
                                        " is evaluated either along a motion or in a region; give one of them");
  Region* const region = survey > 0 ? &draft.parts.regions[survey - 1] : nullptr;
  const EntryContext context{*draft.parts.mechanism, region ? region->plan : draft.parts.plan, options,
                             draft.parts.regions, draft.study.motions};
  return table.explained([&]() -> NamedQuantity {
    FieldRequest own;
    entry.request(context, own);
    add_request(table, own, region ? region->request : draft.parts.request);
    NamedQuantity made{.name = name,
                       .unit = entry.unit(context),
                       .meaning = entry.detail ? entry.detail(context) : entry.meaning,
                       .direction = entry.direction,
                       .quantity = entry.make(context),
                       .analysis = survey,
                       .uses_workspace = entry.reads(context),
                       .range = entry.range(context),
                       .sampled = sampled_value(table, entry, options, draft)};
    if (made.sampled && made.quantity->external_call())
      throw table.find("robust")->refusal("a Python function has no statistic over built machines");
    return made;
  });
}

/// Reads an [[objective]] or an [[output]].
void read_objective(const ConfigValue& value, StudyDraft& draft, bool optimised) {
  const auto& catalogue = draft.catalogues.objectives;
  const ObjectiveEntry& entry = *find_named(catalogue, value.choice("type", names_of(catalogue)));
  const ConfigValue table = value.table(entry.options);
  auto& entries = optimised ? draft.study.objectives : draft.study.outputs;
  NamedQuantity made = make_objective(table, entry, entries, draft);
  std::string role = in_unit(made.unit) + statistic_text(made);
  if (optimised) {
    if (const auto direction = table.find("direction"))
      made.direction = direction->word() == "maximise" ? Direction::maximise : Direction::minimise;
    role = (made.direction == Direction::maximise ? "maximise, " : "minimise, ") + role;
  }
  if (made.sampled) made.sampled->greater_is_better = made.direction == Direction::maximise;
  entries.back().role = role;
  (optimised ? draft.parts.objectives : draft.parts.reports).push_back(std::move(made));
}

/// Reads an objective that is used as a constraint, with a minimum or maximum of its value.
void read_bounded_objective(const ConfigValue& value, const ObjectiveEntry& entry, StudyDraft& draft) {
  const ConfigValue table = value.described_by(bounded_objective_keys(), entry.options);
  const auto least = table.find("min"), greatest = table.find("max");
  if (!least && !greatest)
    throw table.refusal("give min = .. or max = ..: the objective " + entry.name + " is used as a constraint");
  if (least && greatest)
    throw table.refusal("found both min and max; give one of them, and write a second [[constraint]] for the other");
  NamedQuantity made = make_objective(table, entry, draft.study.constraints, draft);
  const double bound = (least ? least : greatest)->number(made.unit);
  (least ? made.lower_bound : made.upper_bound) = bound;
  if (made.sampled) made.sampled->greater_is_better = least.has_value();
  const std::string role = (least ? ">= " : "<= ") + with_unit(bound, made.unit) + statistic_text(made);
  made.meaning = "margin of " + role + ": " + made.meaning;
  draft.study.constraints.back().role = role;
  // Constraints without a workspace analysis come first: the analysis is skipped if they are violated. External
  // functions and statistics over built machines are evaluated last.
  const bool is_late = made.uses_workspace || made.sampled || made.quantity->external_call();
  (is_late ? draft.parts.workspace_margins : draft.parts.design_margins).push_back(std::move(made));
}

/// Reads a [[constraint]] that has a margin: a constraint on the design alone, or on the result of a workspace
/// analysis.
void read_margin_constraint(const ConfigValue& value, const ConstraintEntry& entry, StudyDraft& draft) {
  auto specs = entry.options(draft.info());
  const ConfigValue table = value.described_by(margin_constraint_keys(), specs);
  refuse_unsupported(table, entry, draft);
  // The unit of the margin may depend on some options, and other options may have this unit; these are read second.
  auto first = specs;
  std::erase_if(first, [](const OptionSpec& spec) { return spec.unit == kUnitOfEntry; });
  Options options = read_options(table, first);
  const EntryContext context{*draft.parts.mechanism, draft.parts.plan, options, draft.parts.regions,
                             draft.study.motions};
  NamedQuantity made;
  made.name = entry_name(table, entry.name, draft.study.constraints);
  if (const auto robust = table.find("robust")) made.sampled = sampled_value(table, {}, options, draft);
  table.explained([&] {
    made.unit = entry.unit(context);
    specs = with_entry_unit(std::move(specs), made.unit);
    options = read_options(table, specs);
    made.quantity = entry.make(context);
    if (entry.name == kMotionConstraint) draft.parts.followed.push_back({motion_of(context), mode_of(context)});
    made.meaning = entry.detail ? entry.detail(context) : entry.meaning;
    made.uses_workspace = entry.needs_workspace && entry.needs_workspace(context);
    FieldRequest own;
    entry.request(context, own);
    add_request(table, own, draft.parts.request);
  });
  const std::string role = "margin >= 0, " + in_unit(made.unit) + statistic_text(made);
  draft.study.constraints.push_back({entry.name, made.name, role, specs, options});
  (made.uses_workspace || made.sampled ? draft.parts.workspace_margins : draft.parts.design_margins)
      .push_back(std::move(made));
}

/// Name of the constraint that a motion adds to a study: "motion-cycle" for a motion called cycle; characters that are
/// invalid in names of constraints become dashes.
std::string implied_name(const std::string& motion, const std::vector<StudyEntry>& before) {
  std::string name = std::string(kMotionConstraint) + "-" + motion;
  for (char& letter : name)
    if (std::string(kLetters).find(letter) == std::string::npos) letter = '-';
  while (find_named(before, name)) name += "-2";
  return name;
}

/// Adds the constraint that a motion satisfies every pose-level limit: one for each motion that entries use and for
/// each working mode. It is omitted if the study already has the constraint, or the motion has follow = false.
void add_motion_constraints(StudyDraft& draft) {
  const ConstraintEntry* const entry = find_named(draft.catalogues.constraints, kMotionConstraint);
  if (!entry || draft.implied == ImpliedConstraints::left_out) return;
  struct Use {
    std::int64_t samples = 0;  ///< maximum number of samples over the entries; 0: none of the entries has samples
    std::vector<std::string> names;
  };
  Study& study = draft.study;
  for (const DesignMotion& named : study.motions) {
    std::map<std::string, Use> by_mode;
    bool is_stated = contains(study.unfollowed_motions, named.name);
    for (const auto* const list : {&study.objectives, &study.constraints, &study.outputs})
      for (const StudyEntry& user : *list) {
        if (!user.options.has("motion") || user.options.word("motion") != named.name) continue;
        is_stated = is_stated || user.type == kMotionConstraint;
        const std::string mode = user.options.has("mode") ? user.options.word("mode") : draft.info().modes.front();
        Use& use = by_mode[mode];
        if (user.options.has("samples")) use.samples = std::max(use.samples, user.options.integer("samples"));
        if (!contains(use.names, user.name)) use.names.push_back(user.name);
      }
    if (is_stated) continue;
    for (const auto& [mode, use] : by_mode) {
      auto specs = entry->options(draft.info());
      Options options = default_options(specs);
      options.set("motion", named.name);
      if (use.samples > 0) options.set("samples", use.samples);
      if (mode != draft.info().modes.front()) options.set("mode", mode);
      const EntryContext context{*draft.parts.mechanism, draft.parts.plan, options, draft.parts.regions, study.motions};
      NamedQuantity made{.name = implied_name(named.name, study.constraints),
                         .unit = entry->unit(context),
                         .meaning = entry->detail(context),
                         .quantity = entry->make(context),
                         .uses_workspace = false};
      const std::string role = "margin >= 0, " + in_unit(made.unit) + ", because of " + join(use.names, " and ");
      study.constraints.push_back({entry->name, made.name, role, std::move(specs), options});
      draft.parts.design_margins.push_back(std::move(made));
      draft.parts.followed.push_back({named, mode});
    }
  }
}

void read_pose_constraint(const ConfigValue& value, const ConstraintEntry& entry, StudyDraft& draft) {
  const MechanismInfo& info = draft.info();
  const auto specs = entry.options(info);
  const ConfigValue table = value.described_by(pose_constraint_keys(), specs);
  refuse_unsupported(table, entry, draft);
  const Options options = read_options(table, specs);
  LimitSpec& all = draft.parts.plan.limits;
  const LimitSpec own = table.explained([&] { return entry.limits(info, options); });
  std::vector<std::string> set;
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    if (!own.given[i] && !own.derived[i]) continue;
    std::string& origin = draft.study.limit_origins[i];
    if (!origin.empty())
      throw table.refusal("the threshold " + info.limits[i].name + " is set here and in " + origin + "; set it once");
    origin = table.place().key + " " + entry.name + " (" + table.line() + ")";
    all.given[i] = own.given[i];
    all.derived[i] = own.derived[i];
    set.push_back(info.limits[i].name);
  }
  const std::string role = set.empty() ? "sets no threshold" : "restricts the workspace by " + join(set);
  draft.study.constraints.push_back({entry.name, entry.name, role, specs, options});
}

/// Reads either the pose-level [[constraint]]s or all others, including those whose type is an objective.
void read_constraints(const ConfigValue& root, StudyDraft& draft, bool pose_level) {
  std::vector<ConstraintEntry> entries = draft.catalogues.constraints;
  // Every [[design]] of the mechanism file is a type of constraint, too.
  for (const DesignMarginInfo& test : design_tests_of(*draft.parts.mechanism))
    if (!find_named(entries, test.name)) entries.push_back(design_test(test.name, test.meaning));
  std::vector<std::string> names = names_of(entries);
  for (const auto& name : names_of(draft.catalogues.objectives))
    if (!contains(names, name)) names.push_back(name);
  for (const auto& table : tables_in(root, "constraint")) {
    const std::string& type = table.choice("type", names);
    const ConstraintEntry* const entry = find_named(entries, type);
    if ((entry && entry->pose_level()) != pose_level) continue;
    if (pose_level)
      read_pose_constraint(table, *entry, draft);
    else if (entry)
      read_margin_constraint(table, *entry, draft);
    else
      read_bounded_objective(table, *find_named(draft.catalogues.objectives, type), draft);
  }
}

/// A threshold replaces the parameter of the same name, so this parameter must not be a variable.
void check_thresholds(const ConfigValue& root, const StudyDraft& draft) {
  const auto variables = root.find("variables");
  if (!variables) return;
  const auto& limits = draft.info().limits;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (const auto varied = variables->find(limits[i].name); varied && draft.parts.plan.limits.given[i])
      throw varied->refusal("the threshold " + limits[i].name + " is set in " + draft.study.limit_origins[i] +
                            ", so it cannot be a variable");
}

}  // namespace

void read_pose_constraints(const ConfigValue& root, StudyDraft& draft) {
  read_constraints(root, draft, true);
  override_limits(draft);
  check_thresholds(root, draft);
}

void read_quantities(const ConfigValue& root, StudyDraft& draft) {
  draft.has_tolerances = root.has("tolerance");
  for (const auto& table : tables_in(root, "objective")) read_objective(table, draft, true);
  read_constraints(root, draft, false);
  for (const auto& table : tables_in(root, "output")) read_objective(table, draft, false);
  add_motion_constraints(draft);
}

}  // namespace pkm
