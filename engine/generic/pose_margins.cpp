#include "engine/generic/pose_margins.hpp"

#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/generic/clearance.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/generic/report_limits.hpp"

namespace pkm::generic {
namespace {

template <class S>
struct MarginScratch {
  std::vector<S> inputs, registers;
};

}  // namespace

std::string unit_of_margin(const Mechanism& mechanism, const std::string& name) {
  if (const Evaluation* const e = evaluation_of(mechanism)) {
    if (const ReportedMargin* const group = find_named(e->model.reported_margins, name)) return group->unit;
    for (const auto* const margins : {&e->model.domains, &e->model.margins})
      if (const Result* const margin = find_named(*margins, name)) return margin->unit;
  }
  const LimitInfo* const limit = find_named(mechanism.info().limits, name);
  return limit ? limit->unit : "";
}

std::string unit_of_passive_joint(const Mechanism& mechanism, const std::string& name) {
  const Evaluation* const e = evaluation_of(mechanism);
  const Result* const joint = e ? find_named(e->model.angles, name) : nullptr;
  return joint ? joint->unit : "rad";
}

template <class S>
void append_margins(const Evaluation& e, std::span<const S> parameters, std::size_t mode, const LimitSpec& limits,
                    std::span<const Pose<double>> poses, Scratch& scratch, std::vector<S>& margins) {
  const Model& model = e.model;
  const auto& outputs = e.constraints.outputs();
  const std::size_t joints = model.inputs.joints, constraints = model.domains.size() + model.margins.size();
  const std::optional<double> clearance_limit = clearance_of(model, limits);
  const bool has_report_limits = first_report_limit(model, limits) != nullptr;
  auto& [inputs, registers] = scratch.get<MarginScratch<S>>();
  inputs.resize(model.inputs.count());
  e.fill_inputs<S>(parameters, limits, mode, inputs);
  for (const Pose<double>& pose : poses) {
    for (std::size_t i = 0; i < pose.size(); ++i) inputs[model.inputs.coordinate(i)] = S(pose[i]);
    e.constraints.run_all<S>(inputs, registers);
    bool all_finite = true, assembles = true, one_is_negative = false;
    const auto add = [&](const S& margin) {
      const double value = value_of(margin);
      one_is_negative = one_is_negative || value < 0;
      if (std::isfinite(value))
        margins.push_back(margin);
      else
        all_finite = false;
      return value >= 0;
    };
    for (std::size_t i = 0; i < joints; ++i) assembles = assembles && std::isfinite(value_of(registers[outputs[i]]));
    for (std::size_t i = 0; i < constraints; ++i) {
      const bool satisfied = add(registers[outputs[joints + i]]);
      if (i < model.domains.size()) assembles = assembles && satisfied;
    }
    if (assembles && clearance_limit)
      if (const auto nearest = nearest_bodies(e, inputs, limits.obstacles))
        add(S(nearest->clearance - *clearance_limit));
    if constexpr (std::is_same_v<S, double>) {
      if (assembles && has_report_limits)
        visit_report_margins(model, limits, inspect_pose(e, parameters, pose, mode, limits),
                             [&](const std::string&, double margin) { add(margin); });
    }
    if (!(assembles && all_finite) && !one_is_negative) margins.push_back(S(-1.0));
  }
}

std::vector<std::string> ordered_margin_names(const Model& model, const LimitSpec& limits) {
  std::vector<std::string> names;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) names.push_back(result.name);
  if (clearance_of(model, limits)) names.emplace_back(kClearanceLimit);
  for (const ReportLimit& each : model.report_limits)
    if (limits.given[each.limit]) names.push_back(model.info.limits[each.limit].name);
  return names;
}

template <class S>
void append_ordered_margins(const Evaluation& e, std::span<const S> parameters, std::size_t mode,
                            const LimitSpec& limits, std::span<const Pose<S>> poses, Scratch& scratch,
                            std::vector<S>& margins) {
  const Model& model = e.model;
  const auto& outputs = e.constraints.outputs();
  const std::size_t joints = model.inputs.joints, constraints = model.domains.size() + model.margins.size();
  const std::optional<double> clearance_limit = clearance_of(model, limits);
  const S undefined(std::numeric_limits<double>::quiet_NaN());
  auto& [inputs, registers] = scratch.get<MarginScratch<S>>();
  inputs.resize(model.inputs.count());
  e.fill_inputs<S>(parameters, limits, mode, inputs);
  for (const Pose<S>& pose : poses) {
    for (std::size_t i = 0; i < pose.size(); ++i) inputs[model.inputs.coordinate(i)] = pose[i];
    e.constraints.run_all<S>(inputs, registers);
    bool assembles = true;
    for (std::size_t i = 0; i < joints; ++i) assembles = assembles && std::isfinite(value_of(registers[outputs[i]]));
    for (std::size_t i = 0; i < constraints; ++i) {
      margins.push_back(registers[outputs[joints + i]]);
      if (i < model.domains.size()) assembles = assembles && value_of(margins.back()) >= 0;
    }
    if (clearance_limit) {
      const auto nearest = assembles ? nearest_bodies(e, inputs, limits.obstacles) : std::nullopt;
      margins.push_back(nearest ? S(nearest->clearance - *clearance_limit) : undefined);
    }
    if (!first_report_limit(model, limits)) continue;
    if constexpr (std::is_same_v<S, double>) {
      if (assembles) {
        visit_report_margins(model, limits, inspect_pose(e, parameters, pose, mode, limits),
                             [&](const std::string&, double margin) { margins.push_back(margin); });
        continue;
      }
    }
    for (const ReportLimit& each : model.report_limits)
      if (limits.given[each.limit]) margins.push_back(undefined);
  }
}

template void append_ordered_margins(const Evaluation&, std::span<const double>, std::size_t, const LimitSpec&,
                                     std::span<const Pose<double>>, Scratch&, std::vector<double>&);
template void append_ordered_margins(const Evaluation&, std::span<const Dual4>, std::size_t, const LimitSpec&,
                                     std::span<const Pose<Dual4>>, Scratch&, std::vector<Dual4>&);
template void append_margins(const Evaluation&, std::span<const double>, std::size_t, const LimitSpec&,
                             std::span<const Pose<double>>, Scratch&, std::vector<double>&);
template void append_margins(const Evaluation&, std::span<const Dual4>, std::size_t, const LimitSpec&,
                             std::span<const Pose<double>>, Scratch&, std::vector<Dual4>&);

}  // namespace pkm::generic
