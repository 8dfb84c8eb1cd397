// Reader of [tolerance]: errors of the parameters of built machines, by parameter and by limb.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/config/built_in_files.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

constexpr double kSigmasOfBound = 3;  // ratio of the bound of an error to the default standard deviation

/// A parameter that [tolerance] names: one that all limbs share ("l_a"), or one of a single limb ("arm2.l_a").
struct Tolerance {
  std::string name;
  ConfigValue value;
  double bound, sigma;
  /// true: the parameter has an independent error in each limb; false: the same error in all limbs.
  bool is_independent;
  bool has_copies_key;      ///< true: the file sets the key `copies`
  std::string common = {};  ///< name of the parameter without the name of a limb, such as "l_a"
};

const std::vector<std::string> kSettings = {"samples", "correlation"};

/// The names of the parameters whose errors the table [tolerance] gives. If a key is not a parameter, but the name of a
/// limb, its table contains parameters of this limb.
std::vector<std::string> names_in(const ConfigValue& table, const std::vector<Parameter>& known) {
  std::vector<std::string> names;
  for (const std::string& key : table.keys()) {
    if (contains(kSettings, key)) continue;
    const ConfigValue value = *table.find(key);
    if (value.is_table() && !find_named(known, key) && key.find('.') == std::string::npos)
      for (const std::string& inner : value.keys()) names.push_back(key + "." + inner);
    else
      names.push_back(key);
  }
  return names;
}

/// [tolerance] with its description, which includes the names of parameters; std::nullopt if the study has none.
std::optional<ConfigValue> find_tolerances(const ConfigValue& root, const std::vector<Parameter>& known) {
  const auto table = root.find("tolerance");
  if (!table) return {};
  std::vector<std::string> names = names_in(*table, known);
  for (const std::string& key : table->keys())  // the keys include names of limbs, such as "arm2" of arm2.l_a
    if (!contains(kSettings, key) && !contains(names, key)) names.push_back(key);
  return table->table(named_keys(table->table_spec(), names));
}

std::vector<Tolerance> read_errors(const ConfigValue& table, const std::vector<Parameter>& known) {
  std::vector<Tolerance> all;
  for (const std::string& name : names_in(table, known)) {
    const ConfigValue value = *table.find(name);
    const std::string common = name.substr(name.find('.') + 1);
    const Parameter* const parameter = find_named(known, common);
    if (!parameter) {
      std::vector<std::string> expected = names_of(known);
      expected.insert(expected.end(), kSettings.begin(), kSettings.end());
      throw value.error_of("an unknown parameter", "one of " + join(expected), nearest_name(common, expected));
    }
    if (find_named(all, name)) throw value.refusal("the parameter is there already");
    Tolerance read{
        .name = name, .value = value, .bound = 0, .sigma = 0, .is_independent = true, .has_copies_key = false};
    read.common = common;
    if (!value.is_table()) {
      read.bound = value.positive(parameter->unit);
    } else {
      const ConfigValue keys = value.table();
      read.bound = keys.at("bound").positive(parameter->unit);
      const auto sigma = keys.find("sigma");
      if (keys.word_at("distribution") == "normal") {
        read.sigma = sigma ? sigma->positive(parameter->unit) : read.bound / kSigmasOfBound;
        if (read.sigma > read.bound)
          throw sigma->error("a standard deviation of at most the bound " + with_unit(read.bound, parameter->unit) +
                             "; a wider distribution is nearly uniform");
      } else if (sigma) {
        throw sigma->refusal("only a normal distribution has a standard deviation: distribution = \"normal\"");
      }
      read.is_independent = keys.word_at("copies") == "independent";
      read.has_copies_key = keys.has("copies");
      if (read.has_copies_key && name != common)
        throw keys.find("copies")->refusal(name + " is one copy; the key belongs to the parameter " + common);
    }
    all.push_back(std::move(read));
  }
  if (all.empty()) throw table.error_of("no parameter", "errors of parameters, such as l_a = \"0.2 mm\"");
  return all;
}

/// For each parameter that has independent errors in the limbs, one parameter per limb, such as "arm2.l_a".
std::vector<LimbParameter> find_copies(const std::vector<Tolerance>& tolerances, const StudyDraft& draft) {
  std::vector<std::string> common;
  for (const Tolerance& each : tolerances)
    if (each.is_independent && !contains(common, each.common)) common.push_back(each.common);
  const std::optional<SourceText> description =
      draft.study.description ? draft.study.description : find_built_in_file(draft.info().name);
  std::vector<LimbParameter> copies;
  if (description && !common.empty())
    copies = limb_copies(description->text, description->file_name, common, draft.limb_parameters);
  if (!draft.study.description) {
    // A built-in mechanism may describe several limbs by the formulas of one limb. A parameter with a single copy is
    // therefore not a dimension of one real part, and has no independent errors.
    const auto all = copies;
    std::erase_if(copies, [&all](const LimbParameter& copy) {
      return std::ranges::count(all, copy.parameter, &LimbParameter::parameter) < 2;
    });
  }
  for (const Tolerance& each : tolerances) {
    const auto is_it = [&each](const LimbParameter& copy) {
      return each.name == copy.name() || each.name == copy.parameter;
    };
    if (std::ranges::any_of(copies, is_it) || find_named(draft.info().parameters, each.name) == nullptr) {
      if (std::ranges::any_of(copies, is_it)) continue;
      std::vector<std::string> names;
      for (const LimbParameter& copy : copies) names.push_back(copy.name());
      if (!description)
        throw each.value.refusal("parameters of single limbs need a mechanism file; 'pkmopt new mechanism' writes one");
      throw each.value.error_of(
          "an unknown copy of " + each.common,
          names.empty() ? "a parameter on which joints or limits of a limb depend" : "one of " + join(names),
          nearest_name(each.name, names));
    }
    if (each.has_copies_key && each.is_independent)
      throw each.value.refusal(draft.study.description ? "no joint or limit of a single limb depends on " + each.name +
                                                             "; expected copies = \"common\""
                                                       : "the limbs of this mechanism share " + each.name +
                                                             "; expected copies = \"common\", or a mechanism file");
  }
  return copies;
}

/// Sets the errors of a tolerance model: one for each copy of a parameter in a limb, and one for each parameter without
/// copies.
void add_errors(const std::vector<Tolerance>& tolerances, const std::vector<LimbParameter>& copies,
                const std::vector<Parameter>& known, ToleranceModel& model) {
  const auto add = [&](const std::string& name, const Tolerance& tolerance) {
    const auto parameter = static_cast<std::size_t>(find_named(known, name) - known.data());
    model.errors.push_back({name, parameter, tolerance.bound, tolerance.sigma});
  };
  for (const Tolerance& each : tolerances) {
    bool has_copies = false;
    for (const LimbParameter& copy : copies) {
      if (!each.is_independent || copy.parameter != each.name) continue;
      has_copies = true;
      if (!find_named(tolerances, copy.name())) add(copy.name(), each);
    }
    if (!has_copies) add(each.name, each);
  }
}

/// Cholesky factor of the part of a matrix in the given rows and the columns with the same indices; empty if this part
/// is not positive definite.
std::vector<std::vector<double>> cholesky(const std::vector<std::vector<double>>& matrix,
                                          const std::vector<std::size_t>& rows) {
  std::vector<std::vector<double>> factor(rows.size(), std::vector<double>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k <= i; ++k) {
      double rest = matrix[rows[i]][rows[k]];
      for (std::size_t j = 0; j < k; ++j) rest -= factor[i][j] * factor[k][j];
      if (i == k && !(rest > 1e-12)) return {};
      factor[i][k] = i == k ? std::sqrt(rest) : rest / factor[k][k];
    }
  return factor;
}

/// Reads the key `correlation`, and divides the errors into groups; errors of one group are correlated and sampled
/// together.
void read_correlations(const ConfigValue& table, ToleranceModel& model) {
  const std::size_t count = model.errors.size();
  std::vector<std::vector<double>> matrix(count, std::vector<double>(count));
  for (std::size_t i = 0; i < count; ++i) matrix[i][i] = 1;
  std::vector<std::size_t> group(count);  // for each error, the number of its group
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto named = [&model](const ConfigValue& name) {
    const std::string& text = name.text("a parameter of the table");
    std::vector<std::size_t> found;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < model.errors.size(); ++i) {
      const ParameterError& error = model.errors[i];
      const std::string common = error.name.substr(error.name.find('.') + 1);
      for (const std::string& each : {error.name, common})
        if (!contains(names, each)) names.push_back(each);
      if (text != error.name && text != common) continue;
      if (error.sigma == 0)
        throw name.refusal("the error of " + text + " is uniform; correlated errors need distribution = \"normal\"");
      found.push_back(i);
    }
    if (found.empty()) throw name.error("one of " + join(names), nearest_name(text, names));
    return found;
  };
  const auto list = table.find("correlation");
  for (const ConfigValue& each : table.tables("correlation")) {
    const std::vector<ConfigValue> pair = each.at("between").elements("two parameters");
    const double coefficient = each.at("coefficient").number();
    bool any = false;
    for (const std::size_t i : named(pair[0]))
      for (const std::size_t k : named(pair[1])) {
        if (i == k) continue;
        any = true;
        matrix[i][k] = matrix[k][i] = coefficient;
        const std::size_t from = group[k], to = group[i];
        std::ranges::replace(group, from, to);
      }
    if (!any) throw each.refusal("there is only one error, which has no other to be correlated with");
  }
  for (std::size_t g = 0; g < count; ++g) {
    ErrorGroup members;
    for (std::size_t i = 0; i < count; ++i)
      if (group[i] == g) members.errors.push_back(i);
    if (members.errors.empty()) continue;
    if (members.errors.size() > 1) {
      members.factor = cholesky(matrix, members.errors);
      if (members.factor.empty())
        throw list->refusal("the matrix of these correlations is not positive definite: no errors have all of them");
    }
    model.groups.push_back(std::move(members));
  }
}

/// Converts the quantities of a study to those of a single machine: removes yields, and replaces statistics over
/// machines by the value for the machine.
void remove_statistics(ProblemParts& parts) {
  for (auto* const list : {&parts.objectives, &parts.design_margins, &parts.workspace_margins, &parts.reports}) {
    std::erase_if(*list, [](const NamedQuantity& q) { return q.sampled && q.sampled->is_yield(); });
    for (NamedQuantity& q : *list) q.sampled.reset();
  }
}

/// The problem that is evaluated for each sampled machine. Its quantities are those of which the study needs
/// statistics; their indices are written to SampledValue::row in `parts`, the problem of the study.
/// @param machine  the problem of a machine as built, with all quantities of the study
ProblemParts sampled_problem(ProblemParts machine, ProblemParts& parts) {
  std::vector<NamedQuantity> robust;
  bool has_yield = false;
  const auto add = [&](std::vector<NamedQuantity>& of_study, const std::vector<NamedQuantity>& of_machine) {
    for (std::size_t i = 0; i < of_study.size(); ++i) {
      if (!of_study[i].sampled) continue;
      if (of_study[i].sampled->is_yield()) {
        has_yield = true;
        continue;
      }
      of_study[i].sampled->row = robust.size();
      robust.push_back(of_machine[i]);
      robust.back().sampled.reset();
    }
  };
  add(parts.objectives, machine.objectives);
  add(parts.workspace_margins, machine.workspace_margins);
  add(parts.reports, machine.reports);
  remove_statistics(machine);
  if (has_yield && machine.design_margins.empty() && machine.workspace_margins.empty())
    throw std::invalid_argument("a yield needs a [[constraint]] that a built machine can violate");
  if (has_yield)
    for (const NamedQuantity& q : machine.workspace_margins)
      if (q.quantity->external_call())
        throw std::invalid_argument("a yield cannot evaluate the Python function of the constraint " + q.name);
  machine.objectives = std::move(robust);
  machine.reports.clear();
  if (!has_yield) {
    machine.design_margins.clear();
    machine.workspace_margins.clear();
  }
  return machine;
}

}  // namespace

void read_tolerances(const ConfigValue& root, const std::function<void(StudyDraft&)>& read_problem, StudyDraft& draft) {
  const std::vector<Parameter>& known = draft.info().parameters;
  const auto table = find_tolerances(root, known);
  if (!table) return;
  const std::vector<Tolerance> tolerances = read_errors(*table, known);
  const std::vector<LimbParameter> copies = find_copies(tolerances, draft);

  StudyDraft machine{.catalogues = draft.catalogues,
                     .description = [&draft](const ConfigValue&) { return *draft.study.description; },
                     .study = {},
                     .parts = {},
                     .changes = draft.changes,
                     .implied = draft.implied};
  machine.study.file_name = draft.study.file_name;
  for (const LimbParameter& copy : copies)
    if (!find_named(known, copy.name())) machine.copies.push_back(copy);
  read_problem(machine);

  ToleranceModel& model = draft.study.tolerances.emplace();
  model.seed = draft.study.seed;
  model.samples = static_cast<std::size_t>(table->find("samples") ? table->find("samples")->integer() : 64);
  for (const StudyChanges& changes : draft.changes)
    if (changes.machines) model.samples = static_cast<std::size_t>(*changes.machines);
  const std::vector<Parameter>& all = machine.info().parameters;
  const auto index = [&all](const std::string& name) {
    return static_cast<std::size_t>(find_named(all, name) - all.data());
  };
  for (const LimbParameter& copy : machine.copies) model.copies.push_back({index(copy.name()), index(copy.parameter)});
  add_errors(tolerances, copies, all, model);
  read_correlations(*table, model);

  ProblemParts single = machine.parts;
  remove_statistics(single);
  ProblemParts& parts = draft.parts;
  const auto has_statistic = [](const std::vector<NamedQuantity>& list) {
    return std::ranges::any_of(list, [](const NamedQuantity& q) { return q.sampled.has_value(); });
  };
  table->explained([&] {
    draft.study.machine = std::make_shared<const DesignProblem>(std::move(single));
    if (!has_statistic(parts.objectives) && !has_statistic(parts.workspace_margins) && !has_statistic(parts.reports))
      return;
    ProblemParts sampled = sampled_problem(std::move(machine.parts), parts);
    std::ranges::copy(model.copies, std::back_inserter(sampled.copies));
    parts.built = std::make_shared<const BuiltMachines>(
        BuiltMachines{model, std::make_shared<const DesignProblem>(std::move(sampled))});
  });
}

}  // namespace pkm
