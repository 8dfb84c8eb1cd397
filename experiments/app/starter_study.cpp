#include "experiments/app/starter_study.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "engine/config/swept_coordinates.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/display_unit.hpp"
#include "engine/core/error.hpp"
#include "engine/core/formatted.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "experiments/app/catalogue.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxVariables = 4;
constexpr double kLowerFactor = 0.8, kUpperFactor = 1.25;  // bounds of a variable, relative to its default value
constexpr double kQuick = 5e-3;  // CPU time [s] of an evaluation up to which a study uses exact columns

/// Text of a TOML string, in quotes.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// A comment at the end of a TOML line. Control characters are escaped, so that a text from a mechanism file cannot end
/// the line.
std::string comment(const std::string& text) { return "    # " + printable(text) + '\n'; }

bool is_built_in(const Catalogues& catalogues, const std::string& name) {
  return std::ranges::any_of(catalogues.mechanisms, [&](const auto& m) { return m.name() == name; });
}

/// The line of the table [mechanism] that names the mechanism. The path of a mechanism file is relative to the folder
/// of the study that is written.
std::string mechanism_key(const Catalogues& catalogues, const std::string& name, const std::string& output) {
  if (is_built_in(catalogues, name)) return "type = " + quoted_toml(name) + '\n';
  const auto folder_of = [](const std::string& file) { return fs::weakly_canonical(fs::absolute(file).parent_path()); };
  const fs::path here = output.empty() ? fs::weakly_canonical(fs::current_path()) : folder_of(output);
  const fs::path there = folder_of(name) / fs::path(name).filename();
  const std::string path = there.lexically_proximate(here).string();
  if (printable(path) != path)
    throw ConfigError({"", 0, "new study"}, "'" + path + "'", "a path in UTF-8 without control characters");
  return "file = " + quoted_toml(path) + comment("relative to this file");
}

/// A value as TOML: a number, or text with the unit that people use, such as "160 mm".
std::string toml_value(double value, const std::string& unit) {
  return unit == "1" || unit.empty() ? shortest(value) : quoted_toml(display_text(value, unit));
}

/// A value rounded to two significant digits in its display unit.
double rounded(double value, const std::string& unit) {
  const DisplayUnit shown = display_unit(unit);
  const std::string text = formatted("%.2g", value / shown.size);
  return parse_quantity(with_name(text, shown), unit).value();
}

/// A bound of a variable: a multiple of its default value, rounded, within the parameter's range.
struct Bound {
  double value;
  std::string text;  ///< the bound as TOML
  bool is_limited;   ///< true if the range of the parameter limits the bound
};
Bound bound(double factor, const Parameter& p) {
  const double wanted = rounded(factor * p.nominal, p.unit), value = std::clamp(wanted, p.lower, p.upper);
  // A limit is written in SI units, so that no rounding error of a conversion puts it outside of the range.
  return {value,
          value == wanted ? toml_value(value, p.unit)
          : p.unit == "1" ? shortest(value)
                          : quoted_toml(with_unit(value, p.unit)),
          value != wanted};
}

/// Parameters that can become variables (positive default value, range not empty), lengths first.
std::vector<const Parameter*> candidates(const std::vector<Parameter>& parameters) {
  std::vector<const Parameter*> all;
  for (const bool length : {true, false})
    for (const Parameter& p : parameters)
      if ((p.unit == "m") == length && p.nominal > 0 && p.lower < p.upper) all.push_back(&p);
  return all;
}

std::vector<const Parameter*> first_few(std::vector<const Parameter*> parameters) {
  parameters.resize(std::min(parameters.size(), kMaxVariables));
  return parameters;
}

struct StarterStudy {
  std::vector<const Parameter*> variables;
  bool by_columns = false;
  std::string why_method;   ///< comment that states why the method (columns or voxels) was selected
  std::string constraints;  ///< further tables of the study
};

class StudyWriter {
 public:
  StudyWriter(const Catalogues& catalogues, std::string name, std::string output)
      : catalogues_(catalogues),
        name_(std::move(name)),
        output_(std::move(output)),
        mechanism_(find_mechanism(catalogues, name_)),
        info_(mechanism_->info()) {
    if (!is_built_in(catalogues_, name_)) description_ = {read_text_file(name_, "a mechanism in TOML"), name_};
    for (const Parameter& p : info_.parameters) defaults_.push_back(p.nominal);
  }

  std::string write() const {
    StarterStudy draft{first_few(candidates(info_.parameters))};
    const Study voxels = read(draft);
    try {
      voxels.problem->workspace(voxels.problem->parts().parameters);  // throws if the mechanism has no search box
      draft.variables = influential_variables(*voxels.problem, *mechanism_);
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({name_, 0, ""}, reason.what());
    }
    choose_method(draft);
    const std::string examples = constraint_examples(draft);
    return text(draft) +
           (examples.empty() ? "" : "\n# Examples of constraints; remove the '# ' to use one.\n" + examples);
  }

 private:
  Study read(const StarterStudy& draft) const {
    return read_study_toml(text(draft), "the study", catalogues_, description_);
  }

  std::string text(const StarterStudy& draft) const {
    std::string text = "# A study of " + printable(info_.name) +
                       " for pkmopt. Check it with 'pkmopt check FILE', run it with 'pkmopt run FILE'.\n";
    text += "[mechanism]\n" + mechanism_key(catalogues_, name_, output_);
    text += "\n[variables]" + comment("parameters that the optimiser varies: 80 .. 125 % of their defaults, rounded");
    std::string baseline;
    for (const Parameter* const p : draft.variables) {
      const Bound lower = bound(kLowerFactor, *p), upper = bound(kUpperFactor, *p);
      const std::string range = display_range(p->lower, p->upper, p->unit);
      text += p->name + " = { min = " + lower.text + ", max = " + upper.text + " }" +
              comment((p->meaning.empty() ? p->name : p->meaning) +
                      (lower.is_limited || upper.is_limited ? "; the mechanism allows " + range : ""));
      baseline += p->name + " = " + toml_value(p->nominal, p->unit) + '\n';
    }
    if (!baseline.empty())
      text += "\n[baseline]" + comment("the design to compare with: the defaults of the mechanism") + baseline;
    text += "\n[workspace]" + (draft.why_method.empty() ? "\n" : comment(draft.why_method));
    if (draft.by_columns) {
      text += "method = \"columns\"\n";
    } else {
      std::vector<std::string> cells;
      for (const std::string& axis : coordinate_names(info_, info_.sweeps.front().swept))
        cells.push_back(axis + " = 24");
      text += "method = \"voxels\"\ncells = { " + join(cells) + " }" + comment("more cells are more accurate");
    }
    text += "\n[[objective]]\n";
    if (const Size* const size = mechanism_->size())
      text += "type = \"workspace-ratio\"" + comment("volume divided by " + size->meaning());
    else
      text += "type = \"workspace-volume\"\n";
    text += "\n[[stage]]" + comment("a genetic algorithm finds the region of the best designs") +
            "optimiser = \"ga\"\ngenerations = " + (draft.by_columns ? "20" : "50") + '\n';
    if (draft.by_columns)
      text += "\n[[stage]]" + comment("a gradient solver refines the best of them to a local optimum") +
              "optimiser = \"nlopt\"\nalgorithm = \"slsqp\"\n";
    return text + draft.constraints;
  }

  /// Selects exact columns if the mechanism has them with derivatives, and if they are quick for the default design.
  void choose_method(StarterStudy& draft) const {
    draft.why_method = "counts feasible cells of a grid: the mechanism has no exact columns";
    if (!mechanism_->columns()) return;
    draft.by_columns = true;
    try {
      const Study study = read(draft);
      constexpr double kTimeLimit = 2;  // elapsed time [s] of the measurement
      const StopScope limit(kTimeLimit);
      const auto seconds = [&] {
        const std::clock_t begin = std::clock();
        const bool failed = study.problem->report(defaults_).status == Status::failed;
        return failed ? 1.0 : static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      };
      seconds();  // warms up
      if (!study.problem->why_no_derivatives() && std::min(seconds(), seconds()) < kQuick) {
        draft.why_method = "exact, with derivatives; quick for the default design";
        return;
      }
    } catch (const ConfigError&) {  // this mechanism's columns do not support the study
    } catch (const std::invalid_argument&) {
    } catch (const Stopped&) {
    }
    draft.by_columns = false;
    draft.why_method = "counts feasible cells of a grid: exact columns take more than 5 ms for the default design";
  }

  /// One constraint of each kind that the mechanism supports, as comments. Each of them has been read as part of the
  /// study.
  std::string constraint_examples(const StarterStudy& draft) const {
    std::string all;
    const auto add = [&](const std::string& tables) {
      StarterStudy tried = draft;
      tried.constraints = '\n' + tables;
      try {
        const Study study = read(tried);
        if (draft.by_columns && study.problem->why_no_derivatives()) return;
      } catch (const ConfigError&) {
        return;
      } catch (const std::invalid_argument&) {
        return;
      }
      all += '\n';
      for (std::size_t begin = 0, end = 0; begin < tables.size(); begin = end + 1) {
        end = tables.find('\n', begin);
        all += (end > begin ? "# " : "#") + tables.substr(begin, end - begin) + '\n';
      }
    };
    const auto constraint = [](const std::string& type, const std::string& meaning, const std::string& options) {
      return "[[constraint]]" + comment(meaning) + "type = " + quoted_toml(type) + '\n' + options;
    };
    if (const DesignTests* const tests = mechanism_->design_tests(); tests && !tests->list().empty()) {
      const DesignMarginInfo& test = tests->list().front();
      if (!find_named(catalogues_.constraints, test.name))
        add(constraint(test.name, "a test of the mechanism file: " + test.meaning, ""));
    }
    for (const ConstraintEntry& entry : catalogues_.constraints) {
      if (entry.refusal(*mechanism_)) continue;
      if (const auto given = example_options(entry, draft))
        add(given->first + constraint(entry.name, entry.meaning, given->second));
    }
    const ObjectiveEntry* const conditioning = find_named(catalogues_.objectives, "conditioning");
    if (conditioning && !conditioning->refusal(*mechanism_))
      add(constraint("conditioning", conditioning->meaning + "; any objective can be bounded", "min = 0.1\n"));
    return all;
  }

  /// Example values of the options of a constraint, as TOML, and the tables that they refer to (first); std::nullopt if
  /// there is no example for this constraint.
  std::optional<std::pair<std::string, std::string>> example_options(const ConstraintEntry& entry,
                                                                     const StarterStudy& draft) const {
    using Tables = std::pair<std::string, std::string>;
    const std::vector<OptionSpec> specs = entry.options(info_);
    if (entry.name == "clearance") return Tables{"", "min = \"5 mm\"\n"};
    if (entry.name == "singularity-margin") {
      const auto spec = std::ranges::find_if(
          specs, [](const OptionSpec& s) { return s.kind == OptionKind::number && s.unit == "1" && s.upper >= 0.1; });
      if (spec == specs.end()) return {};
      return Tables{"", spec->name + " = 0.1" + comment(spec->meaning)};
    }
    if (entry.name == "task-workspace" || entry.name == "motion") return example_of_poses(entry.name, draft);
    if (entry.name == "linear" || entry.name == "expression") {
      const Parameter* first = nullptr;
      const Parameter* second = nullptr;
      for (const Parameter* const a : draft.variables)
        for (const Parameter* const b : draft.variables)
          if (!first && a != b && a->unit == b->unit) first = a, second = b;
      if (!first) return {};
      if (entry.name == "linear")
        return Tables{"", "coefficients = { " + first->name + " = 1, " + second->name + " = 1 }\nbound = " +
                              toml_value(rounded(1.1 * (first->nominal + second->nominal), first->unit), first->unit) +
                              '\n'};
      return Tables{"", "expression = " + quoted_toml(first->name + " / " + second->name) +
                            "\nmin = " + shortest(rounded(0.9 * first->nominal / second->nominal, "1")) + '\n'};
    }
    if (needs_options(specs)) return {};
    return Tables{"", ""};
  }

  /// A region or a motion about a pose in the middle of the default design's workspace, and the option that names it.
  std::optional<std::pair<std::string, std::string>> example_of_poses(const std::string& type,
                                                                      const StarterStudy& draft) const {
    constexpr double kShare = 0.05;  // extent to each side, relative to the range of the coordinate
    const auto middle = central_pose(*mechanism_, defaults_, no_limits(info_), info_.modes.front());
    const auto ranges = mechanism_->ranges(defaults_);
    if (!middle || !ranges) return {};
    const auto about = [&](int coordinate, double side) {
      const auto i = static_cast<std::size_t>(coordinate);
      const AxisInfo& axis = info_.coordinates[i];
      const double extent = kShare * ((*ranges)[i][1] - (*ranges)[i][0]);
      return toml_value(rounded((*middle)[i], axis.unit) + side * rounded(extent, axis.unit), axis.unit);
    };
    if (type == "motion") {
      std::vector<std::string> pose;
      for (int i = 0; i < std::ssize(info_.coordinates); ++i)
        pose.push_back(info_.coordinates[static_cast<std::size_t>(i)].name + " = " + about(i, 0));
      const int moved = info_.sweeps.front().swept.front();
      return std::pair{"[[motion]]\nname = \"move\"\ntype = \"points\"\nacceleration = \"5 m/s^2\"\npoints = [{ " +
                           join(pose) + " }, { " + coordinate_names(info_, {moved})[0] + " = " + about(moved, 1) +
                           " }]\n\n",
                       std::string("motion = \"move\"\n")};
    }
    std::vector<std::string> box, cells;
    const std::vector<int>& swept = info_.sweeps.front().swept;
    for (const int i : swept) {
      const std::string name = coordinate_names(info_, {i})[0];
      box.push_back(name + " = [" + about(i, -1) + ", " + about(i, 1) + "]");
      cells.push_back(name + " = 4");
    }
    const std::string method =
        draft.by_columns ? "method = \"columns\"\n" : "method = \"voxels\"\ncells = { " + join(cells) + " }\n";
    return std::pair{"[[region]]" + comment("a box of poses in the middle of the workspace") + "name = \"task\"\n" +
                         method + "box = { " + join(box) + " }\n\n",
                     std::string("region = \"task\"\n")};
  }

  /// Selects as variables the first candidates that influence the objective: changing only this parameter of the
  /// default design to one of the variable's bounds changes the objective. If there is no such candidate, for example
  /// because the workspace is empty, selects the first candidates.
  static std::vector<const Parameter*> influential_variables(const DesignProblem& problem, const Mechanism& mechanism) {
    const MechanismInfo& info = mechanism.info();
    std::vector<double> design;
    for (const Parameter& p : info.parameters) design.push_back(p.nominal);
    const auto objective = [&] {
      return mechanism.refuse(design) ? std::nan("") : problem.report(design).objectives[0];
    };
    const double default_value = objective();
    const auto all = candidates(info.parameters);
    std::vector<const Parameter*> some;
    for (const Parameter* const p : all) {
      if (some.size() == kMaxVariables) break;
      double& value = design[static_cast<std::size_t>(p - info.parameters.data())];
      const auto changes = [&](double factor) {
        value = bound(factor, *p).value;
        const double changed = objective();
        return !std::isnan(changed) && changed != default_value;
      };
      if (changes(kLowerFactor) || changes(kUpperFactor)) some.push_back(p);
      value = p->nominal;
    }
    return some.empty() ? first_few(all) : some;
  }

  const Catalogues& catalogues_;
  std::string name_, output_;
  std::shared_ptr<const Mechanism> mechanism_;
  const MechanismInfo& info_;
  std::optional<SourceText> description_;
  std::vector<double> defaults_;
};

}  // namespace

std::string starter_study(const Catalogues& catalogues, const std::string& mechanism, const std::string& output) {
  return StudyWriter(catalogues, mechanism, output).write();
}

}  // namespace pkm
