// Margins of poses, as numbers or with derivatives by the parameters: for constraints on regions and motions.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Appends the finite margins of each pose to `margins`: domains, margins and clearance, each in its own unit. A pose
/// is infeasible if one of its margins is not finite, or if a joint coordinate has no solution; if such a pose has no
/// negative margin, -1 is appended so that it is recognised as infeasible.
template <class S>
void append_margins(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                    const LimitSpec& limits, std::span<const Pose<double>> poses, Scratch& scratch,
                    std::vector<S>& margins);

/// Names of the margins that append_ordered_margins() appends for a pose, in the same order.
std::vector<std::string> ordered_margin_names(const Model& model, const LimitSpec& limits);

/// Appends the margins of each pose in a fixed order, NaN where one does not exist: domains, margins, clearance, and
/// limits of quantities without a formula, which are always NaN if S has derivatives.
template <class S>
void append_ordered_margins(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                            const LimitSpec& limits, std::span<const Pose<S>> poses, Scratch& scratch,
                            std::vector<S>& margins);

/// SI unit of a margin of PoseReport::margins; "" if it is unknown, because the margin is the argument of a square root
/// or of a similar operation, or because the mechanism is not from a file.
std::string unit_of_margin(const Mechanism& mechanism, const std::string& name);

/// Unit of the passive joint `name` of PoseReport::angles: "m" for a slide of a mechanism file, otherwise "rad".
std::string unit_of_passive_joint(const Mechanism& mechanism, const std::string& name);

}  // namespace pkm::generic
