#include "engine/runner/certificates.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/largest_solid_options.hpp"

namespace pkm {
namespace {

// Beginnings of the texts of notes.
constexpr const char* kAlong = "along the motion ";
constexpr const char* kReduced = "reduced by 0.1 %, the ";

// Relative reduction of the dimensions of a largest solid before it is certified; kReduced states it in notes.
constexpr double kReduction = 1e-3;
// Maximum numbers of boxes examined for each solid, and of time intervals examined for each motion; each of them takes
// some seconds.
constexpr std::size_t kMaxSolidBoxes = 600'000;
constexpr std::size_t kMaxMotionBoxes = 200'000;

using StopFunction = std::function<bool()>;

PoseCertificate certify(const ProblemParts& parts, std::span<const double> parameters, const FollowedMotion& along,
                        const StopFunction& stop) {
  return parts.mechanism->bounds()->motion(parameters, parts.plan.limits, along.mode, *along.motion.at(parameters),
                                           {.max_boxes = kMaxMotionBoxes, .stop = stop});
}

/// The reduced largest solid of a design; no poses if the design has no largest solid.
std::vector<PoseSolid> reduced_solid(const LargestSolidFinder& finder, std::span<const double> parameters) {
  LargestSolid found = finder.find(parameters);
  if (!(found.volume > 0)) return {};
  for (double& dimension : found.solid.dimensions) dimension *= 1 - kReduction;
  return finder.pose_solids(parameters, found.solid);
}

PoseCertificate certify(const ProblemParts& parts, std::span<const double> parameters, const LargestSolidFinder& finder,
                        const PoseSolid& poses, const StopFunction& stop) {
  WorkspacePlan plan = parts.plan;
  plan.limits = finder.limits();
  return parts.mechanism->bounds()->solid(parameters, plan, "", poses, {.max_boxes = kMaxSolidBoxes, .stop = stop});
}

/// Computes a certificate for some tenths of a second. @return its estimated time [s]; 0 if it is not supported
/// @param compute        calls compute(stop)
/// @param expected_boxes  by a result that was stopped: number of boxes that the complete certificate examines
template <class Compute, class Boxes>
double estimated_seconds(const Compute& compute, const Boxes& expected_boxes) {
  constexpr double kTimeLimit = 0.3;  // [s]
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  try {
    const auto found = compute([&] { return seconds() > kTimeLimit || stop_requested(); });
    check_stop();
    return found.stopped ? seconds() * std::max(1.0, expected_boxes(found)) : seconds();
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

}  // namespace

void certify_motions(const ProblemParts& parts, const std::string& name, DesignRecord& design,
                     std::vector<std::string>& notes) {
  using Kind = PropertyResult::Kind;
  for (const FollowedMotion& along : parts.followed) {
    if (design.status != Status::feasible) return;
    const std::string begin = kAlong + along.motion.name + " the " + name + " ";
    try {
      const PoseCertificate found = certify(parts, design.parameters, along, stop_requested);
      check_stop();
      const PropertyResult& result = found.feasible;
      const std::string when = result.time ? "t = " + with_unit(*result.time, "s") : "";
      if (result.kind == Kind::holds)
        notes.push_back(begin + "satisfies every limit of a pose at every instant (certified)");
      else if (result.kind == Kind::undecided)
        notes.push_back(begin + "may violate " + result.detail + " near " + when + ": undecided");
      else {
        design.status = Status::failed;
        design.reason =
            kAlong + along.motion.name + ", " + result.detail + " is violated at " + when + ", between its samples";
      }
    } catch (const std::invalid_argument& reason) {
      notes.push_back(begin + "cannot be certified: " + reason.what());
    }
  }
}

void certify_solids(const ProblemParts& parts, const std::string& name, DesignRecord& design,
                    std::vector<std::string>& notes) {
  using Kind = PropertyResult::Kind;
  if (!parts.mechanism->bounds() || design.status != Status::feasible) return;
  for (const NamedQuantity* const measure : solid_measures(parts)) {
    const LargestSolidFinder& finder = *measure->quantity->largest_solid();
    const std::vector<PoseSolid> solids = reduced_solid(finder, design.parameters);
    if (solids.empty()) continue;
    const std::string begin = kReduced + measure->name + " of the " + name + " ";
    const auto place = [&](const PropertyResult& result) {
      std::vector<std::string> words;
      const auto& coordinates = parts.mechanism->info().coordinates;
      for (std::size_t i = 0; i < coordinates.size(); ++i)
        words.push_back(coordinates[i].name + " = " + with_unit((*result.pose)[i], coordinates[i].unit));
      return join(words);
    };
    std::string doubt;
    bool is_regular = finder.is_regular();
    try {
      for (const PoseSolid& poses : solids) {
        const auto [feasible, regular, boxes, stopped] =
            certify(parts, design.parameters, finder, poses, stop_requested);
        check_stop();
        if (feasible.kind == Kind::fails) {
          design.status = Status::failed;
          design.reason = "in its " + measure->name + ", " + feasible.detail + " is violated at " + place(feasible);
          return;
        }
        if (feasible.kind == Kind::undecided) doubt = feasible.detail + " is undecided near " + place(feasible);
        is_regular = is_regular && regular.kind != Kind::not_examined;
        if (is_regular && regular.kind != Kind::holds)
          doubt = regular.detail + (regular.kind == Kind::fails ? ", at " : " is undecided near ") + place(regular);
      }
      notes.push_back(begin + (doubt.empty() ? std::string("is feasible ") + (is_regular ? "and not singular " : "") +
                                                   "everywhere (certified)"
                                             : "is not certified: " + doubt));
    } catch (const std::invalid_argument& reason) {
      notes.push_back(begin + "cannot be certified: " + reason.what());
    }
  }
}

bool is_note_of_certificate(const std::string& note) { return note.starts_with(kAlong) || note.starts_with(kReduced); }

CertificateCost certificate_cost(const ProblemParts& parts, std::span<const double> parameters) {
  CertificateCost cost;
  const auto up_to = [](std::size_t max_boxes) {
    return [max_boxes](const PoseCertificate& found) {
      return static_cast<double>(max_boxes) / static_cast<double>(std::max<std::size_t>(found.boxes, 1));
    };
  };
  if (const ColumnOptions* const columns = parts.plan.columns(); columns && columns->certified) {
    // The gap is proportional to the size of the boxes, which cover a surface in the space of the outer coordinates.
    const auto outer = static_cast<double>(sweep_of(parts.mechanism->info(), parts.plan).swept.size()) - 1;
    cost.volume = estimated_seconds(
        [&](const StopFunction& stop) {
          return parts.mechanism->bounds()->volume(parameters, parts.plan, parts.request.mode,
                                                   {.gap = *columns->certified, .stop = stop});
        },
        [&](const VolumeBounds& found) {
          const double most = static_cast<double>(BoundsOptions().max_boxes) / static_cast<double>(found.examined + 1);
          return found.upper > 0 ? std::min(most, std::pow(found.gap() / *columns->certified, outer)) : most;
        });
    for (const FollowedMotion& along : parts.followed)
      cost.motions += estimated_seconds(
          [&](const StopFunction& stop) { return certify(parts, parameters, along, stop); }, up_to(kMaxMotionBoxes));
  }
  if (!parts.mechanism->bounds()) return cost;
  for (const NamedQuantity* const measure : solid_measures(parts)) {
    const LargestSolidFinder& finder = *measure->quantity->largest_solid();
    for (const PoseSolid& poses : reduced_solid(finder, parameters))
      cost.solids +=
          estimated_seconds([&](const StopFunction& stop) { return certify(parts, parameters, finder, poses, stop); },
                            up_to(kMaxSolidBoxes));
  }
  return cost;
}

}  // namespace pkm
