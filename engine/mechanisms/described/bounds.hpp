// What is certain of a description's workspace, by its graph over intervals.
#pragma once

#include "engine/mechanisms/described/evaluation.hpp"

namespace pkm::described {

VolumeBounds bound_volume(const Mechanism& mechanism, const Evaluation& evaluation, std::span<const double> parameters,
                          const SurveyPlan& plan, std::size_t mode, const BoundsOptions& options);
BoxCertificate certify_box(const Evaluation& evaluation, std::span<const double> parameters, const SurveyPlan& plan,
                           std::size_t mode, std::span<const std::array<double, 2>> ranges,
                           const BoundsOptions& options);

}  // namespace pkm::described
