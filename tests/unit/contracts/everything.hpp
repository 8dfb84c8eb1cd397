// A problem made of all that the catalogues hold: every objective in each of its statistics, every design-level
// constraint, and every parameter a variable. And random designs and limits for it.
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
#include "tests/unit/contracts/nominal.hpp"

namespace pkm::test {

/// Default options, and for what has no default: a relation of the first two parameters, a formula.
inline Options some_options(const std::vector<OptionSpec>& specs, const MechanismInfo& info,
                            const std::string& expression) {
  Options options = default_options(specs);
  for (const OptionSpec& spec : specs) {
    if (spec.kind == OptionKind::named_numbers)
      options.set(spec.name, NamedNumbers{{info.parameters[0].name, 0.7}, {info.parameters[1].name, -1.3}});
    if (spec.name == "expression") options.set(spec.name, expression);
    if (spec.name == "region") options.set(spec.name, std::string("task"));
    if (spec.name == "motion") options.set(spec.name, std::string("swing"));
    if (spec.name == "samples") options.set(spec.name, std::int64_t{5});
  }
  return options;
}

/// Not the number of a joint that the mechanism lacks.
inline bool makes_sense(const std::string& choice, const MechanismInfo& info) {
  const bool number = choice.size() == 1 && std::isdigit(static_cast<unsigned char>(choice[0]));
  return !number || static_cast<std::size_t>(choice[0] - '0') <= info.joints.size();
}

/// The same, in each choice of an option that has choices.
inline std::vector<Options> every_choice(const std::vector<OptionSpec>& specs, const MechanismInfo& info,
                                         const std::string& expression) {
  std::vector<Options> all{some_options(specs, info, expression)};
  for (const OptionSpec& spec : specs) {
    std::vector<Options> more;
    for (const Options& options : all)
      for (const std::string& choice : spec.choices) {
        if (!makes_sense(choice, info)) continue;
        more.push_back(options);
        more.back().set(spec.name, choice);
      }
    if (!more.empty()) all = more;
  }
  return all;
}

/// Which objectives: those of the volume, with conditioning, and with inertia too.
enum class Of { volume, kinematics, inertia };

/// @param centre  of the box of poses that is to be feasible
inline DesignProblem everything(const std::shared_ptr<const Mechanism>& mechanism, const SurveyPlan& plan, Of of,
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
    // Those that look at the design alone have nothing of the survey, and designs may fail them: their own tests.
    if (!entry.reads_survey || entry.refusal(*mechanism)) continue;
    for (const Options& options : every_choice(entry.options, info, "volume * " + product)) {
      const EntryContext context{*mechanism, plan, options};
      Demand demand = parts.demand;
      entry.demand(context, demand);
      if (of == Of::volume && demand.needs_jacobian()) continue;
      if (of != Of::inertia && demand.needs_inertia()) continue;
      auto quantity = entry.make(context);
      if (quantity->no_derivatives()) continue;
      parts.demand = demand;
      parts.objectives.push_back(
          {entry.name, entry.unit(context), entry.meaning, entry.direction, std::move(quantity)});
    }
  }
  for (const ConstraintEntry& entry : all_constraints()) {
    if (entry.pose_level() || entry.refusal(*mechanism)) continue;
    const Options options = some_options(entry.options(info), info, "1 - " + product);
    const std::vector<Region> regions = {task(info, centre)};
    const std::vector<NamedMotion> swing = motions(*mechanism);
    const EntryContext context{*mechanism, plan, options, regions, swing};
    NamedQuantity margin;
    margin.name = entry.name;
    margin.quantity = entry.make(context);
    if (margin.quantity->no_derivatives()) continue;
    parts.design_margins.push_back(margin);
  }
  return DesignProblem(parts);
}
inline DesignProblem everything(const std::shared_ptr<const Mechanism>& mechanism, const SurveyPlan& plan,
                                Of of = Of::kinematics) {
  return everything(mechanism, plan, of, usual_pose(*mechanism));
}

/// A design whose parameters are 0.6 to 1.6 times the nominal ones.
inline std::vector<double> random_design(const MechanismInfo& info, Stream& random) {
  std::vector<double> design = nominal(info);
  for (std::size_t i = 0; i < design.size(); ++i)
    design[i] = std::clamp(design[i] * (0.6 + random.u01()), info.parameters[i].lower, info.parameters[i].upper);
  return design;
}

/// Whether surveys under the limit have derivatives.
inline bool has_slopes(const LimitInfo& limit) { return limit.group != "clearance"; }

/// A design and what its survey holds and limits, to see a finding again.
inline std::string told(const MechanismInfo& info, const std::vector<double>& design, const SurveyPlan& plan) {
  std::ostringstream text;
  text << std::setprecision(17) << "parameters";
  for (std::size_t i = 0; i < design.size(); ++i) text << ' ' << info.parameters[i].name << '=' << design[i];
  text << "; held";
  for (const HeldCoordinate& held : plan.held) {
    text << ' ' << info.coordinates[static_cast<std::size_t>(held.coordinate)].name;
    if (held.kind == HeldCoordinate::Kind::value) text << '=' << held.value;
    if (held.kind == HeldCoordinate::Kind::integrated) text << " integrated";
  }
  text << "; limits";
  for (std::size_t i = 0; i < plan.limits.given.size(); ++i)
    if (plan.limits.given[i]) text << ' ' << info.limits[i].name << '=' << *plan.limits.given[i];
  return text.str();
}

/// Half of the limits that have slopes, each up to 0.4 of the way from inactive to where nothing passes (a length
/// counts up to 1 m), or derived from the design where it can be.
inline LimitSpec random_limits(const MechanismInfo& info, Stream& random) {
  LimitSpec spec = no_limits(info);
  const LimitSpec end = absurd_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const double choice = random.u01(), share = 0.4 * random.u01(), inactive = info.limits[i].inactive;
    if (!has_slopes(info.limits[i])) continue;
    if (choice < 0.25 && !info.limits[i].derivation.empty())
      spec.derived[i] = true;
    else if (choice < 0.5)
      spec.given[i] = inactive + share * (std::min(*end.given[i], 1.0) - inactive);
  }
  return spec;
}

}  // namespace pkm::test
