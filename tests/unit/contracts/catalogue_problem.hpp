// Design problem with all entries of the catalogues: every objective with each of its statistics, every design-level
// constraint, and every parameter as a variable; with random designs and limits for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <vector>

#include "constraints/all.hpp"
#include "engine/math/random.hpp"
#include "engine/problem/design_problem.hpp"
#include "objectives/all.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm::test {

/// Default options; for options without a default, a linear relation of the first two parameters, the formula, and the
/// region and motion of the fixtures.
inline Options test_options(const std::vector<OptionSpec>& specs, const MechanismInfo& info,
                            const std::string& expression) {
  Options options = default_options(specs);
  for (const OptionSpec& spec : specs) {
    if (spec.kind == OptionKind::named_numbers)
      options.set(spec.name, NamedNumbers{{info.parameters[0].name, 0.7}, {info.parameters[1].name, -1.3}});
    if (spec.name == "expression") options.set(spec.name, expression);
    if (spec.name == "quantity") options.set(spec.name, some_quantity(info));
    if (spec.name == "region") options.set(spec.name, std::string("task"));
    if (spec.name == "motion" && spec.required) options.set(spec.name, std::string("swing"));
    if (spec.name == "samples") options.set(spec.name, std::int64_t{5});
  }
  return options;
}

/// False if the choice is the number of a joint that the mechanism does not have.
inline bool is_valid_choice(const std::string& choice, const MechanismInfo& info) {
  const bool number = choice.size() == 1 && std::isdigit(static_cast<unsigned char>(choice[0]));
  return !number || static_cast<std::size_t>(choice[0] - '0') <= info.joints.size();
}

/// The same options once for each choice of the options that have choices.
inline std::vector<Options> every_choice(const std::vector<OptionSpec>& specs, const MechanismInfo& info,
                                         const std::string& expression) {
  std::vector<Options> all{test_options(specs, info, expression)};
  for (const OptionSpec& spec : specs) {
    std::vector<Options> more;
    for (const Options& options : all)
      for (const std::string& choice : spec.choices) {
        if (!is_valid_choice(choice, info)) continue;
        more.push_back(options);
        more.back().set(spec.name, choice);
      }
    if (!more.empty()) all = more;
  }
  return all;
}

/// Which objectives to include: of the volume only, also of the conditioning, also of the joint-space inertia.
enum class Of { volume, kinematics, inertia };

/// @param centre  of the box of poses of the task-workspace constraint
inline DesignProblem everything(const std::shared_ptr<const Mechanism>& mechanism, const WorkspacePlan& plan, Of of,
                                const Pose<double>& centre) {
  const MechanismInfo& info = mechanism->info();
  ProblemParts parts;
  parts.mechanism = mechanism;
  parts.parameters = nominal(info);
  parts.plan = plan;
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const Parameter& p = info.parameters[i];
    variables.push_back({p.name, p.unit, p.lower, p.upper});
    parts.varies.push_back(i);
  }
  parts.space = DesignSpace(variables);
  const std::string product = info.parameters[0].name + " * " + info.parameters[1].name;
  for (const ObjectiveEntry& entry : all_objectives()) {
    // Objectives that depend on the design only have their own tests: random designs may fail them.
    if (!entry.uses_workspace || entry.refusal(*mechanism)) continue;
    for (const Options& options : every_choice(entry.options, info, "volume * " + product)) {
      // The standard deviation of a constant has no derivative, and the conditioning of some mechanisms is constant.
      if (entry.name == "quantity" && options.word("statistic") == "std") continue;
      const EntryContext context{*mechanism, plan, options};
      if (!entry.reads(context)) continue;
      FieldRequest request = parts.request;
      entry.request(context, request);
      if (of == Of::volume && request.needs_jacobian()) continue;
      if (of != Of::inertia && request.needs_inertia()) continue;
      auto quantity = entry.make(context);
      if (quantity->why_no_derivatives()) continue;
      parts.request = request;
      parts.objectives.push_back(
          {entry.name, entry.unit(context), entry.meaning, entry.direction, std::move(quantity)});
    }
  }
  for (const ConstraintEntry& entry : all_constraints()) {
    if (entry.pose_level() || entry.refusal(*mechanism)) continue;
    const Options options = test_options(entry.options(info), info, "1 - " + product);
    const std::vector<Region> regions = {task(info, centre)};
    const std::vector<DesignMotion> swing = motions(*mechanism);
    const EntryContext context{*mechanism, plan, options, regions, swing};
    NamedQuantity margin;
    margin.name = entry.name;
    margin.quantity = entry.make(context);
    if (margin.quantity->why_no_derivatives()) continue;
    parts.design_margins.push_back(margin);
  }
  return DesignProblem(parts);
}
inline DesignProblem everything(const std::shared_ptr<const Mechanism>& mechanism, const WorkspacePlan& plan,
                                Of of = Of::kinematics) {
  return everything(mechanism, plan, of, reference_pose(*mechanism));
}

/// A design whose parameters are 0.6 to 1.6 times the nominal ones.
inline std::vector<double> random_design(const MechanismInfo& info, Stream& random) {
  std::vector<double> design = nominal(info);
  for (std::size_t i = 0; i < design.size(); ++i)
    design[i] = std::clamp(design[i] * (0.6 + random.u01()), info.parameters[i].lower, info.parameters[i].upper);
  return design;
}

/// Whether workspace analyses with this limit have derivatives.
inline bool has_derivatives(const LimitInfo& limit) { return limit.group != "clearance"; }

/// A design with the fixed coordinates and limits of a plan, to reproduce a failure.
inline std::string told(const MechanismInfo& info, const std::vector<double>& design, const WorkspacePlan& plan) {
  std::ostringstream text;
  text << std::setprecision(17) << "parameters";
  for (std::size_t i = 0; i < design.size(); ++i) text << ' ' << info.parameters[i].name << '=' << design[i];
  text << "; fixed";
  for (const FixedCoordinate& fixed : plan.fixed) {
    text << ' ' << info.coordinates[static_cast<std::size_t>(fixed.coordinate)].name;
    if (fixed.kind == FixedCoordinate::Kind::value) text << '=' << fixed.value;
    if (fixed.kind == FixedCoordinate::Kind::integrated) text << " integrated";
  }
  text << "; limits";
  for (std::size_t i = 0; i < plan.limits.given.size(); ++i)
    if (plan.limits.given[i]) text << ' ' << info.limits[i].name << '=' << *plan.limits.given[i];
  return text.str();
}

/// Random thresholds for half of the limits that have derivatives: up to 0.4 of the way from the inactive to an
/// infeasible value (lengths: at most 1 m), or derived from the design if the limit has a derivation.
inline LimitSpec random_limits(const MechanismInfo& info, Stream& random) {
  LimitSpec spec = no_limits(info);
  const LimitSpec end = infeasible_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const double choice = random.u01(), share = 0.4 * random.u01(), inactive = info.limits[i].inactive;
    if (!has_derivatives(info.limits[i])) continue;
    if (choice < 0.25 && !info.limits[i].derivation.empty())
      spec.derived[i] = true;
    else if (choice < 0.5)
      spec.given[i] = inactive + share * (std::min(*end.given[i], 1.0) - inactive);
  }
  return spec;
}

}  // namespace pkm::test
